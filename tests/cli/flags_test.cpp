// The command line itself: flags of other renderers, help, what is near to a misspelt word, texts about ranges, --display with a
// mode, frames that the scene does not have, the default number of threads.
#include "command_folder.h"
#include <nlohmann/json.hpp>

namespace flags_test {

using Json = nlohmann::json;

namespace {

const char* const kScene = "Format 16 12 1\nWorldBegin\nTranslate 0 0 5\nSurface \"constant\"\nSphere 1 -1 1 360\nWorldEnd\n";

class Flags : public alpenglow::cli::testing::CommandFolder {
protected:
    void SetUp() override {
        CommandFolder::SetUp();
        write("s.rib", kScene);
    }
    std::string run(const std::string& arguments) { return CommandFolder::run(arguments, "2>err"); }
    std::string errors() const { return text("err"); }
    std::string text(const std::string& name) const {
        std::ifstream in(dir / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    bool says(const std::string& part) const { return errors().find(part) != std::string::npos; }
};

/// Width and height that a PNG's header has.
std::pair<int, int> sizeOfPng(const std::string& bytes) {
    const auto at = [&](size_t i) {
        int n = 0;
        for (size_t k = 0; k < 4; ++k) n = n << 8 | int(static_cast<unsigned char>(bytes[i + k]));
        return n;
    };
    return bytes.size() > 24 ? std::pair{at(16), at(20)} : std::pair{0, 0};
}

} // namespace

TEST_F(Flags, ThoseOfOtherRenderersAreTaken) {
    run("-p:2 -t:1 -progress -res 20 10 -statsfile t.json -cwd . -o a.png s.rib");
    EXPECT_EQ(status, 0) << errors();
    EXPECT_EQ(sizeOfPng(text("a.png")), std::pair(20, 10));
    EXPECT_EQ(Json::parse(text("t.json"))["threads"], 1);
    run("render -crop 0 .5 0 1 -f 1 3 -recover 0 -woff A57001,R50004 -nocolor -v -o b.png s.rib");
    EXPECT_EQ(status, 0) << errors();
    EXPECT_TRUE(says("note: -crop is --crop 0,.5,0,1 here")) << errors();
    EXPECT_TRUE(says("note: -f is --frames 1-3 here")) << errors();
    EXPECT_TRUE(says("-woff of prman has no effect")) << errors();
    run("render -frames=1,3-4 -threads=1 -option 'Format 8 8 1' -q -o c.png s.rib");
    EXPECT_EQ(status, 0) << errors();
    EXPECT_EQ(errors(), "");
    EXPECT_EQ(run("-version").rfind("alpenglow ", 0), 0u);
    EXPECT_EQ(status, 0);
    run("render -cwd nowhere s.rib");
    EXPECT_EQ(status, 2);
    EXPECT_TRUE(says("there is no folder \"nowhere\"")) << errors();
}

TEST_F(Flags, ThoseThatCannotBeTakenAreAnswered) {
    for (const auto& [flag, answer] : {std::pair{"-capture x.rib", "`alpenglow rib`"}, {"-res 100", "-res takes 2 values"}}) {
        run(std::string("render s.rib ") + flag);
        EXPECT_EQ(status, 2) << flag;
        EXPECT_TRUE(says(answer)) << flag << ": " << errors();
    }
    EXPECT_FALSE(std::filesystem::exists(dir / "ri.pic"));
}

TEST_F(Flags, ThoseThatAskForWhatIsNotDoneAreNoted) {
    for (const auto& [flag, answer] : {std::pair{"-d", "--display TYPE:NAME:MODE"},
                                       {"-d it", "--display TYPE:NAME:MODE"},
                                       {"-d 4", "--display TYPE:NAME:MODE"},
                                       {"-id", "--display TYPE:NAME:MODE"},
                                       {"-fb", "--display TYPE:NAME:MODE"},
                                       {"-type=file", "--display TYPE:NAME:MODE"},
                                       {"-checkpoint 5m", "--checkpoint FILE"},
                                       {"-recover 1", "--checkpoint FILE --resume"}}) {
        for (const char* quiet : {"", " -q"}) {
            std::filesystem::remove(dir / "ri.pic");
            run(std::string(flag) + " s.rib" + quiet);
            EXPECT_EQ(status, 0) << flag << ": " << errors();
            EXPECT_EQ(says(answer), !*quiet) << flag << ": " << errors();
            EXPECT_TRUE(std::filesystem::exists(dir / "ri.pic")) << flag;
        }
    }
    run("-dspyserver host:1 -dspyframe 2 -stats1 -nd -silent -o a.png s.rib");
    EXPECT_EQ(status, 0) << errors();
    EXPECT_EQ(errors(), "");
    run("render -d s.rib -o b.png"); // the scene is no display driver
    EXPECT_EQ(status, 0) << errors();
}

// A file that misspells a request for each of its shapes: the first three, and how many more there were.
TEST_F(Flags, WarningsThatRepeatAreSummedUp) {
    std::string rib = "Format 8 8 1\nWorldBegin\nTranslate 0 0 5\nSphere 1 -1 1 360\n";
    for (int i = 0; i < 40; ++i) rib += "GeometricApproximation \"tesselation\" 64\n";
    write("many.rib", rib + "WorldEnd\n");
    const auto count = [&](const std::string& part) {
        const std::string all = errors();
        int n = 0;
        for (size_t at = 0; (at = all.find(part, at)) != all.npos; ++at) ++n;
        return n;
    };
    run("render -o a.png many.rib");
    EXPECT_EQ(status, 0) << errors();
    EXPECT_EQ(count("many.rib:"), 3) << errors();
    EXPECT_EQ(count("warning: 37 more like this were not shown (-v shows all): "), 1) << errors();
    run("render -v -o a.png many.rib");
    EXPECT_EQ(count("warning: "), 40) << errors();
}

TEST_F(Flags, MisspeltOptionsAndCommands) {
    run("render --hidr path s.rib");
    EXPECT_EQ(status, 2);
    EXPECT_TRUE(says("render has no option --hidr; did you mean --hider?")) << errors();
    run("render --treads=2 s.rib");
    EXPECT_TRUE(says("did you mean --threads?")) << errors();
    run("renderr s.rib");
    EXPECT_EQ(status, 2);
    EXPECT_TRUE(says("there is no command and no file \"renderr\"; did you mean \"render\"?")) << errors();
    write("shadee", kScene); // a file, however it is called
    run("shadee -o f.png");
    EXPECT_EQ(status, 0) << errors();
    run("help infoo");
    EXPECT_EQ(status, 2);
    EXPECT_TRUE(says("did you mean \"info\"?")) << errors();
}

TEST_F(Flags, Help) {
    const std::string all = run("help");
    EXPECT_EQ(status, 0);
    EXPECT_EQ(all, run("--help"));
    EXPECT_EQ(run("help render"), run("render --help"));
    EXPECT_EQ(status, 0);
}

TEST_F(Flags, RangesInPlainWords) {
    for (const auto& [flag, answer] :
         {std::pair{"--noise 0", "--noise: takes a number above 0, for example 0.02 for 2 %, not 0\n"},
          {"--noise 5%", "not 5%\n"},
          {"--time -1", "--time: takes a number above 0, not -1\n"},
          {"--gamma 0", "--gamma: takes a number from 0.01 to 100, not 0\n"},
          {"--threads 0", "--threads: takes a whole number from 1 to 1024, not 0\n"},
          {"--threads 1.5", "takes a whole number from 1 to 1024, not 1.5\n"},
          {"--sample-clamp -2", "takes a number that is 0 or more, not -2\n"}}) {
        run(std::string("render s.rib ") + flag);
        EXPECT_EQ(status, 2) << flag;
        EXPECT_TRUE(says(answer)) << flag << ": " << errors();
    }
}

TEST_F(Flags, DisplayWithAMode) {
    run("render -q --display png:n.png:N --display openexr:all.exr:rgba,N,z --display png:p.png s.rib");
    EXPECT_EQ(status, 0) << errors();
    const std::string exr = text("all.exr");
    for (const char* channel : {"N.x", "R", "A", "Z"}) EXPECT_NE(exr.substr(0, 2000).find(channel), std::string::npos) << channel;
    EXPECT_FALSE(text("n.png").empty());
    EXPECT_FALSE(text("p.png").empty());
    for (const char* bad : {"png", "png:", ":a.png", "png:a.png:"}) {
        run(std::string("render --display ") + bad + " s.rib");
        EXPECT_EQ(status, 2) << bad;
        EXPECT_TRUE(says("takes TYPE:NAME or TYPE:NAME:MODE")) << errors();
    }
}

TEST_F(Flags, FramesThatTheSceneDoesNotHave) {
    std::string frames;
    for (const char* n : {"1", "2", "3", "7"}) frames += std::string("FrameBegin ") + n + "\n" + kScene + "FrameEnd\n";
    write("f.rib", frames);
    run("render -o f.png --frames 30 f.rib");
    EXPECT_EQ(status, 3);
    EXPECT_TRUE(says("the scene has frames 1-3,7, not 30")) << errors();
    EXPECT_FALSE(says("no world was rendered")) << errors();
    run("render -o f.png --frames 2,4-6 f.rib");
    EXPECT_EQ(status, 0) << "the one that is there is rendered";
    EXPECT_TRUE(says("the scene has frames 1-3,7, not 4-6")) << errors();
}

TEST_F(Flags, ThreadsByDefault) {
    ASSERT_EQ(setenv("SLURM_CPUS_PER_TASK", "1", 1), 0);
    run("render -q --stats t.json -o a.png s.rib");
    unsetenv("SLURM_CPUS_PER_TASK");
    EXPECT_EQ(Json::parse(text("t.json"))["threads"], 1);
    run("render -q --threads 2 --stats t.json -o a.png s.rib");
    EXPECT_EQ(Json::parse(text("t.json"))["threads"], 2);
}

TEST_F(Flags, SmallTruths) {
    write("h.rib", std::string("Format 8 8 1\nHider \"pathtrace\"\n") + kScene);
    run("render -q -o h.png h.rib");
    EXPECT_TRUE(says("h.rib:2:1: error: there is no hider \"pathtrace\": \"hidden\" is used")) << errors();
    EXPECT_TRUE(says("the hiders are hidden, path, photon and raytrace")) << errors();
    for (const char* same : {"paint", "painter", "stochastic", "zbuffer", "reyes", "scanline", "depthbuffer",
                             "opengl"}) { // names that other programs have for it
        write("h.rib", std::string("Format 8 8 1\nHider \"") + same + "\"\n" + kScene);
        run("render -q -o h.png h.rib");
        EXPECT_EQ(status, 0) << same << ": " << errors();
    }
    const std::string moving = "MotionBegin [0 1]\nTranslate 0 0 5\nTranslate 1 0 5\nMotionEnd\n";
    write("c.rib", "Format 8 8 1\nShutter 0 1\n" + moving + "WorldBegin\nSphere 1 -1 1 360\nWorldEnd\n");
    run("render --progress none -o c.png c.rib");
    EXPECT_FALSE(says("motion")) << "a moving camera is drawn as it moves: " << errors();
    write("p.rib", "Format 8 8 1\nShutter 0 1\nWorldBegin\n" + moving + "Sphere 1 -1 1 360\nWorldEnd\n");
    run("render --progress none -o c.png p.rib");
    EXPECT_FALSE(says("motion") || says("move")) << "moving primitives are drawn as they move: " << errors();
    run("render -q -o a.exr s.rib");
    run("render -q -o b.png s.rib");
    run("diff a.exr b.png");
    EXPECT_TRUE(says("the pictures have different channels: r g b a in the first, r g b in the second")) << errors();
    run("maketx b.png -o b.tx");
    EXPECT_EQ(status, 0) << errors();
    EXPECT_FALSE(text("b.tx").empty());
}

TEST_F(Flags, SeedOfTheFrame) {
    std::string frames;
    for (const char* n : {"5", "6"})
        frames += std::string("FrameBegin ") + n + "\nDisplay \"f" + n + ".exr\" \"openexr\" \"rgba\"\nHider \"path\"\n" +
                  kScene + "FrameEnd\n";
    write("f.rib", frames);
    run("render -q --spp 4 --seed frame --stats t.json f.rib");
    const Json j = Json::parse(text("t.json"));
    EXPECT_EQ(j["frames"][0]["seed"], 5);
    EXPECT_EQ(j["frames"][1]["seed"], 6);
    const std::string sixth = text("f6.exr");
    run("render -q --spp 4 --seed 6 --frames 6 f.rib");
    EXPECT_TRUE(text("f6.exr") == sixth);
    run("render --seed x f.rib");
    EXPECT_EQ(status, 2);
    EXPECT_TRUE(says("--seed: takes a whole number or frame, not x")) << errors();
}

} // namespace flags_test
