// alpenglow rib, and the program under the names of others.
#include "command_folder.h"
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace rib_test {

namespace fs = std::filesystem;

namespace {

class Rib : public alpenglow::cli::testing::CommandFolder {
protected:
    std::string run(const std::string& arguments, const std::string& input = "") {
        return CommandFolder::run(arguments, input + " 2>err");
    }
    std::string errors() const { return contents("err"); }
    std::string contents(const std::string& name) const {
        std::ifstream in(dir / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    /// The program by another name.
    std::string runAs(const std::string& name, const std::string& arguments) {
        fs::remove(dir / name);
        fs::create_symlink(ALPENGLOW_PROGRAM, dir / name);
        const std::string command = "cd '" + dir.string() + "' && './" + name + "' " + arguments + " 2>err";
        std::string out;
        FILE* p = popen(command.c_str(), "r");
        if (!p) return out;
        for (int c; (c = fgetc(p)) != EOF;) out += char(c);
        const int s = pclose(p);
        status = WIFEXITED(s) ? WEXITSTATUS(s) : 128 + WTERMSIG(s);
        return out;
    }
    static constexpr const char* kScene =
        "Format 24 16 1\nDisplay \"x.exr\" \"openexr\" \"rgba\"\nProjection \"perspective\" \"fov\" 40\n"
        "Translate .1 .2 5\nWorldBegin\nLightSource \"pointlight\" 1 \"intensity\" 20 \"from\" [2 3 -4]\n"
        "Surface \"plastic\" \"Kd\" .7\nColor [.9 .3 .1]\nAttributeBegin\nRotate 33.3 .3 1 .1\n"
        "Sphere 1 -1 1 360\nAttributeEnd\nPolygon \"P\" [-3.1 -1.2 9 3.3 -1.2 9 3 2.7 9.1]\nWorldEnd\n";
};

} // namespace

TEST_F(Rib, ThereAndBackGivesTheSamePicture) {
    write("a.rib", kScene);
    run("rib a.rib --binary -o b.rib");
    EXPECT_EQ(status, 0) << errors();
    run("rib b.rib -o c.rib");
    run("rib c.rib --gzip -o d.rib");
    run("rib d.rib --binary -o e.rib.gz");
    EXPECT_EQ(contents("d.rib").substr(0, 2), "\x1f\x8b");
    EXPECT_EQ(contents("e.rib.gz").substr(0, 2), "\x1f\x8b");
    for (const char* f : {"a.rib", "b.rib", "c.rib", "d.rib", "e.rib.gz"}) {
        run(std::string("render -q --spp 2 -o ") + f[0] + ".exr " + f);
        EXPECT_EQ(status, 0) << f << errors();
        run(std::string("diff a.exr ") + f[0] + ".exr");
        EXPECT_EQ(status, 0) << f;
    }
}

TEST_F(Rib, IsAFilterOfPipes) {
    write("a.rib", "AttributeBegin Sides 1 AttributeEnd");
    EXPECT_EQ(run("rib", "<a.rib"), "AttributeBegin\n    Sides 1\nAttributeEnd\n");
    EXPECT_EQ(run("rib --indent 1 -", "<a.rib"), "AttributeBegin\n Sides 1\nAttributeEnd\n");
}

TEST_F(Rib, FiltersPutInAndLeaveOut) {
    write("a.rib", "FrameBegin 1 Sides 1 FrameEnd FrameBegin 2 Surface \"matte\" Imager \"fog\" FrameEnd");
    EXPECT_EQ(run("rib a.rib --frames 2 --drop Imager --replace 'Surface \"matte\"=Surface \"plastic\" Sides 2' --rib 'Matte 1'"),
              "Matte 1\nFrameBegin 2\n    Surface \"plastic\"\n    Sides 2\nFrameEnd\n");
    EXPECT_EQ(status, 0) << errors();
    EXPECT_EQ(run("rib a.rib --only Sides"), "Sides 1\n");
    run("rib a.rib --frames 9 -o b.rib");
    EXPECT_NE(errors().find("there is no frame 9"), std::string::npos);
    for (const char* wrong : {"--drop '('", "--replace x", "--rib 'Sphree 1'", "--frames x", "--binary --ascii", "--nothing"}) {
        run(std::string("rib a.rib -o c.rib ") + wrong);
        EXPECT_EQ(status, 2) << wrong;
        EXPECT_FALSE(fs::exists(dir / "c.rib")) << wrong;
    }
}

TEST_F(Rib, ExpandsChecksAndCounts) {
    write("part.rib", "Sphere 1 -1 1 360");
    write("a.rib", "WorldBegin ReadArchive \"part.rib\" WorldEnd");
    EXPECT_EQ(run("rib --expand a.rib"), "WorldBegin\n    Sphere 1 -1 1 360\nWorldEnd\n");
    EXPECT_EQ(run("rib --validate a.rib"), "");
    EXPECT_EQ(status, 0) << errors();
    write("bad.rib", "WorldBegin Polygon \"P\" [1 2] WorldEnd");
    EXPECT_EQ(run("rib --validate bad.rib"), "");
    EXPECT_EQ(status, 1);
    EXPECT_NE(errors().find("bad.rib:1"), std::string::npos) << errors();
    run("rib none.rib -o b.rib");
    EXPECT_EQ(status, 3);
    EXPECT_FALSE(fs::exists(dir / "b.rib"));
    const auto j = nlohmann::json::parse(run("rib --stats --json --expand a.rib"));
    EXPECT_EQ(j["stats"]["primitives"]["times"], 1);
    EXPECT_EQ(j["stats"]["worlds"], 1);
    EXPECT_NE(run("rib --stats a.rib").find("archives (1): part.rib"), std::string::npos);
    run("rib a.rib -o /no/such/folder/x.rib");
    EXPECT_EQ(status, 5);
}

TEST_F(Rib, WritesOverWhatItReads) {
    write("a.rib", "AttributeBegin\nSides 1\nAttributeEnd");
    run("rib --format a.rib -o a.rib");
    EXPECT_EQ(contents("a.rib"), "AttributeBegin\n    Sides 1\nAttributeEnd\n");
}

TEST_F(Rib, NamesOfOthersDoTheirWork) {
    write("a.rib", "Sides 1 AttributeBegin AttributeEnd");
    EXPECT_EQ(runAs("catrib", "a.rib"), "Sides 1\nAttributeBegin\nAttributeEnd\n");
    runAs("catrib", "-binary -gzip -o b.rib a.rib");
    EXPECT_EQ(status, 0) << errors();
    EXPECT_EQ(runAs("catrib", "-ascii b.rib"), "Sides 1\nAttributeBegin\nAttributeEnd\n");
    EXPECT_EQ(runAs("renderdl", "-catrib a.rib"), "Sides 1\nAttributeBegin\nAttributeEnd\n");
    EXPECT_EQ(runAs("prman", "-catrib - a.rib"), "Sides 1\nAttributeBegin\nAttributeEnd\n");
    EXPECT_EQ(runAs("catrib", "< a.rib"), "Sides 1\nAttributeBegin\nAttributeEnd\n");
    write("tiny.rib", kScene);
    runAs("prman", "-t:1 -progress -d it -recover 1 -checkpoint 5m -dspyserver x -res 8 8 tiny.rib");
    EXPECT_EQ(status, 0) << errors();
    EXPECT_TRUE(fs::exists(dir / "x.exr"));
    runAs("txmake", "-mode periodic -resize up- -format pixar -compression lossy -byte -filter box x.exr x.tex");
    EXPECT_EQ(status, 0) << errors();
    EXPECT_TRUE(fs::exists(dir / "x.tex"));
    const auto made = fs::last_write_time(dir / "x.tex");
    runAs("tdlmake", "-newer -lzw x.exr x.tex");
    EXPECT_EQ(status, 0) << errors();
    EXPECT_EQ(fs::last_write_time(dir / "x.tex"), made);
    write("s.sl", "surface s(float Kd = .5) { Ci = Kd; }");
    runAs("shader", "-I. -DX=1 -o s.slo s.sl");
    EXPECT_EQ(status, 0) << errors();
    EXPECT_NE(errors().find("-o of shader"), std::string::npos);
    EXPECT_NE(runAs("sloinfo", "s.sl").find("Kd"), std::string::npos);
    EXPECT_NE(runAs("sloinfo", "plastic").find("roughness"), std::string::npos) << errors();
    EXPECT_NE(runAs("sho", "x.exr").find("24"), std::string::npos);
    runAs("it", "x.exr");
    EXPECT_EQ(status, 2);
    EXPECT_NE(errors().find("alpenglow view"), std::string::npos);
    EXPECT_NE(runAs("txmake", "--version").find("lpenglow"), std::string::npos);
}

TEST_F(Rib, CatribTakesItsFormFromTheEnvironment) {
    write("a.rib", "Sides 1");
    setenv("RIFORMAT", "binary", 1);
    setenv("RISERVER", "out.rib", 1);
    runAs("catrib", "a.rib");
    unsetenv("RIFORMAT");
    unsetenv("RISERVER");
    EXPECT_EQ(contents("out.rib")[0], '\xcc'); // 0314: a request is defined
}

TEST_F(Rib, ScenesInZipArchivesAreRendered) {
    write("s.rib", kScene);
    if (std::system(("cd '" + dir.string() + "' && zip -q s.zip s.rib 2>/dev/null").c_str()) != 0)
        GTEST_SKIP() << "there is no zip";
    run("render -q --spp 1 -o whole.exr s.rib");
    run("-q --spp 1 -o inside.exr 's.zip!s.rib'");
    EXPECT_EQ(status, 0) << errors();
    run("diff whole.exr inside.exr");
    EXPECT_EQ(status, 0);
}

} // namespace rib_test
