// A deep shadow pass and a picture that reads it, in one file, as published scenes have them.
#include "command_folder.h"
#include "display/imageio.h"
#include <cmath>
#include <fmt/format.h>

namespace deepshadow_test {

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
            s += fmt::format(
                "AttributeBegin Surface \"constant\" Opacity {} Polygon \"P\" [-2 -2 {} -2 2 {} 2 2 {} 2 -2 {}] AttributeEnd\n",
                std::string("[") + opacity + "]", z, z, z, z);
        return s;
    }
    void scene(const std::string& options, const std::string& hider) const {
        write("asks.sl", "surface asks(string map = \"\"; float at = 0;) {\n"
                         "    point Q = P + vector(0, 0, at);\n    Oi = 1; Ci = color shadow(map, Q, \"bias\", .01);\n}\n");
        write("alike.sl", "surface alike(string map = \"\";) { Oi = 1; Ci = float shadow(map, P, \"bias\", .01); }\n");
        std::string s = "Option \"statistics\" \"endofframe\" 0\n" + options +
                        "Format 32 32 1\nPixelSamples 2 2\nProjection \"orthographic\"\nScreenWindow -4 4 -4 4\n"
                        "FrameBegin 1\nHider \"" +
                        hider + "\"\nDisplay \"lamp.dsm\" \"deepshad\" \"deepopacity\"\nWorldBegin\nSides 2\n" + panes() +
                        "Surface \"constant\"\nPolygon \"P\" [-9 -9 10 -9 9 10 9 9 10 9 -9 10]\nWorldEnd\nFrameEnd\n"
                        "MakeShadow \"lamp.dsm\" \"lamp.shd\"\n";
        int frame = 2;
        for (const char* shader :
             {"\"asks\" \"at\" -5", "\"asks\" \"at\" -3", "\"asks\" \"at\" -1", "\"asks\" \"at\" 1", "\"alike\""}) {
            s += fmt::format(
                "FrameBegin {}\nDisplay \"f{}.exr\" \"openexr\" \"rgb\"\nWorldBegin\nSurface {} \"string map\" \"lamp.shd\"\n"
                "Polygon \"P\" [-9 -9 10 -9 9 10 9 9 10 9 -9 10]\nWorldEnd\nFrameEnd\n",
                frame, frame, shader);
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
    write("s.rib",
          "Format 40 4 1\nPixelSamples 8 8\nProjection \"orthographic\"\nScreenWindow -5 5 -.5 .5\nShutter 0 1\n"
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
            m.deep->transmittanceAt(size_t(y * 40 + i), 4, left);
            sum += left[1] / 4;
        }
        EXPECT_NEAR(sum, (i - 20 + .5) / 16, .06) << i; // two deviations of 256 independent halves; strata are nearer
    }
}

// A box of fog between lamp and floor: what is left at a depth is exp(-extinction times the way through it), and below the fog
// what a traced ray finds.
TEST_F(DeepShadows, FogIsSeenByItsDepth) {
    const std::string fog =
        "AttributeBegin Interior \"murk\" Surface \"clear\" Opacity [0 0 0]\n"
        "TransformBegin Translate 0 0 6 Polygon \"P\" [-2 -2 -2 -2 2 -2 2 2 -2 2 -2 -2] Polygon \"P\" [-2 -2 2 2 -2 2 2 2 2 -2 2 "
        "2]\n"
        "Polygon \"P\" [-2 -2 -2 -2 -2 2 -2 2 2 -2 2 -2] Polygon \"P\" [2 -2 -2 2 2 -2 2 2 2 2 -2 2]\n"
        "Polygon \"P\" [-2 -2 -2 2 -2 -2 2 -2 2 -2 -2 2] Polygon \"P\" [-2 2 -2 -2 2 2 2 2 2 2 2 -2] TransformEnd AttributeEnd\n";
    write("clear.sl", "surface clear() { Oi = 0; Ci = 0; }\n");
    write("murk.sl", "volume murk(color density = color(.2, .5, 1);) { color t = color(exp(-length(I) * comp(density, 0)), "
                     "exp(-length(I) * comp(density, 1)), exp(-length(I) * comp(density, 2)));\n"
                     "    Ci = Ci * t; Oi = 1 - (1 - Oi) * t; }\n");
    write("s.rib", "Format 16 16 1\nPixelSamples 2 2\nProjection \"orthographic\"\nScreenWindow -4 4 -4 4\nDisplay \"fog.dsm\" "
                   "\"deepshad\" \"deepopacity\"\n"
                   "Option \"limits\" \"float deepshadowerror\" 0\nWorldBegin\nSides 2\n" +
                       fog + "WorldEnd\n");
    run("render --progress none s.rib", "2>err");
    ASSERT_EQ(status, 0) << text("err");
    const display::Image m = read("fog.dsm");
    ASSERT_TRUE(m.deep);
    const double density[] = {.2, .5, 1};
    for (const double z : {3.9, 4.5, 5.0, 6.0, 7.5, 8.5}) {
        double left[3];
        m.deep->transmittanceAt(8 * 16 + 8, z, left);
        const double way = std::clamp(z - 4, 0.0, 4.0);
        // Half of a step, which takes 1/64 of the light, either way.
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(left[k], std::exp(-way * density[k]), z > 8 ? 1e-4 : .012) << z << " " << k;
        m.deep->transmittanceAt(0, z, left);
        EXPECT_EQ(left[0], 1) << "beside it";
    }
}

// Hairs that let some light through: as much of a pixel as they cover, layer by layer.
TEST_F(DeepShadows, HairTakesWhatItCovers) {
    std::string hairs;
    for (int layer = 0; layer < 3; ++layer) {
        std::string points;
        for (int i = 0; i < 16; ++i)
            points += fmt::format("{} -5 {} {} 5 {} ", -4 + .5 * i + .125, 3 + layer, -4 + .5 * i + .125, 3 + layer);
        hairs += "Curves \"linear\" [" +
                 [] {
                     std::string n;
                     for (int i = 0; i < 16; ++i) n += "2 ";
                     return n;
                 }() +
                 "] \"nonperiodic\" \"P\" [" + points + "] \"constantwidth\" [.25]\n";
    }
    write("s.rib", "Format 16 16 1\nPixelSamples 8 8\nProjection \"orthographic\"\nScreenWindow -4 4 -4 4\nDisplay \"hair.dsm\" "
                   "\"deepshad\" \"deepopacity\"\n"
                   "WorldBegin\nSides 2\nSurface \"constant\" Opacity [.4 .4 .4]\n" +
                       hairs + "WorldEnd\n");
    run("render --progress none s.rib", "2>err");
    ASSERT_EQ(status, 0) << text("err");
    const display::Image m = read("hair.dsm");
    ASSERT_TRUE(m.deep);
    for (int layer = 0; layer < 3; ++layer) {
        double left[3], sum = 0;
        for (int x = 2; x < 14; ++x) {
            m.deep->transmittanceAt(size_t(8 * 16 + x), 3.5 + layer, left);
            sum += left[1] / 12;
        }
        EXPECT_NEAR(sum, .5 + .5 * std::pow(.6, layer + 1), .02) << "half of each pixel is hair";
    }
}

// A point light's six faces, one map each: shadow() of the face that looks there is what a ray finds.
TEST_F(DeepShadows, SixFacesOfAPointLight) {
    // The light stands at the origin in a ring of balls, one before each face, a bit off its middle.
    const char* turn[] = {"Rotate -90 0 1 0", "Rotate 90 0 1 0", "Rotate 90 1 0 0",
                          "Rotate -90 1 0 0", "Rotate 0 1 0 0",  "Rotate 180 0 1 0"};
    const char* axis[] = {"2 .3 0", "-2 .3 0", ".3 2 0", ".3 -2 0", "0 .3 2", "0 .3 -2"};
    std::string balls;
    for (const char* a : axis) balls += std::string("TransformBegin Translate ") + a + " Sphere .4 -.4 .4 360 TransformEnd\n";
    const std::string room = "TransformBegin ReverseOrientation Sphere 4 -4 4 360 TransformEnd\n";
    std::string s = "Option \"statistics\" \"endofframe\" 0\n";
    for (int f = 0; f < 6; ++f)
        s += fmt::format(
            "FrameBegin {}\nFormat 128 128 1\nPixelSamples 2 2\nProjection \"perspective\" \"fov\" 95\nDisplay \"face{}.dsm\" "
            "\"deepshad\" \"deepopacity\"\n{}\nWorldBegin\nSides 2\nSurface \"constant\"\n{}WorldEnd\nFrameEnd\n",
            f + 1, f, turn[f], balls);
    write("six.sl",
          "surface six(float traced = 0;) {\n"
          "    point Q = transform(\"world\", P); float x = abs(xcomp(Q)), y = abs(ycomp(Q)), z = abs(zcomp(Q)), dark = 0;\n"
          "    if (traced != 0) dark = 1 - comp(transmission(P, point \"world\" (0, 0, 0), \"samplecone\", 0), 0);\n"
          "    else if (x >= y && x >= z) { if (xcomp(Q) > 0) dark = shadow(\"face0.dsm\", P, \"bias\", .05); else dark = "
          "shadow(\"face1.dsm\", P, \"bias\", .05); }\n"
          "    else if (y >= z) { if (ycomp(Q) > 0) dark = shadow(\"face2.dsm\", P, \"bias\", .05); else dark = "
          "shadow(\"face3.dsm\", P, \"bias\", .05); }\n"
          "    else { if (zcomp(Q) > 0) dark = shadow(\"face4.dsm\", P, \"bias\", .05); else dark = shadow(\"face5.dsm\", P, "
          "\"bias\", .05); }\n"
          "    Oi = 1; Ci = dark;\n}\n");
    int frame = 7;
    for (int traced = 0; traced < 2; ++traced)
        for (int view = 0; view < 6; ++view, ++frame)
            s += fmt::format("FrameBegin {}\nFormat 40 40 1\nPixelSamples 3 3\nProjection \"perspective\" \"fov\" 90\nDisplay "
                             "\"v{}{}.exr\" \"openexr\" \"rgb\"\n{}\nWorldBegin\nSides 2\nSurface \"six\" \"traced\" {}\n{}"
                             "Surface \"constant\" Attribute \"visibility\" \"int camera\" 0\n{}WorldEnd\nFrameEnd\n",
                             frame, traced, view, turn[view], traced, room, balls);
    write("s.rib", s);
    run("render --progress none s.rib", "2>err");
    ASSERT_EQ(status, 0) << text("err");
    for (int view = 0; view < 6; ++view) {
        const display::Image maps = read(fmt::format("v0{}.exr", view)), rays = read(fmt::format("v1{}.exr", view));
        double error = 0, dark = 0;
        for (size_t i = 0; i < maps.data.size(); ++i) {
            error += std::fabs(double(maps.data[i]) - double(rays.data[i])) / double(maps.data.size());
            dark += double(rays.data[i]) / double(maps.data.size());
        }
        EXPECT_GT(dark, .01) << view;
        EXPECT_LT(error, .02) << view << ": edges of shadows are filtered over pixels of the map";
    }
}

TEST_F(DeepShadows, WrongNumbersAreSaid) {
    write("s.rib",
          "Format 4 4 1\nOption \"limits\" \"float deepshadowerror\" 7\nDisplay \"a.dsm\" \"dsm\" \"deepopacity\"\nWorldBegin\n"
          "Translate 0 0 5\nSphere 1 -1 1 360\nWorldEnd\n");
    run("render --progress none s.rib", "2>err");
    EXPECT_NE(text("err").find("deepshadowerror"), std::string::npos);
    EXPECT_TRUE(read("a.dsm").deep);
}

class DepthMaps : public DeepShadows {};

// Between the two nearest surfaces, whether light comes through the first or not; nothing where there is but one. From the left:
// a wall alone at 2, the same with another at 4 behind it, and a ball of radius .4 about 6.
TEST_F(DepthMaps, InTheMiddleOfTwoSurfaces) {
    for (const char* opacity : {"1 1 1", ".5 .5 .5"})
        for (const char* hider : {"hidden", "raytrace"}) {
            write("m.rib",
                  fmt::format(
                      "Format 16 16 1\nPixelSamples 1 1\nPixelFilter \"box\" 1 1\nProjection \"orthographic\"\n"
                      "Hider \"{}\" \"string depthfilter\" \"midpoint\" \"jitter\" 0\nDisplay \"m.exr\" \"openexr\" \"z\"\n"
                      "WorldBegin\nSurface \"constant\"\nOpacity {}\nPolygon \"P\" [-1 -1 2 0 -1 2 0 1 2 -1 1 2]\n"
                      "Polygon \"P\" [-.5 -1 4 0 -1 4 0 1 4 -.5 1 4]\nTranslate .5625 .0625 6\nSphere .4 -.4 .4 360\nWorldEnd\n",
                      hider, opacity));
            run("render --progress none m.rib", "2>err");
            ASSERT_EQ(status, 0) << text("err");
            const display::Image m = read("m.exr");
            EXPECT_NEAR(m.pixel(6, 8)[0], 3, 1e-6) << hider << opacity;
            EXPECT_NEAR(m.pixel(12, 7)[0], 6, 1e-5) << "from 5.6 to 6.4";
            EXPECT_GT(m.pixel(1, 8)[0], 1e30f) << "one wall";
            EXPECT_GT(m.pixel(14, 1)[0], 1e30f) << "none";
        }
}

} // namespace

} // namespace deepshadow_test
