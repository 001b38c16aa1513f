// Declarations and the counts of primitive variables (docs/design/ri.md).
#include "collect.h"
#include "ri/declare.h"
#include "scene/counts.h"

namespace variables_test {

using namespace alpenglow;
using namespace alpenglow::ri;
using scene::Class;
using scene::Type;

TEST(Declarations, Parse) {
    auto d = parseDeclaration("varying color[3]");
    ASSERT_TRUE(d);
    EXPECT_EQ(d->cls, Class::Varying);
    EXPECT_EQ(d->type, Type::Color);
    EXPECT_EQ(d->arrayLength, 3);
    EXPECT_EQ(parseDeclaration("int")->type, Type::Integer);
    EXPECT_EQ(parseDeclaration("float")->cls, Class::Uniform);
    EXPECT_EQ(parseDeclaration(" facevertex \t hpoint [ 2 ] ")->arrayLength, 2);
    for (const auto& [text, length] : {std::pair{"vertex mpoint", 4}, {"vertex mpoint[3]", 12}}) { // rows of matrices
        EXPECT_EQ(parseDeclaration(text)->type, Type::HPoint);
        EXPECT_EQ(parseDeclaration(text)->arrayLength, length);
    }
    EXPECT_FALSE(parseDeclaration("vertex mpoint[2147483647]"));
    for (const char* bad : {"", "varying", "colour", "float[0]", "float[-1]", "float[", "float]", "float[2147483648]",
                            "color varying", "float x y"})
        EXPECT_FALSE(parseDeclaration(bad)) << bad;
    EXPECT_EQ(read("Declare \"x\" \"colour\"")->only().code, Rie::Syntax);
    // VTK's exporter declares all its arrays so.
    for (const char* given : {"Declare \"e\" \"varying double\" Polygon \"P\" [0 0 0 1 0 0 1 1 0] \"e\" [1 2 3]",
                              "Polygon \"P\" [0 0 0 1 0 0 1 1 0] \"varying double e\" [1 2 3]"}) {
        const auto c = inWorld(given);
        EXPECT_EQ(c->only().severity, Severity::Warning) << c->messages();
        const scene::Param* e = scene::find(c->primitive().params, "e");
        ASSERT_NE(e, nullptr);
        EXPECT_EQ(e->type, scene::Type::Float);
        EXPECT_EQ(e->numbers, (std::vector<float>{1, 2, 3}));
    }
    for (const char* wrong :
         {"Surface \"a\" \"uniform flaot x\" 1", "Declare \"x\" \"uniform flaot\"", "Surface \"a\" \"flaot x\" 1"}) {
        EXPECT_EQ(inWorld(wrong)->only().code, Rie::Syntax);
        EXPECT_EQ(inWorld(wrong)->only().hint, "did you mean float?") << wrong;
    }
}

// A parameter of type shader takes a handle, as RIB of PRMan gives it: a string.
TEST(Declarations, AShaderIsAString) {
    for (const char* given : {"Surface \"a\" \"shader base\" [\"one\"] Sphere 1 -1 1 360",
                              "Declare \"base\" \"uniform shader\" Surface \"a\" \"base\" \"one\" Sphere 1 -1 1 360",
                              "Surface \"a\" \"shader[1] base\" [\"one\"] Sphere 1 -1 1 360"}) {
        const auto c = inWorld(given);
        EXPECT_EQ(c->only().severity, Severity::Warning) << c->messages();
        EXPECT_NE(c->only().hint.find("co-shader"), std::string::npos);
        const scene::Param* base = scene::find(c->primitive().attributes->surface->params, "base");
        ASSERT_NE(base, nullptr);
        EXPECT_EQ(base->strings, std::vector<std::string>{"one"}) << given;
    }
}

TEST(Declarations, InlineOverridesForOneOccurrence) {
    auto c = inWorld("Declare \"k\" \"color\" Surface \"a\" \"float k\" 1 \"k\" [1 2 3] Sphere 1 -1 1 360");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    const auto& p = c->primitive().attributes->surface->params;
    EXPECT_EQ(p[0].type, Type::Float);
    EXPECT_EQ(p[1].type, Type::Color);
}

TEST(Declarations, UndeclaredParametersOfShaders) {
    auto c = inWorld("Surface \"a\" \"mine\" [1 2 3] \"file\" \"x.tx\" \"one\" 5 \"background\" \"b.tx\" Sphere 1 -1 1 360");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    const auto& p = c->primitive().attributes->surface->params;
    ASSERT_EQ(p.size(), 4u);
    EXPECT_FALSE(p[0].declared);
    EXPECT_EQ(p[0].type, Type::Float);
    EXPECT_EQ(p[0].arrayLength, 3);
    EXPECT_EQ(p[1].type, Type::String);
    EXPECT_EQ(p[2].arrayLength, 0);
    EXPECT_FALSE(p[3].declared); // the standard name is a colour; this shader's is not
    EXPECT_EQ(p[3].type, Type::String);
}

TEST(Declarations, ShaderParameterCounts) {
    EXPECT_EQ(inWorld("Surface \"a\" \"color k\" [1 2]")->only().code, Rie::Consistency);
    EXPECT_EQ(inWorld("Surface \"a\" \"float[3] k\" [1 2]")->only().code, Rie::Consistency);
    EXPECT_EQ(inWorld("Surface \"a\" \"Kd\"")->only().code, Rie::MissingData);
    EXPECT_EQ(inWorld("Surface \"a\" 3")->only().code, Rie::Syntax);
    EXPECT_EQ(inWorld("Surface \"a\" \"string k\" 3")->only().code, Rie::Consistency);
    EXPECT_TRUE(inWorld("Surface \"a\" \"lightcolor\" 1 .5 0")->ok); // brackets forgotten
}

namespace {
struct Counts {
    const char* request; ///< without the closing of its parameter list
    int64_t uniform, varying, vertex, faceVarying;
};
std::string repeat(int64_t n, const char* item) {
    std::string s = "[";
    for (int64_t i = 0; i < n; ++i) s += std::string(item) + " ";
    return s + "]";
}
// By hand from the table of docs/design/ri.md.
const Counts kCounts[] = {
    {"Polygon \"P\" [0 0 0 1 0 0 1 1 0 0 1 0 0 .5 0]", 1, 5, 5, 5},
    {"GeneralPolygon [4 3] \"P\" [0 0 0 9 0 0 9 9 0 0 9 0 1 1 0 2 1 0 1 2 0]", 1, 7, 7, 7},
    {"PointsPolygons [3 4] [0 1 2 0 2 3 4] \"P\" [0 0 0 1 0 0 1 1 0 0 1 0 -1 0 0]", 2, 5, 5, 7},
    {"PointsGeneralPolygons [1 2] [3 3 3] [0 1 2 0 2 3 1 2 3] \"P\" [0 0 0 1 0 0 1 1 0 0 1 0]", 2, 4, 4, 9},
    {"SubdivisionMesh \"catmull-clark\" [4 3] [0 1 2 3 0 3 4] \"P\" [0 0 0 1 0 0 1 1 0 0 1 0 -1 0 0]", 2, 5, 5, 7},
    {"Patch \"bilinear\" \"P\" [0 0 0 1 0 0 0 1 0 1 1 0]", 1, 4, 4, 4},
    {"Patch \"bicubic\" \"Pz\" [0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0]", 1, 4, 16, 4},
    {"PatchMesh \"bilinear\" 3 \"nonperiodic\" 4 \"periodic\" \"Pz\" [0 0 0 0 0 0 0 0 0 0 0 0]", 2 * 4, 3 * 4, 12, 12},
    // Bezier, step 3: nu = 7 nonperiodic: 2 patches, 3 corners; nv = 6 periodic: 2 patches, 2 corners.
    {"PatchMesh \"bicubic\" 7 \"nonperiodic\" 6 \"periodic\" \"Pz\" [0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 "
     "0 0 0 0 0 0 0 0 0 0 0 0]",
     4, 6, 42, 6},
    // nu = 4, order 3: segments 2; nv = 3, order 2: segments 2; varying (2+1)(2+1).
    {"NuPatch 4 3 [0 0 0 1 2 2 2] 0 2 3 2 [0 0 1 2 2] 0 2 \"P\" [0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 "
     "0 0 0 0]",
     4, 9, 12, 9},
    {"Sphere 1 -1 1 360", 1, 4, 4, 4},
    {"Torus 1 .2 0 360 360", 1, 4, 4, 4},
    {"Points \"P\" [0 0 0 1 1 1 2 2 2]", 1, 3, 3, 3},
    {"Curves \"linear\" [2 3] \"nonperiodic\" \"P\" [0 0 0 1 0 0 0 0 0 1 0 0 2 0 0]", 2, 5, 5, 5},
    // Cubic, step 3: 4 points 1 segment, 7 points 2 segments: (1+1) + (2+1).
    {"Curves \"cubic\" [4 7] \"nonperiodic\" \"P\" [0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0]", 2, 5, 11,
     5},
    {"Curves \"cubic\" [6] \"periodic\" \"P\" [0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0]", 1, 2, 6, 2},
    // Three points, step 3: one segment, which ends where it begins.
    {"Curves \"cubic\" [3] \"periodic\" \"P\" [0 0 0 0 0 0 0 0 0]", 1, 1, 3, 1},
    {"PatchMesh \"bicubic\" 3 \"periodic\" 4 \"nonperiodic\" \"Pz\" [0 0 0 0 0 0 0 0 0 0 0 0]", 1, 2, 12, 2},
    {"Blobby 2 [1001 0 1001 16 0 2 0 1] [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1] [\"\"]", 1, 2, 2, 2},
};
} // namespace

TEST(Counts, OfEveryPrimitive) {
    for (const Counts& k : kCounts) {
        struct {
            const char* cls;
            int64_t n;
        } classes[] = {{"constant", 1},      {"uniform", k.uniform},         {"varying", k.varying},
                       {"vertex", k.vertex}, {"facevarying", k.faceVarying}, {"facevertex", k.faceVarying}};
        for (auto& cl : classes) {
            std::string head = std::string(k.request) + " \"" + cl.cls + " float[2] q\" ";
            auto good = inWorld(head + repeat(cl.n, "1 2"));
            EXPECT_EQ(good->count(), 0u) << head << good->messages();
            ASSERT_EQ(good->frame().primitives.size(), 1u) << head;
            const scene::Param* q = scene::find(good->primitive().params, "q");
            ASSERT_NE(q, nullptr) << head;
            EXPECT_EQ(int64_t(q->numbers.size()), 2 * cl.n);
            auto bad = inWorld(head + repeat(cl.n + 1, "1 2"));
            EXPECT_EQ(bad->only().code, Rie::Consistency) << head << bad->messages();
            EXPECT_EQ(scene::find(bad->primitive().params, "q"), nullptr); // the variable is dropped, the primitive stays
        }
        auto text = inWorld(std::string(k.request) + " \"uniform string names\" " + repeat(k.uniform, "\"a\""));
        EXPECT_EQ(text->count(), 0u) << text->messages();
    }
}

TEST(Counts, BadArgumentsDropThePrimitive) {
    for (const char* bad :
         {"Polygon \"P\" [0 0 0 1 0 0]",
          "Polygon \"P\" [0 0 0 1 0 0 1 1]",
          "GeneralPolygon [3] \"P\" [0 0 0 1 0 0]",
          "GeneralPolygon [] \"P\" []",
          "GeneralPolygon [-3] \"P\" []",
          "PointsPolygons [3] [0 1] \"P\" [0 0 0]",
          "PointsPolygons [3] [0 1 2] \"P\" [0 0 0 1 0 0]",
          "PointsPolygons [3] [0 1 -2] \"P\" [0 0 0 1 0 0]",
          "PointsPolygons [3] [0 1 2000000000] \"P\" [0 0 0 1 0 0]",
          "PointsPolygons [2] [0 1] \"P\" [0 0 0 1 0 0]",
          "PointsPolygons [2147483647 2147483647] [0 1 2] \"P\" [0 0 0]",
          "PointsGeneralPolygons [2] [3] [0 1 2] \"P\" [0 0 0 1 0 0 1 1 0]",
          "Patch \"bilinear\" \"P\" [0 0 0]",
          "Patch \"bicubic\" \"P\" [0 0 0 1 1 1]",
          "PatchMesh \"bilinear\" 1 \"periodic\" 2 \"periodic\" \"Pz\" [0 0]",
          "PatchMesh \"bicubic\" 5 \"nonperiodic\" 4 \"nonperiodic\" \"Pz\" [0]",
          "PatchMesh \"bilinear\" 2147483647 \"nonperiodic\" 2147483647 \"nonperiodic\" \"Pz\" [0]",
          "PatchMesh \"bilinear\" -5 \"nonperiodic\" -5 \"nonperiodic\" \"Pz\" [0]",
          "NuPatch 2 3 [0 0 0 1 1] 0 1 2 2 [0 0 1 1] 0 1 \"P\" [0 0 0]",
          "NuPatch 2 2 [0 1 0 1] 0 1 2 2 [0 0 1 1] 0 1 \"P\" [0 0 0 1 0 0 0 1 0 1 1 0]",
          "NuPatch 2 2 [0 0 1] 0 1 2 2 [0 0 1 1] 0 1 \"P\" [0 0 0 1 0 0 0 1 0 1 1 0]",
          "Curves \"cubic\" [3] \"nonperiodic\" \"P\" [0 0 0 1 0 0 2 0 0]",
          "Curves \"linear\" [1] \"nonperiodic\" \"P\" [0 0 0]",
          "SubdivisionMesh \"catmull-clark\" [3] [0 1 2] [\"crease\"] [2] [0 1] [1] \"P\" [0 0 0 1 0 0 1 1 0]",
          "SubdivisionMesh \"catmull-clark\" [3] [0 1 2] [\"crease\"] [3 1] [0 1] [1] \"P\" [0 0 0 1 0 0 1 1 0]"}) {
        auto c = inWorld(bad);
        EXPECT_EQ(c->only().code, Rie::Consistency) << bad << c->messages();
        EXPECT_EQ(c->only().place.line, 2);
        EXPECT_TRUE(c->frame().primitives.empty()) << bad;
    }
    EXPECT_EQ(inWorld("Polygon \"Cs\" [1 0 0]")->only().code, Rie::MissingData);
    EXPECT_EQ(inWorld("Patch \"cubic\" \"P\" [0]")->only().code, Rie::BadToken);
    EXPECT_EQ(inWorld("PatchMesh \"bilinear\" 2 \"round\" 2 \"periodic\" \"Pz\" [0 0 0 0]")->only().code, Rie::BadToken);
}

TEST(Counts, UnusedPointsOfAMeshAreCut) {
    auto c = inWorld("PointsPolygons [3] [0 1 2] \"P\" [0 0 0 1 0 0 1 1 0 7 7 7] \"Cs\" [1 0 0 0 1 0 0 0 1 1 1 1]");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    EXPECT_EQ(scene::find(c->primitive().params, "P")->numbers.size(), 9u);
    EXPECT_EQ(scene::find(c->primitive().params, "Cs")->numbers.size(), 9u);
}

TEST(Counts, OneUniformValueHoldsForAll) {
    auto c = inWorld("PointsPolygons [3 3] [0 1 2 0 2 1] \"P\" [0 0 0 1 0 0 1 1 0] \"uniform color k\" [1 0 0]");
    EXPECT_EQ(c->only().severity, Severity::Warning);
    EXPECT_EQ(scene::find(c->primitive().params, "k")->cls, Class::Constant);
}

TEST(Counts, UndeclaredVariablesAreFitted) {
    auto c = inWorld("Polygon \"P\" [0 0 0 1 0 0 1 1 0] \"temp\" [1 2 3] \"tint\" [1 0 0 0 1 0 0 0 1] \"odd\" [1 2 3 4 5 6 7 8 9 "
                     "10 11 12 13 14 15 16 17]");
    auto all = c->diagnostics.all();
    ASSERT_EQ(all.size(), 4u) << c->messages(); // three guesses, one that fits nothing
    EXPECT_EQ(all.back().code, Rie::Consistency);
    const scene::Param* temp = scene::find(c->primitive().params, "temp");
    EXPECT_FALSE(temp->declared);
    EXPECT_EQ(temp->cls, Class::Vertex);
    EXPECT_EQ(temp->arrayLength, 0);
    EXPECT_EQ(scene::find(c->primitive().params, "tint")->arrayLength, 3);
    EXPECT_EQ(scene::find(c->primitive().params, "odd"), nullptr);
}

TEST(Counts, PositionForms) {
    auto c = inWorld("Patch \"bilinear\" \"Pw\" [0 0 0 1 1 0 0 1 0 1 0 1 1 1 0 1]");
    EXPECT_EQ(scene::find(c->primitive().params, "Pw")->type, Type::HPoint);
    EXPECT_EQ(c->count(), 0u) << c->messages();
    auto d = inWorld("Patch \"bilinear\" \"Pz\" [0 0 0 0] \"P\" [0 0 0 1 0 0 0 1 0 1 1 0]");
    EXPECT_EQ(d->only().severity, Severity::Warning);
    EXPECT_EQ(d->primitive().params.size(), 1u);
    auto e = inWorld("Polygon \"varying point P\" [0 0 0 1 0 0 1 1 0]"); // declared by hand
    EXPECT_EQ(scene::find(e->primitive().params, "P")->cls, Class::Vertex);
}

TEST(Counts, SubdivisionTags) {
    auto c = inWorld("SubdivisionMesh \"catmull-clark\" [3] [0 1 2] [\"crease\" \"interpolateboundary\"] [2 1 0 0] [0 1] [3.5] "
                     "\"P\" [0 0 0 1 0 0 1 1 0]");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    const auto& p = c->primitive();
    EXPECT_EQ(p.strings, (std::vector<std::string>{"catmull-clark", "crease", "interpolateboundary"}));
    EXPECT_EQ(p.ints3, (std::vector<int>{2, 1, 0, 0}));
    EXPECT_EQ(scene::find(p.params, "intargs")->numbers, (std::vector<float>{0, 1}));
    EXPECT_EQ(scene::find(p.params, "floatargs")->numbers, (std::vector<float>{3.5f}));
}

TEST(Counts, TrimCurves) {
    auto c =
        inWorld("TrimCurve [1] [2] [0 0 1 2 2] [0] [2] [3] [0 1 0] [0 0 0] [1 1 1] Sphere 1 -1 1 360 TrimCurve [] [] [] [] [] "
                "[] [] [] [] Sphere 1 -1 1 360");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    ASSERT_TRUE(c->primitive(0).attributes->trimCurve);
    EXPECT_EQ(scene::find(*c->primitive(0).attributes->trimCurve, "knot")->numbers.size(), 5u);
    EXPECT_FALSE(c->primitive(1).attributes->trimCurve);
    EXPECT_EQ(inWorld("TrimCurve [1] [2] [0 0 1 2] [0] [2] [3] [0 1 0] [0 0 0] [1 1 1]")->only().code, Rie::Consistency);
}

TEST(Volumes, AreClosedShapesWithTheShaderInside) {
    auto c = inWorld("Color [1 0 0] Atmosphere \"fog\" Surface \"plastic\" Volume \"box\" [-1 2 -3 4 -5 6] [0 0 0] \"constant "
                     "float density\" [3] "
                     "Interior \"haze\" Volume \"ellipsoid\" [1 3 1 3 1 5] [0 0 0] Volume \"cylinder\" [0 1 0 1 0 1] [0 0 0]");
    EXPECT_EQ(c->messages(), "");
    ASSERT_EQ(c->frame().primitives.size(), 5u); // the cylinder has two ends
    const scene::Primitive &box = c->primitive(0), &egg = c->primitive(1);
    EXPECT_EQ(box.kind, "PointsPolygons");
    EXPECT_EQ(box.attributes->surface->name, "null");
    EXPECT_EQ(box.attributes->interior->name, "fog");
    EXPECT_EQ(box.attributes->atmosphere, nullptr);
    ASSERT_NE(scene::find(box.params, "density"), nullptr);
    EXPECT_EQ(egg.attributes->interior->name, "haze");
    EXPECT_EQ(egg.attributes->atmosphere->name, "fog");
    expectMatrix(egg.toWorld.first(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2, 0, 2, 2, 3, 1});

    c = inWorld(
        "Interior \"haze\" MotionBegin [0 1] Volume \"box\" [-1 1 -1 1 -1 1] [0 0 0] Volume \"box\" [-1 1 -1 1 -1 3] [0 0 "
        "0] MotionEnd");
    EXPECT_EQ(c->messages(), "");
    ASSERT_EQ(c->primitive().motionKeys.size(), 1u);
    EXPECT_EQ(scene::find(c->primitive().motionKeys[0]->params, "P")->numbers[14], 3);
}

TEST(Volumes, GridsAreBoxesThatTellTheirShaders) {
    const std::string volume = "Volume \"blobbydso:impl_openvdb\" [-1 2 -3 4 -5 6] [0 0 0] \"constant string[2] "
                               "blobbydso:stringargs\" [\"a.vdb\" \"smoke\"] \"varying float smoke\" []";
    auto c = inWorld("Bxdf \"PxrVolume\" \"v\" Translate 0 0 1 " + volume);
    EXPECT_EQ(c->messages(), "");
    ASSERT_EQ(c->frame().primitives.size(), 1u);
    const scene::Primitive& box = c->primitive(0);
    EXPECT_EQ(box.attributes->interior->name, "PxrVolumeGrid");
    expectMatrix(box.attributes->interior->toWorld.first(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1});
    EXPECT_EQ(scene::find(box.params, "gridFile")->strings[0], "a.vdb");
    EXPECT_EQ(scene::find(box.params, "gridName")->strings[0], "smoke");
    EXPECT_EQ(scene::find(box.params, "gridBound")->numbers, (std::vector<float>{-1, 2, -3, 4, -5, 6}));
    EXPECT_EQ(scene::find(box.params, "blobbydso:stringargs"), nullptr);
    // A grid that the shader names comes first; another shader keeps its name.
    c = inWorld("Bxdf \"PxrVolume\" \"v\" \"string densityFloatPrimVar\" \"fog\" " + volume);
    EXPECT_EQ(scene::find(c->primitive(0).params, "gridName")->strings[0], "fog");
    c = inWorld("Interior \"haze\" " + volume);
    EXPECT_EQ(c->primitive(0).attributes->interior->name, "haze");
    // Without a file: said, and nothing is read.
    c = inWorld("Interior \"haze\" Volume \"blobbydso:impl_openvdb\" [-1 1 -1 1 -1 1] [0 0 0]");
    EXPECT_EQ(c->only().code, Rie::MissingData);
}

TEST(Volumes, ThatAreNoneAreErrors) {
    for (const char* text :
         {"Volume \"blob\" [-1 1 -1 1 -1 1] [0 0 0]", "Volume \"box\" [1 -1 -1 1 -1 1] [0 0 0]",
          "Volume \"box\" [-1 1 -1 1 1 1] [0 0 0]", "Volume \"box\" [-1 1 -1 1 -1 1] [0 0]",
          "Volume \"box\" [-1 1 -1 1 -1 1] [-1 0 0]", "Volume \"blobbydso:fields\" [-1 1 -1 1 -1 1] [0 0 0]",
          "MotionBegin [0 1] Volume \"cone\" [-1 1 -1 1 -1 1] [0 0 0] Volume \"cone\" [-1 1 -1 1 -1 2] [0 0 0] MotionEnd"}) {
        auto c = inWorld(std::string("Interior \"haze\" ") + text + " Sphere 1 -1 1 360");
        EXPECT_GE(c->diagnostics.errors(), 1) << text;
        ASSERT_EQ(c->frame().primitives.size(), 1u) << text;
        EXPECT_EQ(c->primitive().kind, "Sphere");
    }
    // Voxels, and no shader at all: said, and the rest holds. A billion of them take nothing.
    auto c = inWorld(
        "Interior \"haze\" Volume \"box\" [-1 1 -1 1 -1 1] [1000000000 1000000000 1000000000] \"vertex float density\" [1]");
    EXPECT_NE(c->only().message.find("voxels"), std::string::npos);
    EXPECT_EQ(c->frame().primitives.size(), 1u);
    c = inWorld("Volume \"box\" [-1 1 -1 1 -1 1] [0 0 0]");
    EXPECT_NE(c->only().message.find("empty"), std::string::npos);
}

} // namespace variables_test
