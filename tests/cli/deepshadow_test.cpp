// A deep shadow pass and a picture that reads it, in one file, as published scenes have them.
#include "command_folder.h"
#include "display/imageio.h"
#include <fmt/format.h>

using namespace alpenglow;

namespace {

class DeepShadows : public cli::testing::CommandFolder {
protected:
    std::string text(const std::string& name) const {
        std::ifstream in(dir / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    display::Image read(const std::string& name) const {
        Diagnostics d;
        auto m = display::readImage((dir / name).string(), d);
        EXPECT_TRUE(m) << name;
        return m ? *m : display::makeImage(1, 1, {"r", "g", "b"});
    }
    /// Panes of an opacity at heights 1, 2 and 3 over the floor z = 10 away from lamp and eye, seen along the same way.
    std::string panes() const {
        std::string s;
        for (const auto& [z, opacity] : {std::pair{4, "1 0 0"}, {6, ".5 .5 0"}, {8, "0 .25 .25"}})
            s += fmt::format("AttributeBegin Surface \"constant\" Opacity {} Polygon \"P\" [-2 -2 {} -2 2 {} 2 2 {} 2 -2 {}] AttributeEnd\n",
                             std::string("[") + opacity + "]", z, z, z, z);
        return s;
    }
    void scene(const std::string& options, const std::string& hider) const {
        write("asks.sl", "surface asks(string map = \"\"; float at = 0;) {\n"
                         "    point Q = P + vector(0, 0, at);\n    Oi = 1; Ci = color shadow(map, Q, \"bias\", .01);\n}\n");
        write("alike.sl", "surface alike(string map = \"\";) { Oi = 1; Ci = float shadow(map, P, \"bias\", .01); }\n");
        std::string s = "Option \"statistics\" \"endofframe\" 0\n" + options +
                        "Format 32 32 1\nPixelSamples 2 2\nProjection \"orthographic\"\nScreenWindow -4 4 -4 4\n"
                        "FrameBegin 1\nHider \"" + hider + "\"\nDisplay \"lamp.dsm\" \"deepshad\" \"deepopacity\"\nWorldBegin\nSides 2\n" + panes() +
                        "Surface \"constant\"\nPolygon \"P\" [-9 -9 10 -9 9 10 9 9 10 9 -9 10]\nWorldEnd\nFrameEnd\n"
                        "MakeShadow \"lamp.dsm\" \"lamp.shd\"\n";
        int frame = 2;
        for (const char* shader : {"\"asks\" \"at\" -5", "\"asks\" \"at\" -3", "\"asks\" \"at\" -1", "\"asks\" \"at\" 1", "\"alike\""}) {
            s += fmt::format("FrameBegin {}\nDisplay \"f{}.exr\" \"openexr\" \"rgb\"\nWorldBegin\nSurface {} \"string map\" \"lamp.shd\"\n"
                             "Polygon \"P\" [-9 -9 10 -9 9 10 9 9 10 9 -9 10]\nWorldEnd\nFrameEnd\n", frame, frame, shader);
            ++frame;
        }
        write("s.rib", s);
    }
};

TEST_F(DeepShadows, TransparentColouredPanes) {
    for (const char* hider : {"hidden", "path"}) {
        scene("", hider);
        run("render --progress none s.rib", "2>err");
        ASSERT_EQ(status, 0) << text("err");
        EXPECT_EQ(text("err").find("warning"), std::string::npos) << text("err");
        const Color want[] = {{1, 0, 0}, {1, .5f, 0}, {1, .625f, .25f}, {1, 1, 1}};
        for (int f = 0; f < 4; ++f) {
            const display::Image m = read(fmt::format("f{}.exr", f + 2));
            const float *in = m.pixel(16, 16), *out = m.pixel(2, 2);
            for (int k = 0; k < 3; ++k) {
                EXPECT_NEAR(in[k], want[f][k], 1e-5) << hider << f << k;
                EXPECT_NEAR(out[k], f == 3 ? 1 : 0, 1e-5) << "beside the panes, and below the floor";
            }
        }
        EXPECT_NEAR(read("f6.exr").pixel(16, 16)[0], (1 + .625f + .25f) / 3, 1e-5) << "one number: the mean of the colours";
        const display::Image map = read("lamp.dsm");
        ASSERT_TRUE(map.deep);
        EXPECT_EQ(map.width, 32);
    }
}

// The same whatever the number of threads, and a moving edge covers what it covers.
TEST_F(DeepShadows, MovingThingsAndThreads) {
    write("s.rib", "Format 40 4 1\nPixelSamples 8 8\nProjection \"orthographic\"\nScreenWindow -5 5 -.5 .5\nShutter 0 1\n"
                   "Option \"limits\" \"float deepshadowerror\" 0\nDisplay \"a.dsm\" \"dsm\" \"deepopacity\"\nWorldBegin\nSides 2\n"
                   "MotionBegin [0 1]\nTranslate 0 0 0\nTranslate 4 0 0\nMotionEnd\nSurface \"constant\"\n"
                   "Polygon \"P\" [-5 -9 3 -5 9 3 0 9 3 0 -9 3]\nWorldEnd\n");
    run("render --progress none --threads 1 s.rib", "2>err");
    ASSERT_EQ(status, 0) << text("err");
    const std::string one = text("a.dsm");
    run("render --progress none --threads 3 s.rib", "2>err");
    EXPECT_EQ(text("a.dsm"), one);
    // The right edge goes from x = 0 to 4: at x the polygon is there for 1 - x / 4 of the time.
    const display::Image m = read("a.dsm");
    ASSERT_TRUE(m.deep);
    for (int i = 20; i < 36; ++i) {
        double left[3], sum = 0;
        for (int y = 0; y < 4; ++y) {
            m.deep->leftAt(size_t(y * 40 + i), 4, left);
            sum += left[1] / 4;
        }
        EXPECT_NEAR(sum, (i - 20 + .5) / 16, .06) << i; // two deviations of 256 independent halves; strata are nearer
    }
}

TEST_F(DeepShadows, WrongNumbersAreSaid) {
    write("s.rib", "Format 4 4 1\nOption \"limits\" \"float deepshadowerror\" 7\nDisplay \"a.dsm\" \"dsm\" \"deepopacity\"\nWorldBegin\n"
                   "Translate 0 0 5\nSphere 1 -1 1 360\nWorldEnd\n");
    run("render --progress none s.rib", "2>err");
    EXPECT_NE(text("err").find("deepshadowerror"), std::string::npos);
    EXPECT_TRUE(read("a.dsm").deep);
}

} // namespace
