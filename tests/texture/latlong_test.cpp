// Latitude-longitude environments: the projection, its derivatives, lookups across the seam.
#include "pictures.h"
#include <algorithm>
#include <cmath>

namespace latlong_test {

using namespace alpenglow;
using namespace alpenglow::texture;
using namespace alpenglow::display::test;
using namespace alpenglow::texture::test;
using display::Image;
using display::makeImage;

TEST(LatLong, Convention) {
    LatLong map;
    float s, t;
    auto expect = [&](Vec3 d, float es, float et) {
        map.project(d, s, t);
        EXPECT_NEAR(s, es, 1e-6f);
        EXPECT_NEAR(t, et, 1e-6f);
    };
    expect({0, 0, 5}, 0, 0);
    expect({0, 0, -1}, 0, 1);
    expect({1, 0, 0}, 0, 0.5f);
    expect({0, 2, 0}, 0.25f, 0.5f);
    expect({-1, 0, 0}, 0.5f, 0.5f);
    expect({0, -1, 0}, 0.75f, 0.5f);
    expect({1, 1, 0}, 0.125f, 0.5f);
    expect({1, 0, 1}, 0, 0.25f);
    expect({0, 0, 0}, 0.5f, 0.5f);
    map.pole = {0, 1, 0};
    map.zero = {0, 0, 1};
    map.quarter = {1, 0, 0};
    expect({0, 1, 0}, 0, 0);
    expect({1, 0, 0}, 0.25f, 0.5f);
}

TEST(LatLong, ProjectionIsTheInverseOfDirection) {
    LatLong map;
    for (float s = 0.01f; s < 1; s += 0.0973f)
        for (float t = 0.02f; t < 1; t += 0.0871f) {
            Vec3 d = map.direction(s, t);
            float s2, t2;
            map.project(d * 3.0f, s2, t2);
            EXPECT_NEAR(s2, s, 2e-6f);
            EXPECT_NEAR(t2, t, 1e-6f);
            // Derivatives by central differences.
            for (Vec3 e : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
                float h = 1e-3f, sa, ta, sb, tb, ds, dt;
                map.project(d + e * h, sa, ta);
                map.project(d - e * h, sb, tb);
                map.differentiate(d, e, ds, dt);
                float numeric = (sa - sb) / (2 * h);
                if (std::fabs(numeric) < 5)
                    EXPECT_NEAR(ds, std::clamp(numeric, -1.0f, 1.0f), 2e-3f + 2e-3f * std::fabs(numeric)); // not across the seam
                EXPECT_NEAR(dt, (ta - tb) / (2 * h), 1e-3f);
            }
        }
}

TEST(LatLong, LooksUpAndWraps) {
    Image m = makeImage(8, 4, {"y"});
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x) m.pixel(x, y)[0] = float(y < 2);
    auto t = makeTextureFrom(m);
    float v;
    LatLong map;
    environmentLatLong(t.get(), map, 0, 1, {0, 0.1f, 1}, {}, {}, {}, &v);
    EXPECT_EQ(v, 1); // up is the top half
    environmentLatLong(t.get(), map, 0, 1, {0.1f, 0, -1}, {}, {}, {}, &v);
    EXPECT_EQ(v, 0);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x) m.pixel(x, y)[0] = x == 0 ? 2 : x == 7 ? 4 : 0;
    t = makeTextureFrom(m);
    environmentLatLong(t.get(), map, 0, 1, {1, 0, 0}, {}, {}, {}, &v);
    EXPECT_NEAR(v, 3, 1e-5f); // the seam lies between the first and the last column
    float fill;
    LookupOptions o;
    o.fill = 0.25f;
    environmentLatLong(nullptr, map, 0, 1, {1, 0, 0}, {}, {}, o, &fill);
    EXPECT_EQ(fill, 0.25f);
    Vec3 corners[4] = {{1, 0.1f, 0.1f}, {1, -0.1f, 0.1f}, {1, 0.1f, -0.1f}, {1, -0.1f, -0.1f}};
    environmentLatLongQuad(t.get(), map, 0, 1, corners, {}, &v);
    EXPECT_NEAR(v, 3, 1e-4f);
}

} // namespace latlong_test
