// RIB that is written and read again; bytes and text by RISpec 3.2, appendix C.
#include "base/limits.h"
#include "calls.h"
#include "ri/decimal.h"
#include "ri/writer.h"
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

namespace writer_test {

using namespace alpenglow;
using namespace alpenglow::ri;

namespace {

constexpr RibFormat kBinary{.binary = true};

std::string written(const std::vector<Call>& calls, RibFormat format = {}) {
    std::string out;
    RibWriter w(stringSink(out), format);
    for (const Call& c : calls) w.write(c);
    EXPECT_TRUE(w.finish()) << w.failure();
    return out;
}

std::string rewritten(const std::string& text, RibFormat format = {}) { return written(callsOf(text), format); }

/// Text to calls, to the form, to calls: equal, and nothing to say.
void expectRoundTrip(const std::string& text, const std::string& what) {
    const std::vector<Call> calls = callsOf(text);
    for (const bool binary : {false, true})
        for (const bool gzip : {false, true}) {
            std::string said;
            const std::vector<Call> again = callsOf(written(calls, {.binary = binary, .gzip = gzip}), &said);
            const std::string where = what + (binary ? ", binary" : ", ASCII") + (gzip ? ", gzip" : "");
            EXPECT_EQ(said, "") << where;
            ASSERT_EQ(calls.size(), again.size()) << where;
            for (size_t i = 0; i < calls.size() && !testing::Test::HasFailure(); ++i)
                expectSame(calls[i], again[i], binary, where);
        }
}

std::string contents(const std::filesystem::path& p) {
    std::ifstream in(p, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

} // namespace

TEST(Writer, EverySampleComesBack) {
    for (const Request& r : requestTable()) {
        const std::string text = std::string(r.name) + " " + std::string(r.sample) + "\n";
        ASSERT_EQ(callsOf(text).size(), 1u) << text;
        expectRoundTrip(text, text);
    }
}

TEST(Writer, EveryExampleComesBack) {
    size_t scenes = 0;
    for (const auto& e : std::filesystem::recursive_directory_iterator(ALPENGLOW_SOURCE_DIR "/examples")) {
        if (e.path().extension() != ".rib") continue;
        ++scenes;
        expectRoundTrip(contents(e.path()), e.path().filename());
    }
    EXPECT_GT(scenes, 15u);
}

TEST(Writer, ValuesKeepTheirForm) {
    expectRoundTrip("Surface \"a\" \"b\" 1 \"c\" [1] \"d\" [] \"e\" \"f\" \"g\" [\"h\"] \"i\" [\"j\" \"k\"] \"l\" 1 2 3",
                    "forms");
    expectRoundTrip("DepthOfField DepthOfField 2 3 4 Translate 1 2 3 Translate [1 0 0 0 0 1 0 0 0 0 1 0 5 6 7 1]", "counts");
    expectRoundTrip("LightSource \"a\" 7 LightSource \"a\" \"7\" \"intensity\" [1] LightSource \"a\" \"key\" \"intensity\" 2 "
                    "Illuminate \"key\" 1 Illuminate \"007\" 0",
                    "handles");
    expectRoundTrip("Basis [1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16] 3 \"bezier\" 1 "
                    "SubdivisionMesh \"catmull-clark\" [3] [0 1 2] [\"crease\" \"hole\"] [2 1 1 0] [0 1 2] [3.5] \"P\" [] "
                    "SubdivisionMesh \"catmull-clark\" [3] [0 1 2] \"P\" []",
                    "arrays");
}

TEST(Writer, StringsKeepEveryByte) {
    std::string all;
    for (int i = 0; i < 256; ++i) all += char(i);
    Call c = callsOf("Attribute \"user\" \"string a\" \"b\"")[0];
    c.params[0].value.strings[0] = all;
    for (const RibFormat f : {RibFormat{}, kBinary}) {
        const auto again = callsOf(written({c}, f));
        ASSERT_EQ(again.size(), 1u);
        EXPECT_EQ(again[0].params[0].value.strings[0], all);
    }
    c.params[0].value.strings[0] = "a\"\\\n\t\x01";
    EXPECT_EQ(written({c}), "Attribute \"user\" \"string a\" \"a\\\"\\\\\\n\\t\\001\"\n");
    c.params[0].value.strings[0] = std::string(70'000, 'x'); // three bytes of length
    EXPECT_EQ(callsOf(written({c}, kBinary))[0].params[0].value.strings[0].size(), 70'000u);
}

TEST(Writer, NumbersComeBackToTheBit) {
    std::mt19937_64 random(7);
    std::vector<double> values{0,     -0.0,  1,       -1,      127,      128,        255,          256,           -129,
                               32767, 32768, 8388607, 8388608, 16777217, 2147483647, 2147483648.0, -2147483648.0, .1,
                               .5,    1e38,  -1e-30,  1e300};
    for (int i = 0; i < 2000; ++i) {
        double d = std::bit_cast<double>(random());
        if (std::isfinite(d)) values.push_back(d);
        float f = std::bit_cast<float>(uint32_t(random()));
        if (std::isfinite(f)) values.push_back(double(f));
    }
    for (const bool binary : {false, true}) {
        Call c = callsOf("TrimCurve [1] [2] [3] [4] [5] [6] [7] [8] [9]")[0];
        c.arguments[6].numbers = values; // all are arguments, of an array
        Call one = callsOf("Translate 1 2 3")[0];
        std::vector<Call> calls{c};
        for (const double d : values) {
            one.arguments[0].numbers = {d, d, -d};
            calls.push_back(one);
        }
        const auto again = callsOf(written(calls, {.binary = binary}));
        ASSERT_EQ(again.size(), calls.size());
        for (size_t i = 0; i < calls.size(); ++i)
            for (size_t a = 0; a < calls[i].arguments.size(); ++a) {
                const auto &x = calls[i].numbers(a), &y = again[i].numbers(a);
                ASSERT_EQ(x.size(), y.size());
                for (size_t k = 0; k < x.size(); ++k)
                    EXPECT_EQ(std::bit_cast<uint64_t>(x[k]), std::bit_cast<uint64_t>(y[k])) << x[k] << (binary ? " binary" : "");
            }
    }
}

TEST(Writer, FloatsAreTheirShortestDecimals) {
    Call c = callsOf("Polygon \"float a\" [1]")[0];
    c.params[0].value.numbers = {double(.1f), double(1.f / 3), 16777217, .1, double(3e-20f)};
    EXPECT_EQ(written({c}), "Polygon \"float a\" [0.1 0.33333334 16777217 0.1 3e-20]\n");
    std::mt19937 random(3);
    c.params[0].value.numbers.clear();
    for (int i = 0; i < 100'000; ++i) {
        const float f = std::bit_cast<float>(uint32_t(random()));
        if (std::isfinite(f)) c.params[0].value.numbers.push_back(double(f));
    }
    expectSame(c, callsOf(written({c}))[0], true, "ASCII");
    expectSame(c, callsOf(written({c}, kBinary))[0], false, "binary");
    // With ColorSamples colours are sums of products of doubles.
    std::string s = written({callsOf("ColorSamples [1 1 1] [1 1 1]")[0], c}, {.columns = 0});
    expectSame(c, callsOf(s)[1], false, "ColorSamples");
}

TEST(Writer, DecimalOfAFloatIsWhatAFileSays) {
    EXPECT_EQ(decimalOf(.1f), .1);
    EXPECT_EQ(decimalOf(1e38f), 1e38);
    EXPECT_EQ(decimalOf(-2.5f), -2.5);
    EXPECT_TRUE(std::isnan(decimalOf(NAN)));
    std::mt19937 random(5);
    for (int i = 0; i < 100'000; ++i) {
        const float f = std::bit_cast<float>(uint32_t(random()));
        if (!std::isnormal(f)) continue;
        char nine[32]; // nine digits tell all floats apart
        std::snprintf(nine, sizeof nine, "%.9g", double(f));
        EXPECT_NEAR(decimalOf(f) / std::strtod(nine, nullptr), 1, 1e-7);
        EXPECT_EQ(float(decimalOf(f)), f);
    }
}

TEST(Writer, TextIsIndentedByBlocks) {
    EXPECT_EQ(rewritten("FrameBegin 1 Format 4 3 1.0 WorldBegin AttributeBegin Color [1 .5 0] IfBegin \"1\" Sphere 1 -1 1 360 "
                        "Else Identity IfEnd AttributeEnd MotionBegin [0 1] Translate 1 2 3 Translate 4 5 6 MotionEnd WorldEnd "
                        "FrameEnd"),
              "FrameBegin 1\n"
              "    Format 4 3 1\n"
              "    WorldBegin\n"
              "        AttributeBegin\n"
              "            Color [1 0.5 0]\n"
              "            IfBegin \"1\"\n"
              "                Sphere 1 -1 1 360\n"
              "            Else\n"
              "                Identity\n"
              "            IfEnd\n"
              "        AttributeEnd\n"
              "        MotionBegin [0 1]\n"
              "            Translate 1 2 3\n"
              "            Translate 4 5 6\n"
              "        MotionEnd\n"
              "    WorldEnd\n"
              "FrameEnd\n");
    EXPECT_EQ(rewritten("AttributeBegin Identity AttributeEnd", {.indentation = 1}), "AttributeBegin\n Identity\nAttributeEnd\n");
}

TEST(Writer, LongLinesGoOnInTheNext) {
    std::string text = "Polygon \"P\" [";
    for (int i = 0; i < 3000; ++i) text += std::to_string(i % 97) + ".25 ";
    std::istringstream lines(rewritten(text + "]"));
    size_t n = 0, longest = 0;
    for (std::string line; std::getline(lines, line); ++n) longest = std::max(longest, line.size());
    EXPECT_GT(n, 150u);
    EXPECT_LE(longest, 100u);
    EXPECT_GT(longest, 90u);
    const std::string one = rewritten(text + "]", {.columns = 0});
    EXPECT_EQ(std::count(one.begin(), one.end(), '\n'), 1);
}

TEST(Writer, BytesAreThoseOfTheAppendix) {
    const auto bytes = [](std::initializer_list<int> b) {
        std::string s;
        for (int v : b) s += char(v);
        return s;
    };
    // 0314: defines a request, 0246: uses it; 0225: a string of five bytes; 0310: an array of floats.
    EXPECT_EQ(rewritten("Color [1 .5 0]", kBinary),
              bytes({0314, 0, 0225}) + "Color" + bytes({0246, 0, 0310, 3, 0x3f, 0x80, 0, 0, 0x3f, 0, 0, 0, 0, 0, 0, 0}) + "\n");
    // 0200 + bytes - 1: an integer; 0244: a float; 0245: a double.
    EXPECT_EQ(rewritten("Translate 300 .5 .1", kBinary),
              bytes({0314, 0, 0231}) + "Translate" +
                  bytes({0246, 0, 0201, 1, 44, 0244, 0x3f, 0, 0, 0, 0245, 0x3f, 0xb9, 0x99, 0x99, 0x99, 0x99, 0x99, 0x9a}) +
                  "\n");
    // 0315 defines a string when it comes a second time, 0317 uses it.
    const std::string twice = rewritten("Surface \"ab\" Surface \"ab\" Surface \"ab\"", kBinary);
    EXPECT_EQ(twice, bytes({0314, 0, 0227}) + "Surface" + bytes({0246, 0, 0222}) + "ab\n" + bytes({0246, 0, 0315, 0, 0222}) +
                         "ab" + bytes({0317, 0}) + "\n" + bytes({0246, 0, 0317, 0}) + "\n");
}

TEST(Writer, ThousandsOfStringsHaveCodes) {
    std::string text;
    for (int pass = 0; pass < 3; ++pass)
        for (int i = 0; i < 1000; ++i)
            text += "Attribute \"user\" \"float name" + std::to_string(i) + "\" " + std::to_string(i) + "\n";
    expectRoundTrip(text, "codes");
    EXPECT_LT(rewritten(text, kBinary).size(), text.size() * 3 / 4);
}

TEST(Writer, CommentsAndTextStayWhatTheyAre) {
    std::string out;
    for (const bool binary : {false, true}) {
        out.clear();
        RibWriter w(stringSink(out), {.binary = binary});
        w.structure("RenderMan RIB-Structure 1.0");
        w.comment("one\ntwo");
        w.write(callsOf("WorldBegin")[0]);
        w.verbatim("Color 1 0 0\n");
        w.comment("in");
        w.write(callsOf("WorldEnd")[0]);
        EXPECT_TRUE(w.finish());
        Diagnostics d;
        Reporter reporter(d);
        std::string said;
        Parser p(memorySource(out), "x", reporter,
                 [&](const std::string& k, const std::string& t) { said += k + ":" + t + ";"; });
        std::string names;
        for (Call c; p.next(c);) names += std::string(c.request->name) + " ";
        EXPECT_EQ(names, "WorldBegin Color WorldEnd ");
        EXPECT_EQ(said, "structure:RenderMan RIB-Structure 1.0;comment:one;comment:two;comment:in;");
        EXPECT_EQ(w.bytes(), out.size());
    }
}

TEST(Writer, FailuresAreTold) {
    struct Full : ByteSink {
        bool write(std::string_view s) override {
            left -= std::min(left, s.size());
            if (left == 0) failure_ = "no space";
            return left > 0;
        }
        bool flush() override { return left > 0; }
        size_t left = 1000;
    };
    for (const bool gzip : {false, true}) {
        RibWriter w(std::make_unique<Full>(), {.gzip = gzip});
        std::mt19937 random(1);
        Call c = callsOf("Translate 1 2 3")[0];
        for (int i = 0; i < 10'000; ++i) {
            c.arguments[0].numbers[0] = double(random());
            w.write(c);
        }
        EXPECT_FALSE(w.finish());
        EXPECT_EQ(w.failure(), "no space");
    }
    std::string why;
    EXPECT_EQ(fileSink("/no/such/folder/x.rib", &why), nullptr);
    EXPECT_NE(why, "");
}

TEST(Writer, WhatIsFlushedCanBeRead) {
    for (const bool gzip : {false, true}) {
        std::string out;
        RibWriter w(stringSink(out), {.gzip = gzip});
        w.write(callsOf("Translate 1 2 3")[0]);
        EXPECT_TRUE(w.flush());
        EXPECT_EQ(callsOf(out).size(), 1u); // a gzip stream that goes on has an end missing, not a request
    }
}

} // namespace writer_test
