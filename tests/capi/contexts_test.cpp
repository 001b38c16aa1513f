// Contexts, callbacks, handles, what is written, and that calls stream.
#include "../sanitized.h"
#include "folder.h"
#include <cstdlib>
#include <ri.h>
#include <sys/resource.h>
#include <vector>

namespace capi_contexts_test {

using namespace alpenglow;

namespace {

std::vector<std::string> gGot;
RtVoid got(RtToken type, char* format, ...) { gGot.push_back(std::string(type) + ":" + format); }

class CContexts : public capi::testing::Folder {
protected:
    void TearDown() override {
        while (RiGetContext()) RiEnd();
        Folder::TearDown();
    }
    /// What a file holds behind its first two lines.
    std::string body(const std::string& name) const {
        const std::string t = text(name);
        return t.substr(t.find('\n', t.find('\n') + 1) + 1);
    }
};

TEST_F(CContexts, SeveralAtATime) {
    RiBegin("a.rib");
    RtContextHandle a = RiGetContext();
    RiSides(1);
    RiBegin("b.rib");
    RtContextHandle b = RiGetContext();
    EXPECT_NE(a, b);
    RiSides(2);
    RiContext(a);
    RiMatte(RI_TRUE);
    RiEnd();
    EXPECT_EQ(RiGetContext(), nullptr); // RISpec: none is current then
    RiContext(b);
    RiMatte(RI_FALSE);
    RiEnd();
    EXPECT_EQ(body("a.rib"), "Sides 1\nMatte 1\n");
    EXPECT_EQ(body("b.rib"), "Sides 2\nMatte 0\n");
}

TEST_F(CContexts, FormatsOfFiles) {
    const auto write = [](const char* name, RtString format, RtString compression, bool before) {
        const auto say = [&] { RiOption("rib", "string format", &format, "string compression", &compression, RI_NULL); };
        if (before) say();
        RiBegin(name);
        if (!before) say();
        RtFloat tenth[1] = {.1f};
        RiTranslate(.1f, 0, 3);
        RiPoints(0, "constantwidth", tenth, RI_NULL);
        RiEnd();
    };
    write("a.rib", "ascii", "none", false);
    write("b.rib", "binary", "none", false);
    write("c.rib", "ascii", "gzip", false);
    EXPECT_EQ(body("a.rib"), "Translate 0.1 0 3\nPoints \"constantwidth\" [0.1]\n");
    EXPECT_LT(text("b.rib").find('\246'), text("b.rib").size()); // a request by its code
    EXPECT_EQ(text("c.rib").substr(0, 2), "\x1f\x8b");
    write("d.rib", "binary", "gzip", true); // holds for the next file
    EXPECT_EQ(text("d.rib").substr(0, 2), "\x1f\x8b");
    EXPECT_EQ(run("zcat < d.rib | cmp - b.rib"), "");
    RiBegin("e.rib");
    RiSides(1);
    RiEnd();
    EXPECT_EQ(body("e.rib"), "Sides 1\n");
}

TEST_F(CContexts, Records) {
    RiBegin("a.rib");
    RiArchiveRecord(RI_STRUCTURE, "RenderMan RIB-Structure %d.%d Entity", 1, 0);
    RiArchiveRecord(RI_COMMENT, "half of it: 50%% %s", "x");
    RiArchiveRecord(RI_VERBATIM, "Sides %d\n", 2);
    RiArchiveRecord("essay", "no such type");
    RiEnd();
    EXPECT_EQ(text("a.rib"), "##RenderMan RIB-Structure 1.0 Entity\n#half of it: 50% x\nSides 2\n");
    RiBegin(RI_NULL);
    gGot.clear();
    RiReadArchive("a.rib", got, RI_NULL);
    EXPECT_EQ(gGot, (std::vector<std::string>{"structure:RenderMan RIB-Structure 1.0 Entity", "comment:half of it: 50%% x"}));
    RiEnd();
}

// Calls between ArchiveBegin and ArchiveEnd are kept; declarations and bases among them hold for what follows in it.
TEST_F(CContexts, InlineArchives) {
    RiBegin(RI_NULL);
    RiErrorHandler([](RtInt, RtInt, char* m) { ADD_FAILURE() << m; });
    RtFloat one[4] = {1, 1, 1, 1};
    RtFloat mesh[16][3] = {};
    for (int i = 0; i < 16; ++i) mesh[i][0] = RtFloat(i % 4), mesh[i][1] = RtFloat(i / 4);
    RiDisplay("x.exr", "openexr", "rgba", RI_NULL);
    RiFormat(8, 8, 1);
    RiTranslate(0, 0, 5);
    RiWorldBegin();
    RiArchiveBegin("part", RI_NULL);
    RiDeclare("own", "varying float");
    RiBasis(RiBSplineBasis, 1, RiBSplineBasis, 1);
    RiPatchMesh("bicubic", 4, "nonperiodic", 4, "nonperiodic", "P", mesh, "own", one, RI_NULL);
    RiArchiveEnd();
    RiReadArchive("part", nullptr, RI_NULL);
    RiIfBegin("0 == 1", RI_NULL);
    RiDeclare("other", "uniform float");
    RiSphere(1, -1, 1, 360, "other", one, RI_NULL);
    RiElse();
    RiSphere(.5, -.5, .5, 360, RI_NULL);
    RiIfEnd();
    RiWorldEnd();
    RiEnd();
    RiErrorHandler(RiErrorPrint);
    const display::Image i = picture("x.exr");
    EXPECT_GT(i.pixel(4, 4)[i.channel("a")], 0);
}

int gSubdivided, gFreed;

TEST_F(CContexts, ProceduralsAreCalledOnceAndFreed) {
    for (const char* name : {static_cast<const char*>(nullptr), "a.rib"}) {
        gSubdivided = gFreed = 0;
        RtBound bound = {-1, 1, -1, 1, -1, 1};
        RiBegin(name);
        RiFormat(4, 4, 1);
        RiDisplay("x.exr", "openexr", "rgba", RI_NULL);
        RiWorldBegin();
        const auto make = [](RtPointer data, RtFloat) {
            ++gSubdivided;
            EXPECT_EQ(data, &gFreed);
            RiSides(1);
            RiSphere(1, -1, 1, 360, RI_NULL);
        };
        RiProcedural(&gFreed, bound, make, [](RtPointer) { ++gFreed; });
        RiWorldEnd();
        RiEnd();
        EXPECT_EQ(gSubdivided, 1);
        EXPECT_EQ(gFreed, 1);
    }
    EXPECT_NE(body("a.rib").find("    AttributeBegin\n        Sides 1\n        Sphere 1 -1 1 360\n    AttributeEnd\n"),
              std::string::npos)
        << body("a.rib");
}

TEST_F(CContexts, PointsOfOtherSpaces) {
    RiBegin(RI_NULL);
    RiTranslate(0, 0, 5);
    RiWorldBegin();
    RiScale(2, 2, 2);
    RiCoordinateSystem("big");
    RtPoint p[2] = {{1, 0, 0}, {0, 1, 1}};
    ASSERT_EQ(RiTransformPoints("big", "world", 2, p), p);
    EXPECT_EQ(p[0][0], 2);
    EXPECT_EQ(p[1][2], 2);
    ASSERT_EQ(RiTransformPoints("world", "camera", 2, p), p);
    EXPECT_EQ(p[1][2], 7);
    RiErrorHandler(RiErrorIgnore);
    EXPECT_EQ(RiTransformPoints("world", "nowhere", 2, p), nullptr);
    EXPECT_EQ(p[1][2], 7);
    EXPECT_EQ(RiLastError, RIE_BADTOKEN);
    RiErrorHandler(RiErrorPrint);
    RiEnd();
}

TEST_F(CContexts, HandlesInFiles) {
    RiBegin("a.rib");
    RtString key = "key";
    RtLightHandle one = RiLightSource("pointlight", RI_NULL);
    RtLightHandle two = RiLightSource("pointlight", "string __handleid", &key, RI_NULL);
    RtObjectHandle ball = RiObjectBegin();
    RiObjectEnd();
    RiIlluminate(one, RI_FALSE);
    RiIlluminate(two, RI_TRUE);
    RiObjectInstance(ball);
    RiEnd();
    EXPECT_EQ(body("a.rib"), "LightSource \"pointlight\" 1\nLightSource \"pointlight\" \"key\"\nObjectBegin 3\nObjectEnd\n"
                             "Illuminate 1 0\nIlluminate \"key\" 1\nObjectInstance 3\n");
}

// Connections of RIS have texts as values, whatever type their token says.
TEST_F(CContexts, ConnectionsAreTexts) {
    RiBegin("a.rib");
    RtString from = "wood:resultRGB";
    RiBxdf("PxrDiffuse", "top", "reference color diffuseColor", &from, RI_NULL);
    RiEnd();
    EXPECT_EQ(body("a.rib"), "Bxdf \"PxrDiffuse\" \"top\" \"reference color diffuseColor\" [\"wood:resultRGB\"]\n");
}

// A library that was loaded for its loader alone, as Python does, still serves libraries of procedurals.
TEST_F(CContexts, LoadedAtRunTimeByTheOldNames) {
    if (kSanitized) GTEST_SKIP() << "Python is not sanitized, so it cannot load the library";
    if (std::system("python3 -c 'import ctypes'") != 0) GTEST_SKIP() << "without Python";
    std::ofstream("drive.py") << R"(
import ctypes, sys
ri = ctypes.CDLL(sys.argv[1])
f = ctypes.c_float
ri.RiBegin(None)
ri.RiFormat(16, 16, f(1))
ri.RiDisplay(b"x.exr", b"openexr", b"rgba", None)
ri.RiTranslate(f(0), f(0), f(5))
ri.RiScale(f(.2), f(.2), f(1))
ri.RiWorldBegin()
strings = (ctypes.c_char_p * 2)(sys.argv[2].encode(), b"halves 2")
bound = (f * 6)(-2, 2, -2, 2, -2, 2)
ri.RiProcedural(strings, bound, ri.RiProcDynamicLoad, None)
ri.RiWorldEnd()
ri.RiEnd()
print(ctypes.c_int.in_dll(ri, "RiLastError").value, ctypes.c_char_p.in_dll(ri, "RI_RGBA").value)
)";
    const std::string folder = std::filesystem::path(ALPENGLOW_LIBRARY).parent_path().string();
    for (const char* name : {"libri.so", "librib.so"})
        EXPECT_EQ(run("ALPENGLOW_OPTIONS=--allow-exec python3 drive.py " + folder + "/" + name +
                      " " ALPENGLOW_PROCEDURALS "/facets.so"),
                  "0 b'rgba'\n");
}

// Calls become bytes as they come: 16 MB of RIB take no memory.
TEST_F(CContexts, CallsStream) {
    const auto peak = [] {
        rusage u{};
        getrusage(RUSAGE_SELF, &u);
        return u.ru_maxrss; // kilobytes
    };
    RiBegin("/dev/null");
    RtPoint p[40] = {};
    for (int i = 0; i < 40; ++i) p[i][0] = RtFloat(i) / 7, p[i][1] = RtFloat(i) / 11;
    RiPolygon(40, "P", p, RI_NULL);
    const auto before = peak();
    for (int i = 0; i < 20'000; ++i) RiPolygon(40, "P", p, RI_NULL);
    if (!kSanitized) EXPECT_LT(peak() - before, 8 << 10); // a sanitizer keeps what is freed
    RiEnd();
}

} // namespace

} // namespace capi_contexts_test
