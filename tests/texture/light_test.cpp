// Maps whose numbers are a curve of light: colours as light, everything else as the file has it.
#include "base/srgb.h"
#include "pictures.h"
#include "texture/lookup.h"
#include "texture/maketexture.h"
#include <cmath>

namespace light_test {

using namespace alpenglow;
using namespace alpenglow::texture;
using namespace alpenglow::display::test;
using namespace alpenglow::texture::test;
using display::Image;
using display::makeImage;

namespace {

TextureSettings inLight() {
    TextureSettings s;
    s.light = true;
    return s;
}

/// One lookup of channels 0.. at (s, t), over a footprint of the given side.
std::vector<float> at(Handle h, int count, bool asLight, float s = 0.5f, float t = 0.5f, float side = 0) {
    std::vector<float> v(static_cast<size_t>(count), -1.f);
    LookupOptions o;
    o.asLight = asLight;
    o.filter = Filter::Box;
    lookup(h, 0, count, s, t, {side * side, 0, side * side}, o, v.data());
    return v;
}

Image codes(int w, int h, int channels, float value) {
    Image m = makeImage(w, h, display::defaultChannels(channels));
    for (float& x : m.data) x = value;
    m.bits = 8;
    m.floating = false;
    return m;
}

constexpr float kCode = 141 / 255.f;

} // namespace

TEST(Light, ColoursOf8BitsAreSrgbAndNumbersStay) {
    Scratch s;
    Image m = codes(4, 4, 4, kCode);
    for (size_t i = 3; i < m.data.size(); i += 4) m.data[i] = 51 / 255.f;
    save(s, "a.png", m, display::Format::Png);
    Diagnostics d;
    TextureSystem light(d, inLight()), plain(d);
    const auto c = at(light.open(s / "a.png"), 4, true), n = at(light.open(s / "a.png"), 4, false);
    EXPECT_FLOAT_EQ(c[0], srgbDecode(kCode));
    EXPECT_FLOAT_EQ(c[2], srgbDecode(kCode));
    EXPECT_FLOAT_EQ(c[3], 51 / 255.f);                               // alpha is a number
    EXPECT_FLOAT_EQ(n[0], kCode);                                    // a float lookup: a height, a mask
    EXPECT_FLOAT_EQ(at(plain.open(s / "a.png"), 4, true)[0], kCode); // under hidden
}

// Half black, half white, seen from afar: half the light, not the light of half the code; and slopes are those of light.
TEST(Light, MeansAreOfLight) {
    Image m = codes(64, 64, 3, 0);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            for (int c = 0; c < 3; ++c) m.pixel(x, y)[c] = x % 2 ? 1.f : 0.f;
    const auto tex = makeTextureFrom(m, inLight());
    EXPECT_NEAR(at(tex.get(), 3, true, 0.5f, 0.5f, 0.5f)[1], 0.5f, 0.01f);
    EXPECT_NEAR(at(tex.get(), 3, false, 0.5f, 0.5f, 0.5f)[1], 0.5f, 0.01f);
    for (float& v : m.data) v = v > 0 ? kCode : 0;
    const auto grey = makeTextureFrom(m, inLight());
    EXPECT_NEAR(at(grey.get(), 3, true, 0.5f, 0.5f, 0.5f)[1], srgbDecode(kCode) / 2, 0.003f);
    EXPECT_NEAR(at(grey.get(), 3, false, 0.5f, 0.5f, 0.5f)[1], kCode / 2, 0.006f);
    float v[3], slopes[6];
    LookupOptions o;
    o.asLight = true;
    lookup(grey.get(), 0, 3, 2.0f / 64, 0.5f, {}, o, v, slopes); // between a bright texel and a dark one
    EXPECT_NEAR(slopes[0], -srgbDecode(kCode) * 64, 0.01f);
}

TEST(Light, WhatAFileDeclaresGoesFirst) {
    for (const auto& [key, value, expected] : {std::tuple{"colorspace", "sRGB", srgbDecode(kCode)},
                                               {"gamma", "0.5", kCode * kCode},
                                               {"gamma", "1", kCode},
                                               {"colorspace", "light", kCode}}) {
        Image m = codes(2, 2, 3, kCode);
        m.metadata[key] = value;
        EXPECT_NEAR(at(makeTextureFrom(m, inLight()).get(), 3, true)[0], expected, 1e-6f) << key << " " << value;
        m.floating = true; // also of floats
        m.bits = 32;
        EXPECT_NEAR(at(makeTextureFrom(m, inLight()).get(), 3, true)[0], expected, 1e-6f) << key << " " << value;
    }
    Image sixteen = codes(2, 2, 3, kCode);
    sixteen.bits = 16;
    EXPECT_FLOAT_EQ(at(makeTextureFrom(sixteen, inLight()).get(), 3, true)[0], kCode);
    Image floats = constant(2, 2, kCode);
    EXPECT_FLOAT_EQ(at(makeTextureFrom(floats, inLight()).get(), 3, true)[0], kCode);
}

TEST(Light, MapsAreReadAsTheirPictureOrAsToldWhenMade) {
    using Colours = MakeOptions::Colours;
    Scratch s;
    save(s, "a.png", codes(8, 4, 3, kCode), display::Format::Png);
    save(s, "f.exr", constant(8, 4, kCode), display::Format::Exr, display::Sample::Float);
    for (const char* kind : {"MakeTexture", "MakeLatLongEnvironment", "MakeCubeFaceEnvironment", "MakeBump"})
        for (const auto& [colours, picture, expected] : {std::tuple{Colours::Auto, "a.png", srgbDecode(kCode)},
                                                         {Colours::Srgb, "a.png", srgbDecode(kCode)},
                                                         {Colours::Light, "a.png", kCode},
                                                         {Colours::Auto, "f.exr", kCode},
                                                         {Colours::Srgb, "f.exr", srgbDecode(kCode)}}) {
            Diagnostics d;
            MakeOptions o;
            o.policy = s.policy();
            o.colours = colours;
            const bool cube = std::string(kind) == "MakeCubeFaceEnvironment";
            std::vector<std::string> names(cube ? 6 : 1, s / picture);
            names.push_back("m.tx");
            ASSERT_TRUE(runMakeRequest(kind, names, {}, o, d)) << kind << messages(d);
            TextureSystem sys(d, inLight());
            Handle h = sys.open(s / "m.tx");
            ASSERT_TRUE(h) << messages(d);
            LookupOptions lo;
            lo.asLight = true;
            float v[3];
            environment(h, {}, 0, 3, {1, 0.2f, 0.3f}, {}, {}, lo, v);
            const bool bump = std::string(kind) == "MakeBump" && colours == Colours::Auto; // heights are numbers
            EXPECT_NEAR(v[1], bump ? kCode : expected, 1e-6f) << kind << " " << picture << " " << int(colours);
            lo.asLight = false;
            environment(h, {}, 0, 3, {1, 0.2f, 0.3f}, {}, {}, lo, v);
            EXPECT_NEAR(v[1], colours == Colours::Srgb ? expected : kCode, 1e-6f)
                << kind << " " << picture << " " << int(colours);
        }
}

// A map that was made of 8 bits is a file of floats: in memory it takes what its picture takes, and says the same numbers.
TEST(Light, MapsOf8BitsAreCodesInMemory) {
    Scratch s;
    Image m = codes(64, 64, 3, 0);
    for (size_t i = 0; i < m.data.size(); ++i) m.data[i] = float(i * 7919 % 256) / 255.f;
    save(s, "a.png", m, display::Format::Png);
    Diagnostics d;
    MakeOptions how;
    how.policy = {s / "", true};
    ASSERT_TRUE(makeTexture(s / "a.png", s / "a.tx", how, d));
    TextureSystem system(d, inLight());
    Handle picture = system.open(s / "a.png"), map = system.open(s / "a.tx");
    ASSERT_TRUE(picture && map);
    ASSERT_EQ(map->levels[0].codes.size(), m.data.size());
    EXPECT_TRUE(map->levels[0].values.empty());
    EXPECT_TRUE(map->levels[0].light.empty());
    for (size_t i = 0; i < m.data.size(); ++i) {
        const int c = int(i % 3);
        ASSERT_EQ(map->levels[0].texel(i, c, false), m.data[i]);
        ASSERT_EQ(map->levels[0].texel(i, c, true), srgbDecode(m.data[i]));
    }
    // Numbers between the codes are kept as they are.
    for (float& x : m.data) x += 1e-4f;
    m.bits = 32;
    m.floating = true;
    m.metadata["colorspace"] = kEightBits;
    auto floats = makeTextureFrom(m, inLight());
    EXPECT_TRUE(floats->levels[0].codes.empty());
    const Texels<float>& kept = floats->levels[0].values;
    EXPECT_EQ(std::vector<float>(kept.data(), kept.data() + kept.size()), m.data);
}

} // namespace light_test
