// Errors of the C binding: the codes of RISpec 3.2, 7.2, each by a call that brings it, in both kinds of contexts.
#include "../sanitized.h"
#include "folder.h"
#include "ri/c/client.h"
#include <functional>
#include <ri.h>
#include <sys/mman.h>
#include <vector>

namespace capi_errors_test {

using namespace alpenglow;

namespace {

struct Said {
    RtInt code, severity;
    std::string message;
};
std::vector<Said> gSaid;
RtVoid note(RtInt code, RtInt severity, char* message) { gSaid.push_back({code, severity, message}); }

class CErrors : public capi::testing::Folder {
protected:
    void SetUp() override {
        Folder::SetUp();
        RiErrorHandler(note);
        gSaid.clear();
        RiLastError = 0;
    }
    void TearDown() override {
        while (RiGetContext()) RiEnd();
        RiErrorHandler(RiErrorPrint);
        Folder::TearDown();
    }
    static std::string all() {
        std::string s;
        for (const Said& x : gSaid) s += std::to_string(x.code) + " " + std::to_string(x.severity) + " " + x.message + "\n";
        return s;
    }
    /// What these calls bring in a world that is drawn, with a file of the name archive.rib.
    void expectInWorld(RtInt code, const std::function<void()>& calls, const std::string& archive = "") {
        if (!archive.empty()) std::ofstream(dir / "archive.rib") << archive;
        gSaid.clear();
        RiLastError = 0;
        RiBegin(RI_NULL);
        RiFormat(4, 4, 1);
        RiDisplay("x.exr", "openexr", "rgba", RI_NULL);
        RiWorldBegin();
        calls();
        ASSERT_FALSE(gSaid.empty()) << code;
        EXPECT_EQ(gSaid[0].code, code) << all();
        EXPECT_EQ(RiLastError, gSaid.back().code);
        RiWorldEnd();
        RiEnd();
    }
};

RtVoid throws(RtPointer, RtFloat) { throw std::runtime_error("no content today"); }
RtFloat stairs(RtFloat x, RtFloat, RtFloat, RtFloat) { return x < 0 ? RtFloat(.2) : RtFloat(1); }

TEST_F(CErrors, EachCode) {
    RtBound bound = {-1, 1, -1, 1, -1, 1};
    RtFloat two[2] = {1, 2}, colors[3] = {1, 1, 1};
    RtMatrix flat = {};
    expectInWorld(RIE_SYSTEM, [&] { RiProcedural(nullptr, bound, throws, nullptr); });
    expectInWorld(RIE_NOFILE, [] { RiReadArchive("nowhere.rib", nullptr, RI_NULL); });
    expectInWorld(RIE_VERSION, [] { RiReadArchive("archive.rib", nullptr, RI_NULL); }, "version 9");
    expectInWorld(RIE_INCAPABLE, [] { RiDeformation("bend", RI_NULL); });
    expectInWorld(RIE_NESTING, [] { RiAttributeEnd(); });
    expectInWorld(RIE_NOTOPTIONS, [] { RiClipping(1, 2); });
    expectInWorld(RIE_BADMOTION, [&] {
        RiMotionBeginV(2, two);
        RiSides(1);
        RiMotionEnd();
    });
    expectInWorld(RIE_BADSOLID, [] { RiSolidBegin("welded"); });
    expectInWorld(RIE_BADTOKEN, [&] { RiSphere(1, -1, 1, 360, "unheard", colors, RI_NULL); });
    expectInWorld(RIE_BADTOKEN, [&] { RiOrientation("upwards"); });
    expectInWorld(RIE_RANGE, [] { RiSides(3); });
    expectInWorld(RIE_CONSISTENCY, [] { RiPolygon(-1, RI_NULL); });
    expectInWorld(RIE_CONSISTENCY, [] { RiColor(nullptr); });
    expectInWorld(RIE_CONSISTENCY, [] { RiSurface(nullptr, RI_NULL); });
    expectInWorld(RIE_BADHANDLE, [] { RiObjectInstance(nullptr); });
    expectInWorld(RIE_BADHANDLE, [&] { RiIlluminate(&bound, RI_TRUE); });
    expectInWorld(RIE_MISSINGDATA, [] { RiReadArchive("archive.rib", nullptr, RI_NULL); }, "Sphere 1 -1 1");
    expectInWorld(RIE_SYNTAX, [] { RiReadArchive("archive.rib", nullptr, RI_NULL); }, "Sides 1.5");
    expectInWorld(RIE_MATH, [&] { RiTransform(flat); });
    expectInWorld(RIE_LIMIT, [] {
        for (int i = 0; i < 100'000 && gSaid.empty(); ++i) RiAttributeBegin();
    });
}

TEST_F(CErrors, ShadersThatAreMissingAreNamedWhenTheWorldEnds) {
    RiBegin(RI_NULL);
    RiFormat(4, 4, 1);
    RiDisplay("x.exr", "openexr", "rgba", RI_NULL);
    RiWorldBegin();
    RiSurface("nosuchshader", RI_NULL);
    RiSphere(1, -1, 1, 360, RI_NULL);
    EXPECT_TRUE(gSaid.empty()) << all();
    RiWorldEnd();
    ASSERT_FALSE(gSaid.empty());
    EXPECT_EQ(gSaid[0].code, RIE_NOSHADER) << all();
    EXPECT_NE(gSaid[0].message.find("call:5"), std::string::npos) << all(); // RiBegin is the first
    RiEnd();
}

TEST_F(CErrors, PrimitivesOutsideOfWorlds) {
    RiBegin(RI_NULL);
    RiSphere(1, -1, 1, 360, RI_NULL);
    ASSERT_EQ(gSaid.size(), 1u) << all();
    EXPECT_EQ(gSaid[0].code, RIE_NOTPRIMS);
    RiEnd();
}

TEST_F(CErrors, NobodyIsThere) {
    RiWorldBegin();
    RtPoint p[1] = {};
    EXPECT_EQ(RiTransformPoints("world", "camera", 1, p), nullptr);
    EXPECT_EQ(RiObjectBegin(), nullptr);
    EXPECT_EQ(RiLightSource("pointlight", RI_NULL), nullptr);
    RiEnd();
    EXPECT_EQ(gSaid.size(), 5u) << all();
    for (const Said& s : gSaid) EXPECT_EQ(s.code, RIE_NOTSTARTED);
    EXPECT_EQ(RiGetContext(), nullptr);
    gSaid.clear();
    RiContext(&p);
    ASSERT_EQ(gSaid.size(), 1u);
    EXPECT_EQ(gSaid[0].code, RIE_BADHANDLE);
}

TEST_F(CErrors, InFiles) {
    RiBegin("x.rib");
    RiWorldEnd();
    RiAttributeBegin();
    RiTransformBegin();
    RiAttributeEnd();
    RiTransformEnd();
    RiElse();
    RiWorldBegin();
    EXPECT_EQ(gSaid.size(), 4u) << all();
    RiEnd();
    ASSERT_EQ(gSaid.size(), 5u) << all();
    for (const Said& s : gSaid) EXPECT_EQ(s.code, RIE_NESTING) << s.message;
    RiBegin((dir / "no/such/folder.rib").c_str());
    EXPECT_EQ(gSaid.back().code, RIE_NOFILE);
    EXPECT_EQ(RiGetContext(), nullptr);
}

TEST_F(CErrors, AFullDiskIsSaidOnceAndNotHidden) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP();
    RiBegin("/dev/full");
    RtPoint p[3] = {};
    for (int i = 0; i < 50'000; ++i) RiPolygon(3, "P", p, RI_NULL);
    RiEnd();
    ASSERT_EQ(gSaid.size(), 1u) << all();
    EXPECT_EQ(gSaid[0].code, RIE_DISKFULL);
    EXPECT_EQ(gSaid[0].severity, RIE_SEVERE);
}

TEST_F(CErrors, FiltersOfTheProgram) {
    RiBegin("x.rib");
    RiPixelFilter([](RtFloat x, RtFloat y, RtFloat xw, RtFloat yw) { return 3 * RiMitchellFilter(x, y, xw, yw); }, 4, 4);
    EXPECT_TRUE(gSaid.empty()) << all();
    RiPixelFilter(stairs, 2, 2);
    ASSERT_EQ(gSaid.size(), 1u);
    EXPECT_EQ(gSaid[0].code, RIE_INCAPABLE);
    RiPixelFilter(nullptr, 2, 2);
    EXPECT_EQ(gSaid.back().code, RIE_CONSISTENCY);
    RiEnd();
    EXPECT_NE(text("x.rib").find("PixelFilter \"mitchell\" 4 4\nPixelFilter \"gaussian\" 2 2\n"), std::string::npos);
}

// Some programs pass a text where the address of a string is due.
TEST_F(CErrors, ATextInThePlaceOfAnAddress) {
    if (kSanitized) GTEST_SKIP() << "a short text in the place of an address is read behind its end";
    RiBegin("x.rib");
    RtString right = "right";
    RiAttribute("user", "string a", "on", "string b", &right, "string c", "", RI_NULL);
    EXPECT_EQ(gSaid.size(), 2u) << all();
    for (const Said& s : gSaid) EXPECT_EQ(s.severity, RIE_WARNING);
    // At the end of what can be read, nothing behind it is touched.
    const size_t page = size_t(sysconf(_SC_PAGESIZE));
    auto* end = static_cast<char*>(mmap(nullptr, 2 * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
    ASSERT_NE(end, MAP_FAILED);
    ASSERT_EQ(mprotect(end + page, page, PROT_NONE), 0);
    std::copy_n("off", 4, end + page - 4);
    RiAttribute("user", "string d", end + page - 4, RI_NULL);
    munmap(end, 2 * page);
    RtString none = nullptr;
    gSaid.clear();
    RiAttribute("user", "string e", &none, RI_NULL);
    ASSERT_EQ(gSaid.size(), 1u);
    EXPECT_EQ(gSaid[0].code, RIE_CONSISTENCY);
    RiEnd();
    EXPECT_NE(text("x.rib").find(R"("string a" ["on"] "string b" ["right"] "string c" [""])"), std::string::npos)
        << text("x.rib");
    EXPECT_NE(text("x.rib").find(R"("string d" ["off"])"), std::string::npos) << text("x.rib");
}

// A count that is far too large is reported where the array ends in what cannot be read.
TEST_F(CErrors, CountsBeyondTheArray) {
    const size_t page = size_t(sysconf(_SC_PAGESIZE));
    void* one = mmap(nullptr, 2 * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    ASSERT_NE(one, MAP_FAILED);
    ASSERT_EQ(mprotect(static_cast<char*>(one) + page, page, PROT_NONE), 0);
    RiBegin("x.rib");
    RiPoints(RtInt(page / 12), "P", one, RI_NULL);
    EXPECT_TRUE(gSaid.empty()) << all();
    RiPoints(2 * RtInt(page / 12), "P", one, RI_NULL);
    ASSERT_EQ(gSaid.size(), 1u) << all();
    EXPECT_EQ(gSaid[0].code, RIE_CONSISTENCY);
    RtInt face[1] = {3}, corners[3] = {0, 1, INT32_MAX - 1};
    RiPointsPolygons(1, face, corners, "P", one, RI_NULL);
    EXPECT_EQ(gSaid.size(), 2u) << all();
    RiEnd();
    munmap(one, 2 * page);
}

TEST_F(CErrors, WhatIsPrinted) {
    testing::internal::CaptureStderr();
    RiErrorHandler(RiErrorPrint);
    RiBegin(RI_NULL);
    RiAttributeEnd();
    RiErrorHandler(RiErrorIgnore);
    RiAttributeEnd();
    RiErrorPrint(RIE_RANGE, RIE_WARNING, const_cast<char*>("as a program's own handler may"));
    RiEnd();
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "call:2: error: AttributeEnd without AttributeBegin\n"
                                                      "warning: as a program's own handler may [RIE 42]\n");
    EXPECT_EQ(RiLastError, RIE_NESTING);
}

} // namespace

} // namespace capi_errors_test
