// Calls in any order with any arguments, as long as arrays have the lengths that are said: nothing ends the program, in a context
// that draws and in one that writes. Under the sanitizers (./check --asan) no byte beyond an array is touched.
#include "folder.h"
#include "sanitized.h"
#include <cstdlib>
#include <random>
#include <ri.h>

namespace capi_random_test {

using namespace alpenglow;

namespace {

class RandomCalls : public capi::testing::Folder {
protected:
    void SetUp() override {
        Folder::SetUp();
        RiErrorHandler(RiErrorIgnore);
    }
    void TearDown() override {
        while (RiGetContext()) RiEnd();
        RiErrorHandler(RiErrorPrint);
        Folder::TearDown();
    }
};

/// Arguments. Every array is as long as any call may ask for.
class Arguments {
public:
    explicit Arguments(unsigned seed) : random_(seed), floats_(kLength), ints_(kLength), tokens_(kLength, "P") {}
    int below(int n) { return int(random_() % unsigned(n)); }
    RtFloat number() {
        static const RtFloat kOdd[] = {0, -1, 1e38f, -1e38f, 1e-30f, NAN, INFINITY, -INFINITY, 360, .5f};
        return below(4) ? RtFloat(below(2000)) / 500 - 2 : kOdd[below(10)];
    }
    RtInt count() { return below(12) ? below(9) : below(2) ? -1 - below(9) : 0; }
    RtInt integer() { return below(8) ? below(9) : std::array<RtInt, 4>{-1, INT32_MAX, INT32_MIN, 1 << 20}[size_t(below(4))]; }
    /// Numbers; of an array whose entries are counts no entry is large.
    RtFloat* floats() {
        if (!below(20)) return nullptr;
        for (int i = 0; i < 64; ++i) floats_[size_t(i)] = number();
        return floats_.data();
    }
    RtInt* ints() {
        if (!below(20)) return nullptr;
        for (int i = 0; i < 64; ++i) ints_[size_t(i)] = below(20) ? below(5) : -below(3);
        return ints_.data();
    }
    RtToken name() {
        static const RtToken kNames[] = {"matte",      "bilinear", "bicubic",         "periodic", "nonperiodic", "P",
                                         "cubic",      "linear",   "world",           "union",    "rgba",        "catmull-clark",
                                         "outside",    "nosuch",   "searchpath",      "",         "primitive",   "plastic",
                                         "pointlight", "[",        "varying color Cs"};
        return below(20) ? kNames[below(21)] : nullptr;
    }
    /// Tokens of known lengths of their values, which are as long as any call may ask for.
    struct List {
        RtInt n;
        RtToken* tokens;
        RtPointer* values;
    };
    List list() {
        static const RtToken kTokens[] = {
            "P",  "N",  "Cs",    "st",          "constant float a", "uniform color[3] b", "vertex hpoint Pw",
            "Ks", "Pz", "width", "integer bad", "not declared",     "varying matrix m",   "[ ] x"};
        static RtToken chosen[4];
        static RtPointer values[4];
        const RtInt n = below(4);
        for (int i = 0; i < n; ++i) {
            chosen[i] = below(30) ? kTokens[below(14)] : nullptr;
            values[i] = below(30) ? floats_.data() : nullptr;
        }
        return {below(40) ? n : -n, below(40) ? chosen : nullptr, below(40) ? values : nullptr};
    }
    RtToken* names() {
        for (int i = 0; i < 16; ++i) tokens_[size_t(i)] = below(9) ? "crease" : name();
        return below(20) ? tokens_.data() : nullptr;
    }

private:
    static constexpr size_t kLength = 1 << 16;
    std::mt19937 random_;
    std::vector<RtFloat> floats_;
    std::vector<RtInt> ints_;
    std::vector<RtToken> tokens_;
};

#define LIST l.n, l.tokens, l.values

void shape(Arguments& a) {
    const auto l = a.list();
    auto* m = reinterpret_cast<RtFloat(*)[3]>(a.floats());
    switch (a.below(18)) {
    case 0:
        return RiPolygonV(a.count(), LIST);
    case 1:
        return RiGeneralPolygonV(a.count(), a.ints(), LIST);
    case 2:
        return RiPointsPolygonsV(a.count(), a.ints(), a.ints(), LIST);
    case 3:
        return RiPointsGeneralPolygonsV(a.count(), a.ints(), a.ints(), a.ints(), LIST);
    case 4:
        return RiPatchV(a.name(), LIST);
    case 5:
        return RiPatchMeshV(a.name(), a.count(), a.name(), a.count(), a.name(), LIST);
    case 6:
        return RiNuPatchV(a.count(), a.count(), a.floats(), a.number(), a.number(), a.count(), a.count(), a.floats(), a.number(),
                          a.number(), LIST);
    case 7:
        return RiSubdivisionMeshV(a.name(), a.count(), a.ints(), a.ints(), a.count(), a.names(), a.ints(), a.ints(), a.floats(),
                                  LIST);
    case 8:
        return RiHierarchicalSubdivisionMeshV(a.name(), a.count(), a.ints(), a.ints(), a.count(), a.names(), a.ints(), a.ints(),
                                              a.floats(), a.names(), LIST);
    case 9:
        return RiSphereV(a.number(), a.number(), a.number(), a.number(), LIST);
    case 10:
        return RiHyperboloidV(m ? m[0] : nullptr, m ? m[1] : nullptr, a.number(), LIST);
    case 11:
        return RiTorusV(a.number(), a.number(), a.number(), a.number(), a.number(), LIST);
    case 12:
        return RiPointsV(a.count(), LIST);
    case 13:
        return RiCurvesV(a.name(), a.count(), a.ints(), a.name(), LIST);
    case 14:
        return RiBlobbyV(a.count(), a.count(), a.ints(), a.count(), a.floats(), a.count(), a.names(), LIST);
    case 15:
        return RiGeometryV(a.name(), LIST);
    case 16:
        return RiVolumeV(a.name(), a.floats(), a.ints(), LIST);
    default:
        return RiDiskV(a.number(), a.number(), a.number(), LIST);
    }
}

void attribute(Arguments& a) {
    const auto l = a.list();
    auto* m = reinterpret_cast<RtFloat(*)[4]>(a.floats());
    switch (a.below(30)) {
    case 0:
        return RiColor(a.floats());
    case 1:
        return RiOpacity(a.floats());
    case 2:
        return RiShadingRate(a.number());
    case 3:
        return RiShadingInterpolation(a.name());
    case 4:
        return RiBound(a.floats());
    case 5:
        return RiDetail(a.floats());
    case 6:
        return RiDetailRange(a.number(), a.number(), a.number(), a.number());
    case 7:
        return RiGeometricApproximation(a.name(), a.number());
    case 8:
        return RiOrientation(a.name());
    case 9:
        return RiSides(a.integer());
    case 10:
        return RiBasis(m, a.integer(), m, a.integer());
    case 11:
        return RiBasis(RiBSplineBasis, 1, RiPowerBasis, 4);
    case 12:
        return RiTrimCurve(a.count(), a.ints(), a.ints(), a.floats(), a.floats(), a.floats(), a.ints(), a.floats(), a.floats(),
                           a.floats());
    case 13:
        return RiAttributeV(a.name(), LIST);
    case 14:
        return RiSurfaceV(a.name(), LIST);
    case 15:
        return RiShaderV(a.name(), a.name(), LIST);
    case 16:
        return RiIlluminate(RiLightSourceV(a.name(), LIST), RtBoolean(a.below(2)));
    case 17:
        return RiIlluminate(RtLightHandle(uintptr_t(a.below(1000)) << a.below(50)), RI_TRUE);
    case 18:
        return RiTransform(m);
    case 19:
        return RiConcatTransform(m);
    case 20:
        return RiPerspective(a.number());
    case 21:
        return RiTranslate(a.number(), a.number(), a.number());
    case 22:
        return RiRotate(a.number(), a.number(), a.number(), a.number());
    case 23:
        return RiScale(a.number(), a.number(), a.number());
    case 24:
        return RiSkew(a.number(), a.number(), a.number(), a.number(), a.number(), a.number(), a.number());
    case 25:
        return RiCoordinateSystem(a.name());
    case 26:
        return RiCoordSysTransform(a.name());
    case 27:
        RiDeclare(a.name(), a.name());
        return;
    case 28:
        RiTransformPoints(a.name(), a.name(), a.count(), reinterpret_cast<RtPoint*>(a.floats()));
        return;
    default:
        return RiIdentity();
    }
}

void option(Arguments& a) {
    const auto l = a.list();
    switch (a.below(16)) {
    case 0:
        return RiFrameAspectRatio(a.number());
    case 1:
        return RiScreenWindow(a.number(), a.number(), a.number(), a.number());
    case 2:
        return RiCropWindow(a.number(), a.number(), a.number(), a.number());
    case 3:
        return RiProjectionV(a.name(), LIST);
    case 4:
        return RiClipping(a.number(), a.number());
    case 5:
        return RiClippingPlane(a.number(), a.number(), a.number(), a.number(), a.number(), a.number());
    case 6:
        return RiDepthOfField(a.number(), a.number(), a.number());
    case 7:
        return RiShutter(a.number(), a.number());
    case 8:
        return RiPixelFilter(a.below(9) ? RiSincFilter : nullptr, a.number(), a.number());
    case 9:
        return RiExposure(a.number(), a.number());
    case 10:
        return RiQuantize(a.name(), a.integer(), a.integer(), a.integer(), a.number());
    case 11:
        return RiHiderV(a.name(), LIST);
    case 12:
        return RiColorSamples(a.count(), a.floats(), a.floats());
    case 13:
        return RiRelativeDetail(a.number());
    case 14:
        return RiOptionV(a.name(), LIST);
    default:
        return RiErrorHandler(RiErrorIgnore);
    }
}

void block(Arguments& a) {
    const auto l = a.list();
    static RtObjectHandle object = nullptr;
    switch (a.below(28)) {
    case 0:
        return RiAttributeBegin();
    case 1:
        return RiAttributeEnd();
    case 2:
        return RiTransformBegin();
    case 3:
        return RiTransformEnd();
    case 4:
        return RiFrameBegin(a.integer());
    case 5:
        return RiFrameEnd();
    case 6:
        return RiWorldBegin();
    case 7:
        return RiSolidBegin(a.name());
    case 8:
        return RiSolidEnd();
    case 9:
        object = RiObjectBegin();
        return;
    case 10:
        return RiObjectEnd();
    case 11:
        return RiObjectInstance(object);
    case 12:
        return RiMotionBeginV(a.count(), a.floats());
    case 13:
        return RiMotionEnd();
    case 14:
        return RiResourceBegin();
    case 15:
        return RiResourceEnd();
    case 16:
        return RiResourceV(a.name(), a.name(), LIST);
    case 17:
        return RiIfBeginV(a.name(), LIST);
    case 18:
        return RiElse();
    case 19:
        return RiElseIfV(a.name(), LIST);
    case 20:
        return RiIfEnd();
    case 21:
        RiArchiveBeginV("part", LIST);
        return;
    case 22:
        return RiArchiveEnd();
    case 23:
        return RiReadArchiveV(a.below(2) ? "part" : a.name(), nullptr, LIST);
    case 24:
        return RiArchiveRecord(a.name(), "Sides %d", a.integer());
    case 25:
        return RiArchiveRecord("verbatim", "AttributeBegin Sides %d", a.integer());
    case 26: {
        static int depth = 0;
        if (depth > 3) return;
        ++depth;
        RiProcedural(
            &a, a.floats(),
            [](RtPointer data, RtFloat) {
                auto& inner = *static_cast<Arguments*>(data);
                for (int i = 0; i < 4; ++i) inner.below(2) ? shape(inner) : block(inner);
            },
            nullptr);
        --depth;
        return;
    }
    default:
        return RiWorldEnd();
    }
}

void call(Arguments& a) {
    const int kind = a.below(10);
    if (kind < 4) shape(a);
    else if (kind < 7) attribute(a);
    else if (kind < 8) option(a);
    else block(a);
}

TEST_F(RandomCalls, NothingEndsTheProgram) {
    int drawn = 0;
    const char* only = std::getenv("ALPENGLOW_RANDOM_SEED"); // to look at one
    const unsigned first = only ? unsigned(std::strtoul(only, nullptr, 10)) : 1, last = only ? first : kSanitized ? 12 : 20;
    for (unsigned seed = first; seed <= last; ++seed)
        for (const char* name : {static_cast<const char*>(nullptr), "out.rib"}) {
            Arguments a(seed);
            RiBegin(name);
            RiFormat(4, 4, 1);
            RiDisplay("x.exr", "openexr", "rgba", RI_NULL);
            RiPixelSamples(1, 1);
            if (a.below(2)) RiWorldBegin();
            for (int i = 0; i < 250; ++i) call(a);
            RiEnd();
            ++drawn;
            EXPECT_EQ(RiGetContext(), nullptr);
        }
    EXPECT_GE(drawn, only ? 2 : 20);
    EXPECT_TRUE(std::filesystem::exists(dir / "out.rib"));
}

} // namespace

} // namespace capi_random_test
