// Every request of the table: its sample is read and executed; the table and RISpec 3.2 agree.
#include "collect.h"
#include "ri/parser.h"
#include "ri/requests/manual.h"
#include "ri/requests/request.h"
#include <set>

namespace table_test {

using namespace alpenglow;
using namespace alpenglow::ri;

TEST(Table, NamesAreSortedAndUnique) {
    const auto& t = requestTable();
    for (size_t i = 1; i < t.size(); ++i) EXPECT_LT(t[i - 1].name, t[i].name);
}

namespace {

/// RISpec 3.2, appendix C.2, the first column.
constexpr const char* kRequestsOfTheReference[] = {"version",
                                                   "Declare",
                                                   "FrameBegin",
                                                   "FrameEnd",
                                                   "WorldBegin",
                                                   "WorldEnd",
                                                   "AttributeBegin",
                                                   "AttributeEnd",
                                                   "TransformBegin",
                                                   "TransformEnd",
                                                   "SolidEnd",
                                                   "ObjectEnd",
                                                   "MotionEnd",
                                                   "ArchiveEnd",
                                                   "IfEnd",
                                                   "Else",
                                                   "ResourceBegin",
                                                   "ResourceEnd",
                                                   "Format",
                                                   "FrameAspectRatio",
                                                   "ScreenWindow",
                                                   "CropWindow",
                                                   "Projection",
                                                   "Clipping",
                                                   "ClippingPlane",
                                                   "DepthOfField",
                                                   "Shutter",
                                                   "PixelVariance",
                                                   "PixelSamples",
                                                   "PixelFilter",
                                                   "Exposure",
                                                   "Imager",
                                                   "Surface",
                                                   "Displacement",
                                                   "Atmosphere",
                                                   "Interior",
                                                   "Exterior",
                                                   "Deformation",
                                                   "Quantize",
                                                   "Display",
                                                   "DisplayChannel",
                                                   "Hider",
                                                   "ColorSamples",
                                                   "RelativeDetail",
                                                   "Option",
                                                   "Attribute",
                                                   "Color",
                                                   "Opacity",
                                                   "TextureCoordinates",
                                                   "LightSource",
                                                   "AreaLightSource",
                                                   "Illuminate",
                                                   "Shader",
                                                   "ShadingRate",
                                                   "ShadingInterpolation",
                                                   "Matte",
                                                   "Bound",
                                                   "Detail",
                                                   "DetailRange",
                                                   "GeometricApproximation",
                                                   "GeometricRepresentation",
                                                   "Orientation",
                                                   "ReverseOrientation",
                                                   "Sides",
                                                   "Identity",
                                                   "Transform",
                                                   "ConcatTransform",
                                                   "Perspective",
                                                   "Translate",
                                                   "Scale",
                                                   "Rotate",
                                                   "Skew",
                                                   "CoordinateSystem",
                                                   "CoordSysTransform",
                                                   "ScopedCoordinateSystem",
                                                   "Polygon",
                                                   "GeneralPolygon",
                                                   "PointsPolygons",
                                                   "PointsGeneralPolygons",
                                                   "Basis",
                                                   "Patch",
                                                   "PatchMesh",
                                                   "NuPatch",
                                                   "TrimCurve",
                                                   "SubdivisionMesh",
                                                   "HierarchicalSubdivisionMesh",
                                                   "Sphere",
                                                   "Cone",
                                                   "Cylinder",
                                                   "Hyperboloid",
                                                   "Paraboloid",
                                                   "Disk",
                                                   "Torus",
                                                   "Points",
                                                   "Curves",
                                                   "Blobby",
                                                   "Geometry",
                                                   "Procedural",
                                                   "SolidBegin",
                                                   "ObjectBegin",
                                                   "ObjectInstance",
                                                   "MotionBegin",
                                                   "MakeTexture",
                                                   "MakeBump",
                                                   "MakeLatLongEnvironment",
                                                   "MakeCubeFaceEnvironment",
                                                   "MakeShadow",
                                                   "MakeBrickMap",
                                                   "ErrorHandler",
                                                   "ReadArchive",
                                                   "ArchiveBegin",
                                                   "IfBegin",
                                                   "ElseIf",
                                                   "Resource",
                                                   "System"};

} // namespace

TEST(Table, HoldsEveryRequestOfTheReference) {
    for (const char* n : kRequestsOfTheReference) EXPECT_NE(findRequest(n), nullptr) << n;
    EXPECT_EQ(findRequest("Options"), nullptr); // docs/rib.md: no such call
}

TEST(Table, EveryEntryIsComplete) {
    for (const Request& r : requestTable()) {
        EXPECT_FALSE(r.doc.empty()) << r.name;
        EXPECT_NE(r.handler, nullptr) << r.name;
        EXPECT_NE(r.scopes, 0u) << r.name;
        EXPECT_EQ(r.matrix != nullptr, r.kind == Kind::Transform && r.motion) << r.name;
        for (const ArgSpec& a : r.args) EXPECT_FALSE(a.name.empty()) << r.name;
    }
}

TEST(Table, EverySampleParses) {
    for (const Request& r : requestTable()) {
        Diagnostics d;
        Reporter reporter(d);
        std::string text = std::string(r.name) + " " + std::string(r.sample) + "\n";
        Parser parser(memorySource(text), "sample", reporter);
        Call call;
        ASSERT_TRUE(parser.next(call)) << text;
        EXPECT_EQ(call.request, &r);
        ASSERT_EQ(call.arguments.size(), r.args.size()) << text;
        for (size_t i = 0; i < r.args.size(); ++i) EXPECT_TRUE(call.given(i) || r.args[i].optional) << text;
        EXPECT_FALSE(parser.next(call)) << text;
        EXPECT_TRUE(d.all().empty()) << text << (d.all().empty() ? "" : toString(d.all()[0]));
    }
}

TEST(Table, EveryArgumentIsMissed) {
    // Without its arguments, a request that needs some is refused with the place of its name.
    for (const Request& r : requestTable()) {
        bool needs = false;
        for (const ArgSpec& a : r.args) needs = needs || !a.optional;
        if (!needs) continue;
        Diagnostics d;
        Reporter reporter(d);
        std::string text = "  " + std::string(r.name) + "\n";
        Parser parser(memorySource(text), "sample", reporter);
        Call call;
        if (r.args[0].form == ArgSpec::Form::Handle && r.parameters) continue;
        EXPECT_FALSE(parser.next(call)) << text;
        ASSERT_EQ(d.all().size(), 1u) << text;
        EXPECT_EQ(d.all()[0].code, Rie::MissingData) << text;
        EXPECT_EQ(d.all()[0].place.line, 1);
        EXPECT_EQ(d.all()[0].place.column, 3);
    }
}

TEST(Table, EverySampleExecutesInItsScope) {
    for (const Request& r : requestTable()) {
        std::string name(r.name), text = name + " " + std::string(r.sample) + "\n", before, after;
        if (name == "ReadArchive") before = "ArchiveBegin \"part.rib\"\nColor 1 0 0\nArchiveEnd\n";
        if (name == "ObjectInstance") before = "ObjectBegin 1\nSphere 1 -1 1 360\nObjectEnd\n";
        if (name == "Illuminate") before = "LightSource \"pointlight\" 1\n";
        if (name == "ElseIf" || name == "Else") before = "IfBegin \"0\"\n", after = "IfEnd\n";
        if (name == "MotionBegin") after = "Sphere 1 -1 1 360\nSphere 2 -2 2 360\nMotionEnd\n";
        if (name == "MotionEnd") before = "MotionBegin [0 1]\nTranslate 0 0 0\nTranslate 0 0 1\n";
        if (name == "IfEnd") before = "IfBegin \"1\"\n";
        if (name.ends_with("Begin") && name != "MotionBegin")
            after = (name == "IfBegin" ? "IfEnd" : name.substr(0, name.size() - 5) + "End") + "\n";
        if (name.ends_with("End") && name != "MotionEnd" && name != "IfEnd") {
            std::string begin = name.substr(0, name.size() - 3) + "Begin";
            const Request* b = findRequest(begin);
            ASSERT_NE(b, nullptr);
            before = begin + " " + std::string(b->sample) + "\n";
        }
        if (name.starts_with("EditWorld")) before = "ArchiveBegin \"part.rib\"\nColor 1 0 0\nArchiveEnd\n" + before;
        std::string whole = before + text + after;
        bool ownWorld = name.starts_with("World") || name.starts_with("Frame");
        if (!ownWorld && !(r.scopes & kBase)) whole = "WorldBegin\n" + whole + "WorldEnd\n";
        if (name == "SolidBegin" || name == "SolidEnd" || name == "AttributeEnd" || name == "MotionBegin" || name == "MotionEnd")
            whole = "WorldBegin\n" + before + text + after + "WorldEnd\n";
        auto c = read(whole);
        const bool foreign = text.find("RunProgram") != text.npos; // needs --allow-exec
        EXPECT_EQ(c->ok, !foreign) << whole << c->messages();
        for (const Diagnostic& d : c->diagnostics.all()) EXPECT_EQ(d.code, Rie::Incapable) << whole << toString(d);
    }
}

TEST(Table, ManualNamesEveryRequest) {
    std::string m = requestManual();
    for (const Request& r : requestTable()) EXPECT_NE(m.find("\n| " + std::string(r.name) + " | "), std::string::npos) << r.name;
}

} // namespace table_test
