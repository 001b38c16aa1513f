// docs/colour.md as a user meets it: a texel and a plain colour through render, under every hider.
#include "base/srgb.h"
#include "command_folder.h"
#include "display/imageio.h"
#include <fstream>

namespace colour_test {

using namespace alpenglow;

namespace {

class Colour : public cli::testing::CommandFolder {
protected:
    std::string errors() const {
        std::ifstream in(dir / "err", std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    display::Image picture(const std::string& name) const {
        Diagnostics d;
        auto m = display::readImage(dir / name, d);
        EXPECT_TRUE(m) << name;
        return m ? *m : display::Image();
    }
    /// The middle of a picture in codes.
    std::array<int, 3> middle(const std::string& name) const {
        const display::Image m = picture(name);
        if (m.width == 0) return {};
        const float* p = m.pixel(m.width / 2, m.height / 2);
        return {int(std::lround(p[0] * 255)), int(std::lround(p[1] * 255)), int(std::lround(p[2] * 255))};
    }
    void SetUp() override {
        CommandFolder::SetUp();
        display::Image m = display::makeImage(4, 4, {"r", "g", "b"});
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 4; ++x)
                for (int c = 0; c < 3; ++c) m.pixel(x, y)[c] = float(kTexel[size_t(c)]) / 255;
        display::WriteOptions o;
        o.format = display::Format::Png;
        o.sample = display::Sample::UInt8;
        o.policy = {dir, true};
        Diagnostics d;
        ASSERT_TRUE(display::writeImage("pic.png", m, o, d));
        write("show.sl",
              "surface show(string map = \"\"; float number = 0) { color c = Cs; float f = 0; if (map != \"\") c = texture(map, "
              "s, t); if (number > 0) { f = texture(map, s, t); c = f; } Ci = c; Oi = 1; }\n");
    }
    /// A wall that fills the picture.
    static std::string wall(const std::string& before, const std::string& surface) {
        return before +
               "\nFormat 8 8 1\nProjection \"perspective\" \"fov\" 40\nWorldBegin\nTranslate 0 0 1\nColor [.5 .18 1]\nSurface "
               "\"show\" " +
               surface + "\nPolygon \"P\" [-2 -2 0 2 -2 0 2 2 0 -2 2 0] \"st\" [0 0 1 0 1 1 0 1]\nWorldEnd\n";
    }
    static constexpr std::array<int, 3> kTexel{141, 60, 220};
};

// Dither of half a code: one code either way.
void expectNear(const std::array<int, 3>& a, const std::array<int, 3>& b, const std::string& what) {
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1) << what << ", channel " << c;
}

constexpr const char* kNew = "Display \"d.png\" \"png\" \"rgb\"";
constexpr const char* kOld = "Display \"d.tiff\" \"file\" \"rgb\"";
constexpr const char* kUnsaid = "";
constexpr std::array<int, 3> kLight{188, 118, 255}; // .5 .18 1 by the curve of sRGB
constexpr std::array<int, 3> kNumbers{128, 46, 255};

} // namespace

TEST_F(Colour, ACurveUnderPathAlone) {
    write("w.rib", wall(kNew, ""));
    for (const std::string hider : {"hidden", "raytrace", "path"}) {
        const bool path = hider == "path";
        const std::array<int, 3>& expected = path ? kLight : kNumbers;
        run(std::string("render --progress none --hider ") + hider + " --display tiff:t.tif --display jpeg:j.jpg w.rib", "2>err");
        ASSERT_EQ(status, 0) << errors();
        EXPECT_NE(errors().find(path ? "  curve        sRGB\n" : "  curve        none: numbers are as shaders compute them"),
                  std::string::npos)
            << errors();
        expectNear(middle("d.png"), expected, "png " + hider);
        expectNear(middle("t.tif"), expected, "tiff " + hider);
        for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(middle("j.jpg")[c], expected[c], 4) << hider; // coded with loss
        EXPECT_EQ(picture("d.png").metadata.contains("colorspace"), path);
    }
}

// Whatever the scene's own displays are.
TEST_F(Colour, NumbersOfScenesUnderHidden) {
    for (const char* display : {kNew, kOld, kUnsaid}) {
        write("w.rib", wall(display, ""));
        for (const char* hider : {"", "--hider raytrace"}) {
            run(std::string("render -q -o o.png ") + hider + " w.rib", "2>err");
            expectNear(middle("o.png"), kNumbers, std::string(display) + hider);
            EXPECT_FALSE(picture("o.png").metadata.contains("colorspace"));
        }
        run("render -q --hider path -o o.png w.rib", "2>err");
        expectNear(middle("o.png"), kLight, std::string(display) + "path");
        run("render -q --gamma srgb -o o.png w.rib", "2>err");
        expectNear(middle("o.png"), kLight, std::string(display) + "--gamma srgb");
    }
    write("w.rib", wall(kUnsaid, ""));
    run("render -q w.rib", "2>err");
    expectNear(middle("ri.pic"), kNumbers, "ri.pic");
}

TEST_F(Colour, ExposureQuantizeAndGammaSayOtherwise) {
    for (const char* hider : {"hidden", "path"}) {
        const std::string with = std::string("render -q -o o.png --hider ") + hider;
        for (const char* request : {"Exposure 1 1\n", "Quantize \"rgba\" 255 0 255 .5\n"}) {
            write("w.rib", wall(std::string(request) + kNew, ""));
            run(with + " w.rib", "2>err");
            expectNear(middle("o.png"), kNumbers, request);
        }
        write("w.rib", wall(kNew, ""));
        run(with + " --gamma 1 w.rib", "2>err");
        expectNear(middle("o.png"), kNumbers, "--gamma 1");
        run(with + " --gamma 2 w.rib", "2>err");
        expectNear(middle("o.png"), {180, 108, 255}, "--gamma 2");
    }
    run("render --gamma 0 w.rib", "2>err");
    EXPECT_EQ(status, 2);
    run("render --gamma srgbb w.rib", "2>err");
    EXPECT_EQ(status, 2);
    EXPECT_NE(errors().find("or srgb"), std::string::npos) << errors();
}

// What is in the file is on the picture: by any hider, made into a map or not, whether it declares its colours or not.
TEST_F(Colour, TexelsComeOutAsTheyAre) {
    display::Image declared = picture("pic.png");
    declared.metadata["colorspace"] = "sRGB";
    display::WriteOptions o;
    o.format = display::Format::Png;
    o.sample = display::Sample::UInt8;
    o.policy = {dir, true};
    Diagnostics d;
    ASSERT_TRUE(display::writeImage("said.png", declared, o, d));
    ASSERT_EQ(picture("said.png").metadata["colorspace"], "sRGB");
    run("maketx pic.png auto.tx", "2>err");
    ASSERT_EQ(status, 0) << errors();
    for (const char* display : {kNew, kOld})
        for (const char* map : {"pic.png", "said.png", "auto.tx"}) {
            write("w.rib", wall(display, std::string("\"string map\" \"") + map + "\""));
            for (const char* hider : {"hidden", "path"}) {
                run(std::string("render -q -o o.png --hider ") + hider + " w.rib", "2>err");
                ASSERT_EQ(status, 0) << errors();
                expectNear(middle("o.png"), kTexel, std::string(display) + map + hider);
            }
        }
}

TEST_F(Colour, MapsThatAreToldAndNumbers) {
    run("maketx --linear pic.png lin.tx", "2>err");
    EXPECT_EQ(status, 0) << errors();
    run("maketx --srgb pic.png srgb.tx", "2>err");
    EXPECT_EQ(status, 0) << errors();
    run("maketx --srgb --linear pic.png no.tx", "2>err");
    EXPECT_EQ(status, 2);
    std::array<int, 3> asLight; // the numbers taken for light
    for (size_t c = 0; c < 3; ++c) asLight[c] = int(std::lround(255 * srgbEncode(float(kTexel[c]) / 255)));
    const auto shows = [&](const std::string& before, const std::string& surface, const std::array<int, 3>& expected) {
        write("w.rib", wall(before, surface));
        run("render -q -o o.png --hider path w.rib", "2>err");
        expectNear(middle("o.png"), expected, before + surface);
    };
    shows(kNew, "\"string map\" \"lin.tx\"", asLight);
    shows(kNew, "\"string map\" \"srgb.tx\"", kTexel);
    run("render -q --gamma srgb --rib 'Option \"texture\" \"string colorspace\" \"srgb\"' -o h.png w.rib", "2>err");
    expectNear(middle("h.png"), kTexel, "hidden, in light");
    shows("Option \"texture\" \"string colorspace\" \"linear\"", "\"string map\" \"pic.png\"", asLight);
    shows(kNew, "\"string map\" \"pic.png\" \"float number\" 1", {asLight[0], asLight[0], asLight[0]}); // a float is data
}

} // namespace colour_test
