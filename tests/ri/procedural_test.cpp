// Programs that make parts of scenes: run only when asked for, one process a command, bounded in time, depth and breadth.
#include "base/limits.h"
#include "collect.h"
#include "ri/program.h"
#include "scene/motion.h"
#include "scene/scene.h"
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>

namespace procedural_test {

using namespace alpenglow;
using namespace alpenglow::ri;
namespace fs = std::filesystem;

namespace {

class Procedurals : public ::testing::Test {
protected:
    void SetUp() override {
        dir = fs::temp_directory_path() / ("alpenglow_procedurals_" + std::to_string(::getpid()) + "_" +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(dir / "tools");
    }
    void TearDown() override { fs::remove_all(dir); }
    void program(const std::string& name, const std::string& body) {
        std::ofstream(dir / name, std::ios::binary) << "#!/bin/sh\n" + body;
        fs::permissions(dir / name, fs::perms::owner_all);
    }
    std::unique_ptr<Collected> readHere(const std::string& text, bool allow = true, double seconds = 20) {
        std::ofstream(dir / "main.rib", std::ios::binary) << text;
        auto c = std::make_unique<Collected>();
        ReaderOptions o;
        o.allowExec = allow;
        o.programSeconds = seconds;
        RibReader reader(o, *c, c->diagnostics);
        c->ok = reader.readFile((dir / "main.rib").string());
        return c;
    }
    fs::path dir;
};

const std::string bound = " [-1 1 -1 1 -1 1] ";

} // namespace

TEST_F(Procedurals, ArePartsOfTheSceneAtTheirPlace) {
    // The number of the process is the radius: one process answers both, and remembers.
    program("maker",
            "n=0; while read detail data; do n=$((n+1)); echo \"Translate $data $n 0 Sphere $$ -1 1 360\"; printf '\\377'; done");
    auto c = readHere("WorldBegin Color [1 0 0] Translate 0 0 5 Procedural \"RunProgram\" [\"maker\" \"7\"]" + bound +
                      "Sphere 1 -1 1 360 Procedural2 \"RunProgram2\" \"SimpleBound\" \"string command\" \"maker\" \"string "
                      "data\" \"8\" WorldEnd");
    EXPECT_EQ(c->messages(), "");
    ASSERT_EQ(c->frame().primitives.size(), 3u); // in the order of the file
    expectMatrix(c->primitive(0).toWorld.first(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 7, 1, 5, 1});
    expectMatrix(c->primitive(1).toWorld.first(),
                 {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1}); // what the program did to the state is gone
    expectMatrix(c->primitive(2).toWorld.first(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 8, 2, 5, 1});
    EXPECT_EQ(c->primitive(0).numbers[0], c->primitive(2).numbers[0]);
    EXPECT_EQ(c->primitive(0).attributes->color.y, 0);
}

TEST_F(Procedurals, NeedToBeAllowed) {
    program("maker", "touch " + (dir / "ran").string());
    auto c = readHere("WorldBegin Procedural \"RunProgram\" [\"maker\" \"\"]" + bound + "WorldEnd", false);
    EXPECT_NE(c->only().message.find("--allow-exec"), std::string::npos);
    EXPECT_EQ(c->only().severity, Severity::Error); // a request that was not done
    EXPECT_FALSE(fs::exists(dir / "ran"));
}

TEST_F(Procedurals, AreFoundAlongTheirPathAndTakeArguments) {
    program("tools/args", "while read detail data; do echo \"Sphere $# -1 1 360 # $1 $2\"; printf '\\377'; done");
    auto c =
        readHere("Option \"searchpath\" \"procedural\" \"tools\" WorldBegin Procedural \"RunProgram\" [\"args 'a b' c;d\" \"\"]" +
                 bound + "WorldEnd");
    EXPECT_EQ(c->messages(), "");
    EXPECT_EQ(c->primitive().numbers[0], 2);
    c = readHere("WorldBegin Procedural \"RunProgram\" [\"sh\" \"\"]" + bound +
                 "WorldEnd"); // the shell's own path is not looked through
    EXPECT_EQ(c->only().code, Rie::NoFile);
    EXPECT_EQ(commandWords("a  \"b c\"'d' \"\""), (std::vector<std::string>{"a", "b cd", ""}));
}

TEST_F(Procedurals, AreToldHowLargeTheyAre) {
    // A square of side 1 at distance 4 under a field of 90 degrees: 1/4 of 100 pixels for half the width; 25 * 25 / 4... the near
    // face counts.
    program("maker", "while read detail data; do echo \"Sphere 1 -1 1 $detail\"; printf '\\377'; done");
    auto c = readHere("Format 200 200 1 Projection \"perspective\" \"fov\" 90 Translate 0 0 4 WorldBegin "
                      "Procedural \"RunProgram\" [\"maker\" \"\"] [-.5 .5 -.5 .5 0 0] WorldEnd");
    EXPECT_EQ(c->messages(), "");
    EXPECT_NEAR(c->primitive().numbers[3], 25 * 25, 1e-3); // 1 of 8 units of the plane's width, of 200 pixels
}

TEST_F(Procedurals, ThatHangOrFailAreToldAndNotAskedAgain) {
    program("hangs", "read line; echo 'Sphere 1 -1 1 360'; sleep 1000");
    program("ends", "read line; echo 'Sphere 2 -1 1 360'");
    program("deaf", "sleep 1000 < /dev/null");
    const auto begun = std::chrono::steady_clock::now();
    auto c =
        readHere("WorldBegin Procedural \"RunProgram\" [\"hangs\" \"\"]" + bound + "Procedural \"RunProgram\" [\"hangs\" \"\"]" +
                     bound + "Procedural \"RunProgram\" [\"ends\" \"\"]" + bound + "Procedural \"RunProgram\" [\"none\" \"\"]" +
                     bound + "Procedural \"RunProgram\" [\"deaf\" \"\"]" + bound + "Procedural \"RunProgram\" [\"\" \"\"]" +
                     bound + "Sphere 3 -1 1 360 WorldEnd",
                 true, 0.5);
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count(), 15);
    ASSERT_EQ(c->frame().primitives.size(), 3u); // what they said is drawn
    const std::string said = c->messages();
    EXPECT_EQ(c->count(), 5u) << said;
    for (const char* what : {"\"hangs\": it took too long", "\"ends\": it ended before the end of its answer",
                             "\"none\" was not found", "\"deaf\": it took too long", "the program has no name"})
        EXPECT_NE(said.find(what), std::string::npos) << what << "\n" << said;
}

// As a text stream of Python writes '\377'. The program waits for its next line, so that nothing more comes.
TEST_F(Procedurals, ThatEndAnAnswerAsTextAreTold) {
    program("text", "# Surface\nwhile read line; do printf 'Sphere 1 -1 1 360\\nNone\\n\\303\\277'; done");
    const auto begun = std::chrono::steady_clock::now();
    auto c = readHere("WorldBegin Procedural \"RunProgram\" [\"text\" \"\"]" + bound + "WorldEnd");
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count(), 10); // of 20 that it has
    EXPECT_EQ(c->frame().primitives.size(), 1u);
    const std::string said = c->messages();
    EXPECT_EQ(c->count(), 2u) << said;
    EXPECT_NE(said.find("ends with the bytes C3 BF"), std::string::npos) << said;
    EXPECT_NE(said.find("sys.stdout.buffer.write(b'\\xff')"), std::string::npos) << said;
    EXPECT_NE(said.find("output of text:2:1"), std::string::npos) << said; // a fault in what it said, not in its text
}

TEST_F(Procedurals, NestToALimit) {
    program("again", "while read detail data; do echo \"Sphere 1 -1 1 360 Procedural \\\"RunProgram\\\" [\\\"again\\\" "
                     "\\\"x\\\"] [-1 1 -1 1 -1 1]\"; printf '\\377'; done");
    auto c = readHere("WorldBegin Procedural \"RunProgram\" [\"again\" \"\"]" + bound + "WorldEnd");
    EXPECT_EQ(c->only().code, Rie::Limit);
    EXPECT_EQ(c->frame().primitives.size(), size_t(limits::kArchiveDepth));
}

TEST_F(Procedurals, HaveTheirLimits) {
    EXPECT_EQ(ReaderOptions().programSeconds, limits::kProgramSeconds);
    std::string calls = "WorldBegin\n";
    for (int i = 0; i <= limits::kProgramCalls; ++i) calls += "Procedural \"RunProgram\" [\"missing\" \"\"]" + bound + "\n";
    const auto c = readHere(calls + "WorldEnd");
    EXPECT_NE(c->messages().find("more than " + std::to_string(limits::kProgramCalls)), std::string::npos);

    program("talks", "while read line; do i=0; while [ $i -lt 1000 ]; do echo \"# said before\"; i=$((i+1)); done; done");
    std::string why, answer;
    const auto talks = Program::start({(dir / "talks").string()}, why);
    ASSERT_NE(talks, nullptr) << why;
    EXPECT_FALSE(talks->ask("1\n", 20, nullptr, answer, why, 4096));
    EXPECT_EQ(why, "its answer is too long");
    EXPECT_GT(limits::kProgramBytes, size_t(1) << 30); // what ask() takes by itself
}

// DynamicLoad: the libraries of tests/ri/procedurals.
namespace {

std::string library(const std::string& data, const std::string& name = ALPENGLOW_PROCEDURALS "/facets.so") {
    return "Procedural \"DynamicLoad\" [\"" + name + "\" \"" + data + "\"]" + bound;
}

const scene::Param& variable(const scene::Primitive& p, const std::string& name) {
    static const scene::Param none;
    const scene::Param* v = scene::find(p.params, name);
    EXPECT_NE(v, nullptr) << name;
    return v ? *v : none;
}

} // namespace

TEST_F(Procedurals, OfLibrariesArePartsOfTheSceneAtTheirPlace) {
    auto c = readHere(
        "Format 200 200 1 Projection \"perspective\" \"fov\" 90 Translate 0 0 4 WorldBegin Color [1 0 0] Translate 0 0 0 "
        "Procedural \"DynamicLoad\" [\"" ALPENGLOW_PROCEDURALS "/facets\" \"detail\"] [-.5 .5 -.5 .5 0 0] "
        "Sphere 5 -1 1 360 " +
        library("halves 2") + " WorldEnd");
    EXPECT_EQ(c->messages(), "");
    ASSERT_EQ(c->frame().primitives.size(), 6u);
    EXPECT_NEAR(c->primitive(0).numbers[3], 25 * 25, 1e-3); // as AreToldHowLargeTheyAre
    EXPECT_EQ(c->primitive(0).attributes->color.y, 0);
    EXPECT_EQ(c->primitive(1).numbers[0], 5);
    // Halves of 2: at 2 and 4 halves of 1, each with balls of a half at 1 and 2 behind.
    const double x[] = {3, 4, 5, 6};
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(c->primitive(2 + i).numbers[0], 0.5f);
        EXPECT_EQ(c->primitive(2 + i).toWorld.first().m[3][0], x[i]);
    }
}

TEST_F(Procedurals, OfLibrariesHaveVariablesOfEveryClass) {
    auto c = readHere("WorldBegin " + library("variables") + " WorldEnd");
    EXPECT_EQ(c->messages(), "");
    ASSERT_EQ(c->frame().primitives.size(), 1u);
    const scene::Primitive& p = c->primitive();
    EXPECT_EQ(p.ints, (std::vector<int>{4, 4}));
    EXPECT_EQ(p.ints2, (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7}));
    EXPECT_EQ(variable(p, "P").numbers.size(), 24u);
    EXPECT_EQ(variable(p, "Cs").numbers, (std::vector<float>{1, 0, 0, 0, 1, 0}));
    EXPECT_EQ(variable(p, "kinds").numbers, (std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8}));
    EXPECT_EQ(variable(p, "kinds").cls, scene::Class::FaceVarying);
    EXPECT_EQ(variable(p, "weight").numbers, (std::vector<float>{9}));
    EXPECT_EQ(variable(p, "label").strings, (std::vector<std::string>{"box"}));
}

TEST_F(Procedurals, OfLibrariesSetStateForThemselves) {
    auto c = readHere("WorldBegin Translate 10 0 0 " + library("state") + " Sphere 4 -1 1 360 WorldEnd");
    EXPECT_EQ(c->messages(), "");
    const scene::Frame& f = c->frame();
    ASSERT_EQ(f.primitives.size(), 3u);
    ASSERT_EQ(f.instances.size(), 1u);
    ASSERT_EQ(f.lights.size(), 1u);
    EXPECT_EQ(f.lights[0].shader->name, "pointlight");
    EXPECT_EQ(variable(scene::Primitive{.params = f.lights[0].shader->params}, "intensity").numbers[0], 3);
    const scene::Attributes& a = *c->primitive(0).attributes;
    EXPECT_EQ(a.color.y, 0);
    EXPECT_EQ(a.surface->name, "matte");
    EXPECT_EQ(a.surface->params[0].numbers[0], 0.25f);
    EXPECT_EQ(a.value("displacementbound:sphere")->numbers[0], 0.5f);
    EXPECT_EQ(a.value("dice:hair")->numbers[0], 1);
    EXPECT_EQ(a.ubasis.name, "b-spline");
    EXPECT_EQ(a.vbasis.name, "bezier");
    // (1, 2, 3) of "here" is (11, 2, 4) of the world; the motion block moves by it from 10, 0, 1.
    const Matrix begin = scene::at(c->primitive(0).toWorld, 0), close = scene::at(c->primitive(0).toWorld, 1);
    expectMatrix(begin, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 21, 2, 5, 1});
    expectMatrix(close, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 10, 0, 1, 1});
    EXPECT_EQ(c->primitive(1).attributes->color.y, 1);
    EXPECT_EQ(c->primitive(1).numbers[0], 3);
    EXPECT_EQ(c->primitive(2).numbers[0], 4);
    expectMatrix(c->primitive(2).toWorld.first(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 10, 0, 0, 1});
}

TEST_F(Procedurals, OfLibrariesReadArchivesAndAreFreed) {
    std::ofstream(dir / "ball.rib") << "Sphere 6 -1 1 360";
    auto c = readHere("WorldBegin " + library("archive") + library("count") + library("count") + " WorldEnd");
    EXPECT_EQ(c->messages(), "");
    ASSERT_EQ(c->frame().primitives.size(), 3u);
    EXPECT_EQ(c->primitive(0).numbers[0], 6);
    // Loaded once, asked for each, freed after each.
    EXPECT_EQ(c->primitive(2).numbers[0], c->primitive(1).numbers[0] + 1);
    EXPECT_EQ(c->primitive(2).numbers[3], c->primitive(1).numbers[3] + 1);
}

TEST_F(Procedurals, OfLibrariesThatAreWrongAreToldAtTheirPlace) {
    auto c = readHere("WorldBegin\n" + library("mistakes") + "\nSphere 1 -1 1 360\nWorldEnd");
    ASSERT_EQ(c->frame().primitives.size(), 2u);
    EXPECT_EQ(c->primitive(0).kind, "Polygon");
    const std::string said = c->messages();
    for (const char* what : {"RiPointsPolygons, called by a library: a count is negative",
                             "RiPointsPolygons, called by a library: an argument is a null pointer",
                             "RiPolygon, called by a library: an argument is a null pointer",
                             "RiSurface, called by a library: an argument is a null pointer", "\"unheard\" is not declared",
                             "RiColor, called by a library: an argument is a null pointer", "before the AttributeBegin"})
        EXPECT_NE(said.find(what), std::string::npos) << what << "\n" << said;
    for (const Diagnostic& d : c->diagnostics.all()) EXPECT_EQ(d.place.line, 2) << toString(d);
    EXPECT_EQ(c->count(), 7u) << said;
}

TEST_F(Procedurals, OfLibrariesNeedToBeAllowedAndThere) {
    const std::string text = library("detail");
    auto c = readHere("WorldBegin " + text + "WorldEnd", false);
    EXPECT_NE(c->only().message.find("--allow-exec"), std::string::npos);
    EXPECT_EQ(c->frame().primitives.size(), 0u);

    c = readHere("WorldBegin " + library("", "nowhere") + library("", "nowhere") + " Sphere 1 -1 1 360 WorldEnd");
    EXPECT_EQ(c->only().code, Rie::NoFile);
    EXPECT_NE(c->only().message.find("library \"nowhere\" of procedurals was not found"), std::string::npos);
    EXPECT_EQ(c->frame().primitives.size(), 1u);

    c = readHere("Option \"searchpath\" \"procedural\" \"" ALPENGLOW_PROCEDURALS "\" WorldBegin " + library("", "hollow") +
                 "WorldEnd");
    EXPECT_NE(c->only().message.find("it does not define Subdivide, Free"), std::string::npos) << c->messages();
    c = readHere("WorldBegin " + library("", ALPENGLOW_PROCEDURALS "/stranger_calls.so") + "WorldEnd");
    EXPECT_NE(c->only().message.find("RiNotThere"), std::string::npos) << c->messages();
    std::ofstream(dir / "text.so") << "no library";
    c = readHere("WorldBegin " + library("", "text") + "WorldEnd");
    EXPECT_NE(c->only().message.find("it cannot be loaded"), std::string::npos) << c->messages();
}

TEST_F(Procedurals, OfLibrariesNestToALimit) {
    auto c = readHere("WorldBegin " + library("forever") + " Sphere 1 -1 1 360 WorldEnd");
    EXPECT_EQ(c->only().code, Rie::Limit);
    EXPECT_EQ(c->frame().primitives.size(), 1u);
    c = readHere("WorldBegin MotionBegin [0 1] " + library("detail") + " MotionEnd WorldEnd");
    EXPECT_NE(c->messages().find("motion block"), std::string::npos);
}

TEST_F(Procedurals, OutsideThePictureAreNotExpandedWhereOnlyTheCameraCouldSeeThem) {
    std::ofstream(dir / "ball.rib") << "Sphere 1 -1 1 360";
    const std::string camera = "Format 100 100 1 Projection \"perspective\" \"fov\" 90 ", box = " [-1 1 -1 1 -1 1] ",
                      alone = "Attribute \"visibility\" \"int diffuse\" 0 \"int specular\" 0 \"int transmission\" 0 ";
    const auto drawn = [&](const std::string& options, const std::string& inside) {
        auto c = readHere(camera + options + " WorldBegin " + inside + " Procedural \"DelayedReadArchive\" [\"ball.rib\"]" + box +
                          (inside.find("SolidBegin") != std::string::npos ? "SolidEnd WorldEnd" : "WorldEnd"));
        EXPECT_EQ(c->messages(), "") << options << inside;
        return c->frame().primitives.size();
    };
    // At z = 5 the picture is from -5 to 5, and 4 pixels more on all sides: the box of 1 is half seen, just seen, and not seen.
    EXPECT_EQ(drawn("", alone + "Translate 5 0 5"), 1u);
    EXPECT_EQ(drawn("", alone + "Translate 6.9 0 5"), 1u); // its far side is nearer to the middle: 5.9 / 6
    EXPECT_EQ(drawn("", alone + "Translate 8 0 5"), 0u);
    EXPECT_EQ(drawn("", alone + "Translate 0 -8 5"), 0u);
    EXPECT_EQ(drawn("", alone + "Translate 0 0 -2"), 0u); // behind
    EXPECT_EQ(drawn("", alone + "Translate 0 0 -.5"), 1u);
    EXPECT_EQ(drawn("ScreenWindow -2 2 -2 2", alone + "Translate 8 0 5"), 1u);
    EXPECT_EQ(drawn("Projection \"orthographic\"", alone + "Translate 5 0 5"), 0u);
    // Who else could meet it, or what reaches out of its box.
    const std::string away = " Translate 8 0 5 ";
    EXPECT_EQ(drawn("", away), 1u);
    EXPECT_EQ(drawn("", "Attribute \"cull\" \"int hidden\" 1" + away), 0u);
    EXPECT_EQ(drawn("", "Attribute \"cull\" \"int hidden\" 0 " + alone + away), 1u);
    EXPECT_EQ(drawn("", alone + "Attribute \"visibility\" \"int transmission\" 1" + away), 1u);
    for (const char* hider : {"path", "raytrace"}) EXPECT_EQ(drawn("Hider \"" + std::string(hider) + "\"", alone + away), 1u);
    EXPECT_EQ(drawn("DepthOfField 2 1 5", alone + away), 1u);
    EXPECT_EQ(drawn("", alone + "Displacement \"bumpy\"" + away), 1u);
    EXPECT_EQ(drawn("", alone + "AreaLightSource \"arealight\" 1" + away), 1u);
    EXPECT_EQ(drawn("", alone + "MotionBegin [0 1] Translate 8 0 5 Translate 0 0 5 MotionEnd"), 1u);
    EXPECT_EQ(drawn("", alone + "SolidBegin \"primitive\"" + away), 1u);
}

TEST_F(Procedurals, EndWhenNobodyReadsThem) {
    // We ignore SIGPIPE, as the program does, and what is ignored is inherited.
    const auto before = std::signal(SIGPIPE, SIG_IGN);
    program("maker", "read line; grep SigIgn /proc/self/status >'" + (dir / "signals").string() +
                         "'; echo Sphere 1 -1 1 360; printf '\\377'");
    auto c = readHere("WorldBegin Procedural \"RunProgram\" [\"maker\" \"\"]" + bound + "WorldEnd");
    std::signal(SIGPIPE, before);
    EXPECT_EQ(c->messages(), "");
    std::ifstream in(dir / "signals");
    std::string word, mask;
    ASSERT_TRUE(in >> word >> mask);
    EXPECT_EQ(std::stoull(mask, nullptr, 16) >> (SIGPIPE - 1) & 1, 0u) << mask;
}

} // namespace procedural_test
