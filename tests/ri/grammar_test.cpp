// ASCII RIB: RISpec 3.2, appendix C.2, and what files do beyond it (docs/design/ri.md, "Reading").
#include "base/limits.h"
#include "collect.h"
#include "scene/scene.h"
#include <sstream>

namespace grammar_test {

using namespace alpenglow;
using namespace alpenglow::ri;

TEST(Grammar, Numbers) {
    auto c = inWorld("Sphere .5 -5. +1e-1 3.6E+2");
    EXPECT_TRUE(c->ok) << c->messages();
    EXPECT_EQ(c->primitive().numbers, (std::vector<float>{.5f, -5.f, .1f, 360.f}));
}

TEST(Grammar, BadNumbersAreReportedInPlace) {
    auto c = inWorld("Sphere 1 -1 1 3x6");
    auto all = c->diagnostics.all();
    ASSERT_EQ(all.size(), 2u) << c->messages();
    EXPECT_EQ(all[0].code, Rie::Syntax);
    EXPECT_EQ(all[0].place.line, 2);
    EXPECT_EQ(all[0].place.column, 15); // "Sphere 1 -1 1 " has 14 bytes
    EXPECT_EQ(all[0].sourceLine, "Sphere 1 -1 1 3x6");
    EXPECT_EQ(all[1].code, Rie::MissingData);
    EXPECT_EQ(inWorld("Sphere 1e999 -1 1 360")->first().code, Rie::Range);
    EXPECT_TRUE(inWorld("Translate 1e-999 0 0")->ok);
    for (const char* bad : {"-", "+", ".", "1.2.3", "--1", "1e", "0x10", "nan", "-inf"})
        EXPECT_FALSE(inWorld(std::string("Translate 0 0 ") + bad)->ok) << bad;
}

// What C libraries print of numbers that are none; exporters write it. The other numbers stay where they are.
TEST(Grammar, NotANumberIsSaidAndTaken) {
    const std::string none[] = {"nan", "-nan", "-NaN(ind)", "1.#QNAN", "-1.#IND00"},
                      endless[] = {"inf", "Infinity", "1.#INF00", "+INF"};
    for (const std::string& text : none) {
        auto c = inWorld("Polygon \"P\" [" + text + " 0 0 1 " + text + " 2 3 4 " + text + "] Sphere 1 -1 1 360");
        EXPECT_EQ(c->frame().primitives.size(), 2u) << c->messages();
        EXPECT_EQ(c->primitive().params[0].numbers, (std::vector<float>{0, 0, 0, 1, 0, 2, 3, 4, 0})) << text;
        EXPECT_EQ(c->only().code, Rie::Range) << "said once";
        EXPECT_EQ(c->only().place.column, 14);
    }
    for (const std::string& text : endless) {
        auto c = read("Clipping .5 " + text + "\nWorldBegin WorldEnd");
        EXPECT_EQ(c->frame().options.clipFar, 1e38f) << text;
        EXPECT_EQ(c->only().code, Rie::Range);
    }
    EXPECT_EQ(inWorld("Polygon \"P\" [0 0 0 1 -inf 2 3 4 5]")->primitive().params[0].numbers[4], -1e38f);
    EXPECT_TRUE(inWorld("Color 1 1 1.#INFO\nSphere 1 -1 1 360")->ok) << "a comment";
    EXPECT_EQ(inWorld("Color 1 1 1 info")->first().code, Rie::BadToken) << "a request";
}

TEST(Grammar, Utf16IsNamed) {
    for (const std::string mark : {"\xff\xfe", "\xfe\xff"}) {
        auto c = read(mark + "W\1o\1r\1l\1d\1");
        EXPECT_NE(c->only().message.find("UTF-16"), std::string::npos);
    }
}

TEST(Grammar, MessagesAboutARequestShowItsLine) {
    auto c = read("WorldBegin\n  Rotate 10\n  0 0 0\nSphere 1 -1 1 360\nWorldEnd");
    EXPECT_EQ(c->only().place.line, 2);
    EXPECT_EQ(c->only().sourceLine, "  Rotate 10");
}

TEST(Grammar, StringEscapes) {
    auto c = read("Display \"a\\\"b\\\\c\\n\\t\\101\\7z\\\nq\" \"file\" \"rgb\"\nWorldBegin WorldEnd");
    EXPECT_TRUE(c->ok) << c->messages();
    EXPECT_EQ(c->frame().options.displays[0].name, "a\"b\\c\n\tA\7zq");
}

TEST(Grammar, UnterminatedStringIsReportedWhereItStarts) {
    auto c = inWorld("Surface \"plastic");
    auto all = c->diagnostics.all();
    ASSERT_FALSE(all.empty());
    EXPECT_EQ(all[0].code, Rie::Syntax);
    EXPECT_EQ(all[0].place.line, 2);
    EXPECT_EQ(all[0].place.column, 9);
    EXPECT_EQ(c->frames.size(), 1u); // the world renders all the same
}

TEST(Grammar, BracketsAreOptionalAroundCounts) {
    for (const char* text : {"Color 1 .5 0", "Color [1 .5 0]", "Color[1 .5 0]"}) {
        auto c = inWorld(std::string(text) + " Sphere 1 -1 1 360");
        EXPECT_TRUE(c->ok) << c->messages();
        EXPECT_EQ(c->primitive().attributes->color, Color(1, .5f, 0));
    }
    auto c = read("Format [320 200 1] ScreenWindow [-1 1 -1 1] CropWindow 0 1 0 .5 PixelSamples [3 4] WorldBegin Sphere [1 -1 1 "
                  "360] WorldEnd");
    EXPECT_TRUE(c->ok) << c->messages();
    EXPECT_EQ(c->frame().options.xres, 320);
    EXPECT_EQ(c->frame().options.pixelSamplesY, 4);
    EXPECT_EQ(c->frame().options.crop[3], .5f);
}

TEST(Grammar, CommentsAndStructure) {
    std::vector<std::pair<std::string, std::string>> seen;
    ReaderOptions o;
    o.comments = [&](const std::string& kind, const std::string& text) { seen.emplace_back(kind, text); };
    auto c = read("##RenderMan RIB-Structure 1.0\n# plain\nWorldBegin # after\nSphere 1 # in between\n -1 1 360\nWorldEnd", o);
    EXPECT_TRUE(c->ok) << c->messages();
    ASSERT_EQ(seen.size(), 4u);
    EXPECT_EQ(seen[0], (std::pair<std::string, std::string>{"structure", "RenderMan RIB-Structure 1.0"}));
    EXPECT_EQ(seen[1], (std::pair<std::string, std::string>{"comment", " plain"}));
}

TEST(Grammar, WildBytes) {
    auto c = read("\xef\xbb\xbfversion 3.03\r\nWorldBegin\r\n\fSphere 1 -1\r1 360\nversion 3.03\nWorldEnd");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    EXPECT_EQ(c->frame().primitives.size(), 1u);
    // A lone carriage return ends a line, the pair ends one line.
    auto d = read("Format\r640 480 1\r\nfoo");
    EXPECT_EQ(d->only().place.line, 3);
    EXPECT_EQ(d->only().place.column, 1);
}

TEST(Grammar, UnknownRequestHasAHint) {
    auto c = read("WorldBegin\n  Sphree 1 -1 1 360\nSphere 1 -1 1 360\nWorldEnd");
    EXPECT_EQ(c->only().code, Rie::BadToken);
    EXPECT_EQ(c->only().place.line, 2);
    EXPECT_EQ(c->only().place.column, 3);
    EXPECT_EQ(c->only().hint, "did you mean Sphere?");
    EXPECT_EQ(c->frame().primitives.size(), 1u); // in step again
}

TEST(Grammar, MissingBracket) {
    auto c = inWorld(
        "Polygon \"P\" [0 0 0 1 0 0 1 1 0 \"Cs\" [1 0 0 0 1 0 0 0 1]\nPolygon \"P\" [0 0 0 1 0 0 1 1 0\nSphere 1 -1 1 360");
    EXPECT_EQ(c->frame().primitives.size(), 3u) << c->messages();
    EXPECT_NE(scene::find(c->primitive(0).params, "Cs"), nullptr);
    ASSERT_EQ(c->count(), 2u) << c->messages();
    EXPECT_EQ(c->first().place.column, 13);
    EXPECT_EQ(c->first().code, Rie::Syntax);
    EXPECT_EQ(inWorld("Color 1 0 0 ] Sphere 1 -1 1 360")->only().code, Rie::Syntax);
}

TEST(Grammar, IntegersMustBeWhole) {
    EXPECT_TRUE(read("Format 640.0 480 1")->ok);
    EXPECT_EQ(read("Format 640.5 480 1")->only().code, Rie::Syntax);
    EXPECT_EQ(read("Format 1e30 480 1")->only().code, Rie::Syntax);
}

TEST(Grammar, VersionTooNew) {
    EXPECT_EQ(read("version 3.04")->count(), 0u);
    EXPECT_EQ(read("version 3.2")->count(), 0u); // the number of the specification
    EXPECT_EQ(read("version 4.0")->only().code, Rie::Version);
}

TEST(Grammar, OldOddities) {
    auto c = read("Format 380 380 -1 WorldBegin PatchMesh \"bilinear\" 2 \"nowrap\" 2 \"nowrap\" \"Pz\" [0 0 0 1] WorldEnd");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    EXPECT_EQ(c->frame().options.pixelAspect, 1);
    EXPECT_EQ(c->primitive().strings, (std::vector<std::string>{"bilinear", "nonperiodic", "nonperiodic"}));
    auto d = inWorld("Translate [1 0 0 0 0 1 0 0 0 0 1 0 5 6 7 1] Sphere 1 -1 1 360");
    EXPECT_EQ(d->only().severity, Severity::Warning);
    EXPECT_EQ(transformPoint(d->primitive().toWorld.first(), {0, 0, 0}), Vec3d(5, 6, 7));
    auto e = inWorld("Polygon \"P\" [9 9 9 9 9 9 9 9 9] \"P\" [0 0 0 1 0 0 1 1 0]");
    EXPECT_EQ(e->only().severity, Severity::Warning);
    EXPECT_EQ(scene::find(e->primitive().params, "P")->numbers[3], 1);
}

TEST(Grammar, TooManyNumbersAreNamed) {
    auto c = inWorld("Sphere 1 -1 1 360 7");
    EXPECT_EQ(c->only().severity, Severity::Warning);
    EXPECT_EQ(c->frame().primitives.size(), 1u);
}

TEST(Grammar, LongTokensAndStringsAreBounded) {
    EXPECT_EQ(read("Translate 0 0 " + std::string(limits::kTokenBytes + 10, '1'))->first().code, Rie::Limit);
    EXPECT_EQ(read(std::string(limits::kTokenBytes + 10, 'A'))->first().code, Rie::Limit);
    auto c = read("Surface \"" + std::string(limits::kStringBytes + 10, 'a') + "\"\nColor 1 0 0");
    EXPECT_EQ(c->only().code, Rie::Limit);
    // Just below is fine.
    EXPECT_TRUE(read("Translate 0 0 0." + std::string(limits::kTokenBytes - 100, '1'))->ok);
}

TEST(Grammar, LongArraysCrossTheBuffer) {
    // 100,000 points: about a megabyte, several buffers long. Sum of 0..n-1 checks that none is lost or torn.
    const int n = 100000;
    std::string text = "Points \"P\" [";
    for (int i = 0; i < n; ++i) text += std::to_string(i) + " 0 0.5\n";
    auto c = inWorld(text + "]");
    EXPECT_TRUE(c->ok) << c->messages();
    const auto& p = scene::find(c->primitive().params, "P")->numbers;
    ASSERT_EQ(p.size(), size_t(n) * 3);
    double sum = 0;
    for (size_t i = 0; i < p.size(); i += 3) sum += p[i];
    EXPECT_EQ(sum, double(n) * (n - 1) / 2);
}

TEST(Grammar, StreamsOneByteAtATime) {
    struct Slow : std::streambuf { // hands out one byte, has nothing ready beyond it
        std::string text;
        size_t at = 0;
        char c = 0;
        int_type underflow() override {
            if (at >= text.size()) return traits_type::eof();
            c = text[at++];
            setg(&c, &c, &c + 1);
            return traits_type::to_int_type(c);
        }
    } slow;
    slow.text = "WorldBegin\nSphere 1.25 -1 1 360 # x\nSurface \"matte\" \"Kd\" [.5]\nCylinder 1 -1 1 360\nWorldEnd";
    std::istream in(&slow);
    Collected c;
    RibReader reader({}, c, c.diagnostics);
    EXPECT_TRUE(reader.readStream(in, "pipe")) << c.messages();
    ASSERT_EQ(c.frame().primitives.size(), 2u);
    EXPECT_EQ(c.primitive().numbers[0], 1.25f);
    EXPECT_EQ(c.primitive(1).attributes->surface->params[0].numbers[0], .5f);
}

TEST(Grammar, MessagesAreBounded) {
    std::string text;
    for (int i = 0; i < 3 * limits::kReportedProblems; ++i)
        text += "foo" + std::to_string(i) + " "; // the same name would be said once
    auto c = read(text);
    EXPECT_EQ(c->count(), size_t(limits::kReportedProblems) + 1);
    EXPECT_FALSE(c->ok);
}

} // namespace grammar_test
