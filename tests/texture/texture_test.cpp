// Lookups against closed forms.
#include "base/limits.h"
#include "pictures.h"
#include <cmath>
#include <limits>

namespace texture_test {

using namespace alpenglow;
using namespace alpenglow::texture;
using namespace alpenglow::display::test;
using namespace alpenglow::texture::test;
using display::Image;
using display::makeImage;

namespace {

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

TEST(Texture, InfinityInOneTexelStaysThere) {
    Image m = constant(4, 4, 1, 1);
    m.pixel(3, 3)[0] = std::numeric_limits<float>::infinity();
    auto t = makeTextureFrom(m);
    EXPECT_EQ(at(t, 0.125f, 0.125f), 1);
    EXPECT_EQ(at(t, 0.625f, 0.625f), 1); // beside it, weight 0
}

} // namespace texture_test
