// What would be a silent zero or a picture of another kind is said, with the place and what to do.
#include "command_folder.h"
#include "display/imageio.h"
#include <fstream>
#include <gtest/gtest.h>

namespace {

class Said : public alpenglow::cli::testing::CommandFolder {
protected:
    std::string run(const std::string& arguments) { return CommandFolder::run(arguments, "2>err"); }
    std::string text(const char* name) const {
        std::ifstream in(dir / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    std::string errors() const { return text("err"); }
    bool says(const std::string& words) const { return errors().find(words) != std::string::npos; }
    int times(const std::string& words) const {
        const std::string e = errors();
        int n = 0;
        for (size_t at = e.find(words); at != std::string::npos; at = e.find(words, at + 1)) ++n;
        return n;
    }
    /// A picture of 8 x 8 that shows one sphere, with these requests before and in the world.
    void scene(const std::string& options, const std::string& world, const char* name = "a.rib") const {
        write(name, "Format 8 8 1\nProjection \"perspective\" \"fov\" [30]\n" + options + "Translate 0 0 5\nWorldBegin\n" + world +
                        "Sphere 1 -1 1 360\nWorldEnd\n");
    }
};

const std::string kPng = "\x89PNG", kJpeg = "\xff\xd8\xff", kExr = "\x76\x2f\x31\x01", kTiff = "II*";

} // namespace

TEST_F(Said, ExtensionsThatNobodyWrites) {
    scene("", "Surface \"constant\"\n");
    for (const char* name : {"a.gif", "a", "a.pic", "a.exr.bak"}) {
        run(std::string("render -o ") + name + " a.rib");
        EXPECT_EQ(status, 2) << name;
        EXPECT_TRUE(says(".exr .png .tif .tiff .jpg .jpeg")) << errors();
        EXPECT_FALSE(std::filesystem::exists(dir / name));
    }
    run("merge a.part b.part -o a.gif");
    EXPECT_EQ(status, 2);
    run("diff a.exr b.exr -o a.gif");
    EXPECT_EQ(status, 2);
}

TEST_F(Said, Jpeg) {
    scene("Display \"d.jpg\" \"jpeg\" \"rgba\"\nDisplay \"+f.jpeg\" \"file\" \"rgb\"\nDisplay \"+g.bmp\" \"file\" \"rgb\"\n",
          "Surface \"constant\"\nColor [1 .5 .25]\nScale 4 4 1\n"); // fills the picture
    run("render a.rib");
    EXPECT_EQ(status, 0) << errors();
    EXPECT_EQ(text("d.jpg").substr(0, 3), kJpeg);
    EXPECT_EQ(text("f.jpeg").substr(0, 3), kJpeg);
    EXPECT_EQ(text("g.bmp").substr(0, 3), kTiff);
    EXPECT_TRUE(says("a.rib:5:1: warning: display \"g.bmp\": .bmp is not written here")) << errors();
    run("render -o o.jpg a.rib");
    EXPECT_EQ(text("o.jpg").substr(0, 3), kJpeg);
    run("diff d.jpg f.jpeg");
    EXPECT_EQ(status, 0);
    alpenglow::Diagnostics d;
    const auto image = alpenglow::display::readImage((dir / "d.jpg").string(), d);
    ASSERT_TRUE(image);
    ASSERT_EQ(image->channelCount(), 3);
    const float* p = image->pixel(4, 4);
    EXPECT_NEAR(p[0], 1, 3 / 255.);
    EXPECT_NEAR(p[1], .5, 3 / 255.);
    EXPECT_NEAR(p[2], .25, 3 / 255.);
}

TEST_F(Said, StandardOutput) {
    write("talks.sl", "surface talks() { if (u < 2) printf(\"words\\n\"); Ci = 1; Oi = 1; }\n");
    scene("", "Surface \"talks\"\n");
    const std::string png = run("render -o - a.rib");
    EXPECT_EQ(status, 0) << errors();
    EXPECT_EQ(png.substr(0, 4), kPng);
    EXPECT_EQ(png.substr(png.size() - 8, 4), "IEND");
    EXPECT_TRUE(says("words"));
    run("render -o a.png a.rib");
    EXPECT_EQ(text("a.png"), png);
    for (const auto& [type, magic] : {std::pair{"openexr", kExr}, {"tiff", kTiff}, {"jpeg", kJpeg}, {"framebuffer", kPng}}) {
        scene(std::string("Display \"a\" \"") + type + "\" \"rgb\"\n", "Surface \"constant\"\n");
        EXPECT_EQ(run("render -o - a.rib").substr(0, magic.size()), magic);
    }
    EXPECT_FALSE(std::filesystem::exists(dir / "-"));
    run("render --samples 0:1 --hider path -o - a.rib");
    EXPECT_EQ(status, 2);
    CommandFolder::run("render -o - a.rib", ">/dev/full 2>err");
    EXPECT_EQ(status, 5) << errors();
    // A scene's own "-" is a file.
    scene("Display \"-\" \"png\" \"rgb\"\n", "Surface \"constant\"\n");
    EXPECT_EQ(run("render a.rib"), "");
}

TEST_F(Said, UnknownOptionsAndAttributes) {
    scene("Option \"trace\" \"int maxdpth\" 3\nOption \"trase\" \"int maxdepth\" 3\nOption \"user\" \"int mine\" 3\n"
          "Option \"limits\" \"int gridsise\" 3\nOption \"visibility\" \"int camera\" 1\n",
          "Attribute \"visibilty\" \"int trace\" 1\nAttribute \"visibility\" \"int tracee\" 1\nAttribute \"visibilty\" \"int trace\" 0\n"
          "Attribute \"trace\" \"float bias\" .1\nSurface \"constant\"\n");
    run("render -o a.png a.rib");
    EXPECT_EQ(status, 0);
    EXPECT_TRUE(says("a.rib:3:16: warning: Option \"trace\" \"maxdpth\" is not known")) << errors();
    EXPECT_TRUE(says("did you mean \"maxdepth\"?"));
    EXPECT_TRUE(says("a.rib:4:16: warning: Option \"trase\" \"maxdepth\" is not known"));
    EXPECT_TRUE(says("did you mean \"trace\"?"));
    EXPECT_TRUE(says("a.rib:7:21: warning: Option \"visibility\" \"camera\" is not known"));
    EXPECT_TRUE(says("it is an Attribute"));
    EXPECT_EQ(times("Attribute \"visibilty\" \"trace\" is not known"), 1) << errors();
    EXPECT_TRUE(says("did you mean \"visibility\"?"));
    EXPECT_TRUE(says("Attribute \"visibility\" \"tracee\" is not known"));
    EXPECT_EQ(times("warning:"), 5) << errors();
    run("render -v -o a.png a.rib");
    EXPECT_TRUE(says("note: Option \"limits\" \"gridsise\" does nothing here")) << errors();
    EXPECT_FALSE(says("\"mine\""));
}
