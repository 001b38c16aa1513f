// ErrorHandler in whole runs: what is printed, what is written, with which status the program ends.
#include "command_folder.h"
#include <fstream>

namespace errorhandler_test {

namespace {

class ErrorHandler : public alpenglow::cli::testing::CommandFolder {
protected:
    std::string run(const std::string& arguments) { return CommandFolder::run(arguments, "2>err"); }
    std::string errors() const {
        std::ifstream in(dir / "err", std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    bool says(const std::string& words) const { return errors().find(words) != std::string::npos; }
    bool there(const char* name) const { return std::filesystem::exists(dir / name); }
    /// Frames 1 to 3 with a picture each; `second` stands in the world of the second.
    void frames(const std::string& style, const std::string& second) const {
        std::string text = "ErrorHandler \"" + style + "\"\nFormat 8 8 1\nPixelSamples 1 1\n";
        for (const char* n : {"1", "2", "3"})
            text += std::string("FrameBegin ") + n + "\nDisplay \"" + n + ".exr\" \"openexr\" \"rgb\"\nWorldBegin\n" +
                    "Translate 0 0 5\nSurface \"constant\"\n" + (*n == '2' ? second : "") +
                    "Sphere 9 -9 9 360\nWorldEnd\nFrameEnd\n";
        write("a.rib", text);
    }
};

} // namespace

TEST_F(ErrorHandler, PrintGoesOn) {
    frames("print", "Sides 3\n");
    run("render a.rib");
    EXPECT_EQ(status, 1) << errors();
    EXPECT_TRUE(says("a.rib:17:1: error: Sides: it is 1 or 2")) << errors();
    EXPECT_TRUE(there("1.exr") && there("2.exr") && there("3.exr"));
}

TEST_F(ErrorHandler, IgnoreGoesOnInSilence) {
    frames("ignore", "Sides 3\nOption \"trase\" \"int x\" 1\n");
    run("render a.rib");
    EXPECT_EQ(status, 0) << errors();
    EXPECT_FALSE(says("Sides") || says("trase")) << errors();
    EXPECT_TRUE(says("note: ErrorHandler \"ignore\": 3 errors and warnings were not printed; -v prints all")) << errors();
    EXPECT_TRUE(there("1.exr") && there("2.exr") && there("3.exr"));
    run("render -v a.rib");
    EXPECT_EQ(status, 0);
    EXPECT_TRUE(says("error: Sides: it is 1 or 2")) << errors();
}

TEST_F(ErrorHandler, AbortEndsTheRunAtAFaultOfTheFile) {
    for (const char* how : {"", "--hider path --spp 1 ", "--frames-at-once 2 "}) {
        frames("abort", "Sides 3\n");
        run(std::string("render ") + how + "a.rib");
        EXPECT_NE(status, 0) << how;
        EXPECT_TRUE(says("error: Sides: it is 1 or 2")) << errors();
        EXPECT_TRUE(there("1.exr")) << how << errors();
        EXPECT_FALSE(there("2.exr") || there("3.exr")) << how;
        std::filesystem::remove(dir / "1.exr");
    }
}

TEST_F(ErrorHandler, AbortEndsTheRunAtAFaultOfTheDrawing) {
    // A shader that is not there; then one whose map is not there, which is found out when the picture is half done.
    write("maps.sl", "surface maps() { Oi = 1; Ci = texture(\"nowhere.tx\", u, v); }\n");
    for (const char* fault : {"Surface \"nobody\"\n", "Surface \"maps\"\n"})
        for (const char* how : {"", "--hider path --spp 1 "}) {
            frames("abort", fault);
            run(std::string("render ") + how + "a.rib");
            EXPECT_NE(status, 0) << how << fault;
            EXPECT_TRUE(says("error: ")) << errors();
            EXPECT_TRUE(there("1.exr")) << how << errors();
            EXPECT_FALSE(there("2.exr") || there("3.exr")) << how << fault << errors();
            std::filesystem::remove(dir / "1.exr");
        }
    frames("print", "Surface \"nobody\"\n");
    run("render a.rib");
    EXPECT_EQ(status, 1);
    EXPECT_TRUE(there("2.exr") && there("3.exr"));
}

} // namespace errorhandler_test
