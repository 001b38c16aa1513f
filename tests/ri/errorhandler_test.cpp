// ErrorHandler (RISpec 3.2, 7.2).
#include "collect.h"

namespace errorhandler_test {

using namespace alpenglow;
using namespace alpenglow::ri;

namespace {
const std::string kBall = "Sphere 1 -1 1 360\n", kWrong = "Sides 3\n";
std::string frame(const std::string& inside) { return "WorldBegin\n" + inside + "WorldEnd\n"; }
} // namespace

TEST(ErrorHandler, AbortStopsAtTheFirstErrorAndHandsNoFrameOver) {
    auto c = read("ErrorHandler \"abort\"\n" + frame(kBall) + frame(kBall + kWrong + kWrong) + frame(kBall));
    EXPECT_FALSE(c->ok);
    EXPECT_EQ(c->frames.size(), 1u); // the one before the error
    ASSERT_EQ(c->count(), 2u) << c->messages();
    EXPECT_EQ(c->first().place.line, 7);
    EXPECT_NE(c->messages().find("the rest is not read"), std::string::npos);
}

TEST(ErrorHandler, AbortLetsWarningsPass) {
    auto c = read("ErrorHandler \"abort\"\nOption \"trase\" \"int x\" 1\n" + frame(kBall));
    EXPECT_TRUE(c->ok);
    EXPECT_EQ(c->frames.size(), 1u);
    EXPECT_TRUE(c->frame().options.abortsOnError);
}

TEST(ErrorHandler, ErrorsBeforeItDoNotCount) {
    auto c = read(kWrong + "ErrorHandler \"abort\"\n" + frame(kBall));
    EXPECT_EQ(c->frames.size(), 1u);
    c = read(kWrong + "ErrorHandler \"abort\"\nErrorHandler \"print\"\n" + kWrong + frame(kBall));
    EXPECT_EQ(c->frames.size(), 1u);
    EXPECT_FALSE(c->frame().options.abortsOnError);
}

TEST(ErrorHandler, AbortInAnArchive) {
    auto c = read("ErrorHandler \"abort\"\nArchiveBegin \"a\"\n" + kBall + kWrong + kBall + "ArchiveEnd\n" +
                  frame("AttributeBegin\nReadArchive \"a\"\nAttributeEnd\n") + frame(kBall));
    EXPECT_TRUE(c->frames.empty());
    EXPECT_EQ(c->diagnostics.errors(), 1) << c->messages(); // blocks that are open then are nobody's fault
}

namespace {
/// Finds an error in the first frame while it is drawn.
struct Drawing : Collected {
    void render(std::shared_ptr<const scene::Frame> f) override {
        if (frames.empty()) diagnostics.report(Severity::Error, Rie::NoShader, {}, "no shader");
        Collected::render(std::move(f));
    }
};
} // namespace

TEST(ErrorHandler, AbortAlsoAtErrorsOfDrawing) {
    Drawing c;
    RibReader reader({}, c, c.diagnostics);
    reader.readMemory("ErrorHandler \"abort\"\n" + frame(kBall) + frame(kBall), "t.rib");
    EXPECT_EQ(c.frames.size(), 1u) << c.messages();
}

TEST(ErrorHandler, IgnoredErrorsAreKeptApart) {
    auto c = read("ErrorHandler \"ignore\"\nOption \"trase\" \"int x\" 1\n" + frame(kBall + kWrong) + "ErrorHandler \"print\"\n" +
                  kWrong + frame(kBall));
    EXPECT_EQ(c->frames.size(), 2u);
    EXPECT_EQ(c->diagnostics.ignored(), 2);
    EXPECT_EQ(c->diagnostics.errors(), 1);
    EXPECT_EQ(c->diagnostics.warnings(), 0);
    ASSERT_EQ(c->count(), 3u);
    const auto all = c->diagnostics.all();
    EXPECT_TRUE(all[0].ignored && all[1].ignored);
    EXPECT_FALSE(all[2].ignored);
    EXPECT_EQ(all[1].severity, Severity::Error); // it is what it is
}

TEST(ErrorHandler, TheNextSceneBeginsAnew) {
    Collected c;
    RibReader reader({}, c, c.diagnostics);
    for (const char* style : {"ignore", "abort"}) {
        reader.nextScene();
        reader.readMemory("ErrorHandler \"" + std::string(style) + "\"\n" + frame(kBall + kWrong), "a.rib");
    }
    reader.nextScene();
    reader.readMemory(kWrong + frame(kBall), "b.rib");
    EXPECT_EQ(c.frames.size(), 2u) << c.messages(); // of the first scene and the last
    EXPECT_EQ(c.diagnostics.ignored(), 1);
    EXPECT_EQ(c.diagnostics.errors(), 2);
}

} // namespace errorhandler_test
