// ReadArchive, inline archives, DelayedReadArchive, search paths (RISpec 3.2, 7.3).
#include "../sanitized.h"
#include "base/limits.h"
#include "collect.h"
#include "ri/interpreter.h"
#include "scene/scene.h"
#include <ctime>
#include <filesystem>
#include <fstream>

namespace archive_test {

using namespace alpenglow;
using namespace alpenglow::ri;
namespace fs = std::filesystem;

class Archives : public ::testing::Test {
protected:
    void SetUp() override {
        dir = fs::temp_directory_path() / ("alpenglow_ri_" + std::to_string(::getpid()) + "_" +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(dir / "sub");
    }
    void TearDown() override { fs::remove_all(dir); }
    void write(const std::string& name, const std::string& text) { std::ofstream(dir / name, std::ios::binary) << text; }
    std::unique_ptr<Collected> readHere(const std::string& text) {
        write("main.rib", text);
        auto c = std::make_unique<Collected>();
        RibReader reader({}, *c, c->diagnostics);
        c->ok = reader.readFile((dir / "main.rib").string());
        return c;
    }
    fs::path dir;
};

TEST_F(Archives, AreFoundBesideTheFileAndAlongThePath) {
    write("part.rib", "Sphere 1 -1 1 360\n");
    write("sub/deep.rib", "Sphere 2 -2 2 360");
    auto c = readHere("WorldBegin ReadArchive \"part.rib\" ReadArchive \"sub/deep.rib\" WorldEnd");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    EXPECT_EQ(c->frame().primitives.size(), 2u);
    EXPECT_EQ(c->primitive(0).place.file, (dir / "part.rib").string());
    EXPECT_EQ(c->primitive(0).place.line, 1);
    auto d = readHere("Option \"searchpath\" \"archive\" \"/nowhere:" + (dir / "sub").string() +
                      "\" WorldBegin ReadArchive \"deep.rib\" WorldEnd");
    EXPECT_EQ(d->frame().primitives.size(), 1u) << d->messages();
}

TEST_F(Archives, NamesFromOtherMachines) {
    write("sub/Part.rib", "Sphere 1 -1 1 360");
    for (const char* name : {"sub\\\\Part.rib", "C:\\\\scenes\\\\x\\\\Part.rib", "/other/machine/Part.rib", "part.RIB"}) {
        auto c = readHere("Option \"searchpath\" \"archive\" \"" + (dir / "sub").string() + "\" WorldBegin ReadArchive \"" +
                          name + "\" WorldEnd");
        EXPECT_EQ(c->frame().primitives.size(), 1u) << name << c->messages();
        EXPECT_EQ(c->only().severity, Severity::Warning) << name;
    }
    auto c = readHere("ReadArchive \"missing.rib\"");
    EXPECT_EQ(c->only().code, Rie::NoFile);
    EXPECT_NE(c->only().hint.find(dir.string()), std::string::npos);
    EXPECT_EQ(readHere("ReadArchive \"\"")->only().code, Rie::NoFile);
    EXPECT_EQ(readHere("ReadArchive \"sub\"")->only().code, Rie::NoFile);
}

TEST_F(Archives, CyclesAndDepth) {
    write("a.rib", "ReadArchive \"b.rib\"");
    write("b.rib", "ReadArchive \"a.rib\"");
    EXPECT_EQ(readHere("ReadArchive \"a.rib\"")->only().code, Rie::Nesting);
    std::string chain;
    for (int i = 0; i < limits::kArchiveDepth + 5; ++i)
        chain += "ArchiveBegin \"n" + std::to_string(i) + "\" ReadArchive \"n" + std::to_string(i + 1) + "\" ArchiveEnd\n";
    EXPECT_EQ(readHere(chain + "ReadArchive \"n0\"")->only().code, Rie::Limit);
}

TEST_F(Archives, MustBeBalanced) {
    write("open.rib", "AttributeBegin Color 1 0 0");
    write("close.rib", "AttributeEnd");
    auto c = readHere(
        "WorldBegin ReadArchive \"open.rib\"\nSphere 1 -1 1 360 AttributeBegin ReadArchive \"close.rib\" AttributeEnd WorldEnd");
    ASSERT_EQ(c->count(), 2u) << c->messages();
    EXPECT_EQ(c->first().code, Rie::Nesting);
    EXPECT_EQ(c->diagnostics.all()[1].code, Rie::Nesting);
    EXPECT_EQ(c->primitive().attributes->color, Color(1, 1, 1));
    write("if.rib", "IfBegin \"0\"");
    EXPECT_EQ(readHere("WorldBegin ReadArchive \"if.rib\" Sphere 1 -1 1 360 WorldEnd")->frame().primitives.size(), 1u);
}

TEST_F(Archives, MayHoldTheSamplesOfAMotionBlock) {
    write("a.rib", "Sphere 1 -1 1 360");
    write("b.rib", "Sphere 2 -2 2 360");
    auto c = readHere("WorldBegin MotionBegin [0 1] ReadArchive \"a.rib\" ReadArchive \"b.rib\" MotionEnd WorldEnd");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    EXPECT_EQ(c->primitive().motionKeys.size(), 1u);
}

TEST_F(Archives, Delayed) {
    write("d.rib", "Color 1 0 0 Sphere 1 -1 1 360");
    auto c = readHere("WorldBegin Procedural \"DelayedReadArchive\" [\"d.rib\"] [-1 1 -1 1 -1 1] Sphere 1 -1 1 360 WorldEnd");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    EXPECT_EQ(c->primitive(0).attributes->color, Color(1, 0, 0));
    EXPECT_EQ(c->primitive(1).attributes->color, Color(1, 1, 1));
}

TEST_F(Archives, ADelayedOneThatIsMissingIsSaidOnce) {
    write("d.rib", "Sphere 1 -1 1 360");
    const std::string missing = "Procedural \"DelayedReadArchive\" [\"lost.rib\"] [-1 1 -1 1 -1 1]\n";
    auto c = readHere("WorldBegin\n" + missing + "Sphere 1 -1 1 360\nWorldEnd");
    EXPECT_EQ(c->only().code, Rie::NoFile) << c->messages();
    EXPECT_EQ(c->frame().primitives.size(), 1u);
    // Also where others may be instances of what was read.
    auto d = readHere("WorldBegin\nProcedural \"DelayedReadArchive\" [\"d.rib\"] [-1 1 -1 1 -1 1]\n" + missing + "WorldEnd");
    EXPECT_EQ(d->only().code, Rie::NoFile) << d->messages();
}

TEST(InlineArchives, AreRecordedNotExecuted) {
    auto c = read("ArchiveBegin \"ball\" Sphere 1 -1 1 360 ArchiveBegin \"inner\" ArchiveEnd ArchiveEnd WorldBegin ReadArchive "
                  "\"ball\" Translate 1 0 0 ReadArchive \"ball\" WorldEnd");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    ASSERT_EQ(c->frame().primitives.size(), 2u);
    EXPECT_EQ(c->primitive(1).toWorld.first(), translateMatrix(1, 0, 0));
    EXPECT_EQ(read("ArchiveBegin \"x\" ReadArchive \"x\" ArchiveEnd ReadArchive \"x\"")->only().code, Rie::Nesting);
    EXPECT_EQ(read("ArchiveBegin \"x\" Sphere 1 -1 1 360")->only().code, Rie::Nesting);
}

TEST(SearchPath, Splits) {
    using V = std::vector<std::string>;
    EXPECT_EQ(splitSearchPath("a:b;c::d"), (V{"a", "b", "c", "d"}));
    EXPECT_EQ(splitSearchPath("C:/x:D:\\y;e"), (V{"C:/x", "D:\\y", "e"}));
    EXPECT_EQ(splitSearchPath(""), V{});
}

TEST(Files, ThatCannotBeRead) {
    Collected c;
    RibReader reader({}, c, c.diagnostics);
    EXPECT_FALSE(reader.readFile("/nonexistent/x.rib"));
    EXPECT_EQ(c.only().code, Rie::NoFile);
    Collected d;
    RibReader second({}, d, d.diagnostics);
    EXPECT_FALSE(second.readFile("/"));
    EXPECT_EQ(d.only().code, Rie::NoFile);
}

// RIBMosaic and its like name folders from where the scene lies; the renderer may be started anywhere.
TEST_F(Archives, FoldersOfTheSearchPathLieBesideTheScene) {
    write("sub/deep.rib", "Sphere 2 -2 2 360 ReadArchive \"other.rib\"");
    fs::create_directories(dir / "more");
    write("more/other.rib", "Sphere 1 -1 1 360");
    auto c = readHere("Option \"searchpath\" \"string archive\" [\"@:.:sub:more\"] WorldBegin ReadArchive \"deep.rib\" WorldEnd");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    EXPECT_EQ(c->frame().primitives.size(), 2u);
    auto d = readHere("Option \"searchpath\" \"archive\" [\"sub\" \"more\"] WorldBegin ReadArchive \"deep.rib\" WorldEnd");
    EXPECT_EQ(d->count(), 0u) << d->messages();
    EXPECT_EQ(d->frame().primitives.size(), 2u);
}

TEST_F(Archives, SearchPathsKnowTheEnvironment) {
    write("sub/deep.rib", "Sphere 2 -2 2 360");
    ::setenv("ALPENGLOW_TEST_MODELS", (dir / "sub").c_str(), 1);
    for (const char* path :
         {"$ALPENGLOW_TEST_MODELS", "&:${ALPENGLOW_TEST_MODELS}/.", "$ALPENGLOW_TEST_ABSENT:$ALPENGLOW_TEST_MODELS"}) {
        auto c = readHere("Option \"searchpath\" \"archive\" [\"" + std::string(path) +
                          "\"] WorldBegin ReadArchive \"deep.rib\" WorldEnd");
        EXPECT_EQ(c->count(), 0u) << path << c->messages();
        EXPECT_EQ(c->frame().primitives.size(), 1u) << path;
    }
    ::unsetenv("ALPENGLOW_TEST_MODELS");
    // What the environment lacks, and what is no name, stays as it is.
    auto path = [](const std::string& p) {
        auto c = read("Option \"searchpath\" \"texture\" [\"" + p + "\"] WorldBegin WorldEnd");
        return c->frame().options.values.at("searchpath:texture").strings.at(0);
    };
    for (const char* p : {"$ALPENGLOW_TEST_ABSENT/x", "a$", "${", "${}", "a~b", "~other/x", "${ALPENGLOW_TEST_ABSENT}y"})
        EXPECT_EQ(path(p), p);
    ::setenv("HOME", "/home/somebody", 1);
    EXPECT_EQ(path("~:~/tx;x~"), "/home/somebody:/home/somebody/tx;x~");
}

// Archives that the scene names are parsed ahead, several at a time; those of Procedural2 are not. Both draw and say the same, in
// order.
TEST_F(Archives, ParsedAheadAreTheSame) {
    const int count = 40;
    for (int i = 0; i < count; ++i) {
        std::string text = "# an archive\nColor [1 0 0]\n";
        for (int k = 0; k < 50; ++k) text += "Sphere " + std::to_string(100 * i + k + 1) + " -1 1 360\nTranslate 1 0 0\n";
        if (i % 7 == 1) text += "Sphere 1 -1 \n";          // said while it is parsed
        if (i % 7 == 2) text += "Polygon \"P\" [0 0 0]\n"; // said while it is executed
        if (i % 7 == 3) text += "AttributeBegin\n";        // said when it ends
        if (i % 7 == 4) text += "ReadArchive \"a0.rib\"\nIfBegin \"1\"\n";
        if (i % 7 == 5) text += "Polygon \"P\" [0 0 0";                   // ends in the middle
        if (i % 7 == 6) text += std::string("Sphere 7 -1 1 360 \x93 \n"); // binary
        write("a" + std::to_string(i) + ".rib", text);
    }
    const auto scene = [&](bool ahead) {
        std::string text = "WorldBegin\n";
        for (int i = 0; i < 2 * count; ++i) {
            const std::string name = "\"a" + std::to_string(i * 3 % count) + ".rib\"";
            if (i % 5 == 0) text += "IfBegin \"0\"\n"; // passed over
            text += ahead ? "Procedural \"DelayedReadArchive\" [ " + name + "] [-1 1 -1 1 -1 1]\n"
                          : "Procedural2 \"DelayedReadArchive2\" \"SimpleBound\" \"string filename\" " + name +
                                " \"float[6] bound\" [-1 1 -1 1 -1 1]\n";
            if (i % 5 == 0) text += "IfEnd\n";
        }
        return readHere(text + "WorldEnd\n");
    };
    const auto a = scene(true), b = scene(false);
    ASSERT_EQ(a->frame().primitives.size(), b->frame().primitives.size());
    EXPECT_GT(a->frame().primitives.size(), 3000u);
    for (size_t i = 0; i < a->frame().primitives.size(); ++i) {
        const scene::Primitive &p = a->primitive(i), &q = b->primitive(i);
        EXPECT_EQ(p.numbers, q.numbers);
        EXPECT_EQ(p.toWorld.first().m[3][0], q.toWorld.first().m[3][0]);
        EXPECT_EQ(p.place.file, q.place.file);
        EXPECT_EQ(p.place.line, q.place.line);
        EXPECT_EQ(p.place.column, q.place.column);
    }
    ASSERT_EQ(a->count(), b->count());
    EXPECT_GT(a->count(), 20u);
    const std::vector<Diagnostic> said = a->diagnostics.all(), alsoSaid = b->diagnostics.all();
    for (size_t i = 0; i < said.size(); ++i)
        if (said[i].place.file.find("main") == std::string::npos) EXPECT_EQ(toString(said[i]), toString(alsoSaid[i]));
}

TEST_F(Archives, AreParsedOnce) {
    const std::string name = (dir / "part.rib").string();
    write("part.rib", "Sphere 1 -1 1 360\n");
    ArchiveShelf shelf;
    const auto first = shelf.take(name);
    ASSERT_TRUE(first);
    EXPECT_EQ(first->calls.size(), 1u);
    EXPECT_EQ(shelf.take(name), first);
    write("part.rib", "Sphere 1 -1 1 360 Sphere 2 -2 2 360\n"); // another file now
    ASSERT_TRUE(shelf.take(name));
    EXPECT_EQ(shelf.take(name)->calls.size(), 2u);
    write("bad.rib", "Sphere 1 -1 1\n"); // each reading has its messages
    EXPECT_FALSE(shelf.take((dir / "bad.rib").string()));
    EXPECT_FALSE(shelf.take((dir / "none.rib").string()));
    // Many files of the greatest size are not all kept.
    const std::string large = "Sphere 3 -3 3 360\n" + std::string(ArchiveShelf::kArchive - 18, ' ');
    size_t kept = 0, files = ArchiveShelf::kAll / ArchiveShelf::kArchive + 1;
    for (size_t k = 0; k < files; ++k) {
        write("large.rib" + std::to_string(k), large);
        kept += shelf.take((dir / ("large.rib" + std::to_string(k))).string()) != nullptr;
    }
    EXPECT_EQ(kept, files - 2);
    write("larger.rib", large + " ");
    EXPECT_FALSE(ArchiveShelf().take((dir / "larger.rib").string()));
}

TEST_F(Archives, ThatReadTwoOthersTakeLittleTime) {
    write("r0.rib", "");
    constexpr int kDepth = 15;
    for (int k = 1; k <= kDepth; ++k) {
        const std::string one = "ReadArchive \"r" + std::to_string(k - 1) + ".rib\"\n";
        write("r" + std::to_string(k) + ".rib", one + one);
    }
    write("r0.rib", "Attribute \"user\" \"float x\" [1]\n");
    const auto begin = std::clock();
    auto c = readHere("ReadArchive \"r" + std::to_string(kDepth) + ".rib\" WorldBegin Sphere 1 -1 1 360 WorldEnd");
    EXPECT_EQ(c->messages(), "");
    EXPECT_EQ(c->frame().primitives.size(), 1u);
    // 65,535 readings; it was 12 when each was parsed
    EXPECT_LT(double(std::clock() - begin) / CLOCKS_PER_SEC, kSanitized ? 20 : 2.5);
}

TEST_F(Archives, ReadAgainDrawAndSayTheSame) {
    write("part.rib", "Sphere 1 -1 1 360\nTranslate 1 0 0\n");
    write("bad.rib", "Sphere 1 -1 1 360\nNoSuchRequest 1\n");
    auto c = readHere("WorldBegin ReadArchive \"part.rib\" ReadArchive \"part.rib\" ReadArchive \"part.rib\" "
                      "ReadArchive \"bad.rib\" ReadArchive \"bad.rib\" ReadArchive \"bad.rib\" WorldEnd");
    ASSERT_EQ(c->frame().primitives.size(), 6u);
    for (size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(c->primitive(k).toWorld.first().m[3][0], double(k));
        EXPECT_EQ(c->primitive(k).place.file, (dir / "part.rib").string());
        EXPECT_EQ(c->primitive(k).place.line, 1);
    }
    EXPECT_EQ(c->count(), 3u) << c->messages();
}

} // namespace archive_test
