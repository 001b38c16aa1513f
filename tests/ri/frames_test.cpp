// Frames, their options, and what stays from one to the next (RISpec 3.2, section 4.1).
#include "collect.h"
#include "ri/lookahead.h"
#include "scene/scene.h"
#include <fstream>

namespace frames_test {

using namespace alpenglow;
using namespace alpenglow::ri;

TEST(Frames, SaveOptionsAndAttributes) {
    auto c = read(
        "Format 100 100 1 Color 1 0 0 FrameBegin 3 Format 50 50 1 Color 0 1 0 WorldBegin Sphere 1 -1 1 360 WorldEnd FrameEnd\n"
        "FrameBegin 4 WorldBegin Sphere 1 -1 1 360 WorldEnd FrameEnd");
    EXPECT_TRUE(c->ok) << c->messages();
    ASSERT_EQ(c->frames.size(), 2u);
    EXPECT_EQ(c->frames[0]->options.xres, 50);
    EXPECT_EQ(c->frames[0]->options.frameNumber, 3);
    EXPECT_EQ(c->frames[1]->options.xres, 100);
    EXPECT_EQ(c->frames[1]->options.frameNumber, 4);
    EXPECT_EQ(c->frames[1]->primitives.at(0)->attributes->color, Color(1, 0, 0));
}

TEST(Frames, Filter) {
    ReaderOptions o;
    o.frames = {2};
    auto c = read("FrameBegin 1 MakeTexture \"a\" \"b\" \"black\" \"black\" \"box\" 1 1 WorldBegin Sphere 1 -1 1 360 WorldEnd "
                  "FrameEnd FrameBegin 2 WorldBegin WorldEnd FrameEnd",
                  o);
    EXPECT_EQ(c->frame().options.frameNumber, 2);
    EXPECT_TRUE(c->textures.empty());
}

TEST(Frames, OverridesHaveTheLastWord) {
    ReaderOptions o;
    o.overrides = [](scene::Options& x) { x.xres /= 2; };
    auto c = read("Format 100 100 1 WorldBegin WorldEnd WorldBegin WorldEnd", o);
    ASSERT_EQ(c->frames.size(), 2u);
    EXPECT_EQ(c->frames[0]->options.xres, 50);
    EXPECT_EQ(c->frames[1]->options.xres, 50); // each frame's own copy
}

TEST(Frames, TheConsumerHearsOfThoseThatAreNotWanted) {
    struct Told : Collected {
        std::vector<int> passed;
        std::vector<std::string> files;
        void passOver(const scene::Options& o) override { passed.push_back(o.frameNumber); }
        void passOverTexture(const std::vector<std::string>& f) override { files.insert(files.end(), f.begin(), f.end()); }
    } c;
    ReaderOptions o;
    o.frames = {2};
    RibReader reader(o, c, c.diagnostics);
    reader.readMemory(
        "FrameBegin 1 WorldBegin WorldEnd MakeShadow \"a\" \"b\" FrameEnd FrameBegin 2 WorldBegin WorldEnd FrameEnd "
        "FrameBegin 5 FrameEnd WorldBegin WorldEnd",
        "t.rib");
    ASSERT_EQ(c.frames.size(), 2u);
    EXPECT_TRUE(c.frames[0]->options.inFrame);
    EXPECT_FALSE(c.frames[1]->options.inFrame);
    EXPECT_EQ(c.passed, std::vector<int>{1});
    EXPECT_EQ(c.files, (std::vector<std::string>{"a", "b"}));
}

TEST(Frames, PicturesOfMakeRequestsAreKnownBeforehand) {
    const std::string file = testing::TempDir() + "alpenglow-lookahead.rib";
    const auto names = [&](const std::string& text) {
        std::ofstream(file, std::ios::binary) << text;
        auto found = picturesOfMakeRequests(file, {});
        std::remove(file.c_str());
        return found;
    };
    using Names = std::set<std::string>;
    EXPECT_EQ(names("WorldBegin Sphere 1 -1 1 360 WorldEnd"), Names{});
    EXPECT_EQ(names("FrameBegin 1 WorldBegin WorldEnd MakeShadow \"l.z\" \"l.shd\" FrameEnd\n# " + std::string(70000, 'x') +
                    "\nMakeTexture \"a.tif\" \"a.tx\" \"black\" \"black\" \"box\" 1 1\n"
                    "MakeCubeFaceEnvironment \"1\" \"2\" \"3\" \"4\" \"5\" \"6\" \"7\" 90 \"box\" 1 1"),
              (Names{"l.z", "a.tif", "1", "2", "3", "4", "5", "6"}));
    EXPECT_EQ(names(std::string(65534, ' ') + "MakeShadow \"l.z\" \"l.shd\""), Names{"l.z"}); // over the edge of a block
    EXPECT_EQ(picturesOfMakeRequests("-", {}), Names{});
    EXPECT_EQ(picturesOfMakeRequests("/not/there.rib", {}), Names{});
}

TEST(Frames, AFileWithAWorldLeavesNothingToTheNextScene) {
    Collected c;
    RibReader reader({}, c, c.diagnostics);
    const auto scene = [&](const char* text) {
        reader.nextScene();
        return reader.readMemory(text, "scene.rib");
    };
    EXPECT_TRUE(scene("Format 77 88 1 Declare \"k\" \"color\"")); // options only: for all that follow
    EXPECT_TRUE(scene("Color 1 0 0"));
    const char* world = "Scale 2 2 2 LightSource \"l\" 1 WorldBegin Surface \"x\" \"k\" [1 2 3] Sphere 1 -1 1 360 WorldEnd";
    EXPECT_TRUE(scene(("Format 5 5 1 Color 0 1 0 ErrorHandler \"abort\" " + std::string(world)).c_str()));
    EXPECT_FALSE(scene("Sphere \"wrong\" WorldBegin WorldEnd")); // the abort of the scene before does not hold
    EXPECT_TRUE(scene(world));
    ASSERT_EQ(c.frames.size(), 3u) << c.messages();
    EXPECT_EQ(c.frames[0]->options.xres, 5);
    const scene::Frame& last = *c.frames[2];
    EXPECT_EQ(last.options.xres, 77);
    EXPECT_EQ(last.lights.size(), 1u);
    EXPECT_EQ(last.options.worldToCamera.first().m[0][0], 2);
    EXPECT_EQ(last.primitives.at(0)->attributes->color, Color(1, 0, 0));
}

TEST(Frames, StateStaysBetweenStreams) {
    Collected c;
    RibReader reader({}, c, c.diagnostics);
    EXPECT_TRUE(reader.readMemory("Format 77 88 1 Declare \"k\" \"color\"", "--rib"));
    EXPECT_TRUE(reader.readMemory("WorldBegin Surface \"x\" \"k\" [1 2 3] Sphere 1 -1 1 360 WorldEnd", "scene.rib"))
        << c.messages();
    EXPECT_EQ(c.frame().options.xres, 77);
    EXPECT_EQ(c.primitive().attributes->surface->params.at(0).type, scene::Type::Color);
    EXPECT_EQ(c.primitive().place.file, "scene.rib");
}

TEST(Frames, OptionsAreAsGiven) {
    auto c = read("Projection \"perspective\" \"fov\" 30 Clipping 1 100 DepthOfField 2 .5 3 Shutter .25 .75 PixelVariance .01 "
                  "PixelFilter \"box\" 1 3\n"
                  "Exposure 2 2.2 Imager \"background\" \"color bgcolor\" [1 0 0] Quantize \"rgba\" 1023 0 1023 .25 Quantize "
                  "\"z\" 0 0 0 0\n"
                  "Display \"a\" \"tiff\" \"rgb\" Display \"+b\" \"openexr\" \"z\" \"float[4] quantize\" [0 1 0 1] "
                  "DisplayChannel \"varying color diff\"\n"
                  "Hider \"raytrace\" \"int jitter\" 0 RelativeDetail 2 Option \"limits\" \"bucketsize\" [32 16] "
                  "FrameAspectRatio 1.5 ScreenWindow -2 2 -1 1\n"
                  "Option \"searchpath\" \"shader\" \"a:b\" Option \"searchpath\" \"shader\" \"c:&\" WorldBegin WorldEnd");
    EXPECT_EQ(c->only().message, "Option \"limits\" \"bucketsize\" does nothing here");
    EXPECT_EQ(c->only().severity, Severity::Info);
    const scene::Options& o = c->frame().options;
    EXPECT_EQ(o.projection, "perspective");
    EXPECT_EQ(o.fov, 30);
    EXPECT_EQ(o.clipNear, 1);
    EXPECT_EQ(o.clipFar, 100);
    EXPECT_EQ(o.fstop, 2);
    EXPECT_EQ(o.focalDistance, 3);
    EXPECT_EQ(o.shutterClose, .75f);
    EXPECT_EQ(o.pixelVariance, .01f);
    EXPECT_EQ(o.filter.name, "box");
    EXPECT_EQ(o.filter.ywidth, 3);
    EXPECT_EQ(o.gain, 2);
    EXPECT_EQ(o.imager->name, "background");
    EXPECT_EQ(o.quantizeRgba.one, 1023);
    EXPECT_TRUE(o.quantizeZ.set);
    ASSERT_EQ(o.displays.size(), 2u);
    EXPECT_EQ(o.displays[1].name, "b");
    EXPECT_EQ(o.displays[1].params.at(0).numbers.size(), 4u);
    EXPECT_EQ(o.displayChannels.at("diff").type, scene::Type::Color);
    EXPECT_EQ(o.hider, "raytrace");
    EXPECT_EQ(o.values.at("limits:bucketsize").numbers[0], 32);
    EXPECT_EQ(*o.frameAspect, 1.5f);
    EXPECT_EQ((*o.screenWindow)[0], -2);
    EXPECT_EQ(o.values.at("searchpath:shader").strings[0], "c:a:b");
}

TEST(Frames, BadOptionsAreReported) {
    for (const char* bad :
         {"CropWindow 0 2 0 1", "CropWindow .5 .2 0 1", "PixelSamples 0 1", "Exposure 1 0", "Shutter 1 0", "Clipping 5 1",
          "PixelFilter \"box\" 0 1", "Projection \"perspective\" \"fov\" 180", "ScreenWindow 1 1 0 1", "ColorSamples [1 2] [1 2]",
          "FrameAspectRatio 0", "ClippingPlane 0 0 0 0 0 0"})
        EXPECT_EQ(read(bad)->only().code, Rie::Range) << bad;
    EXPECT_EQ(read("PixelFilter \"gausian\" 2 2")->only().hint, "did you mean gaussian?");
    EXPECT_EQ(read("Format 70000 10 1")->only().code, Rie::Limit);
}

// The world of the archive is drawn as it stands, whatever the edits say.
TEST(Frames, EditsOfAWorldAreLeftOut) {
    const std::string archive = "ArchiveBegin \"baked\"\nWorldBegin\nColor 1 0 0\nSphere 1 -1 1 360\nWorldEnd\nArchiveEnd\n";
    auto c = read(archive + "Format 30 20 1\nEditWorldBegin \"baked\" \"string rerenderer\" \"raytrace\"\n"
                            "EditBegin \"attribute\" \"string scopename\" \"ball\"\nEditAttributeBegin \"ball\"\nColor 0 1 0\n"
                            "Sphere 2 -2 2 360\nNoSuchRequest 3\nEditAttributeEnd\nEditEnd\nEditBegin \"null\"\nEditEnd\n"
                            "EditWorldEnd\nFormat 10 10 1\n");
    ASSERT_EQ(c->frames.size(), 1u);
    EXPECT_EQ(c->frames[0]->options.xres, 30);
    ASSERT_EQ(c->frames[0]->primitives.size(), 1u);
    EXPECT_EQ(c->frames[0]->primitives[0]->attributes->color, Color(1, 0, 0));
    EXPECT_NE(c->messages().find("the world of the archive is drawn as it stands"), std::string::npos) << c->messages();
    EXPECT_EQ(read("EditWorldEnd")->only().code, Rie::Nesting);
    EXPECT_EQ(read("EditWorldBegin \"nowhere.rib\"\nEditWorldEnd")->diagnostics.errors(), 1);
    const auto open =
        read(archive + "EditWorldBegin \"baked\"\nEditBegin \"null\"\nEditWorldEnd\nWorldBegin\nSphere 1 -1 1 360\nWorldEnd\n");
    EXPECT_EQ(open->diagnostics.errors(), 1) << open->messages();
    EXPECT_EQ(open->frames.size(), 2u);
}

// JPatch writes "catmullrom"; RenderMan 22 names its cameras PxrPerspective, PxrCamera and PxrOrthographic.
TEST(Frames, NamesOfOtherProgramsMeanTheSame) {
    const auto options = [](const std::string& text, size_t warnings) {
        auto c = read(text + "\nBasis \"catmullrom\" 1 \"bspline\" 1\nWorldBegin\nSphere 1 -1 1 360\nWorldEnd\n");
        EXPECT_EQ(c->count(), warnings) << c->messages();
        EXPECT_EQ(c->primitive().attributes->ubasis.name, "catmull-rom");
        EXPECT_EQ(c->primitive().attributes->vbasis.name, "b-spline");
        return c->frame().options;
    };
    EXPECT_EQ(options("PixelFilter \"catmullrom\" 4 4", 0).filter.name, "catmull-rom");
    EXPECT_EQ(options("PixelFilter \"RiGaussianFilter\" 2 2", 0).filter.name, "gaussian");
    EXPECT_EQ(options("Projection \"PxrPerspective\" \"float fov\" 30", 0).fov, 30);
    EXPECT_EQ(options("Projection \"PxrCamera\" \"float fov\" 30 \"float tilt\" 3", 1).projection, "perspective");
    EXPECT_EQ(options("Projection \"PxrOrthographic\"", 0).projection, "orthographic");
}

} // namespace frames_test
