// The table of requests against ri.h: every request has a call, in both forms where it has a parameter list, and what is called
// is what the same request in a file is.
#include "recorder.h"
#include "ri/parser.h"
#include "ri/requests/header.h"
#include "ri/requests/request.h"
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <map>
#include <sstream>

namespace capi_table_test {

using namespace alpenglow;
using namespace alpenglow::ri;

namespace {

/// Both forms of a call with the arguments that the table has as a sample. arrays: null where there is one form.
struct Sample {
    std::function<void()> list, arrays;
};

#define PLAIN(name, ...)                                                                                                         \
    {                                                                                                                            \
        #name, {                                                                                                                 \
            [] { Ri##name(__VA_ARGS__); }, {}                                                                                    \
        }                                                                                                                        \
    }
/// of: the arguments before the parameter list, in parentheses.
#define OPEN(...) __VA_ARGS__
#define NONE(name, of)                                                                                                           \
    {                                                                                                                            \
        #name, {                                                                                                                 \
            [] { Ri##name(OPEN of, RI_NULL); }, [] { Ri##name##V(OPEN of, 0, nullptr, nullptr); }                                \
        }                                                                                                                        \
    }
#define ONE(name, of, token, value)                                                                                              \
    {                                                                                                                            \
        #name, {                                                                                                                 \
            [] { Ri##name(OPEN of, token, RtPointer(value), RI_NULL); }, [] {                                                    \
                RtToken tokens[] = {token};                                                                                      \
                RtPointer values[] = {RtPointer(value)};                                                                         \
                Ri##name##V(OPEN of, 1, tokens, values);                                                                         \
            }                                                                                                                    \
        }                                                                                                                        \
    }
#define TWO(name, of, token1, value1, token2, value2)                                                                            \
    {                                                                                                                            \
        #name, {                                                                                                                 \
            [] { Ri##name(OPEN of, token1, RtPointer(value1), token2, RtPointer(value2), RI_NULL); }, [] {                       \
                RtToken tokens[] = {token1, token2};                                                                             \
                RtPointer values[] = {RtPointer(value1), RtPointer(value2)};                                                     \
                Ri##name##V(OPEN of, 2, tokens, values);                                                                         \
            }                                                                                                                    \
        }                                                                                                                        \
    }

RtFloat kHalfToHalf[] = {.4f}, kTenth[] = {.1f}, kTwo[] = {2}, kTen[] = {10}, kFive[] = {5}, kThirty[] = {30};
RtFloat kUp[] = {0, 1, 0}, kWhite[] = {1, 1, 1}, kOrange[] = {1, .5f, 0}, kGrey[] = {.5f, .5f, .5f}, kNight[] = {0, 0, .2f};
RtFloat kTriangle[] = {0, 0, 0, 1, 0, 0, 1, 1, 0}, kQuad[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
RtFloat kCorners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, kHeights[] = {0, 0, 0, 1};
RtFloat kTwoPoints[] = {0, 0, 0, 1, 0, 0}, kFourPoints[] = {0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0}, kWidths[] = {.1f, .2f};
RtFloat kSkin[] = {.5f, .4f, .3f}, kRed[] = {1, 0, 0};
RtInt k6[] = {6};
RtFloat kFourColors[] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}, kKnots[] = {0, 0, 1, 1}, kTimes[] = {0, 1};
RtFloat kRange255[] = {0, 255, 0, 255};
RtBound kBound = {-1, 1, -1, 1, -1, 1};
RtMatrix kMoved = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {1, 2, 3, 1}};
RtMatrix kDoubled = {{2, 0, 0, 0}, {0, 2, 0, 0}, {0, 0, 2, 0}, {0, 0, 0, 1}};
RtFloat kIdentity[] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
RtPoint kFrom = {1, 0, 0}, kTo = {1, 1, 1};
RtInt k1[] = {1}, k3[] = {3}, k4[] = {4}, k33[] = {3, 3}, k012[] = {0, 1, 2}, k012023[] = {0, 1, 2, 0, 2, 3};
RtInt kCreaseArgs[] = {2, 1}, k01[] = {0, 1}, kHoleArgs[] = {1, 0, 0}, kBlob[] = {1001, 0}, kNoCells[] = {0, 0, 0};
RtString kBall[] = {"ball"}, kPath[] = {"shaders:@"}, kSave[] = {"save"}, kBox[] = {"box"}, kLamp[] = {"lamp"}, kNothing[] = {""};
RtString kMatte[] = {"matte.exr"}, kObjectName[] = {"identifier:name"};
RtString kCrease[] = {"crease"}, kHole[] = {"hole"}, kCloud[] = {"a.ptc"}, kDepths[] = {"a.z", "b.z"};
RtInt kTrim[] = {1}, kTrimOrder[] = {2}, kTrimN[] = {3};
RtFloat kTrimKnot[] = {0, 0, 1, 2, 2}, kTrimMin[] = {0}, kTrimMax[] = {2}, kTrimU[] = {0, 1, 0}, kTrimV[] = {0, 0, 0};
RtFloat kSpectrum[] = {1, 1, 1}, kBack[] = {.3f, .3f, .4f};
RtObjectHandle kFirst = RtObjectHandle(1);
RtString kProgram[] = {"maker", "data"};

const std::map<std::string_view, Sample> kSamples = {
    PLAIN(Declare, "myparam", "varying color"),
    PLAIN(FrameBegin, 1),
    PLAIN(FrameEnd),
    PLAIN(WorldBegin),
    PLAIN(WorldEnd),
    PLAIN(AttributeBegin),
    PLAIN(AttributeEnd),
    PLAIN(TransformBegin),
    PLAIN(TransformEnd),
    PLAIN(SolidBegin, "union"),
    PLAIN(SolidEnd),
    PLAIN(ObjectBegin),
    PLAIN(ObjectEnd),
    {"MotionBegin", {[] { RiMotionBegin(2, 0., 1.); }, [] { RiMotionBeginV(2, kTimes); }}},
    PLAIN(MotionEnd),
    PLAIN(ResourceBegin),
    PLAIN(ResourceEnd),
    ONE(Resource, ("a", "attributes"), "string operation", kSave),
    NONE(IfBegin, ("1 == 1")),
    NONE(ElseIf, ("0")),
    PLAIN(Else),
    PLAIN(IfEnd),
    PLAIN(Format, 640, 480, 1),
    PLAIN(FrameAspectRatio, 1.333f),
    PLAIN(ScreenWindow, -1, 1, -1, 1),
    PLAIN(CropWindow, 0, .5f, .25f, 1),
    ONE(Projection, ("perspective"), "fov", kThirty),
    PLAIN(Clipping, .1f, 1000),
    PLAIN(ClippingPlane, 0, 0, 5, 0, 0, 1),
    PLAIN(DepthOfField, 2.8f, .05f, 3),
    PLAIN(Shutter, 0, 1),
    PLAIN(PixelVariance, .01f),
    PLAIN(PixelSamples, 4, 4),
    PLAIN(PixelFilter, RiGaussianFilter, 2, 2),
    PLAIN(Exposure, 1, 2.2f),
    ONE(Imager, ("background"), "bgcolor", kNight),
    PLAIN(Quantize, "rgba", 255, 0, 255, .5f),
    ONE(Display, ("a.tif", "tiff", "rgba"), "quantize", kRange255),
    ONE(DisplayChannel, ("varying color diffuse"), "string filter", kBox),
    ONE(Hider, ("hidden"), "jitter", k1),
    PLAIN(ColorSamples, 1, kSpectrum, kBack),
    PLAIN(RelativeDetail, 1),
    ONE(Option, ("searchpath"), "shader", kPath),
    NONE(Camera, ("side")),
    PLAIN(Color, kOrange),
    PLAIN(Opacity, kGrey),
    PLAIN(TextureCoordinates, 0, 0, 1, 0, 0, 1, 1, 1),
    PLAIN(ShadingRate, .5f),
    PLAIN(ShadingInterpolation, "smooth"),
    PLAIN(Matte, RI_TRUE),
    PLAIN(Bound, kBound),
    PLAIN(Detail, kBound),
    PLAIN(DetailRange, 0, 10, 100, 200),
    PLAIN(GeometricApproximation, "motionfactor", 1),
    PLAIN(GeometricRepresentation, "primitive"),
    PLAIN(Orientation, "outside"),
    PLAIN(ReverseOrientation),
    PLAIN(Sides, 2),
    PLAIN(Basis, RiBezierBasis, RI_BEZIERSTEP, RiBSplineBasis, RI_BSPLINESTEP),
    PLAIN(TrimCurve, 1, kTrim, kTrimOrder, kTrimKnot, kTrimMin, kTrimMax, kTrimN, kTrimU, kTrimV, kWhite),
    ONE(Attribute, ("identifier"), "name", kBall),
    TWO(Surface, ("plastic"), "Kd", kHalfToHalf, "specularcolor", kWhite),
    ONE(Displacement, ("bumpy"), "amplitude", kTenth),
    ONE(Atmosphere, ("fog"), "distance", kFive),
    NONE(Interior, ("fog")),
    NONE(Exterior, ("fog")),
    ONE(Shader, ("layer", "base"), "uniform float gain", kTwo),
    TWO(LightSource, ("pointlight"), "intensity", kTen, "from", kUp),
    TWO(AreaLightSource, ("arealight"), "intensity", kFive, "__handleid", kLamp),
    PLAIN(Illuminate, kFirst, RI_FALSE),
    ONE(Bxdf, ("PxrDiffuse", "b"), "color diffuseColor", kSkin),
    ONE(Displace, ("PxrDisplace", "d"), "float dispAmount", kTenth),
    ONE(Pattern, ("PxrChecker", "t"), "color colorA", kRed),
    ONE(Light, ("PxrRectLight", "l"), "float intensity", kTwo),
    ONE(LightFilter, ("PxrRodLightFilter", "f"), "float edge", kTenth),
    PLAIN(EnableLightFilter, "l", "f", RI_TRUE),
    ONE(Integrator, ("PxrPathTracer", "i"), "int maxPathLength", k6),
    NONE(DisplayFilter, ("PxrGrade", "g")),
    TWO(SampleFilter, ("PxrCryptomatte", "c"), "string filename", kMatte, "string layer", kObjectName),
    NONE(PixelSampleImager, ("bg")),
    NONE(VPAtmosphere, ("fog")),
    NONE(VPInterior, ("fog")),
    NONE(VPSurface, ("fog")),
    PLAIN(Identity),
    PLAIN(Transform, kMoved),
    PLAIN(ConcatTransform, kDoubled),
    PLAIN(Perspective, 45),
    PLAIN(Translate, 1, 2, 3),
    PLAIN(Rotate, 90, 0, 0, 1),
    PLAIN(Scale, 2, 2, 2),
    PLAIN(Skew, 45, 0, 1, 0, 1, 0, 0),
    NONE(Deformation, ("bend")),
    PLAIN(CoordinateSystem, "lamp"),
    PLAIN(ScopedCoordinateSystem, "lamp"),
    PLAIN(CoordSysTransform, "camera"),
    ONE(Polygon, (3), "P", kTriangle),
    ONE(GeneralPolygon, (1, k3), "P", kTriangle),
    ONE(PointsPolygons, (1, k3, k012), "P", kTriangle),
    ONE(PointsGeneralPolygons, (1, k1, k3, k012), "P", kTriangle),
    ONE(Patch, ("bilinear"), "P", kCorners),
    ONE(PatchMesh, ("bilinear", 2, "nonperiodic", 2, "nonperiodic"), "Pz", kHeights),
    ONE(NuPatch, (2, 2, kKnots, 0, 1, 2, 2, kKnots, 0, 1), "P", kCorners),
    ONE(SubdivisionMesh, ("catmull-clark", 2, k33, k012023, 1, kCrease, kCreaseArgs, k01, kTen), "P", kQuad),
    ONE(HierarchicalSubdivisionMesh, ("catmull-clark", 2, k33, k012023, 1, kHole, kHoleArgs, k1, nullptr, nullptr), "P", kQuad),
    NONE(Sphere, (1, -1, 1, 360)),
    NONE(Cone, (2, 1, 360)),
    NONE(Cylinder, (1, -1, 1, 360)),
    NONE(Hyperboloid, (kFrom, kTo, 360)),
    NONE(Paraboloid, (1, 0, 2, 360)),
    ONE(Disk, (0, 1, 360), "Cs", kFourColors),
    NONE(Torus, (2, .5f, 0, 360, 360)),
    TWO(Points, (2), "P", kTwoPoints, "constantwidth", kTenth),
    TWO(Curves, ("cubic", 1, k4, "nonperiodic"), "P", kFourPoints, "width", kWidths),
    NONE(Blobby, (1, 2, kBlob, 16, kIdentity, 1, kNothing)),
    NONE(Geometry, ("teapot")),
    NONE(Volume, ("box", kBound, kNoCells)),
    PLAIN(Procedural, kProgram, kBound, RiProcRunProgram, nullptr),
    PLAIN(ObjectInstance, kFirst),
    NONE(ReadArchive, ("part.rib", nullptr)),
    NONE(ArchiveBegin, ("part")),
    PLAIN(ArchiveEnd),
    PLAIN(ArchiveRecord, "comment", "by %s", "hand"),
    PLAIN(System, "ls"),
    NONE(MakeTexture, ("a.tif", "a.tx", "periodic", "clamp", RiBoxFilter, 1, 1)),
    NONE(MakeBump, ("a.tif", "a.tx", "black", "black", RiGaussianFilter, 2, 2)),
    NONE(MakeLatLongEnvironment, ("a.tif", "a.env", RiBoxFilter, 1, 1)),
    NONE(MakeCubeFaceEnvironment, ("a", "b", "c", "d", "e", "f", "g.env", 90, RiBoxFilter, 1, 1)),
    NONE(MakeShadow, ("a.z", "a.shd")),
    NONE(MakeBrickMap, (1, kCloud, "a.bkm")),
    NONE(MakeOcclusion, (2, kDepths, "a.shd")),
};

/// The request with the table's arguments, as a file has it.
Call inFile(const Request& r) {
    Diagnostics d;
    Reporter reporter(d);
    Parser parser(memorySource(std::string(r.name) + " " + std::string(r.sample)), "sample", reporter);
    Call c;
    EXPECT_TRUE(parser.next(c)) << r.name;
    return c;
}

void expectSame(const Call& file, const Call& called, const std::string& what) {
    ASSERT_EQ(file.request, called.request) << what;
    ASSERT_EQ(file.arguments.size(), called.arguments.size()) << what;
    for (size_t i = 0; i < file.arguments.size(); ++i) {
        EXPECT_EQ(file.arguments[i].given, called.arguments[i].given) << what << " argument " << i;
        EXPECT_EQ(file.arguments[i].numbers, called.arguments[i].numbers) << what << " argument " << i;
        EXPECT_EQ(file.arguments[i].strings, called.arguments[i].strings) << what << " argument " << i;
    }
    ASSERT_EQ(file.params.size(), called.params.size()) << what;
    for (size_t i = 0; i < file.params.size(); ++i) {
        EXPECT_EQ(file.params[i].token, called.params[i].token) << what;
        EXPECT_EQ(file.params[i].value.strings, called.params[i].value.strings) << what;
        const auto &a = file.params[i].value.numbers, &b = called.params[i].value.numbers;
        ASSERT_EQ(a.size(), b.size()) << what << " " << file.params[i].token;
        for (size_t k = 0; k < a.size(); ++k) EXPECT_EQ(float(a[k]), float(b[k])) << what << " " << file.params[i].token;
    }
}

void expectCalls(const Request& r, const std::function<void()>& call, const char* form) {
    const std::string what = "Ri" + std::string(r.name) + form;
    Recorder recorder;
    recorder.serial = r.name == "AreaLightSource" ? 7 : 0;
    call();
    EXPECT_EQ(recorder.said(), "") << what;
    ASSERT_EQ(recorder.calls.size(), 1u) << what;
    expectSame(inFile(r), recorder.calls[0], what);
}

TEST(CBinding, EveryRequestIsCalledWithTheTablesSample) {
    int forms = 0;
    for (const Request& r : requestTable()) {
        if (withoutCall(r.name)) continue;
        const auto s = kSamples.find(r.name);
        ASSERT_NE(s, kSamples.end()) << r.name << " has no call in this test";
        expectCalls(r, s->second.list, "");
        const bool two = s->second.arrays != nullptr;
        EXPECT_EQ(two, (r.parameters && !hasOneForm(r.name)) || r.name == "MotionBegin") << r.name;
        if (two) expectCalls(r, s->second.arrays, "V");
        forms += two ? 2 : 1;
    }
    EXPECT_GT(forms, 160);
}

// Made by `alpenglow info --requests --header`, so that prototypes come from the table.
TEST(CBinding, TheHeaderIsThatOfTheTable) {
    std::ifstream in(ALPENGLOW_SOURCE_DIR "/include/ri.h");
    std::stringstream text;
    text << in.rdbuf();
    const std::string header = text.str();
    const size_t begin = header.find(kPrototypesBegin), end = header.find(kPrototypesEnd);
    ASSERT_NE(begin, header.npos);
    ASSERT_NE(end, header.npos);
    const size_t from = begin + kPrototypesBegin.size();
    EXPECT_EQ(header.substr(from, end - from), callPrototypes());
    for (const Request& r : requestTable()) {
        const std::string name = " Ri" + std::string(r.name);
        if (withoutCall(r.name)) continue;
        EXPECT_NE(header.find(name + "("), header.npos) << name;
        if (r.parameters) EXPECT_EQ(header.find(name + "V(") == header.npos, hasOneForm(r.name)) << name;
    }
}

} // namespace

} // namespace capi_table_test
