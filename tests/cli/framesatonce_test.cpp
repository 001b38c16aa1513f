// render --frames-at-once: what comes out is what comes of frames that are drawn one after the other, to the bit and in the same
// order.
#include "command_folder.h"
#include "render/limits.h"
#include <map>
#include <nlohmann/json.hpp>
#include <regex>

namespace framesatonce_test {

namespace fs = std::filesystem;
namespace limits = alpenglow::limits;

namespace {

/// Of one run: what there is to compare.
struct Made {
    int status = -1;
    std::string out, err;
    std::map<std::string, std::string> files; ///< by name, but for those that were there before
    nlohmann::json stats;
};

class FramesAtOnce : public alpenglow::cli::testing::CommandFolder {
protected:
    std::string read(const fs::path& file) const {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    /// One thread, so that each frame has as many whatever N is: batches are counted. What is measured is taken out.
    Made render(int n, const std::string& arguments) {
        std::map<std::string, fs::file_time_type> before;
        for (const auto& e : fs::directory_iterator(dir)) before[e.path().filename()] = e.last_write_time();
        Made m;
        m.out = run("render -v --progress none --threads 1 --stats stats.json --frames-at-once " + std::to_string(n) + " " +
                        arguments,
                    "2>err");
        m.status = status;
        m.err = std::regex_replace(read(dir / "err"), std::regex("\n  (time|before|rays|memory) [^\n]*"), "");
        if (fs::exists(dir / "stats.json")) m.stats = nlohmann::json::parse(read(dir / "stats.json"));
        const auto still = [](nlohmann::json& j) {
            for (const char* key : {"renderSec", "cpuSec", "raysPerMS", "efficiency", "peakMemoryBytes", "threadBytes",
                                    "parseSec", "compileSec", "buildSec", "command", "date", "host"})
                j.erase(key);
        };
        still(m.stats);
        for (nlohmann::json& f : m.stats["frames"]) still(f);
        for (const auto& e : fs::directory_iterator(dir)) {
            const std::string name = e.path().filename();
            if (before.contains(name) || name == "err" || name == "stats.json") continue;
            m.files[name] = read(e.path());
            fs::remove(e.path());
        }
        return m;
    }
    /// The same for 2, 3 and 4 frames at once; returns what one by one gives.
    Made sameForAll(const std::string& arguments) {
        render(1, arguments); // kernels are in the cache from here on
        Made one = render(1, arguments);
        for (const int n : {2, 3, 4}) {
            SCOPED_TRACE(n);
            const Made m = render(n, arguments);
            EXPECT_EQ(m.status, one.status) << m.err;
            EXPECT_EQ(m.out, one.out);
            EXPECT_EQ(m.err, one.err);
            EXPECT_EQ(m.files, one.files) << m.files.size() << " files, not " << one.files.size();
            EXPECT_EQ(m.stats, one.stats);
        }
        return one;
    }
    /// `count` frames; body(k) is what stands in the k-th, behind its Format and Projection.
    template <class Body> void scene(int count, Body body) const {
        std::string s;
        for (int k = 1; k <= count; ++k)
            s += "FrameBegin " + std::to_string(k) + "\nFormat 24 18 1 PixelSamples 2 2 Projection \"perspective\" \"fov\" 40\n" +
                 body(k) + "FrameEnd\n";
        write("a.rib", s);
    }
    static std::string ball(int k, const std::string& surface) {
        return "WorldBegin Translate " + std::to_string(.1 * k) + " 0 5\nLightSource \"distantlight\" 1\n" + surface +
               "\nSphere 1 -1 1 360\nWorldEnd\n";
    }
};

std::string number(int k) { return std::to_string(k); }

// A shadow map that is made for the third frame and the later ones, a frame that cannot be written, one whose shader is not
// there, what shaders print, and what is reported once.
TEST_F(FramesAtOnce, PicturesMessagesAndFiguresAreThoseOfOneByOne) {
    write("says.sl", "surface says(float k = 0) { if (mod(k, 2) == 0) printf(\"frame %f\\n\", k);\n"
                     "Ci = Cs * diffuse(faceforward(normalize(N), I)); Oi = 1; }");
    scene(6, [](int k) {
        const std::string light =
            "LightSource \"shadowspot\" 2 \"intensity\" 40 \"from\" [0 3 2] \"to\" [0 0 5] \"string shadowname\" "
            "\"s.shd\"\n";
        return (k == 3 ? "Display \"s.z\" \"zfile\" \"z\" WorldBegin Translate 0 0 5 Sphere .5 -.5 .5 360 WorldEnd\n"
                         "MakeShadow \"s.z\" \"s.shd\"\n"
                       : std::string()) +
               (k == 5 ? "Display \"/nowhere/p.tif\" \"tiff\" \"rgb\"\n"
                       : "Display \"p." + number(k) + ".tif\" \"tiff\" \"rgb\"\n") +
               "Whatever " + number(k) + "\n" +
               ball(k, (k >= 3 ? light : "") + (k == 2 ? "Surface \"missing\"" : "Surface \"says\" \"float k\" " + number(k)));
    });
    const Made one = sameForAll("a.rib");
    EXPECT_EQ(one.status, 5) << one.err;
    EXPECT_EQ(one.files.size(), 7u); // five pictures and both shadow maps
    EXPECT_NE(one.out.find("frame 4"), std::string::npos);
    EXPECT_LT(one.err.find("missing"), one.err.find("/nowhere")) << one.err;
    EXPECT_EQ(one.stats["frames"].size(), 6u);
}

// Figures of the guides are handed over, too.
TEST_F(FramesAtOnce, FiguresOfGuides) {
    scene(2, [](int) {
        return std::string(
            "Hider \"path\" Translate 0 -.5 4 Rotate -20 1 0 0 WorldBegin Sides 2\nAttributeBegin AreaLightSource \"slrect\" 1 "
            "\"float intensity\" 5 Surface \"constant\" Color 0 0 0 Polygon \"P\" [-.3 2 -.3 .3 2 -.3 .3 2 .3 -.3 2 .3] "
            "AttributeEnd\nIlluminate 1 1 AttributeBegin Surface \"slmaterial\" \"color diffusecolor\" [0 0 0] \"color "
            "transmissive\" [1 1 1] "
            "\"float kn\" 1.5 Translate 0 1 0 Sphere .6 -.6 .6 360 AttributeEnd\nSurface \"matte\" Polygon \"P\" [-3 0 -3 -3 0 3 "
            "3 0 3 3 0 -3] WorldEnd\n");
    });
    const Made one = sameForAll("--spp 2 a.rib");
    EXPECT_EQ(one.status, 0) << one.err;
    EXPECT_GT(one.stats["guide"]["rays"], 10) << one.stats["guide"];
}

TEST_F(FramesAtOnce, StandardOutputHasOnePictureBehindTheOther) {
    scene(5, [](int k) { return ball(k, "Surface \"plastic\""); });
    const Made one = sameForAll("-o - a.rib");
    EXPECT_EQ(one.status, 0) << one.err;
    size_t pictures = 0;
    for (size_t at = 0; (at = one.out.find("\x89PNG", at)) != std::string::npos; ++at) ++pictures;
    EXPECT_EQ(pictures, 5u);
    EXPECT_TRUE(one.files.empty());
}

// The first picture gets its number once a second comes; --pixel prints; options of the path hider go to each frame.
TEST_F(FramesAtOnce, NamesAndOptionsMeanTheSame) {
    scene(4, [](int k) { return ball(k, "Surface \"matte\""); });
    const Made named = sameForAll("-o p.exr --hider path --spp 2 --samples 0:1 a.rib");
    EXPECT_EQ(named.status, 0) << named.err;
    EXPECT_EQ(named.files.size(), 8u); // a picture and a part file each
    EXPECT_TRUE(named.files.contains("p.0001.exr"));
    EXPECT_EQ(sameForAll("--pixel 12,9 a.rib").files.size(), 0u);
    EXPECT_EQ(sameForAll("--frames 2-3,9 -o q.png a.rib").files.size(), 2u);
}

// Names that are put together while a shader runs cannot be seen in the scene.
TEST_F(FramesAtOnce, AFrameWaitsForThePictureThatItReads) {
    write("shows.sl",
          "surface shows(float k = 1) { Oi = 1;\n"
          "if (k > 1) Ci = .1 + .5 * color texture(concat(\"p.\", format(\"%f\", k - 1), \".tif\"), s, t); else Ci = 1; }");
    scene(5, [](int k) {
        return "Display \"p." + number(k) + ".000000.tif\" \"tiff\" \"rgb\" Hider \"hidden\" \"int jitter\" 0\n" +
               ball(k, "Surface \"shows\" \"float k\" " + number(k));
    });
    const Made one = sameForAll("a.rib");
    EXPECT_EQ(one.status, 0) << one.err;
    EXPECT_EQ(one.files.size(), 5u);
}

// Each frame bakes into a cloud that has the name of all others, and reads that of the frame before.
TEST_F(FramesAtOnce, AFrameWaitsForWhatAnotherBakes) {
    write("bakes.sl", "surface bakes(float k = 1) { color was = 0; float there = 0; normal n = normalize(N); Oi = 1;\n"
                      "if (k > 1) there = texture3d(\"c.ptc\", P, n, \"what\", was);\n"
                      "Ci = .2 + .5 * was + .1 * there; bake3d(\"c.ptc\", \"what\", P, n, \"what\", Ci * (1 + .1 * k)); }");
    scene(4, [](int k) {
        return "Display \"p." + number(k) + ".tif\" \"tiff\" \"rgb\"\n" + ball(0, "Surface \"bakes\" \"float k\" " + number(k));
    });
    const Made one = sameForAll("a.rib");
    EXPECT_EQ(one.files.size(), 5u) << one.err;
}

// Each frame makes its shadow map under the same name.
TEST_F(FramesAtOnce, MapsThatAreMadeAnewAreThoseOfTheirFrame) {
    scene(4, [](int k) {
        return "Display \"s.z\" \"zfile\" \"z\" " + ball(2 * k, "Surface \"matte\"") + "MakeShadow \"s.z\" \"s.shd\"\n" +
               "Display \"p." + number(k) + ".tif\" \"tiff\" \"rgb\"\n" +
               ball(k, "LightSource \"shadowspot\" 2 \"intensity\" 40 \"from\" [0 0 -5] \"to\" [0 0 5] \"string shadowname\" "
                       "\"s.shd\" Surface \"matte\"");
    });
    const Made one = sameForAll("a.rib");
    EXPECT_EQ(one.status, 0) << one.err;
    EXPECT_EQ(one.files.size(), 6u);
}

// A procedural that waits for a ray is read in the process that draws; its program is started there.
TEST_F(FramesAtOnce, ProgramsThatMakeContentAreAsked) {
    write("shows.sl", "surface shows() { Ci = .1 + .8 * trace(P, reflect(normalize(I), normalize(N))); Oi = 1; }");
    write("ball.sh", "#!/bin/sh\nwhile read detail size; do echo \"Sphere $size -$size $size 360\"; printf '\\377'; done\n");
    fs::permissions(dir / "ball.sh", fs::perms::owner_all);
    scene(4, [](int k) {
        return "Display \"p." + number(k) +
               ".tif\" \"tiff\" \"rgb\" Hider \"raytrace\" WorldBegin Surface \"shows\" Attribute "
               "\"visibility\" \"int trace\" 1\nAttributeBegin Translate 0 0 4 Polygon \"P\" [-2 -2 0 -2 2 0 2 2 .8 2 -2 .8] "
               "AttributeEnd Surface \"constant\" Color [.8 .4 .2]\nTranslate 0 .4 3 Procedural \"RunProgram\" [\"ball.sh\" "
               "\".2\"] "
               "[-.3 .3 -.3 .3 -.3 .3]\nTranslate 0 0 -7 Procedural \"RunProgram\" [\"ball.sh\" \"." +
               number(k) + "\"] [-1 1 -1 1 -1 1] WorldEnd\n";
    });
    const Made one = sameForAll("--allow-exec a.rib");
    EXPECT_EQ(one.status, 0) << one.err;
    EXPECT_NE(one.err.find("of 1 procedurals outside of the picture 1 were made"), std::string::npos) << one.err;
}

/// A scene whose first frame is drawn at once, and whose others would take minutes.
const char* const kSlow = R"(
surface slow(float k = 0) { float i, x = 0; if (k > 1) for (i = 0; i < 1e7; i += 1) x += sin(i * u); Ci = x; Oi = 1; })";

TEST_F(FramesAtOnce, CtrlCEndsAllAndKeepsWhatIsDone) {
    write("slow.sl", kSlow);
    scene(6, [](int k) {
        return "Display \"p." + number(k) + ".tif\" \"tiff\" \"rgb\"\n" + ball(k, "Surface \"slow\" \"float k\" " + number(k));
    });
    write("go.sh", "\"$1\" render -q --threads 3 --frames-at-once 3 a.rib 2>err & p=$!\n"
                   "i=0; while [ ! -f p.1.tif ] && [ $i -lt 600 ]; do sleep .05; i=$((i + 1)); done\n"
                   "i=0; while [ $(ps -o pid= --ppid $p | wc -l) -lt 3 ] && [ $i -lt 600 ]; do sleep .05; i=$((i + 1)); done\n"
                   "c=$(ps -o pid= --ppid $p); echo $c | wc -w; kill -INT $p; wait $p; echo $?\n"
                   "for q in $c; do kill -0 $q 2>/dev/null && echo $q is left; done; ls p.1.tif p.6.tif 2>/dev/null\n");
    std::string out;
    FILE* pipe = popen(("cd '" + dir.string() + "' && sh go.sh '" ALPENGLOW_PROGRAM "'").c_str(), "r");
    ASSERT_NE(pipe, nullptr);
    for (char buffer[256]; fgets(buffer, sizeof buffer, pipe);) out += buffer;
    pclose(pipe);
    EXPECT_EQ(out, "3\n130\np.1.tif\n") << read(dir / "err");
}

// A process that is gone takes its frame along, and no other.
TEST_F(FramesAtOnce, AProcessThatIsKilledIsOneFrameLess) {
    write("slow.sl", "surface slow(float k = 0) { float i, x = 0; if (k == 2) for (i = 0; i < 1e7; i += 1) x += sin(i * u);\n"
                     "Ci = x; Oi = 1; }");
    scene(4, [](int k) {
        return "Display \"p." + number(k) + ".tif\" \"tiff\" \"rgb\"\n" + ball(k, "Surface \"slow\" \"float k\" " + number(k));
    });
    write("go.sh", "\"$1\" render --progress none --threads 2 --frames-at-once 2 a.rib 2>err & p=$!\n"
                   "i=0; while [ ! -f p.4.tif ] && [ $i -lt 600 ]; do sleep .05; i=$((i + 1)); done\n"
                   "kill -KILL $(ps -o pid= --ppid $p); wait $p; echo $?; ls p.?.tif\n");
    std::string out;
    FILE* pipe = popen(("cd '" + dir.string() + "' && sh go.sh '" ALPENGLOW_PROGRAM "'").c_str(), "r");
    ASSERT_NE(pipe, nullptr);
    for (char buffer[256]; fgets(buffer, sizeof buffer, pipe);) out += buffer;
    pclose(pipe);
    EXPECT_EQ(out, "1\np.1.tif\np.3.tif\np.4.tif\n");
    EXPECT_NE(read(dir / "err").find("error: frame 2 is given up: its process ended by signal 9 (Killed)"), std::string::npos)
        << read(dir / "err");
}

// Each frame has its part of the memory, and says so.
TEST_F(FramesAtOnce, MemoryIsShared) {
    scene(2, [](int k) {
        return "Format 8000 8000 1 Hider \"path\" PixelSamples 1 1\n" + ball(k, "Surface \"matte\""); // 16 GB of sums
    });
    EXPECT_EQ(render(2, "--memory-limit 600M -o p.exr a.rib").status, 4);
    EXPECT_NE(read(dir / "err").find("the limit is 300 MiB for each of 2 frames at once"), std::string::npos)
        << read(dir / "err");
}

TEST_F(FramesAtOnce, BadValuesAreWrongUse) {
    scene(1, [](int k) { return ball(k, ""); });
    for (const std::string& value : {std::string("0"), std::string("-1"), std::string("2.5"), std::string("many"),
                                     std::to_string(limits::kFramesAtOnce + 1)}) {
        run("render --frames-at-once " + value + " a.rib", "2>err");
        EXPECT_EQ(status, 2) << value;
        EXPECT_NE(read(dir / "err").find("--frames-at-once"), std::string::npos) << read(dir / "err");
    }
    for (const char* other : {"--watch", "--preview=blocks", "--display tev:localhost:14158"}) {
        run(std::string("render --frames-at-once 2 a.rib ") + other, "2>err");
        EXPECT_EQ(status, 2) << other;
        EXPECT_NE(read(dir / "err").find("does not go with"), std::string::npos) << read(dir / "err");
    }
    run("render -q --frames-at-once " + std::to_string(limits::kFramesAtOnce) + " -o p.png a.rib", "2>err");
    EXPECT_EQ(status, 0) << read(dir / "err");
}

} // namespace

} // namespace framesatonce_test
