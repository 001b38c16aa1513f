// Procedurals that wait until a ray comes to their bound: the same pictures to the bit as with all of them made at once,
// whatever threads, crops and parts meet first; and those that no ray comes to are not read.
#include "command_folder.h"
#include "display/imageio.h"
#include <sstream>

namespace unmade_test {

namespace {

class DeferredBounds : public alpenglow::cli::testing::CommandFolder {
protected:
    std::string err;
    std::string draw(const std::string& arguments) {
        run("-v --progress none " + arguments, "2>err");
        std::ifstream in(dir / "err");
        err.assign(std::istreambuf_iterator<char>(in), {});
        return err;
    }
    std::vector<float> pixels(const std::string& name) const {
        alpenglow::Diagnostics diag;
        const auto image = alpenglow::display::readImage((dir / name).string(), diag);
        EXPECT_TRUE(image) << name;
        return image ? image->data : std::vector<float>();
    }
    /// A mirror before the camera that shows what lies behind it; kind: "Procedural" or "ReadArchive".
    std::string scene(const std::string& hider, bool waits) const {
        std::ostringstream s;
        s << "Format 48 40 1 PixelSamples 2 2 Hider \"" << hider << "\" Projection \"perspective\" \"fov\" 60 WorldBegin\n"
          << "LightSource \"distantlight\" 1 \"from\" [1 2 -1] \"to\" [0 0 0] \"intensity\" 1\n"
          << "Attribute \"visibility\" \"int trace\" 1 \"string transmission\" \"opaque\" Attribute \"identifier\" \"name\" "
             "\"x\"\n"
          << "AttributeBegin Surface \"shows\" Translate 0 0 4 Polygon \"P\" [-2 -2 0 -2 2 0 2 2 .8 2 -2 .8] AttributeEnd\n"
          << "Surface \"spots\" AttributeBegin Translate 0 -1 2 Sphere .5 -.5 .5 360 AttributeEnd\n";
        for (int row = 0; row < 3; ++row)
            for (int k = 0; k < 4; ++k) {
                s << "TransformBegin Translate " << 3 * k - 4.5 << " " << row * 3 - 3 << " " << -6 - row << " ";
                if (waits) s << "Procedural \"DelayedReadArchive\" [\"tree.rib\"] [-2 2 -2 2 -3 1] TransformEnd\n";
                else s << "AttributeBegin ReadArchive \"tree.rib\" AttributeEnd TransformEnd\n";
            }
        s << "TransformBegin Translate 0 0 -400 Procedural \"DelayedReadArchive\" [\"never.rib\"] [-1 1 -900 -800 -1 1] "
             "TransformEnd\n";
        s << "WorldEnd\n";
        return s.str();
    }
    void files() {
        write("shows.sl",
              "surface shows() { vector r = reflect(normalize(I), normalize(N)); Ci = .1 + .8 * trace(P, r); Oi = 1; }");
        write("spots.sl", "surface spots() { Ci = Cs * (.3 + diffuse(normalize(N))) * (.5 + .5 * noise(4 * transform(\"object\", "
                          "P))); Oi = 1; }");
        write("tree.rib", "Color [.8 .4 .2] Sphere 1 -1 1 360 Declare \"w\" \"uniform float\" TransformBegin Translate 1.2 0 -.5 "
                          "Procedural \"DelayedReadArchive\" [\"leaf.rib\"] [-.6 .6 -.6 .6 -.6 .6] TransformEnd\n"
                          "Color [.2 .7 .3] Translate -1.2 .3 0 Sphere .6 -.6 .6 360\n");
        write("leaf.rib", "Color [.9 .9 .1] Sphere .5 -.5 .5 360");
    }
};

TEST_F(DeferredBounds, PicturesAreThoseOfContentThatIsThereAtOnce) {
    files();
    for (const std::string hider : {"path", "raytrace", "hidden"}) {
        SCOPED_TRACE(hider);
        write("at.rib", scene(hider, false));
        write("late.rib", scene(hider, true));
        const std::string how = hider == "path" ? "--spp 4 " : "";
        draw(how + "-o at.exr --threads 1 at.rib");
        draw(how + "-o one.exr --threads 1 late.rib");
        EXPECT_EQ(err.find("never.rib"), std::string::npos) << err; // it is not there, and nobody looks
        EXPECT_NE(err.find("of 25 procedurals"), std::string::npos) << err;
        draw(how + "-o two.exr --threads 3 --lanes 4 late.rib");
        EXPECT_EQ(pixels("at.exr"), pixels("one.exr"));
        EXPECT_EQ(pixels("one.exr"), pixels("two.exr"));
    }
}

TEST_F(DeferredBounds, PartsMeetOthersFirstAndAreTheSame) {
    files();
    write("late.rib", scene("path", true));
    draw("--spp 4 -o whole.exr late.rib");
    draw("--spp 4 --samples 2:4 -o b.exr late.rib");
    draw("--spp 4 --samples 0:2 -o a.exr late.rib");
    run("merge -o merged.exr a.exr.part b.exr.part", "2>err");
    if (status != 0) run("merge -o merged.exr a.part b.part", "2>err");
    ASSERT_EQ(status, 0);
    EXPECT_EQ(pixels("whole.exr"), pixels("merged.exr"));
    draw("--spp 4 --crop .2,.5,.3,.6 -o crop.exr late.rib");
    EXPECT_EQ(status, 0);
    write("at.rib", scene("path", false));
    EXPECT_EQ(run("--spp 4 --pixel 24,20 late.rib", "2>err"), run("--spp 4 --pixel 24,20 at.rib", "2>err"));
}

TEST_F(DeferredBounds, WhatNoRayComesToIsNotRead) {
    files();
    // Matte under hidden sends no ray: only the wall before the camera is drawn.
    write("matte.rib", "Format 24 24 1 Projection \"perspective\" \"fov\" 60 WorldBegin LightSource \"distantlight\" 1\n"
                       "Surface \"matte\" Translate 0 0 3 Polygon \"P\" [-2 -2 0 -2 2 0 2 2 0 2 -2 0]\n"
                       "Translate 0 0 -9 Procedural \"DelayedReadArchive\" [\"never.rib\"] [-1 1 -1 1 -1 1] WorldEnd");
    draw("-o matte.exr matte.rib");
    EXPECT_EQ(status, 0) << err;
    EXPECT_NE(err.find("of 1 procedurals outside of the picture 0 were made"), std::string::npos) << err;
    EXPECT_EQ(err.find("never.rib"), std::string::npos) << err;
    draw("--hider path --spp 1 -o matte.exr matte.rib"); // light goes everywhere
    EXPECT_NE(err.find("never.rib\" was not found"), std::string::npos) << err;
}

} // namespace

} // namespace unmade_test
