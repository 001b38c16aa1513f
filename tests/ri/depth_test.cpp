// Stacks of the interface: what nests 4,096 deep is read as it is meant, and what is deeper is an error, behind which the rest is
// read. All of it is read by a thread with a stack of 1 MiB.
#include "base/limits.h"
#include "base/ownstack.h"
#include "collect.h"
#include "scene/solids.h"
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <pthread.h>

namespace depth_test {

using namespace alpenglow;
using namespace alpenglow::ri;

namespace {

constexpr int kDeep = limits::kStackDepth;

void onSmallStack(const std::function<void()>& body) {
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, size_t(1) << 20);
    pthread_t thread;
    const auto run = [](void* f) -> void* {
        (*static_cast<const std::function<void()>*>(f))();
        return nullptr;
    };
    ASSERT_EQ(pthread_create(&thread, &attributes, run, const_cast<std::function<void()>*>(&body)), 0);
    pthread_join(thread, nullptr);
    pthread_attr_destroy(&attributes);
}

std::unique_ptr<Collected> readDeep(const std::string& text, ReaderOptions options = {}) {
    std::unique_ptr<Collected> c;
    onSmallStack([&] { c = read(text, std::move(options)); });
    return c;
}

std::string repeated(int n, const std::string& text) {
    std::string all;
    for (int i = 0; i < n; ++i) all += text;
    return all;
}

/// `depth` blocks about `inside`.
std::string nested(int depth, const std::string& begin, const std::string& inside, const std::string& end) {
    return repeated(depth, begin + "\n") + inside + "\n" + repeated(depth, end + "\n");
}

const std::string kBall = "Sphere 1 -1 1 360\n";

} // namespace

TEST(Depth, BlocksOfEachKind) {
    const struct {
        const char *begin, *end, *name;
    } kinds[] = {{"AttributeBegin Color .5 .5 .5", "AttributeEnd", "AttributeBegin"},
                 {"TransformBegin Translate 1 0 0", "TransformEnd", "TransformBegin"},
                 {"ResourceBegin", "ResourceEnd", "ResourceBegin"},
                 {"SolidBegin \"union\"", "SolidEnd", "SolidBegin"}};
    for (const auto& k : kinds) {
        auto c = readDeep("WorldBegin\n" + nested(kDeep, k.begin, kBall, k.end) + kBall + "WorldEnd\n");
        ASSERT_EQ(c->frame().primitives.size(), 2u) << k.name;
        if (k.name != std::string("SolidBegin")) EXPECT_EQ(c->messages(), "") << k.name; // a ball among parts is reported
        EXPECT_EQ(c->primitive(1).attributes->color, Color(1, 1, 1)) << k.name;
        EXPECT_EQ(c->primitive(1).toWorld.first(), Matrix()) << k.name;
        EXPECT_TRUE(c->primitive(1).attributes->solid.empty()) << k.name;

        c = readDeep("WorldBegin\n" + nested(kDeep + 7, k.begin, kBall + "TransformBegin\nTransformEnd\n", k.end) + kBall +
                     "WorldEnd\n");
        ASSERT_EQ(c->frame().primitives.size(), 2u) << k.name;
        EXPECT_EQ(c->first().code, Rie::Limit) << k.name;
        EXPECT_EQ(c->first().place.line, 1 + kDeep + 1) << k.name;
        EXPECT_NE(c->first().message.find(k.name + std::string(" is nested deeper than 4096")), std::string::npos)
            << c->first().message;
        EXPECT_EQ(c->diagnostics.errors(), 1) << c->messages();
        EXPECT_EQ(c->primitive(1).attributes->color, Color(1, 1, 1)) << k.name;
        EXPECT_EQ(c->primitive(1).toWorld.first(), Matrix()) << k.name;
    }
}

// Each kind has a stack of its own.
TEST(Depth, KindsDoNotCountTogether) {
    auto c =
        readDeep("FrameBegin 1\nWorldBegin\n" +
                 nested(kDeep, "AttributeBegin\nTransformBegin", kBall, "TransformEnd\nAttributeEnd") + "WorldEnd\nFrameEnd\n");
    EXPECT_EQ(c->messages(), "");
    EXPECT_EQ(c->frame().primitives.size(), 1u);
}

TEST(Depth, PartsOfSolids) {
    auto c =
        readDeep("WorldBegin\n" +
                 nested(kDeep - 1, "SolidBegin \"difference\"", "SolidBegin \"primitive\" " + kBall + "SolidEnd", "SolidEnd") +
                 "WorldEnd\n");
    EXPECT_EQ(c->messages(), "");
    EXPECT_EQ(scene::solidPath(*c->primitive().attributes).size(), size_t(kDeep));
}

TEST(Depth, Objects) {
    std::string text;
    for (int i = 0; i < kDeep; ++i) text += "ObjectBegin \"o" + std::to_string(i) + "\" " + kBall;
    text += repeated(kDeep, "ObjectEnd\n");
    auto c = readDeep("WorldBegin\n" + text + "ObjectInstance \"o0\"\nObjectInstance \"o4095\"\nWorldEnd\n");
    EXPECT_EQ(c->messages(), "");
    EXPECT_EQ(c->frame().instances.size(), 2u);
}

TEST(Depth, Conditions) {
    auto c = readDeep("WorldBegin\n" + nested(kDeep, "IfBegin \"1\"", kBall, "IfEnd") + "WorldEnd\n");
    EXPECT_EQ(c->messages(), "");
    EXPECT_EQ(c->frame().primitives.size(), 1u);
    const std::string tooDeep =
        "IfBegin \"1\" Sphere 2 -2 2 360 IfBegin \"0\" Sphere 3 -3 3 360 Else Sphere 4 -4 4 360 IfEnd ElseIf "
        "\"1\" Sphere 5 -5 5 360 Else Sphere 6 -6 6 360 IfEnd\n";
    c = readDeep("WorldBegin\n" + nested(kDeep, "IfBegin \"1\"", tooDeep + kBall, "IfEnd") + kBall + "WorldEnd\n");
    EXPECT_EQ(c->only().code, Rie::Limit);
    EXPECT_NE(c->only().message.find("IfBegin is nested deeper than 4096"), std::string::npos);
    ASSERT_EQ(c->frame().primitives.size(), 2u);
    for (const auto& p : c->frame().primitives) EXPECT_EQ(p->numbers[0], 1);
}

TEST(Depth, TimesOfAMotionBlock) {
    const auto moving = [](int n) {
        std::string times, keys;
        for (int i = 0; i < n; ++i) times += std::to_string(i) + " ", keys += kBall;
        return readDeep("WorldBegin\nMotionBegin [" + times + "]\n" + keys + "MotionEnd\n" + kBall + "WorldEnd\n");
    };
    auto c = moving(kDeep);
    EXPECT_EQ(c->messages(), "");
    EXPECT_EQ(c->primitive().motionKeys.size(), size_t(kDeep - 1));
    c = moving(kDeep + 1);
    EXPECT_EQ(c->first().code, Rie::Limit);
    EXPECT_EQ(c->frame().primitives.size(), 2u);
}

TEST(Depth, InlineArchives) {
    const auto chain = [](int n) {
        std::string text;
        for (int i = 1; i < n; ++i)
            text += "ArchiveBegin \"a" + std::to_string(i) + "\"\nReadArchive \"a" + std::to_string(i + 1) + "\"\n" +
                    (i + 1 == n ? "" : kBall) + "ArchiveEnd\n";
        return readDeep(text + "ArchiveBegin \"a" + std::to_string(n) + "\"\nSphere 2 -2 2 360\nArchiveEnd\nWorldBegin\n" +
                        "ReadArchive \"a1\"\n" + kBall + "WorldEnd\n");
    };
    auto c = chain(kDeep);
    EXPECT_EQ(c->messages(), "");
    ASSERT_EQ(c->frame().primitives.size(), size_t(kDeep));
    EXPECT_EQ(c->primitive().numbers[0], 2);
    c = chain(kDeep + 2);
    EXPECT_EQ(c->only().code, Rie::Limit);
    EXPECT_NE(c->only().message.find("4096"), std::string::npos);
    EXPECT_EQ(c->primitive().numbers[0], 1);
}

namespace {
class DepthOfFiles : public ::testing::Test {
protected:
    std::filesystem::path dir;
    void SetUp() override {
        std::string name = (std::filesystem::temp_directory_path() / "alpenglow-depth-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        dir = name;
    }
    void TearDown() override { std::filesystem::remove_all(dir); }
    /// Files f1 to fN, each with what `link` makes of the name of the next one, the last with a sphere of radius 2.
    void chain(int n, const std::function<std::string(const std::string&)>& link) const {
        for (int i = 1; i <= n; ++i)
            std::ofstream(dir / ("f" + std::to_string(i) + ".rib"))
                << (i < n ? link("f" + std::to_string(i + 1) + ".rib") : "Sphere 2 -2 2 360\n");
    }
    std::unique_ptr<Collected> readHere(const std::string& text, bool defers = false) const {
        ReaderOptions o;
        o.searchPaths = {dir.string()};
        o.defers = defers;
        return readDeep(text, o);
    }
};
} // namespace

// More files than a process may have open.
TEST_F(DepthOfFiles, Archives) {
    chain(kDeep, [](const std::string& next) { return "ReadArchive \"" + next + "\"\n"; });
    auto c = readHere("WorldBegin\nReadArchive \"f1.rib\"\n" + kBall + "WorldEnd\n");
    EXPECT_EQ(c->messages(), "");
    ASSERT_EQ(c->frame().primitives.size(), 2u);
    EXPECT_EQ(c->primitive().numbers[0], 2);
    chain(kDeep + 1, [](const std::string& next) { return "ReadArchive \"" + next + "\"\n"; });
    c = readHere("WorldBegin\nReadArchive \"f1.rib\"\n" + kBall + "WorldEnd\n");
    EXPECT_EQ(c->only().code, Rie::Limit);
    EXPECT_EQ(c->frame().primitives.size(), 1u);
}

TEST_F(DepthOfFiles, Procedurals) {
    chain(kDeep, [](const std::string& next) {
        return "Procedural \"DelayedReadArchive\" [\"" + next + "\"] [-1e9 1e9 -1e9 1e9 -1e9 1e9]\n";
    });
    auto c = readHere("WorldBegin\nProcedural \"DelayedReadArchive\" [\"f1.rib\"] [-1e9 1e9 -1e9 1e9 -1e9 1e9]\nWorldEnd\n");
    EXPECT_EQ(c->messages(), "");
    EXPECT_EQ(c->primitive().numbers[0], 2);
}

namespace {
/// Expands all of a frame while it is being rendered, as a renderer does.
struct Expanding : Collected {
    RibReader* reader = nullptr;
    std::shared_ptr<const scene::Frame> made;
    void render(std::shared_ptr<const scene::Frame> f) override {
        made = reader->make(*f, {});
        Collected::render(std::move(f));
    }
};
} // namespace

// Outside of the picture they wait, and are made from within each other later.
TEST_F(DepthOfFiles, ProceduralsThatWait) {
    chain(kDeep,
          [](const std::string& next) { return "Procedural \"DelayedReadArchive\" [\"" + next + "\"] [-1 1 -1 1 -1 1]\n"; });
    onSmallStack([&] {
        Expanding c;
        ReaderOptions o;
        o.searchPaths = {dir.string()};
        o.defers = true;
        RibReader reader(o, c, c.diagnostics);
        c.reader = &reader;
        reader.readMemory("Projection \"perspective\"\nWorldBegin\nTranslate 0 0 -99\nProcedural \"DelayedReadArchive\" "
                          "[\"f1.rib\"] [-1 1 -1 1 -1 1]\nWorldEnd\n",
                          "t.rib");
        EXPECT_EQ(c.messages(), "");
        ASSERT_NE(c.made, nullptr);
        EXPECT_EQ(c.made->primitives.size(), size_t(kDeep + 1)); // those that have been made stay
        EXPECT_EQ(c.made->primitives.back()->kind, "Sphere");
    });
}

TEST(OwnStack, RunsWhereItIsCalledAndPassesExceptions) {
    int n = 0;
    // A frame of 64 kB each: 100 of them would not fit into 1 MiB.
    std::function<void(int)> down = [&](int left) {
        volatile char much[64 << 10];
        much[size_t(left)] = char(left);
        ++n;
        const auto next = [&] { down(left - 1); };
        if (left > 0) left % 50 == 0 ? onOwnStack(next) : next();
        if (left == 7 || much[size_t(left)] != char(left)) throw 7;
    };
    onSmallStack([&] { EXPECT_THROW(onOwnStack([&] { down(400); }), int); });
    EXPECT_EQ(n, 401);
}

} // namespace depth_test
