// What a stranger's files, a full disk and a small machine may do to the program as a user runs it.
#include "base/file.h"
#include "base/limits.h"
#include "base/memory.h"
#include "cli/command_folder.h"
#include "sanitized.h"
#include <chrono>
#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

namespace program_limits_test {

using namespace alpenglow;
namespace fs = std::filesystem;

namespace {

/// Sixteen balls: more than a scene without a tree has.
std::string balls(const std::string& first = "") {
    std::string s = "Format 16 12 1\n" + first +
                    "Projection \"perspective\" \"fov\" 60\nLightSource \"distantlight\" 1\nWorldBegin\n"
                    "Translate 0 0 6\n";
    for (int i = 0; i < 16; ++i)
        s += "TransformBegin Translate " + std::to_string(i % 4 - 1.5) + " " + std::to_string(i / 4 - 1.5) +
             " 0 Surface \"matte\" Sphere .4 -.4 .4 360 TransformEnd\n";
    return s + "WorldEnd\n";
}

class ProgramLimits : public cli::testing::CommandFolder {
protected:
    double seconds = 0; ///< of the last run
    std::string err;    ///< its messages
    std::string render(const std::string& arguments) { return go("render --progress none " + arguments); }
    std::string go(const std::string& arguments) { return shell("'" ALPENGLOW_PROGRAM "' " + arguments); }
    /// Any shell command, in the folder.
    std::string shell(const std::string& command) {
        const auto begin = std::chrono::steady_clock::now();
        const std::string all = "cd '" + dir.string() + "' && { " + command + "; } 2>err";
        std::string out;
        status = -1;
        if (FILE* p = popen(all.c_str(), "r")) {
            std::array<char, 4096> buffer;
            while (size_t n = fread(buffer.data(), 1, buffer.size(), p)) out.append(buffer.data(), n);
            const int s = pclose(p);
            status = WIFEXITED(s) ? WEXITSTATUS(s) : 128 + WTERMSIG(s);
        }
        seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        err = read("err");
        return out;
    }
    std::string read(const std::string& name) const {
        std::ifstream in(dir / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    bool says(const std::string& text) const { return err.find(text) != std::string::npos; }
    /// Starts a render, interrupts it when it has computed for 1.5 s (a fifth of that compiles the shader) and says how long it
    /// took to end.
    double interrupted(const std::string& arguments) {
        shell("'" ALPENGLOW_PROGRAM "' render --progress none " + arguments + " & p=$!; " + cli::testing::worked("$p", 1.5) +
              " date +%s.%N >t0; kill -TERM $p; wait $p; s=$?; date +%s.%N >t1; exit $s");
        return std::atof(read("t1").c_str()) - std::atof(read("t0").c_str());
    }
};

} // namespace

TEST_F(ProgramLimits, ThreadsAndMemoryThatAreNotThere) {
    if (kSanitized) GTEST_SKIP() << "sanitizers map terabytes";
    write("s.rib", balls());
    render("--threads 2 -o good.png s.rib");
    ASSERT_EQ(status, 0) << err;
    const std::string good = read("good.png"), old = "\x89PNG: the old one";
    bool fewer = false;
    for (int kilobytes : {120000, 200000, 250000, 300000, 500000, 1000000})
        for (int threads : {2, 64}) {
            write("old.png", old);
            shell("ulimit -v " + std::to_string(kilobytes) + "; '" ALPENGLOW_PROGRAM "' render --progress none --threads " +
                  std::to_string(threads) + " -o old.png s.rib");
            if (status == 127) continue; // the dynamic loader had no room
            EXPECT_TRUE(status == 0 || status == 4)
                << status << " with " << kilobytes << " kB, " << threads << " threads: " << err;
            EXPECT_TRUE(read("old.png") == (status == 0 ? good : old)) << kilobytes << " kB, " << threads << " threads";
            fewer |= status == 0 && says("threads can be started");
        }
    EXPECT_TRUE(fewer);
}

TEST_F(ProgramLimits, MemoryWhileShadersAreCompiled) {
    if (kSanitized) GTEST_SKIP() << "sanitizers map terabytes";
    const std::string old = "\x89PNG: the old one";
    for (int kilobytes : {200000, 300000, 400000}) {
        write("own.sl",
              "surface own() { float a = " + std::to_string(kilobytes) + "; Ci = noise(P * a) * diffuse(N); Oi = 1; }\n");
        std::string s = balls();
        for (size_t at; (at = s.find("\"matte\"")) != std::string::npos;) s.replace(at, 7, "\"own\"");
        write("s.rib", s);
        write("old.png", old);
        shell("ulimit -v " + std::to_string(kilobytes) +
              "; ALPENGLOW_CACHE=$PWD/cache '" ALPENGLOW_PROGRAM "' render --progress none --threads 1 -o old.png s.rib");
        if (status == 127) continue;
        EXPECT_TRUE(status == 0 || status == 4) << status << " with " << kilobytes << " kB: " << err;
        EXPECT_TRUE(status == 0 || read("old.png") == old) << kilobytes << " kB";
    }
}

TEST_F(ProgramLimits, MemoryOfOneFrame) {
    if (kSanitized) GTEST_SKIP() << "sanitizers map terabytes";
    // Twelve displaced balls of a billionth of a pixel (5.3 GB before there was a limit).
    write("d.sl", "displacement d() { P += .01 * sin(40 * u) * normalize(N); }\n");
    std::string s = "Projection \"perspective\" \"fov\" 60\nShadingRate 1e-9\nWorldBegin\nTranslate 0 0 6\nDisplacement \"d\"\n";
    for (int i = 0; i < 12; ++i) s += "Translate .1 0 0 Sphere 1 -1 1 360\n";
    write("s.rib", s + "WorldEnd\n");
    write("old.png", "\x89PNG: the old one");
    render("--memory-limit 250M -o old.png s.rib");
    EXPECT_EQ(status, 4) << err;
    EXPECT_TRUE(says("--memory-limit")) << err;
    EXPECT_EQ(read("old.png"), "\x89PNG: the old one");
    // Five million balls in 87 kilobytes.
    shell("{ echo WorldBegin; yes 'Sphere 1 -1 1 360' | head -n 5000000; echo WorldEnd; } | gzip >b.rib");
    ASSERT_LT(fs::file_size(dir / "b.rib"), 300000u);
    render("--memory-limit 200M -o old.png b.rib");
    EXPECT_EQ(status, 4) << err;
    EXPECT_EQ(read("old.png"), "\x89PNG: the old one");
    for (const char* bad : {"0", "4X", "-1G", "much"}) {
        render("--memory-limit '" + std::string(bad) + "' -o a.png s.rib");
        EXPECT_EQ(status, 2) << bad;
    }
}

TEST(MemoryLimit, Sizes) {
    EXPECT_EQ(parseMemorySize("1000"), size_t(1000));
    EXPECT_EQ(parseMemorySize("300000K"), size_t(300000) << 10);
    EXPECT_EQ(parseMemorySize("1.5g"), size_t(3) << 29);
    EXPECT_EQ(parseMemorySize("2MiB"), size_t(2) << 20);
    EXPECT_EQ(parseMemorySize("2MB"), size_t(2) << 20);
    for (const char* bad : {"", "G", "4X", "-1G", "0", "nan", "1e99", "4GG"}) EXPECT_FALSE(parseMemorySize(bad)) << bad;
    EXPECT_EQ(memorySizeText(size_t(3) << 29), "1.5 GiB");
    EXPECT_GT(machineMemory(), size_t(1) << 27);
    EXPECT_LT(defaultMemoryLimit(), machineMemory());
}

TEST_F(ProgramLimits, DisplaysThatAreThrownAway) {
    std::string s = "Format 640 480 1\nPixelSamples 1 1\n";
    for (int i = 0; i < 60; ++i)
        s += "Display \"" + std::string(i ? "+" : "") + "n" + std::to_string(i) + "\" \"null\" \"rgba\"\n";
    write("s.rib", s + "WorldBegin\nWorldEnd\n");
    render("--stats s.json s.rib");
    ASSERT_EQ(status, 0) << err;
    EXPECT_LT(double(nlohmann::json::parse(read("s.json"))["peakMemoryBytes"]), kSanitized ? 8e8 : 2e8); // 5.9e8 more before
}

TEST_F(ProgramLimits, InterruptsWhileDicingAndImaging) {
    const double most = kSanitized ? 2 : .7; // 0.2 s on a machine that does nothing else
    // Ten million noises a point: longer than anyone waits.
    write("d.sl", "displacement d() { float k = 0; while (1) { k += 1; P += noise(k, .5) * 1e-30; } }\n");
    write("d.rib", "WorldBegin\nDisplacement \"d\"\nSphere 1 -1 1 360\nWorldEnd\n");
    EXPECT_LT(interrupted("-o d.png d.rib"), most);
    EXPECT_EQ(status, 130) << err;
    EXPECT_FALSE(fs::exists(dir / "d.png"));
    write("i.sl", "imager i() { float k = 0; while (1) { k += 1; Ci += noise(k, .5) * 1e-30; } }\n");
    write("i.rib", "Format 64 64 1\nImager \"i\"\nWorldBegin\nSphere 1 -1 1 360\nWorldEnd\n");
    for (const char* hider : {"hidden", "path"}) {
        write("i.png", "\x89PNG: the old one");
        EXPECT_LT(interrupted("--spp 1 --hider " + std::string(hider) + " -o i.png i.rib"), most) << hider;
        EXPECT_EQ(status, 130) << err;
        EXPECT_EQ(read("i.png"), "\x89PNG: the old one");
        EXPECT_TRUE(says("imager")) << err;
    }
}

TEST_F(ProgramLimits, OutputsAreTriedBeforeTheFirstRay) {
    write("file", "a file, no folder");
    fs::create_directory(dir / "folder");
    fs::create_directory(dir / "folder.png");
    write("s.rib", balls());
    for (const char* bad : {"-o file/a.png", "-o folder.png", "-o a.png --stats file/s.json", "-o a.png --checkpoint file/c.part",
                            "-o a.png --samples 0:8 --checkpoint folder"}) {
        render("--hider path --spp 100000000 " + std::string(bad) + " s.rib");
        EXPECT_EQ(status, 5) << bad << ": " << err;
        EXPECT_TRUE(says("cannot write")) << err;
        EXPECT_LT(seconds, 30) << bad;
        EXPECT_FALSE(fs::exists(dir / "a.png"));
    }
}

TEST_F(ProgramLimits, NamesThatASceneMayNotWrite) {
    for (const char* name : {".bashrc", ".git/config", "a/.ssh/authorized_keys", "s.rib", "notes.txt"}) {
        write("notes.txt", "mine");
        const std::string scene = balls("Display \"" + std::string(name) + "\" \"tiff\" \"rgba\"\n");
        write("s.rib", scene);
        render("s.rib");
        EXPECT_EQ(status, 5) << name << ": " << err;
        EXPECT_TRUE(says("--allow-write")) << err;
        EXPECT_EQ(read("s.rib"), scene);
        EXPECT_EQ(read("notes.txt"), "mine");
        EXPECT_FALSE(fs::exists(dir / ".bashrc") || fs::exists(dir / ".git") || fs::exists(dir / "a"));
    }
    write("s.rib", balls("Display \".hidden\" \"tiff\" \"rgba\"\n"));
    render("--allow-write s.rib");
    EXPECT_EQ(status, 0) << err;
    EXPECT_TRUE(fs::exists(dir / ".hidden"));
    write("s.rib", balls("Display \"a.tif\" \"tiff\" \"rgba\"\n"));
    for (int i = 0; i < 2; ++i) { // a picture is replaced as ever
        render("s.rib");
        EXPECT_EQ(status, 0) << err;
    }
}

TEST_F(ProgramLimits, CheckpointsOfSomethingElse) {
    write("s.rib", balls());
    const std::string how = "--hider path --checkpoint c.part --resume -o a.png ";
    render(how + "--spp 4 s.rib");
    ASSERT_EQ(status, 0) << err; // there was none
    EXPECT_TRUE(says("note: there is no checkpoint yet; rendering starts from the beginning")) << err;
    EXPECT_FALSE(says("warning")) << err;
    const std::string whole = read("c.part");
    ASSERT_FALSE(whole.empty());
    write("t.rib", balls("Color [1 0 0]\n"));
    const auto refused = [&](const std::string& arguments, const std::string& checkpoint) {
        write("c.part", checkpoint);
        write("a.png", "\x89PNG: the old one");
        render(how + "--spp 8 " + arguments);
        EXPECT_EQ(status, 3) << arguments << ": " << err;
        EXPECT_TRUE(read("c.part") == checkpoint) << arguments;
        EXPECT_EQ(read("a.png"), "\x89PNG: the old one");
    };
    refused("--seed 7 s.rib", whole);
    refused("--format 17x12 s.rib", whole);
    refused("t.rib", whole);
    refused("s.rib", whole.substr(0, whole.size() / 2));
    refused("s.rib", "");
    write("c.part", whole);
    render(how + "--spp 8 s.rib");
    EXPECT_EQ(status, 0) << err;
    // Each frame of several has its own.
    std::string two = balls();
    two = two.substr(two.find("WorldBegin"));
    write("two.rib", "Format 16 12 1\nFrameBegin 1\n" + two + "FrameEnd\nFrameBegin 2\n" + two + "FrameEnd\n");
    for (int spp : {2, 4}) {
        render("--hider path --checkpoint f.part --resume --spp " + std::to_string(spp) + " -o f.png two.rib");
        EXPECT_EQ(status, 0) << err;
    }
    EXPECT_TRUE(fs::exists(dir / "f.0001.part") && fs::exists(dir / "f.0002.part"));
}

TEST_F(ProgramLimits, TemporariesOfKilledRenders) {
    write("s.rib", balls());
    render("-o a.png s.rib");
    ASSERT_EQ(status, 0) << err;
    // A process that ends without destructors.
    const OutputPolicy policy{dir.string()};
    if (const pid_t child = fork(); child == 0) {
        Diagnostics d;
        auto file = OutputFile::open("b.png", policy, d);
        _exit(file ? 0 : 1);
    } else {
        int s = -1;
        ASSERT_EQ(waitpid(child, &s, 0), child);
        ASSERT_EQ(s, 0);
    }
    const auto temporaries = [&] {
        int n = 0;
        for (const auto& e : fs::directory_iterator(dir)) n += e.path().extension() == ".tmp";
        return n;
    };
    ASSERT_EQ(temporaries(), 1);
    Diagnostics d;
    auto mine = OutputFile::open("c.png", policy, d); // of a process that lives
    ASSERT_TRUE(mine);
    EXPECT_EQ(temporaries(), 1);
    write(".alpenglow-1-0.tmp", "of an unknown machine, just now");
    write(".alpenglow-2-0.tmp", "of an unknown machine, long ago");
    fs::last_write_time(dir / ".alpenglow-2-0.tmp", fs::file_time_type::clock::now() - std::chrono::hours(25));
    render("-o a.png s.rib");
    EXPECT_EQ(status, 0) << err;
    EXPECT_TRUE(fs::exists(dir / ".alpenglow-1-0.tmp"));
    EXPECT_FALSE(fs::exists(dir / ".alpenglow-2-0.tmp"));
    EXPECT_EQ(temporaries(), 2);
    EXPECT_TRUE(mine->write("\x89PNG", 4) && mine->commit(d));
}

TEST_F(ProgramLimits, ReadsOutsideTheFolders) {
    const std::string secret = "rootpassword hashed";
    fs::create_directories(dir / "a/b/scene");
    fs::create_directories(dir / "a/b/textures");
    write("a/shadow", secret);
    write("a/b/near", secret);
    write("a/b/near.rib", "Sphere 1 -1 1 360\n");
    write("a/far.rib", "Sphere 1 -1 1 360\n");
    write("p.rib", balls());
    render("-o a/paint.tif p.rib");
    ASSERT_EQ(status, 0) << err;
    const std::string top = dir.string();
    const auto in = [&](const std::string& body, const std::string& options, const std::string& with = "") {
        write("a/b/scene/s.rib", "Format 8 8 1\n" + options + "\nWorldBegin\n" + body + "\nWorldEnd\n");
        shell("cd a/b/scene && '" ALPENGLOW_PROGRAM "' render -q -o s.png " + with + " s.rib");
    };
    const auto hides = [&] {
        EXPECT_TRUE(says("outside")) << err;
        EXPECT_TRUE(status == 1) << status << err;
        for (const char* word : {"rootpassword", "hashed"}) EXPECT_FALSE(says(word)) << err;
    };
    for (const std::string& name : {std::string("../../shadow"), top + "/a/shadow", std::string("../near"), top + "/a/far.rib"}) {
        in("ReadArchive \"" + name + "\"", "");
        hides();
    }
    in("ReadArchive \"shadow\"",
       "Option \"searchpath\" \"archive\" [\"" + top + "/a\"]"); // a folder that the scene names: RIB only
    hides();
    in("ReadArchive \"../near.rib\"", "");
    EXPECT_EQ(status, 0) << err;
    in("ReadArchive \"far.rib\"", "Option \"searchpath\" \"archive\" [\"" + top + "/a\"]");
    EXPECT_EQ(status, 0) << err;
    in("ReadArchive \"" + top + "/a/far.rib\"", "", "--searchpath " + top + "/a");
    EXPECT_EQ(status, 0) << err;
    in("ReadArchive \"" + top + "/a/far.rib\"", "", "--allow-read");
    EXPECT_EQ(status, 0) << err;

    write("a/b/scene/t.sl", "surface t(string name = \"\") { Ci = texture(name); }\n");
    for (const std::string& name : {std::string("../../paint.tif"), top + "/a/paint.tif"}) {
        in("Surface \"t\" \"name\" \"" + name + "\" Sphere 1 -1 1 360", "");
        hides();
        EXPECT_TRUE(says("--searchpath")) << err;
    }
    in("Surface \"t\" \"name\" \"" + top + "/a/paint.tif\" Sphere 1 -1 1 360",
       "Option \"searchpath\" \"texture\" [\"" + top + "/a\"]");
    EXPECT_EQ(status, 0) << err;
    in("Surface \"t\" \"name\" \"" + top + "/a/paint.tif\" Sphere 1 -1 1 360", "", "--allow-read");
    EXPECT_EQ(status, 0) << err;
    fs::copy(dir / "a/paint.tif", dir / "a/b/textures/paint.tif");
    in("Surface \"t\" \"name\" \"../textures/paint.tif\" Sphere 1 -1 1 360", "");
    EXPECT_EQ(status, 0) << err;
    fs::copy(dir / "a/paint.tif", dir / "a/b/scene/paint.tif"); // a path of another machine: its own name, along the search path
    in("Surface \"t\" \"name\" \"/studio/maps/paint.tif\" Sphere 1 -1 1 360", "");
    EXPECT_EQ(status, 0) << err;

    for (const std::string& name : {std::string("../../shadow"), top + "/a/shadow"}) {
        write("a/b/scene/t.sl", "#include \"" + name + "\"\nsurface t() {}\n");
        shell("cd a/b/scene && '" ALPENGLOW_PROGRAM "' compile t.sl");
        EXPECT_EQ(status, 1);
        EXPECT_FALSE(says("rootpassword")) << err;
        EXPECT_TRUE(says("not read")) << err;
    }
    write("a/common.h", "#define HALF .5\n");
    write("a/b/scene/t.sl", "#include \"../../common.h\"\nsurface t() { Ci = HALF; }\n");
    shell("cd a/b/scene && '" ALPENGLOW_PROGRAM "' compile t.sl");
    EXPECT_EQ(status, 0) << err;
}

TEST_F(ProgramLimits, StandardOutputThatIsFull) {
    write("s.rib", balls());
    for (const char* what : {"eval 1", "info matte", "info --shadeops", "render -q --pixel 3,3 s.rib", "--help", "--version"}) {
        go(std::string(what) + " >/dev/full");
        EXPECT_EQ(status, 5) << what << ": " << err;
        EXPECT_TRUE(says("standard output")) << what << ": " << err;
        go(std::string(what));
        EXPECT_EQ(status, 0) << what << ": " << err;
    }
    // A reader of the messages that goes away takes no picture along.
    shell("{ '" ALPENGLOW_PROGRAM "' render -v --progress none -o p.png s.rib; echo $? >status; } 2>&1 | true");
    EXPECT_EQ(read("status"), "0\n");
    EXPECT_TRUE(fs::exists(dir / "p.png"));
    // ulimit -f: a file that may not grow is an output that cannot be written.
    shell("ulimit -f 8; '" ALPENGLOW_PROGRAM "' render -q --format 400x300 -o large.exr s.rib");
    EXPECT_EQ(status, 5) << err;
    EXPECT_FALSE(fs::exists(dir / "large.exr"));
    // So is a map.
    render("--format 400x300 -o large.png s.rib");
    write("make.rib", "MakeTexture \"large.png\" \"large.tx\" \"black\" \"black\" \"box\" 1 1\n");
    shell("ulimit -f 8; '" ALPENGLOW_PROGRAM "' render -q make.rib");
    EXPECT_EQ(status, 5) << err;
    for (const auto& e : fs::directory_iterator(dir)) EXPECT_NE(e.path().extension(), ".tmp") << e.path();
}

TEST_F(ProgramLimits, ControlPointsOfSplines) {
    const auto spline = [](const char* basis, int points) {
        std::string s = std::string("spline(") + basis + "0.5";
        for (int i = 0; i < points; ++i) s += "," + std::to_string(i);
        return s + ")";
    };
    EXPECT_EQ(go("eval '" + spline("", limits::kSplinePoints + 1) + "'"), "");
    EXPECT_EQ(status, 1);
    EXPECT_TRUE(says("control points")) << err;
    go("eval '" + spline("\"solvelinear\", ", limits::kSolvedSplinePoints + 1) + "'");
    EXPECT_EQ(status, 1);
    EXPECT_EQ(go("eval '" + spline("\"linear\", ", 101) + "'"), "50\n")
        << err; // segments between the second point and the last but one
}

} // namespace program_limits_test
