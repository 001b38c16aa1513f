// Lookups against closed forms.
#include "../display/support.h"
#include "base/limits.h"
#include "texture/maketexture.h"
#include "texture/shadow.h"
#include "texture/texture.h"
#include <cmath>
#include <limits>
#include <thread>

using namespace alpenglow;
using namespace alpenglow::texture;
using namespace alpenglow::display::test;
using display::Image;
using display::makeImage;

namespace {

Image withWrap(Image m, const std::string& wrap) {
    m.metadata["wrapmodes"] = wrap + "," + wrap;
    return m;
}

Image constant(int w, int h, float v, int channels = 3) {
    Image m = makeImage(w, h, display::defaultChannels(channels));
    for (float& x : m.data) x = v;
    return m;
}

Image checkerboard(int n) {
    Image m = makeImage(n, n, {"y"});
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) m.pixel(x, y)[0] = float((x + y) & 1);
    return m;
}

float at(const std::shared_ptr<const Texture>& t, float s, float tt, LookupOptions o = {}, Footprint fp = {}, int channel = 0) {
    float v = -1;
    lookup(t.get(), channel, 1, s, tt, fp, o, &v);
    return v;
}

LookupOptions blurred(float b, Filter f = Filter::Gaussian) {
    LookupOptions o;
    o.sblur = o.tblur = b;
    o.filter = f;
    return o;
}

constexpr Filter filters[] = {Filter::Box, Filter::Triangle, Filter::Gaussian};

} // namespace

TEST(Texture, ConstantStaysConstant) {
    for (auto [w, h] : {std::pair{64, 64}, {37, 5}, {1, 1}, {3, 200}})
        for (const char* wrap : {"clamp", "periodic"}) {
            auto t = makeTextureFrom(withWrap(constant(w, h, 0.625f), wrap));
            for (Filter f : filters)
                for (float s : {-3.7f, 0.0f, 0.31f, 1.0f, 12.2f})
                    for (float a : {0.0f, 0.001f, 0.1f, 3.0f, 1e9f}) {
                        LookupOptions o;
                        o.filter = f;
                        float v[3];
                        lookup2D(t.get(), 0, 3, s, 0.4f, a, a * 0.3f, -a * 0.01f, a * 0.1f, o, v);
                        for (float x : v) EXPECT_NEAR(x, 0.625f, 2e-6f) << w << " " << a;
                    }
        }
}

TEST(Texture, RampIsExactAtAndBetweenTexelCentres) {
    const int n = 16;
    Image m = makeImage(n, n, {"r", "g"}); // r = (i + 1/2) / n = s, g = t
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            m.pixel(x, y)[0] = (float(x) + 0.5f) / n;
            m.pixel(x, y)[1] = (float(y) + 0.5f) / n;
        }
    auto t = makeTextureFrom(m);
    for (int x = 0; x < n; ++x) EXPECT_EQ(at(t, (float(x) + 0.5f) / n, 0.5f), m.pixel(x, 0)[0]);
    for (float s = 0.1f; s < 0.9f; s += 0.037f) {
        EXPECT_NEAR(at(t, s, 0.5f), s, 1e-6f);
        EXPECT_NEAR(at(t, 0.5f, s, {}, {}, 1), s, 1e-6f);
    }
    // A symmetric filter keeps a ramp, as long as it sees no edge.
    for (Filter f : filters) {
        LookupOptions o;
        o.filter = f;
        EXPECT_NEAR(at(t, 0.5f, 0.5f, o, Footprint::sides(0.2f, 0, 0, 0.05f)), 0.5f, 1e-5f);
    }
}

TEST(Texture, UpperLeftIsTheOrigin) {
    Image m = makeImage(4, 4, {"y"});
    m.pixel(0, 0)[0] = 1; // top left
    m.pixel(3, 0)[0] = 2; // top right
    m.pixel(0, 3)[0] = 3; // bottom left
    auto t = makeTextureFrom(m);
    EXPECT_EQ(at(t, 0.125f, 0.125f), 1);
    EXPECT_EQ(at(t, 0.875f, 0.125f), 2);
    EXPECT_EQ(at(t, 0.125f, 0.875f), 3);
}

TEST(Texture, WrapModes) {
    Image m = makeImage(4, 1, {"y"});
    m.data = {1, 2, 3, 4};
    auto black = makeTextureFrom(withWrap(m, "black")), clamp = makeTextureFrom(withWrap(m, "clamp")),
         periodic = makeTextureFrom(withWrap(m, "periodic"));
    EXPECT_EQ(at(black, 1.5f, 0.5f), 0);
    EXPECT_EQ(at(clamp, 1.5f, 0.5f), 4);
    EXPECT_EQ(at(clamp, -1.5f, 0.5f), 1);
    EXPECT_EQ(at(periodic, 1.125f, 0.5f), 1);
    EXPECT_EQ(at(periodic, -0.125f, 0.5f), 4);
    EXPECT_EQ(at(black, 0.0f, 0.5f), 0.5f); // half of texel 0, half of the black outside
    EXPECT_EQ(at(clamp, 0.0f, 0.5f), 1);
    EXPECT_EQ(at(periodic, 0.0f, 0.5f), 2.5f); // texels 3 and 0
    EXPECT_EQ(at(periodic, 1e30f, 0.5f), at(periodic, 0.0f, 0.5f));
    EXPECT_EQ(makeTextureFrom(m)->swrap, Wrap::Clamp); // plain pictures
    Image mixed = m;
    mixed.metadata["wrapmodes"] = "periodic,black";
    EXPECT_EQ(makeTextureFrom(mixed)->swrap, Wrap::Periodic);
    EXPECT_EQ(makeTextureFrom(mixed)->twrap, Wrap::Black);
}

TEST(Texture, ExtremeBlurIsTheMean) {
    for (auto [w, h] : {std::pair{64, 64}, {37, 23}, {5, 200}, {1, 7}}) {
        Image m = pattern(w, h, {"r", "g", "b"});
        double mean[3] = {};
        for (size_t i = 0; i < m.data.size(); ++i) mean[i % 3] += double(m.data[i]) / (double(w) * h);
        auto t = makeTextureFrom(m);
        for (Filter f : filters)
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(at(t, 0.3f, 0.8f, blurred(8, f), {}, c), mean[c], 2e-5) << w << "x" << h;
    }
}

TEST(Texture, CheckerboardGoesToOneHalf) {
    auto t = makeTextureFrom(withWrap(checkerboard(64), "periodic"));
    EXPECT_EQ(at(t, 0.5f / 64, 0.5f / 64), 0);
    EXPECT_EQ(at(t, 1.5f / 64, 0.5f / 64), 1);
    for (Filter f : filters) {
        LookupOptions o;
        o.filter = f;
        for (float s : {0.1f, 0.377f, 0.93f}) {
            EXPECT_NEAR(at(t, s, 0.2f, o, Footprint::sides(0.25f, 0, 0, 0.25f)), 0.5f, 1e-6f);
            EXPECT_NEAR(at(t, s, 0.2f, o, Footprint::sides(0.25f, 0.1f, 0, 0.05f)), 0.5f, 0.02f);
        }
    }
}

TEST(Texture, VarianceOfTheKernelIsThatOfTheFilter) {
    // A texture v = s^2 filtered symmetrically about s gives s^2 + variance along s. Interpolation makes it depend on the place
    // in a texel, so it is averaged over a quarter of the map, a whole number of texels of every level in use; clamped edges are
    // far away.
    const int n = 512;
    Image m = makeImage(n, n, {"y"});
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            float s = (float(x) + 0.5f) / n;
            m.pixel(x, y)[0] = s * s;
        }
    auto t = makeTextureFrom(m);
    for (auto [f, unit] : {std::pair{Filter::Box, 1.0f / 12}, {Filter::Triangle, 1.0f / 6}})
        for (float width : {0.05f, 0.1f, 0.2f}) { // along s: probes; across: level
            LookupOptions o;
            o.filter = f;
            float expected = unit * width * width;
            double narrow = 0, round = 0;
            for (int i = 0; i < 1000; ++i) {
                float s = 0.375f + 0.00025f * (float(i) + 0.5f);
                narrow += double(at(t, s, 0.5f, o, Footprint::sides(width, 0, 0, width / 16)) - s * s) / 1000;
                round += double(at(t, s, 0.5f, o, Footprint::sides(width, 0, 0, width)) - s * s) / 1000;
            }
            EXPECT_NEAR(narrow, expected, 0.05 * expected) << width;
            EXPECT_NEAR(round, expected, 0.05 * expected) << width;
        }
}

TEST(Texture, WiderDerivativesNeverSharpen) {
    // Of a single bright texel, seen at its centre, less and less remains.
    Image m = makeImage(128, 128, {"y"});
    m.pixel(64, 64)[0] = 1;
    auto t = makeTextureFrom(m);
    float s = 64.5f / 128, last = 2;
    EXPECT_EQ(at(t, s, s), 1);
    for (float w = 0.25f / 128; w < 4; w *= 2) {
        float v = at(t, s, s, {}, Footprint::sides(w, 0, 0, w));
        EXPECT_LE(v, last + 1e-7f) << w;
        last = v;
    }
    EXPECT_NEAR(last, 1.0f / (128 * 128), 1e-8f);
}

TEST(Texture, WidthScalesAndZeroWidthIsSharp) {
    auto t = makeTextureFrom(withWrap(checkerboard(64), "periodic"));
    LookupOptions none, twice, plain;
    none.swidth = none.twidth = 0;
    twice.swidth = twice.twidth = 2;
    Footprint fp = Footprint::sides(0.02f, 0.003f, -0.001f, 0.015f), fp2 = Footprint::sides(0.04f, 0.006f, -0.002f, 0.03f);
    EXPECT_EQ(at(t, 1.5f / 64, 0.5f / 64, none, fp), 1);
    EXPECT_FLOAT_EQ(at(t, 0.3f, 0.4f, twice, fp), at(t, 0.3f, 0.4f, plain, fp2));
}

TEST(Texture, AnisotropicFootprintKeepsTheShortAxisSharp) {
    // Horizontal stripes of 4 rows: a footprint long in s and short in t must not mix them.
    Image m = makeImage(64, 64, {"y"});
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) m.pixel(x, y)[0] = float((y / 4) & 1);
    auto t = makeTextureFrom(withWrap(m, "periodic"));
    float centre = 6.0f / 64;
    EXPECT_NEAR(at(t, 0.5f, centre, {}, Footprint::sides(0.3f, 0, 0, 0.5f / 64)), 1, 1e-5f);
    EXPECT_LT(at(t, 0.5f, centre, {}, Footprint::sides(0.3f, 0, 0, 0.3f)), 0.7f);
    // And turned: diagonal footprint along diagonal stripes.
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) m.pixel(x, y)[0] = float(((x - y + 64) / 8) & 1);
    auto d = makeTextureFrom(withWrap(m, "periodic"));
    EXPECT_NEAR(at(d, 12.0f / 64, 0.0f, {}, Footprint::sides(0.2f, 0.2f, 0, 0)), 1, 1e-4f);
    EXPECT_NEAR(at(d, 12.0f / 64, 0.0f, {}, Footprint::sides(0.2f, -0.2f, 0, 0)), 0.5f, 0.15f);
}

TEST(Texture, ChannelsAndFill) {
    Image m = constant(4, 4, 0, 4);
    for (size_t i = 0; i < m.data.size(); ++i) m.data[i] = float(i % 4 + 1);
    auto t = makeTextureFrom(m);
    LookupOptions o;
    o.fill = 9;
    float v[3];
    lookup(t.get(), 0, 3, 0.5f, 0.5f, {}, o, v);
    EXPECT_EQ((std::vector<float>(v, v + 3)), (std::vector<float>{1, 2, 3}));
    lookup(t.get(), 2, 3, 0.5f, 0.5f, {}, o, v);
    EXPECT_EQ((std::vector<float>(v, v + 3)), (std::vector<float>{3, 4, 9}));
    lookup(t.get(), 7, 3, 0.5f, 0.5f, {}, o, v);
    EXPECT_EQ((std::vector<float>(v, v + 3)), (std::vector<float>{9, 9, 9}));
    lookup(t.get(), -1, 3, 0.5f, 0.5f, {}, o, v);
    EXPECT_EQ((std::vector<float>(v, v + 3)), (std::vector<float>{9, 1, 2}));
    for (int far : {std::numeric_limits<int>::min(), std::numeric_limits<int>::max()}) {
        lookup(t.get(), far, 3, 0.5f, 0.5f, {}, o, v);
        EXPECT_EQ((std::vector<float>(v, v + 3)), (std::vector<float>{9, 9, 9}));
    }
    lookup(nullptr, 0, 3, 0.5f, 0.5f, {}, o, v);
    EXPECT_EQ((std::vector<float>(v, v + 3)), (std::vector<float>{9, 9, 9}));
}

TEST(Texture, ProbesAreBounded) {
    // A footprint of aspect 10^6 asks for as many probes; the limit makes the short axis wider instead: rows that a sharp filter
    // would keep apart mix.
    Image m = makeImage(256, 256, {"y"});
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 256; ++x) m.pixel(x, y)[0] = float(y & 1);
    auto t = makeTextureFrom(withWrap(m, "periodic"));
    float centre = 129.5f / 256;
    EXPECT_NEAR(at(t, 0.5f, centre, {}, Footprint::sides(0.05f, 0, 0, 1e-9f)), 1, 1e-5f); // 13 texels: enough probes
    EXPECT_NEAR(at(t, 0.5f, centre, {}, Footprint::sides(4, 0, 0, 1e-9f)), 0.5f, 1e-5f);  // 1024 texels: more than kTextureTaps
    static_assert(limits::kTextureTaps < 1024 / 4);
}

TEST(Texture, NonFiniteArgumentsAreHarmless) {
    auto t = makeTextureFrom(withWrap(constant(8, 8, 0.5f), "periodic"));
    float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    for (float bad : {nan, inf, -inf, 3e38f, -3e38f})
        for (int k = 0; k < 6; ++k) {
            float a[6] = {0.1f, 0.2f, 0.01f, 0, 0, 0.01f};
            a[k] = bad;
            float v;
            lookup2D(t.get(), 0, 1, a[0], a[1], a[2], a[3], a[4], a[5], {}, &v);
            EXPECT_NEAR(v, 0.5f, 1e-6f) << bad << " " << k;
            LookupOptions o;
            o.sblur = o.twidth = bad;
            lookup2D(t.get(), 0, 1, 0.1f, 0.2f, 0.1f, 0, 0, 0.1f, o, &v);
            EXPECT_NEAR(v, 0.5f, 1e-6f);
        }
}

TEST(Texture, QuadrilateralsInAnyOrder) {
    auto t = makeTextureFrom(pattern(64, 64, {"y"}));
    float s[4] = {0.4f, 0.6f, 0.4f, 0.6f}, tt[4] = {0.3f, 0.3f, 0.5f, 0.5f}, a, b, c;
    lookupQuad(t.get(), 0, 1, s, tt, {}, &a);
    float s2[4] = {0.4f, 0.6f, 0.6f, 0.4f}, t2[4] = {0.3f, 0.3f, 0.5f, 0.5f};
    lookupQuad(t.get(), 0, 1, s2, t2, {}, &b);
    lookup2D(t.get(), 0, 1, 0.5f, 0.4f, 0.2f, 0, 0, 0.2f, {}, &c);
    EXPECT_NEAR(a, b, 1e-6f);
    EXPECT_NEAR(a, c, 1e-5f);
    float same[4] = {0.5f / 64, 0.5f / 64, 0.5f / 64, 0.5f / 64};
    lookupQuad(t.get(), 0, 1, same, same, {}, &a);
    EXPECT_EQ(a, 0); // texel 0 itself
}

TEST(Texture, LanesAreTheSameAsOne) {
    auto t = makeTextureFrom(pattern(50, 30, {"r", "g", "b"}));
    const int n = 13;
    float s[n], tt[n], a[n], b[n], c[n], d[n], out[3 * n];
    unsigned char active[n];
    for (int i = 0; i < n; ++i) {
        s[i] = float(i) * 0.13f;
        tt[i] = float(i) * 0.07f;
        a[i] = 0.01f * float(i);
        b[i] = -0.002f * float(i);
        c[i] = 0.003f;
        d[i] = 0.02f;
        active[i] = i != 5;
    }
    for (float& v : out) v = -7;
    LookupOptions o;
    lookup2DLanes(t.get(), 0, 3, n, active, s, tt, a, b, c, d, &o, false, out);
    for (int i = 0; i < n; ++i) {
        float v[3] = {-7, -7, -7};
        if (i != 5) lookup2D(t.get(), 0, 3, s[i], tt[i], a[i], b[i], c[i], d[i], o, v);
        for (int k = 0; k < 3; ++k) EXPECT_EQ(out[k * n + i], v[k]);
    }
}

TEST(Texture, InfinityInOneTexelStaysThere) {
    Image m = constant(4, 4, 1, 1);
    m.pixel(3, 3)[0] = std::numeric_limits<float>::infinity();
    auto t = makeTextureFrom(m);
    EXPECT_EQ(at(t, 0.125f, 0.125f), 1);
    EXPECT_EQ(at(t, 0.625f, 0.625f), 1); // beside it, weight 0
}

TEST(Pyramid, SizesAndMeans) {
    Image m = pattern(13, 6, {"y"});
    auto levels = reducedLevels(m);
    ASSERT_EQ(levels.size(), 3u); // 6x3, 3x1, 1x1
    EXPECT_EQ(levels[0].width, 6);
    EXPECT_EQ(levels[0].height, 3);
    EXPECT_EQ(levels[2].width, 1);
    m.levels = levels;
    EXPECT_TRUE(hasAllLevels(m));
    m.levels.pop_back();
    EXPECT_FALSE(hasAllLevels(m));
    // 3 texels to 1: exact thirds. 2 to 1: halves.
    Image three = makeImage(3, 1, {"y"});
    three.data = {1, 2, 6};
    EXPECT_FLOAT_EQ(reduced(three).data[0], 3);
    // 5 to 2: each covers 2.5 texels.
    Image five = makeImage(5, 1, {"y"});
    five.data = {1, 2, 3, 4, 5};
    EXPECT_FLOAT_EQ(reduced(five).data[0], (1 + 2 + 1.5f) / 2.5f);
}

TEST(Pyramid, EveryKernelKeepsAConstant) {
    Image m = constant(20, 15, 0.75f, 1);
    for (const char* f : {"box", "triangle", "gaussian", "catmull-rom", "mitchell", "lanczos", "sinc", "disk", "bessel"}) {
        EXPECT_TRUE(isReductionFilter(f));
        for (float w : {0.1f, 1.0f, 3.0f})
            for (auto& l : reducedLevels(m, {f, w, w}))
                for (float v : l.data) EXPECT_NEAR(v, 0.75f, 1e-5f) << f << " " << w;
    }
    EXPECT_FALSE(isReductionFilter("nonesuch"));
}

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

// ---- files ----

namespace {

void save(const Scratch& s, const std::string& name, const Image& m, display::Format f = display::Format::Tiff,
          display::Sample sample = display::Sample::UInt8) {
    Diagnostics d;
    display::WriteOptions o;
    o.format = f;
    o.sample = sample;
    o.policy = s.policy();
    ASSERT_TRUE(display::writeImage(name, m, o, d)) << messages(d);
}

} // namespace

TEST(TextureSystem, OpensOnceAndReportsOnce) {
    Scratch s;
    save(s, "Wood.tif", pattern(32, 16, {"r", "g", "b"}));
    Diagnostics d;
    TextureSystem sys(d);
    Handle h = sys.open("Wood.tif", {s.dir.string()});
    ASSERT_TRUE(h) << messages(d);
    EXPECT_EQ(h, sys.open("Wood.tif", {s.dir.string()}));
    EXPECT_EQ(h, sys.open(s / "Wood.tif"));
    EXPECT_TRUE(d.all().empty());
    EXPECT_EQ(h, sys.open("wood.TIF", {s.dir.string()})); // said
    EXPECT_EQ(d.warnings(), 1);
    EXPECT_FALSE(sys.open("stone.tif", {s.dir.string()}));
    EXPECT_FALSE(sys.open("stone.tif", {s.dir.string()}));
    EXPECT_EQ(d.errors(), 1);
    EXPECT_EQ(d.all().back().code, Rie::NoFile);
    auto i = sys.info(h);
    ASSERT_TRUE(i);
    EXPECT_EQ(i->width, 32);
    EXPECT_EQ(i->height, 16);
    EXPECT_EQ(i->channels, 3);
    EXPECT_EQ(i->bits, 8);
    EXPECT_EQ(i->type, "texture");
    EXPECT_FALSE(sys.info(nullptr));
    EXPECT_GT(sys.bytes(), 32u * 16 * 3);
    float v;
    lookup(h, 1, 1, 3.5f / 32, 2.5f / 16, {}, {}, &v);
    EXPECT_EQ(v, float(7 * 3 + 13 * 2 + 31) / 255.0f); // 8-bit data as given
}

TEST(TextureSystem, DamagedFilesAreReportedOnce) {
    Scratch s;
    putBytes(s / "bad.tif", {'I', 'I', 42, 0, 8});
    Diagnostics d;
    TextureSystem sys(d);
    for (int i = 0; i < 3; ++i) EXPECT_FALSE(sys.open("bad.tif", {s.dir.string()}));
    EXPECT_FALSE(sys.open(s / "bad.tif"));
    EXPECT_EQ(d.errors(), 1) << messages(d);
}

TEST(TextureSystem, ManyThreadsOneLoad) {
    Scratch s;
    save(s, "a.tif", pattern(200, 100, {"r", "g", "b"}));
    Diagnostics d;
    TextureSystem sys(d);
    std::vector<std::thread> threads;
    std::vector<Handle> handles(8);
    std::vector<float> values(8);
    for (size_t i = 0; i < 8; ++i)
        threads.emplace_back([&, i] {
            handles[i] = sys.open("a.tif", {s.dir.string()});
            lookup2D(handles[i], 0, 1, 0.3f, 0.4f, 0.1f, 0.02f, 0.01f, 0.05f, {}, &values[i]);
        });
    for (auto& t : threads) t.join();
    for (size_t i = 1; i < 8; ++i) {
        EXPECT_EQ(handles[i], handles[0]);
        EXPECT_EQ(values[i], values[0]);
    }
    EXPECT_TRUE(handles[0]);
}

TEST(TextureSystem, ForgetReadsAgain) {
    Scratch s;
    save(s, "a.tif", constant(4, 4, 0));
    Diagnostics d;
    TextureSystem sys(d);
    float v = -1;
    lookup(sys.open("a.tif", {s.dir.string()}), 0, 1, 0.5f, 0.5f, {}, {}, &v);
    EXPECT_EQ(v, 0);
    save(s, "a.tif", constant(4, 4, 1));
    sys.forget();
    lookup(sys.open("a.tif", {s.dir.string()}), 0, 1, 0.5f, 0.5f, {}, {}, &v);
    EXPECT_EQ(v, 1);
}

TEST(TextureSystem, Udim) {
    Scratch s;
    save(s, "skin.1001.tif", constant(4, 4, 0.2f));
    save(s, "skin.1012.tif", constant(4, 4, 0.8f)); // column 1, row 1
    Diagnostics d;
    TextureSystem sys(d);
    Handle h = sys.open("skin.UDIM.tif", {s.dir.string()});
    ASSERT_TRUE(h) << messages(d);
    LookupOptions o;
    o.fill = 7;
    float v;
    lookup(h, 0, 1, 0.5f, 0.5f, {}, o, &v);
    EXPECT_NEAR(v, 0.2f, 1e-6f);
    lookup(h, 0, 1, 1.5f, 1.5f, {}, o, &v);
    EXPECT_NEAR(v, 0.8f, 1e-6f);
    lookup(h, 0, 1, 1.5f, 0.5f, {}, o, &v);
    EXPECT_EQ(v, 7);
    lookup(h, 0, 1, -0.5f, std::numeric_limits<float>::quiet_NaN(), {}, o, &v);
    EXPECT_EQ(v, 7);
    EXPECT_EQ(sys.info(h)->width, 4);
    EXPECT_TRUE(sys.open("skin.<UDIM>.tif", {s.dir.string()}));
    EXPECT_FALSE(sys.open("hair.UDIM.tif", {s.dir.string()}));
    EXPECT_EQ(d.errors(), 1);
}

TEST(TextureSystem, DeclaredGammaBecomesLinear) {
    Scratch s;
    Image m = constant(4, 4, 0, 4);
    for (size_t i = 0; i < m.data.size(); ++i) m.data[i] = i % 4 == 3 ? 128 / 255.0f : 64 / 255.0f;
    save(s, "plain.png", m, display::Format::Png);
    // The same file with a gAMA chunk (1/2 * 100000) after the 8 + 25 bytes of signature and IHDR.
    std::vector<uint8_t> b = bytesOf(s / "plain.png"), chunk{'g', 'A', 'M', 'A', 0, 0, 0xc3, 0x50};
    uint32_t crc = 0xffffffff; // CRC-32 of PNG, appendix D
    for (uint8_t c : chunk) {
        crc ^= c;
        for (int k = 0; k < 8; ++k) crc = crc & 1 ? crc >> 1 ^ 0xedb88320 : crc >> 1;
    }
    crc = ~crc;
    chunk.insert(chunk.begin(), {0, 0, 0, 4});
    for (int k = 24; k >= 0; k -= 8) chunk.push_back(uint8_t(crc >> k));
    b.insert(b.begin() + 33, chunk.begin(), chunk.end());
    putBytes(s / "half.png", b);
    Diagnostics d;
    TextureSystem sys(d), raw(d, {Wrap::Clamp, false, {}});
    auto value = [&](TextureSystem& system, const char* name, int c) {
        float v;
        lookup(system.open(name, {s.dir.string()}), c, 1, 0.4f, 0.4f, {}, {}, &v);
        return v;
    };
    EXPECT_NEAR(value(sys, "plain.png", 0), 64 / 255.0f, 1e-6f);
    EXPECT_NEAR(value(sys, "half.png", 0), (64 / 255.0f) * (64 / 255.0f), 1e-6f); // v^(1 / 0.5)
    EXPECT_NEAR(value(sys, "half.png", 3), 128 / 255.0f, 1e-6f);                  // alpha is linear as it is
    EXPECT_NEAR(value(raw, "half.png", 0), 64 / 255.0f, 1e-6f);
    EXPECT_TRUE(d.all().empty()) << messages(d);
}

TEST(MakeTexture, LevelsAreReadAsTheyAre) {
    Scratch s;
    Image m = pattern(48, 20, {"r", "g", "b"});
    save(s, "in.tif", m);
    Diagnostics d;
    MakeOptions o;
    o.swrap = "periodic";
    o.twrap = "clamp";
    o.policy = s.policy();
    o.searchPath = {s.dir.string()};
    ASSERT_TRUE(makeTexture("in.tif", "out.tx", o, d)) << messages(d);
    display::ReadOptions levels;
    levels.levels = true;
    auto r = display::readImage(s / "out.tx", d, levels);
    ASSERT_TRUE(r) << messages(d);
    EXPECT_EQ(r->data, m.data);
    EXPECT_TRUE(hasAllLevels(*r));
    EXPECT_EQ(r->levels.size(), 5u); // 24x10 12x5 6x2 3x1 1x1
    EXPECT_EQ(r->metadata["wrapmodes"], "periodic,clamp");
    TextureSystem sys(d);
    Handle h = sys.open("out.tx", {s.dir.string()});
    ASSERT_TRUE(h);
    EXPECT_EQ(h->swrap, Wrap::Periodic);
    EXPECT_EQ(h->twrap, Wrap::Clamp);
    Image marked = *r; // prove that stored levels are used: change one
    for (float& v : marked.levels.back().data) v = 42;
    display::WriteOptions w;
    w.tile = 16;
    w.policy = s.policy();
    ASSERT_TRUE(display::writeImage("marked.tx", marked, w, d));
    float v;
    lookup(sys.open("marked.tx", {s.dir.string()}), 0, 1, 0.5f, 0.5f, {}, blurred(50), &v);
    EXPECT_EQ(v, 42);
    EXPECT_TRUE(d.all().empty()) << messages(d);
}

TEST(MakeTexture, BadArgumentsAreReportedAndMended) {
    Scratch s;
    save(s, "in.tif", constant(8, 8, 0.5f));
    Diagnostics d;
    MakeOptions o;
    o.swrap = "wrapped";
    o.filter = "fuzzy";
    o.swidth = -1;
    o.policy = s.policy();
    o.searchPath = {s.dir.string()};
    EXPECT_TRUE(makeTexture("in.tif", "out.tx", o, d));
    EXPECT_EQ(d.errors(), 3) << messages(d);
    EXPECT_FALSE(makeTexture("none.tif", "out2.tx", o, d));
    EXPECT_FALSE(std::filesystem::exists(s / "out2.tx"));
}

TEST(MakeTexture, LatLongAndShadow) {
    Scratch s;
    save(s, "sky.exr", constant(16, 8, 2), display::Format::Exr, display::Sample::Float);
    Diagnostics d;
    MakeOptions o;
    o.policy = s.policy();
    o.searchPath = {s.dir.string()};
    ASSERT_TRUE(makeLatLongEnvironment("sky.exr", "sky.env", o, d)) << messages(d);
    TextureSystem sys(d);
    EXPECT_EQ(sys.info(sys.open("sky.env", {s.dir.string()}))->type, "environment");

    // A camera at the origin, orthographic over [-1,1]^2: everything at depth 5 but the left half, which is at depth 2.
    Image z = makeImage(64, 64, {"z"});
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) z.pixel(x, y)[0] = x < 32 ? 2.0f : 5.0f;
    z.worldToCamera = Matrix{};
    z.worldToNDC = display::screenToNDC();
    save(s, "light.z", z, display::Format::Exr, display::Sample::Float);
    ASSERT_TRUE(makeShadow("light.z", "light.shd", o, d)) << messages(d);
    Handle h = sys.open("light.shd", {s.dir.string()});
    ASSERT_TRUE(h);
    EXPECT_EQ(sys.info(h)->type, "shadow");
    ASSERT_TRUE(sys.info(h)->projection);
    EXPECT_NEAR(sys.info(h)->projection->m[1][1], 1, 1e-12); // back to screen: y up
    ShadowOptions so;
    EXPECT_EQ(shadowLookup(h, {-0.5, 0, 3}, {}, {}, so), 1); // behind the near half
    EXPECT_EQ(shadowLookup(h, {0.5, 0, 3}, {}, {}, so), 0);  // before the far half
    EXPECT_EQ(shadowLookup(h, {0.5, 0, 6}, {}, {}, so), 1);
    EXPECT_EQ(shadowLookup(h, {-0.5, 0, 2}, {}, {}, so), 0);        // on the surface itself
    EXPECT_EQ(shadowLookup(h, {3, 0, 100}, {}, {}, so), 0);         // where the map does not look
    EXPECT_NEAR(shadowLookup(h, {0, 0, 3}, {}, {}, so), 0.5, 1e-6); // the edge, between two texels
    so.sblur = so.tblur = 0.2f;
    EXPECT_NEAR(shadowLookup(h, {0, 0, 3}, {}, {}, so), 0.5, 1e-6);
    so.bias = 2;
    EXPECT_EQ(shadowLookup(h, {-0.5, 0, 3}, {}, {}, so), 0);
    EXPECT_EQ(shadowLookup(nullptr, {0, 0, 3}, {}, {}, so), 0);
    EXPECT_TRUE(d.all().empty()) << messages(d);
    Image bare = constant(4, 4, 1, 1);
    save(s, "bare.z", bare, display::Format::Exr, display::Sample::Float);
    EXPECT_TRUE(makeShadow("bare.z", "bare.shd", o, d));
    EXPECT_EQ(d.warnings(), 1);
}
