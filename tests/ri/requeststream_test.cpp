// Requests one by one: as they stand, as they are executed, filtered, counted.
#include "calls.h"
#include "ri/requestfilter.h"
#include "ri/requeststats.h"
#include "ri/writer.h"
#include <filesystem>
#include <fstream>

namespace requeststream_test {

using namespace alpenglow;
using namespace alpenglow::ri;
namespace fs = std::filesystem;

namespace {

/// What arrives, a line each.
class Lines : public RequestReceiver {
public:
    void request(const Call& c) override { text += headOf(c) + "\n"; }
    void unknown(const std::string& name, const std::vector<Value>& values) override {
        text += "? " + name + " " + std::to_string(values.size()) + "\n";
    }
    void comment(const std::string& kind, const std::string& t) override { text += kind + ":" + t + "\n"; }
    std::string text;
};

class RequestStreams : public ::testing::Test {
protected:
    void SetUp() override {
        dir = fs::temp_directory_path() / ("alpenglow_stream_" + std::to_string(::getpid()) + "_" +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(dir);
    }
    void TearDown() override { fs::remove_all(dir); }
    void write(const std::string& name, const std::string& text) const { std::ofstream(dir / name, std::ios::binary) << text; }
    std::string expanded(const std::string& text, bool allowExec = false) {
        write("main.rib", text);
        ReaderOptions o;
        o.allowExec = allowExec;
        said.clear();
        Diagnostics d([&](const Diagnostic& m) { said += toString(m); });
        Lines lines;
        EXPECT_TRUE(passOnExpanded((dir / "main.rib").string(), o, lines, d));
        return lines.text;
    }
    fs::path dir;
    std::string said;
};

std::string filtered(const std::string& text, FilterRules rules) {
    Lines lines;
    RequestFilter filter(std::move(rules), lines);
    Diagnostics d;
    passOnText(text, "t.rib", filter, d);
    filter.finish();
    return lines.text;
}

RequestPattern pattern(const std::string& text) {
    std::string error;
    auto p = RequestPattern::make(text, error);
    EXPECT_TRUE(p) << error;
    return *p;
}

std::vector<Call> calls(const std::string& text) { return callsOf(text); }

} // namespace

TEST_F(RequestStreams, PassAsTheyStand) {
    write("a.rib", "##RenderMan RIB\n#one\nWorldBegin #two\nColor 1 0 0 #three\nNewThing 1 2 \"x\" [3]\nReadArchive \"b.rib\"\n"
                   "IfBegin \"0\" Sides 1 IfEnd\nWorldEnd\n#end");
    Diagnostics d;
    Lines lines;
    EXPECT_TRUE(passOn((dir / "a.rib").string(), lines, d));
    EXPECT_EQ(lines.text,
              "structure:RenderMan RIB\ncomment:one\nWorldBegin\ncomment:two\nColor [1 0 0]\ncomment:three\n? NewThing 3\n"
              "ReadArchive \"b.rib\"\nIfBegin \"0\"\nSides 1\nIfEnd\nWorldEnd\ncomment:end\n");
    ASSERT_EQ(d.all().size(), 1u);
    EXPECT_EQ(d.all()[0].code, Rie::BadToken);
    EXPECT_FALSE(passOn((dir / "none.rib").string(), lines, d));
}

TEST_F(RequestStreams, UnknownRequestsAreWrittenAsTheyWere) {
    for (const bool binary : {false, true}) {
        std::string out;
        RibWriter w(stringSink(out), {.binary = binary});
        struct To : RequestReceiver {
            explicit To(RibWriter& writer) : w(writer) {}
            void request(const Call& c) override { w.write(c); }
            void unknown(const std::string& n, const std::vector<Value>& v) override { w.write(n, v); }
            void comment(const std::string&, const std::string&) override {}
            RibWriter& w;
        } to(w);
        Diagnostics d;
        passOnText("Later 1 .1 \"a\" [] [\"b\" \"c\"] [1 2] Sides 1 Later 2", "t.rib", to, d);
        EXPECT_TRUE(w.finish());
        if (!binary) EXPECT_EQ(out, "Later 1 0.1 \"a\" [] [\"b\" \"c\"] [1 2]\nSides 1\nLater 2\n");
        Lines lines;
        passOnText(out, "t.rib", lines, d);
        EXPECT_EQ(lines.text, "? Later 5\nSides 1\n? Later 1\n");
    }
}

TEST_F(RequestStreams, ExpandedArchivesStandInTheirPlace) {
    write("b.rib", "Sphere 1 -1 1 360 ReadArchive \"c.rib\"");
    write("c.rib", "AttributeBegin Sides 1");
    EXPECT_EQ(expanded("WorldBegin ArchiveBegin \"in\" Sides 2 ArchiveEnd ReadArchive \"b.rib\" ReadArchive \"in\" "
                       "ReadArchive \"none.rib\" IfBegin \"1 == 2\" Color 1 0 0 Else Color 0 1 0 IfEnd "
                       "Procedural \"DelayedReadArchive\" [\"c.rib\"] [-1 1 -1 1 -1 1] WorldEnd"),
              "WorldBegin\nSphere 1 -1 1 360\nAttributeBegin\nSides 1\nAttributeEnd\nSides 2\nReadArchive \"none.rib\"\n"
              "Color [0 1 0]\nAttributeBegin\nAttributeBegin\nSides 1\nAttributeEnd\nAttributeEnd\nWorldEnd\n");
    EXPECT_NE(said.find("none.rib"), std::string::npos);
}

TEST_F(RequestStreams, ExpandedProgramsNeedPermission) {
    write("maker", "#!/bin/sh\nwhile read a b; do echo \"Sphere $b -1 1 360\"; printf '\\377'; done\n");
    fs::permissions(dir / "maker", fs::perms::owner_all);
    const std::string call = "Procedural \"RunProgram\" [\"maker\" \"7\"] [-1 1 -1 1 -1 1]";
    EXPECT_EQ(expanded("WorldBegin " + call + " WorldEnd"), "WorldBegin\n" + call + "\nWorldEnd\n");
    EXPECT_NE(said.find("--allow-exec"), std::string::npos);
    EXPECT_EQ(expanded("WorldBegin " + call + " WorldEnd", true),
              "WorldBegin\nAttributeBegin\nSphere 7 -1 1 360\nAttributeEnd\nWorldEnd\n");
    EXPECT_EQ(said, "");
}

TEST_F(RequestStreams, ExpandedMotionComesOnce) {
    EXPECT_EQ(expanded("WorldBegin MotionBegin [0 1] Translate 0 0 0 Translate 1 0 0 MotionEnd ObjectBegin 1 Sphere 1 -1 1 360 "
                       "ObjectEnd ObjectInstance 1 Geometry \"teapot\" WorldEnd"),
              "WorldBegin\nMotionBegin [0 1]\nTranslate 0 0 0\nTranslate 1 0 0\nMotionEnd\nObjectBegin 1\nSphere 1 -1 1 360\n"
              "ObjectEnd\nObjectInstance 1\nGeometry \"teapot\"\nWorldEnd\n");
    EXPECT_EQ(said, "");
}

TEST_F(RequestStreams, WorldsWithinTheWorldBecomeBlocks) {
    write("b.rib", "Format 10 10 1 Display \"b\" \"file\" \"rgb\" WorldBegin Sphere 2 -2 2 360 WorldEnd");
    EXPECT_EQ(expanded("WorldBegin ReadArchive \"b.rib\" WorldEnd"),
              "WorldBegin\nAttributeBegin\nSphere 2 -2 2 360\nAttributeEnd\nWorldEnd\n");
}

TEST_F(RequestStreams, ValidationFindsWhatAReaderFinds) {
    expanded("WorldBegin Polygon \"P\" [1 2] Sphere 1 -1 1 360 AttributeEnd WorldEnd");
    EXPECT_NE(said.find("Polygon"), std::string::npos);
    EXPECT_NE(said.find("AttributeEnd without AttributeBegin"), std::string::npos);
}

TEST(RequestFilter, FramesAreChosen) {
    const std::string text = "Format 1 1 1 FrameBegin 1 Sides 1 FrameEnd #a\nFrameBegin 2 Sides 2 FrameEnd Matte 1";
    EXPECT_EQ(filtered(text, {.frames = {2}}), "Format 1 1 1\ncomment:a\nFrameBegin 2\nSides 2\nFrameEnd\nMatte 1\n");
}

TEST(RequestFilter, RequestsArePutInBehindTheVersion) {
    EXPECT_EQ(filtered("#x\nversion 3.03 Sides 1", {.before = calls("Matte 1 Identity")}),
              "comment:x\nversion 3.03\nMatte 1\nIdentity\nSides 1\n");
    EXPECT_EQ(filtered("", {.before = calls("Matte 1")}), "Matte 1\n");
}

TEST(RequestFilter, PatternsFitWholeWords) {
    const std::string text = "Surface \"plastic\" \"Kd\" .5 Surface \"plasticine\" Imager \"fog\" LightSource \"pointlight\" 1";
    const auto dropped = [&](const std::string& p) { return filtered(text, {.drop = {pattern(p)}}); };
    EXPECT_EQ(dropped("Surface"), "Imager \"fog\"\nLightSource \"pointlight\" 1\n");
    EXPECT_EQ(dropped("Surface \"plastic\""), "Surface \"plasticine\"\nImager \"fog\"\nLightSource \"pointlight\" 1\n");
    EXPECT_EQ(dropped("Surf|Source"), dropped("None")); // no part of a word
    EXPECT_EQ(dropped("Surface|.*Source"), "Imager \"fog\"\n");
    EXPECT_EQ(dropped(".*\"Kd\" 0[.]5"), "Surface \"plasticine\"\nImager \"fog\"\nLightSource \"pointlight\" 1\n");
    EXPECT_EQ(filtered(text, {.only = {pattern("Imager"), pattern("LightSource")}}),
              "Imager \"fog\"\nLightSource \"pointlight\" 1\n");
    EXPECT_EQ(filtered("#c\n" + text, {.replacements = {{pattern("Surface \"plastic\""), calls("Surface \"matte\" Sides 1")},
                                                        {pattern("Imager"), {}}}}),
              "comment:c\nSurface \"matte\"\nSides 1\nSurface \"plasticine\"\nLightSource \"pointlight\" 1\n");
    std::string error;
    EXPECT_FALSE(RequestPattern::make("(", error));
    EXPECT_NE(error, "");
}

TEST(RequestStats, Counts) {
    RequestStats s;
    for (const Call& c : calls("FrameBegin 1 WorldBegin AttributeBegin LightSource \"pointlight\" 1 \"intensity\" [2] Surface "
                               "\"matte\" Polygon \"P\" [0 0 0 1 0 0 1 1 0] Sphere 1 -1 1 360 ReadArchive \"a.rib\" "
                               "AttributeEnd WorldEnd FrameEnd"))
        s.add(c);
    EXPECT_EQ(s.all.times, 11u);
    EXPECT_EQ(s.primitives.times, 2u);
    EXPECT_EQ(s.primitives.numbers, 13u);
    EXPECT_EQ(s.lights.times, 1u);
    EXPECT_EQ(s.frames, 1u);
    EXPECT_EQ(s.worlds, 1u);
    EXPECT_EQ(s.depth, 3);
    EXPECT_EQ(s.shaders, (std::set<std::string>{"matte", "pointlight"}));
    EXPECT_EQ(s.archives, (std::set<std::string>{"a.rib"}));
    EXPECT_EQ(s.requests.at("Polygon").numbers, 9u);
    EXPECT_NE(statsText(s).find("Polygon"), std::string::npos);
}

} // namespace requeststream_test
