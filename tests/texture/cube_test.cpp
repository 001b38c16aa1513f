// Cube maps, and Make requests by name.
#include "../display/support.h"
#include "texture/maketexture.h"
#include "texture/texture.h"
#include <cmath>

namespace cube_test {

using namespace alpenglow;
using namespace alpenglow::texture;
using namespace alpenglow::display::test;
using display::Image;
using display::makeImage;

namespace {

/// Writes six pictures whose pixels hold the direction they are seen in (x y z, divided by the largest), for 90 degrees.
std::vector<std::string> directionFaces(const Scratch& s, int n, float cot) {
    const char* names[] = {"px", "nx", "py", "ny", "pz", "nz"};
    // Right, up, outward of a left-handed camera turned towards each axis.
    const Vec3 axes[6][3] = {{{0, 0, -1}, {0, 1, 0}, {1, 0, 0}}, {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}},
                             {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}, {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                             {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},  {{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}}};
    std::vector<std::string> files;
    for (int f = 0; f < 6; ++f) {
        // Left-handed: right x up points towards the viewer in a right-handed rule, so right x up = out by components.
        EXPECT_EQ(cross(axes[f][0], axes[f][1]), axes[f][2]);
        Image m = makeImage(n, n, {"r", "g", "b"});
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                float a = (2 * (float(x) + 0.5f) / float(n) - 1) / cot, b = (1 - 2 * (float(y) + 0.5f) / float(n)) / cot;
                Vec3 d = axes[f][2] + axes[f][0] * a + axes[f][1] * b;
                for (int c = 0; c < 3; ++c) m.pixel(x, y)[c] = d[c];
            }
        display::WriteOptions o;
        o.policy = s.policy();
        Diagnostics d;
        files.push_back(std::string(names[f]) + ".exr");
        EXPECT_TRUE(display::writeImage(files.back(), m, o, d));
    }
    return files;
}

} // namespace

TEST(Cube, ShowsTheDirectionItIsSeenIn) {
    for (float fov : {90.0f, 95.0f}) {
        Scratch s;
        float cot = float(1 / std::tan(fov * kPi / 360));
        auto files = directionFaces(s, 32, cot);
        Diagnostics d;
        MakeOptions o;
        o.policy = s.policy();
        o.searchPath = {s.dir.string()};
        auto strings = files;
        strings.push_back("all.env");
        ASSERT_TRUE(runMakeRequest("MakeCubeFaceEnvironment", strings, {fov, 1, 1}, o, d)) << messages(d);
        TextureSystem sys(d);
        Handle h = sys.open("all.env", {s.dir.string()});
        ASSERT_TRUE(h);
        EXPECT_EQ(sys.info(h)->type, "environment");
        for (int i = 0; i < 500; ++i) {
            // Directions all round, not the outermost half texel of a 90 degree face, where there is only clamping.
            float z = 2 * (float(i) + 0.5f) / 500 - 1, phi = 2.399963f * float(i);
            Vec3 v{std::sqrt(1 - z * z) * std::cos(phi), std::sqrt(1 - z * z) * std::sin(phi), z};
            float m = std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
            Vec3 want = v / m;
            float second = std::max({std::fabs(want.x) < 1 ? std::fabs(want.x) : 0, std::fabs(want.y) < 1 ? std::fabs(want.y) : 0,
                                     std::fabs(want.z) < 1 ? std::fabs(want.z) : 0});
            if (second > 0.96f) continue;
            float got[3];
            environment(h, {}, 0, 3, v, {}, {}, {}, got);
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], want[c], 2e-5f) << i;
        }
        EXPECT_TRUE(d.all().empty()) << messages(d);
    }
}

TEST(Cube, DerivativesByDifferences) {
    for (int i = 0; i < 60; ++i) {
        float z = 2 * (float(i) + 0.5f) / 60 - 1, phi = 2.4f * float(i), h = 1e-3f;
        Vec3 v{std::sqrt(1 - z * z) * std::cos(phi), std::sqrt(1 - z * z) * std::sin(phi), z}, e{0.3f, -0.5f, 0.7f};
        float s, t, sa, ta, sb, tb, ds, dt;
        int face = cubeFace(v, 1, s, t);
        if (cubeFace(v + e * h, 1, sa, ta) != face || cubeFace(v - e * h, 1, sb, tb) != face) continue;
        cubeDifferentiate(face, v, e, 1, ds, dt);
        EXPECT_NEAR(ds, (sa - sb) / (2 * h), 2e-3f);
        EXPECT_NEAR(dt, (ta - tb) / (2 * h), 2e-3f);
    }
}

TEST(Cube, QuadAndMissingMap) {
    Scratch s;
    auto files = directionFaces(s, 32, 1);
    Diagnostics d;
    MakeOptions o;
    o.policy = s.policy();
    o.searchPath = {s.dir.string()};
    ASSERT_TRUE(makeCubeFaceEnvironment(files, "all.env", 90, o, d));
    TextureSystem sys(d);
    Handle h = sys.open("all.env", {s.dir.string()});
    float v[3];
    Vec3 corners[4] = {{1, 0.1f, 0.1f}, {1, -0.1f, 0.1f}, {1, 0.1f, -0.1f}, {1, -0.1f, -0.1f}};
    environmentQuad(h, {}, 0, 3, corners, {}, v);
    EXPECT_NEAR(v[0], 1, 1e-5f);
    EXPECT_NEAR(v[1], 0, 1e-5f);
    LookupOptions fill;
    fill.fill = 3;
    environment(nullptr, {}, 0, 3, {1, 0, 0}, {}, {}, fill, v);
    EXPECT_EQ(v[2], 3);
    lookup(h, 0, 3, 0.5f, 0.5f, {}, fill, v); // a cube map is no texture: fill
    EXPECT_EQ(v[0], 3);
    files.pop_back();
    EXPECT_FALSE(makeCubeFaceEnvironment(files, "x.env", 90, o, d));
    files.push_back("none.exr");
    EXPECT_FALSE(makeCubeFaceEnvironment(files, "x.env", 90, o, d));
    files.back() = files[0];
    EXPECT_FALSE(makeCubeFaceEnvironment(files, "x.env", 200, o, d));
    EXPECT_EQ(d.errors(), 3);
}

TEST(MakeRequest, ByName) {
    Scratch s;
    Diagnostics d;
    display::WriteOptions w;
    w.policy = s.policy();
    ASSERT_TRUE(display::writeImage("a.exr", pattern(8, 8, {"r", "g", "b"}), w, d));
    MakeOptions o;
    o.policy = s.policy();
    o.searchPath = {s.dir.string()};
    EXPECT_TRUE(runMakeRequest("MakeTexture", {"a.exr", "a.tx", "periodic", "clamp", "gaussian"}, {2, 2}, o, d));
    EXPECT_EQ(display::readImage(s / "a.tx", d)->metadata["wrapmodes"], "periodic,clamp");
    EXPECT_TRUE(runMakeRequest("MakeLatLongEnvironment", {"a.exr", "a.env", "box"}, {1, 1}, o, d));
    EXPECT_EQ(display::readImage(s / "a.env", d)->metadata["textureformat"], "LatLong Environment");
    EXPECT_TRUE(d.all().empty()) << messages(d);
    EXPECT_FALSE(runMakeRequest("MakeTexture", {"a.exr"}, {}, o, d));
    EXPECT_FALSE(runMakeRequest("MakeBrickMap", {"a", "b"}, {}, o, d));
    EXPECT_EQ(d.errors(), 2);
}

} // namespace cube_test
