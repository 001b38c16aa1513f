// The program as a user runs it: exit statuses, files, what is on standard output, and that the same picture has the same bits.
#include "command_folder.h"
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>

namespace program_test {

namespace fs = std::filesystem;

namespace {

struct Result {
    int status = -1;
    std::string out;
};

class Program : public testing::Test {
protected:
    fs::path dir;
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "alpenglow-cli-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        dir = name;
    }
    void TearDown() override { fs::remove_all(dir); }

    /// Runs the program in the folder; standard error goes to the file "err".
    Result run(const std::string& arguments, const std::string& input = "") const {
        std::string command = "cd '" + dir.string() + "' || exit 99; ";
        if (!input.empty()) {
            write("input", input);
            command += "cat input | ";
        }
        command += std::string("'") + ALPENGLOW_PROGRAM + "' " + arguments + " 2>err";
        Result r;
        FILE* p = popen(command.c_str(), "r");
        if (!p) return r;
        std::array<char, 4096> buffer;
        while (size_t n = fread(buffer.data(), 1, buffer.size(), p)) r.out.append(buffer.data(), n);
        int s = pclose(p);
        r.status = WIFEXITED(s) ? WEXITSTATUS(s) : 128 + WTERMSIG(s);
        return r;
    }
    void write(const std::string& name, const std::string& text) const { std::ofstream(dir / name, std::ios::binary) << text; }
    std::string read(const std::string& name) const {
        std::ifstream in(dir / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    bool has(const std::string& name) const { return fs::exists(dir / name); }
};

const char* const kSphere = R"(
Format 40 30 1
Projection "perspective" "fov" 40
LightSource "distantlight" 1 "from" [0 0 0] "to" [0 0 1]
WorldBegin
Translate 0 0 5
Surface "matte"
Sphere 1 -1 1 360
WorldEnd
)";

/// A small box with a lamp: indirect light, a mirror, every kind of random number.
const char* const kRoom = R"(
Format 32 24 1
PixelFilter "gaussian" 2 2
Projection "perspective" "fov" 60
Hider "path"
WorldBegin
AttributeBegin
AreaLightSource "slrect" "lamp" "float intensity" 5
Polygon "P" [-0.5 0.99 3.5  -0.5 0.99 2.5  0.5 0.99 2.5  0.5 0.99 3.5]
AttributeEnd
Surface "matte" "Kd" 0.7
Polygon "P" [-1 -1 2  1 -1 2  1 -1 4  -1 -1 4]
Polygon "P" [-1 -1 4  1 -1 4  1 1 4  -1 1 4]
Polygon "P" [-1 1 2  -1 1 4  1 1 4  1 1 2]
Surface "slmaterial" "color diffusecolor" [0 0 0] "color specularcolor" [0.9 0.9 0.9]
Translate 0 -0.6 3.2
Sphere 0.4 -0.4 0.4 360
WorldEnd
)";

} // namespace

TEST_F(Program, HelpVersionAndWrongUse) {
    Result help = run("--help");
    EXPECT_EQ(help.status, 0);
    for (const char* c : {"render", "eval", "shade", "compile", "info", "probe", "maketx", "diff", "merge"})
        EXPECT_NE(help.out.find(c), std::string::npos) << c;
    for (const char* c : {"render", "eval", "shade", "compile", "info", "probe", "maketx", "diff", "merge"}) {
        Result r = run(std::string(c) + " --help");
        EXPECT_EQ(r.status, 0) << c;
        EXPECT_GT(r.out.size(), 200u) << c;
    }
    EXPECT_EQ(run("--version").out.rfind("alpenglow ", 0), 0u);
    EXPECT_EQ(run("</dev/null").status, 2);
    EXPECT_EQ(run("render </dev/null").status, 2);
    EXPECT_EQ(run("probe s.rib 0,0,0").status, 2);
    EXPECT_NE(read("err").find("probe: normal is required\nSee alpenglow help probe for more."), std::string::npos)
        << read("err");
    EXPECT_EQ(run("render --no-such-option a.rib").status, 2);
    for (const char* bad : {"--format 64", "--format 0x4", "--crop 1,0,0,1", "--samples 4:2", "--pixel a,b", "--frames 3-1",
                            "--spp 0", "--lanes 5", "--hider zebra", "--display foo", "--resume", "--progress loud"}) {
        write("s.rib", kSphere);
        EXPECT_EQ(run(std::string("render ") + bad + " s.rib").status, 2) << bad;
    }
    EXPECT_FALSE(has("ri.pic"));
}

TEST_F(Program, PlainSceneWritesRiPic) {
    write("s.rib", kSphere);
    Result r = run("s.rib");
    EXPECT_EQ(r.status, 0) << read("err");
    EXPECT_EQ(r.out, "");
    EXPECT_TRUE(has("ri.pic"));
    std::string magic = read("ri.pic").substr(0, 4);
    EXPECT_TRUE(magic == std::string("II*\0", 4) || magic == std::string("MM\0*", 4)); // TIFF
}

TEST_F(Program, ExtensionsAndStandardInput) {
    EXPECT_EQ(run("render -q -o a.png -", kSphere).status, 0) << read("err");
    EXPECT_EQ(read("a.png").substr(1, 3), "PNG");
    EXPECT_EQ(read("err"), "");
    // Other renderers read it where no file is named: prman < a.rib, renderdl -t 1 < a.rib.
    std::filesystem::create_symlink(ALPENGLOW_PROGRAM, dir / "prman");
    for (const char* options : {"", " -t:1", " --threads 1"}) {
        write("in.rib", std::string("Display \"b.png\" \"png\" \"rgb\"\n") + kSphere);
        std::filesystem::remove(dir / "b.png");
        ASSERT_EQ(std::system(("cd '" + dir.string() + "' && ./prman" + options + " < in.rib 2>err").c_str()), 0) << read("err");
        EXPECT_TRUE(has("b.png")) << options;
    }
    write("s.rib", kSphere);
    EXPECT_EQ(run("render -q -o sub/a.exr --format 8x6 s.rib").status, 0);
    EXPECT_EQ(read("sub/a.exr").substr(0, 4), "\x76\x2f\x31\x01");
    EXPECT_FALSE(has("ri.pic"));
    EXPECT_EQ(run("render -q --display png:more.png s.rib").status, 0);
    EXPECT_TRUE(has("more.png"));
}

TEST_F(Program, Statuses) {
    write("s.rib", kSphere);
    write("bad.rib", std::string("Blorp 1 2\n") + kSphere);
    write("empty.rib", "Format 4 4 1\n");
    EXPECT_EQ(run("render -q -o a.exr bad.rib").status, 1);
    EXPECT_TRUE(has("a.exr")); // the rest is rendered
    EXPECT_NE(read("err").find("bad.rib:1"), std::string::npos);
    EXPECT_EQ(run("render -q -o b.exr none.rib").status, 3);
    EXPECT_EQ(run("render -q -o b.exr empty.rib").status, 3);
    EXPECT_EQ(run("render -q -o /proc/none/x.exr s.rib").status, 5);
    EXPECT_EQ(run("render -q --stats /proc/none/x.json -o b.exr s.rib").status, 5);
}

TEST_F(Program, ForeignPathsNeedPermission) {
    fs::create_directory(dir / "in");
    write("in/s.rib", std::string("Display \"") + (dir / "out.exr").string() + "\" \"openexr\" \"rgba\"\n" + kSphere);
    write("in/abs.rib", std::string("Display \"") + (dir / "in/sub/abs.exr").string() + "\" \"openexr\" \"rgba\"\n" + kSphere);
    Result r;
    fs::path top = dir;
    dir = top / "in";
    r = run("render -q s.rib");
    EXPECT_EQ(r.status, 5);
    EXPECT_NE(read("err").find("--allow-write"), std::string::npos) << read("err");
    EXPECT_EQ(run("render -q abs.rib").status, 0) << read("err"); // an absolute name below the current folder
    dir = top;
    EXPECT_FALSE(has("out.exr") || has("in/out.exr"));
    EXPECT_TRUE(has("in/sub/abs.exr"));
    dir = top / "in";
    r = run("render -q --allow-write s.rib");
    dir = top;
    EXPECT_EQ(r.status, 0);
    EXPECT_TRUE(has("out.exr"));
}

TEST_F(Program, StatsHaveTheFixedKeys) {
    write("r.rib", kRoom);
    ASSERT_EQ(run("render -q --spp 16 -o a.exr --stats s.json r.rib").status, 0) << read("err");
    auto j = nlohmann::json::parse(read("s.json"));
    for (const char* key : {"width",           "height",      "spp",      "renderSec",   "cpuSec",     "raysPerMS", "noiseRSE",
                            "noise",           "noiseAtMost", "coverage", "noiseRSE999", "efficiency", "noiseQMC",  "threads",
                            "peakMemoryBytes", "threadBytes", "parseSec", "compileSec",  "buildSec",   "nonFinite", "rays",
                            "shading",         "depth",       "errors",   "warnings"})
        EXPECT_TRUE(j.contains(key)) << key;
    for (const char* key : {"camera", "diffuse", "specular", "transmission", "shadow"})
        EXPECT_TRUE(j["rays"].contains(key)) << key;
    for (const char* key : {"points", "batches", "laneOccupancy", "affineKernels", "suspendingKernels", "kernels", "cacheHits"})
        EXPECT_TRUE(j["shading"].contains(key)) << key;
    EXPECT_EQ(j["width"], 32);
    EXPECT_EQ(j["spp"], 16);
    EXPECT_EQ(j["rays"]["camera"], 32 * 24 * 16);
    EXPECT_EQ(j["nonFinite"], 0);
    EXPECT_GT(double(j["noiseRSE"]), 0);
}

TEST_F(Program, SameBitsForThreadsLanesAndParts) {
    write("r.rib", kRoom);
    ASSERT_EQ(run("render -q --spp 15 -o whole.exr --threads 1 r.rib").status, 0) << read("err");
    std::string whole = read("whole.exr");
    ASSERT_FALSE(whole.empty());
    for (const char* how : {"--threads 2", "--threads 3", "--lanes 8", "--lanes 4"}) {
        EXPECT_EQ(run(std::string("render -q --spp 15 -o a.exr ") + how + " r.rib").status, 0);
        EXPECT_TRUE(read("a.exr") == whole) << how;
    }
    const char* ranges[] = {"0:1", "1:3", "3:4", "4:8", "8:11", "11:13", "13:15"};
    for (int k = 0; k < 7; ++k)
        ASSERT_EQ(run("render -q --samples " + std::string(ranges[k]) + " -o p" + std::to_string(k) + ".exr r.rib").status, 0);
    for (const char* order :
         {"p0.exr p1.exr p2.exr p3.exr p4.exr p5.exr p6.exr", "p6.exr p2.exr p4.exr p0.exr p5.exr p3.exr p1.exr"}) {
        EXPECT_EQ(run(std::string("merge ") + order + " -o m.exr").status, 0) << read("err");
        EXPECT_TRUE(read("m.exr") == whole) << order;
    }
    EXPECT_EQ(run("merge p0.exr p0.exr -o n.exr").status, 3);
    EXPECT_EQ(run("merge nothing.exr -o n.exr").status, 3);
    ASSERT_EQ(run("render -q --spp 15 --seed 1 -o other.exr r.rib").status, 0);
    EXPECT_FALSE(read("other.exr") == whole);
    EXPECT_EQ(run("diff whole.exr m.exr").status, 0);
    EXPECT_EQ(run("diff whole.exr other.exr").status, 1);
    EXPECT_EQ(run("diff whole.exr other.exr --tolerance 100 -o d.exr").status, 0);
    EXPECT_TRUE(has("d.exr"));
    EXPECT_EQ(run("diff whole.exr none.exr").status, 3);
}

// An imager with a co-shader, a space of the scene, an attribute, an option, and the shader found along a path of the scene:
// merging runs it as the whole render did, wherever the scene is by then.
TEST_F(Program, MergingRunsTheImager) {
    fs::create_directory(dir / "far");
    write("far/grade.sl", "class grade(color by = color(1, 2, 4);) { public void tone(output color c) { c *= by; } }\n");
    write("far/finish.sl", R"(imager finish(float gain = 1; string map = "";) {
    shader g = getshader("look");
    float lens = 0, format[3] = {0, 0, 0}; string name = "";
    float found = attribute("user:lens", lens) + option("Format", format) + option("user:stock", name);
    color c = Ci * gain;
    g->tone(c);
    Ci = found == 3 && name == "fast" ? c + color(P / format[0]) * lens : color(-1, 0, 0);
    Oi = 1;
    alpha = comp(transform("stage", point(0, 0, 0)), 0);
}
)");
    std::string scene = kRoom;
    const std::string head = "Option \"searchpath\" \"string shader\" [\"far\"]\nOption \"user\" \"string stock\" "
                             "[\"fast\"]\nAttribute \"user\" \"uniform float lens\" 3\n"
                             "TransformBegin\nTranslate 5 0 0\nCoordinateSystem \"stage\"\nTransformEnd\nShader \"grade\" "
                             "\"look\" \"color by\" [2 3 5]\nImager \"finish\" \"gain\" .5\n";
    scene.insert(scene.find("WorldBegin"), head);
    write("r.rib", scene);
    ASSERT_EQ(run("render -q --spp 6 -o whole.exr r.rib").status, 0) << read("err");
    ASSERT_EQ(run("render -q --samples 0:4 -o p0.exr r.rib").status, 0) << read("err");
    ASSERT_EQ(run("render -q --samples 4:6 -o p1.exr r.rib").status, 0) << read("err");
    fs::remove(dir / "r.rib");
    fs::create_directory(dir / "other");
    for (const char* part : {"p0.exr.part", "p1.exr.part"}) fs::copy(dir / part, dir / "other");
    EXPECT_EQ(run("merge p1.exr p0.exr -o m.exr").status, 0) << read("err");
    EXPECT_TRUE(read("m.exr") == read("whole.exr"));
    EXPECT_EQ(run("merge other/p0.exr other/p1.exr -o m2.exr").status, 0) << read("err");
    EXPECT_TRUE(read("m2.exr") == read("whole.exr"));
    // A shader that is gone: the picture without it, and an error that says so; elsewhere it is found again.
    fs::rename(dir / "far", dir / "near");
    EXPECT_EQ(run("merge p0.exr p1.exr -o m3.exr").status, 1);
    EXPECT_NE(read("err").find("finish"), std::string::npos) << read("err");
    EXPECT_TRUE(has("m3.exr"));
    EXPECT_EQ(run("merge --searchpath near p0.exr p1.exr -o m4.exr").status, 0) << read("err");
    EXPECT_TRUE(read("m4.exr") == read("whole.exr"));
}

TEST_F(Program, CheckpointAndResume) {
    write("r.rib", kRoom);
    ASSERT_EQ(run("render -q --spp 12 -o whole.exr r.rib").status, 0);
    ASSERT_EQ(run("render -q --spp 5 --checkpoint c.part -o a.exr r.rib").status, 0);
    ASSERT_EQ(run("render -q --spp 12 --checkpoint c.part --resume -o b.exr r.rib").status, 0) << read("err");
    EXPECT_TRUE(read("b.exr") == read("whole.exr"));
}

/// A sphere in the light of a wide lamp behind the camera; of the picture only the square that ends `border` of it from each
/// edge.
static std::string sphereBefore(const std::string& fov, int side, double border = 0) {
    const std::string n = std::to_string(side), from = std::to_string(border) + " ", to = std::to_string(1 - border) + " ";
    return "Format " + n + " " + n + " 1\nCropWindow " + from + to + from + to + "\nProjection \"perspective\" \"fov\" " + fov +
           R"(
Hider "path"
WorldBegin
Translate 0 0 6
AttributeBegin
Translate 0 9 -14
AreaLightSource "arealight" "lamp" "float intensity" 2
Sphere 7 -7 7 360
AttributeEnd
Illuminate "lamp" 1
Surface "matte"
Sphere 1 -1 1 360
WorldEnd
)";
}

TEST_F(Program, NoiseStopsWhenItIsReached) {
    write("r.rib", kRoom);
    ASSERT_EQ(run("render -q --noise 0.2 -o a.exr --stats s.json r.rib").status, 0) << read("err");
    auto j = nlohmann::json::parse(read("s.json"));
    EXPECT_LE(double(j["noise"]), 0.2);
    EXPECT_GE(int(j["spp"]), 16);
    // It is the figure that is printed, and the only one; and not reached one look earlier.
    write("r.rib", sphereBefore("24", 60));
    ASSERT_EQ(run("render --progress none --noise 0.011 -o a.exr --stats s.json r.rib").status, 0) << read("err");
    j = nlohmann::json::parse(read("s.json"));
    char text[80];
    std::snprintf(text, sizeof text, "  noise        %.5f: ", double(j["noise"]));
    EXPECT_NE(read("err").find(text), std::string::npos) << read("err");
    EXPECT_EQ(read("err").find("noiseQMC"), std::string::npos);
    EXPECT_LE(double(j["noiseAtMost"]), 0.011);
    EXPECT_LE(double(j["noise"]), double(j["noiseAtMost"])); // which is near it, since a thousand pixels are judged
    EXPECT_GE(double(j["noise"]), double(j["noiseAtMost"]) / 1.08);
    const int spp = j["spp"], before = spp - 8; // looked at every eight up to 128
    ASSERT_GT(spp, 16);
    ASSERT_LE(spp, 128);
    ASSERT_EQ(run("render -q --spp " + std::to_string(before) + " -o a.exr --stats s.json r.rib").status, 0);
    EXPECT_GT(double(nlohmann::json::parse(read("s.json"))["noiseAtMost"]), 0.011);
}

// One sphere, seen by four lenses; by the mean over all pixels the figure would fall to a hundredth. Its light, from a wide lamp
// behind the camera, is nearly as noisy at every point. A pixel that holds more of the sphere's shading has more noise, because
// its samples do not share that out together with the lamp's points (a sphere of 18 pixels shows a quarter more, which is true):
// here each sphere is 50 to 60 pixels wide, and the tolerance is a tenth. Most of what is empty is cropped; four fifths and more
// of the last two pictures stay so.
TEST_F(Program, NoiseDoesNotDependOnWhereTheObjectIs) {
    std::vector<double> noise;
    struct View {
        const char* fov;
        int side;
        double border;
    };
    for (const auto& [fov, side, border] : {View{"24", 75, 0}, {"45", 150, .2}, {"90", 300, .3}, {"140", 900, .4}}) {
        write("s.rib", sphereBefore(fov, side, border));
        ASSERT_EQ(run("render -q --spp 16 -o s.exr --stats s.json s.rib").status, 0) << read("err");
        auto j = nlohmann::json::parse(read("s.json"));
        noise.push_back(j["noise"]);
        EXPECT_NEAR(noise.back() / noise.front(), 1, 0.1) << "fov " << fov;
        EXPECT_LT(double(j["coverage"]), 0.6);
    }
}

TEST_F(Program, HiddenSaysNothingOfNoise) {
    write("s.rib", kSphere);
    for (const char* hider : {"hidden", "raytrace"}) {
        ASSERT_EQ(run(std::string("render --progress none --hider ") + hider + " -o s.exr s.rib").status, 0) << read("err");
        EXPECT_EQ(read("err").find("noise"), std::string::npos) << read("err");
    }
}

TEST_F(Program, InterruptKeepsWhatIsWhole) {
    write("r.rib", kRoom);
    Result r = run("render -q --spp 100000000 --threads 2 -o a.exr r.rib & p=$!; " + alpenglow::cli::testing::worked("$p", 1.5) +
                   " kill -INT $p; wait $p");
    EXPECT_EQ(r.status, 130);
    EXPECT_TRUE(has("a.exr"));
    // A shader that does not end (ten million noises a point) is left within a moment.
    write("w.sl", "surface w() { float i = 0, k = 0; while (i < 1) { k += 1; i = .5 * noise(k, i); } Ci = i; }\n");
    std::string scene = kSphere;
    scene.replace(scene.find("\"matte\""), 7, "\"w\"");
    write("w.rib", scene);
    r = run("render -q -o w.exr w.rib & p=$!; " + alpenglow::cli::testing::worked("$p", 1.5) +
            " kill -INT $p; a=$(date +%s%N); wait $p; s=$?; b=$(date +%s%N); echo $(( (b - a) / 1000000 )); exit $s");
    EXPECT_EQ(r.status, 130);
    EXPECT_LT(std::atoi(r.out.c_str()), 2000) << "milliseconds; generous, because tests share the machine";
}

TEST_F(Program, FramesPixelAndPreset) {
    std::string scene;
    for (int k = 1; k <= 3; ++k)
        scene += "FrameBegin " + std::to_string(k) + "\nDisplay \"f" + std::to_string(k) + ".png\" \"png\" \"rgb\"\n" + kSphere +
                 "FrameEnd\n";
    write("f.rib", scene);
    EXPECT_EQ(run("render -q --frames 2-3 f.rib").status, 0) << read("err");
    EXPECT_FALSE(has("f1.png"));
    EXPECT_TRUE(has("f2.png"));
    EXPECT_TRUE(has("f3.png"));
    write("s.rib", kSphere);
    // The sphere faces the eye and the light: matte, Kd 1, light 1, so radiance 1 at its middle; outside nothing.
    Result r = run("render -q --pixel 20,15 s.rib");
    float c[4] = {};
    ASSERT_EQ(std::sscanf(r.out.c_str(), "%f %f %f %f", &c[0], &c[1], &c[2], &c[3]), 4) << r.out;
    EXPECT_NEAR(c[0], 1, 0.02);
    EXPECT_EQ(c[3], 1);
    EXPECT_EQ(run("render -q --pixel 0,0 s.rib").out, "0 0 0 0\n");
    EXPECT_FALSE(has("ri.pic"));
    EXPECT_EQ(run("render -q --preset slproject --spp 2 --format 8x6 s.rib").status, 0) << read("err");
    EXPECT_TRUE(has("Pathtraced_2_0.png"));
    EXPECT_EQ(run("render -q --rib 'Display \"r.png\" \"png\" \"rgb\"' s.rib").status, 0);
    EXPECT_TRUE(has("r.png"));
}

TEST_F(Program, Eval) {
    EXPECT_EQ(run("eval '1 + 2 * 3'").out, "7\n");
    EXPECT_EQ(run("eval 'color (1, .5, 0) * 2'").out, "2 1 0\n");
    EXPECT_EQ(run("eval --setup 'float x = 4;' 'sqrt(x)'").out, "2\n");
    EXPECT_EQ(run("eval 'concat(\"a\", \"b\")'").out, "ab\n");
    EXPECT_EQ(run("eval 'u + t'").out, "1\n");
    Result r = run("eval 'sqr(2)'");
    EXPECT_EQ(r.status, 1);
    EXPECT_EQ(r.out, "");
    EXPECT_NE(read("err").find("error"), std::string::npos);
}

TEST_F(Program, CompileAndInfo) {
    write("good.sl", "surface good(float Kd = 0.5; string name = \"x\";) { Ci = Kd * Cs * diffuse(normalize(N)); Oi = Os; }\n");
    write("bad.sl", "surface bad() {\n    Ci = nois(P);\n}\n");
    EXPECT_EQ(run("compile good.sl").status, 0) << read("err");
    EXPECT_EQ(run("compile good.sl bad.sl").status, 1);
    EXPECT_NE(read("err").find("bad.sl:2:10"), std::string::npos) << read("err");
    EXPECT_NE(run("compile --dump-ir good.sl").out.find("good"), std::string::npos);
    Result r = run("info --json good.sl");
    EXPECT_EQ(r.status, 0);
    auto j = nlohmann::json::parse(r.out);
    EXPECT_EQ(j["name"], "good");
    EXPECT_EQ(j["type"], "surface");
    EXPECT_EQ(j["parameters"][0]["name"], "Kd");
    EXPECT_EQ(j["parameters"][0]["default"][0], 0.5);
    EXPECT_EQ(j["parameters"][1]["default"][0], "x");
    EXPECT_EQ(j["affine"], true);
    EXPECT_NE(run("info --shadeops noise").out.find("float noise"), std::string::npos);
    EXPECT_EQ(run("info --shadeops nois").status, 1);
    EXPECT_NE(read("err").find("noise"), std::string::npos);
    EXPECT_GT(run("info --shadeops").out.size(), 1000u);
    EXPECT_EQ(run("info").status, 2);
}

TEST_F(Program, ShadeAPatch) {
    write("g.sl", "surface g(float k = 1; color c = 0;) { Ci = color (u, v, k) + c; Oi = 1; }\n");
    Result r = run("shade --patch g.sl -o g.exr --format 8x4 --param k=3 --param c=1,0,0 --iterations 3");
    EXPECT_EQ(r.status, 0) << read("err");
    EXPECT_NE(r.out.find("ns a point"), std::string::npos);
    EXPECT_TRUE(has("g.exr"));
    EXPECT_EQ(run("shade --patch g.sl --param nosuch=3").status, 2);
    EXPECT_EQ(run("shade none.sl").status, 3);
    EXPECT_EQ(run("shade --patch g.sl -o a.exr --format 8x4").status, 0);
    EXPECT_EQ(run("shade --patch g.sl -o b.exr --format 8x4 --param k=1.25").status, 0);
    // Blue differs by 0.25 everywhere, nothing else does: the largest error is that.
    EXPECT_EQ(run("diff a.exr b.exr --tolerance 0.2500001").status, 0);
    EXPECT_EQ(run("diff a.exr b.exr --tolerance 0.2499999").status, 1);
}

TEST_F(Program, ProbeUnderADistantLight) {
    // Light of 2 (irradiance / pi) at 60 degrees: a white point sends back 2 cos 60 = 1, without noise.
    write("d.rib", "Projection \"perspective\" \"fov\" 40\nTranslate 0 0 5\nWorldBegin\n"
                   "LightSource \"distantlight\" 1 \"intensity\" 2 \"from\" [0 0 0] \"to\" [0.8660254 -0.5 0]\n"
                   "Surface \"matte\"\nPolygon \"P\" [-9 0 -9  9 0 -9  9 0 9  -9 0 9]\nWorldEnd\n");
    Result r = run("probe d.rib 0,0,0 0,1,0 --spp 64");
    EXPECT_EQ(r.status, 0) << read("err");
    float v[6];
    ASSERT_EQ(std::sscanf(r.out.c_str(), "%f %f %f %f %f %f", &v[0], &v[1], &v[2], &v[3], &v[4], &v[5]), 6) << r.out;
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(v[k], 1, 1e-4);
        EXPECT_NEAR(v[3 + k], 0, 1e-4);
    }
    // From the other side the sheet is in the way of nothing, and the light does not arrive.
    r = run("probe d.rib 0,0,0 0,-1,0 --spp 16");
    EXPECT_EQ(r.out.rfind("0 0 0 ", 0), 0u) << r.out;
    EXPECT_EQ(run("probe d.rib 0,0 0,1,0").status, 2);
    EXPECT_EQ(run("probe none.rib 0,0,0 0,1,0").status, 3);
}

TEST_F(Program, MaketxTakesOldAndNewSpelling) {
    write("s.rib", kSphere);
    ASSERT_EQ(run("render -q -o a.png s.rib").status, 0);
    EXPECT_EQ(run("maketx -mode periodic a.png a.tx").status, 0) << read("err");
    EXPECT_TRUE(has("a.tx"));
    EXPECT_EQ(run("maketx --envlatl a.png b.tx").status, 0) << read("err");
    EXPECT_EQ(run("maketx -envcube a.png b.tx").status, 2);
    EXPECT_EQ(run("maketx none.png c.tx").status, 3);
}

} // namespace program_test
