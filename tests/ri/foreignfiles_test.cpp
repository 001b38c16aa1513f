// What RIB files published by others ask for and other tests do not: empty meshes, names of other renderers, the teapot.
#include "collect.h"
#include "scene/scene.h"

namespace published_test {

using namespace alpenglow;
using namespace alpenglow::ri;

TEST(Published, EmptyMeshesAreNoErrors) {
    // Houdini writes a mesh without faces for what its frame does not hold.
    auto c = inWorld("PointsPolygons [ ] [ ] \"P\" [ ]\nPointsPolygons [ ] [ ] \"P\" [ ]\nSphere 1 -1 1 360");
    EXPECT_EQ(c->only().severity, Severity::Warning);
    EXPECT_EQ(c->frame().primitives.size(), 1u);
    EXPECT_EQ(inWorld("Points \"P\" [ ] \"constant float constantwidth\" [1]")->only().severity, Severity::Warning);
    EXPECT_EQ(inWorld("Curves \"linear\" [ ] \"nonperiodic\" \"P\" [ ]")->only().severity, Severity::Warning);
    // Points without faces are a mistake.
    EXPECT_EQ(inWorld("PointsPolygons [ ] [ ] \"P\" [0 0 0 1 0 0 1 1 0]")->only().severity, Severity::Error);
}

TEST(Published, NamesOfOtherRenderers) {
    EXPECT_EQ(read("ErrorHandler \"printonce\"")->count(), 0u);
    EXPECT_EQ(read("Declare \"blob\" \"vertex mpoint\"")->count(), 0u);
    EXPECT_EQ(read("Quantize \"N\" 255 0 255 .5")->only().severity, Severity::Warning);
}

TEST(Published, StringsInApostrophes) {
    auto c = read("Display \"a.tif\" 'framebuffer' 'rgba'\nDisplay 'b \"c\".tif' 'file' \"it's\"\nWorldBegin WorldEnd");
    EXPECT_EQ(c->only().severity, Severity::Warning) << "once";
    ASSERT_EQ(c->frame().options.displays.size(), 1u);
    EXPECT_EQ(c->frame().options.displays[0].name, "b \"c\".tif");
    EXPECT_EQ(c->frame().options.displays[0].mode, "it's");
    // One apostrophe alone swallows nothing.
    auto d = inWorld("Sphere 1 -1 1 360 '\nSphere 2 -2 2 360\n'");
    EXPECT_EQ(d->frame().primitives.size(), 2u);
    EXPECT_GT(d->count(), 0u);
}

TEST(Published, ANumberTooManyAtTheEnd) {
    auto c = inWorld("Polygon \"P\" [0 0 0 1 0 0 1 1 0 0 1 0] \"st\" [0 0 1 0 1 1 0 1 0]");
    EXPECT_EQ(c->only().severity, Severity::Warning);
    const scene::Param* st = scene::find(c->primitive().params, "st");
    ASSERT_TRUE(st);
    EXPECT_EQ(st->numbers, (std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1}));
    // A whole element too many is another mistake.
    EXPECT_EQ(inWorld("Polygon \"P\" [0 0 0 1 0 0 1 1 0] \"st\" [0 0 1 0 1 1 0 1]")->only().severity, Severity::Error);
}

TEST(Published, FilesOfDosEndWithAByte) {
    auto c = read("WorldBegin\r\nSphere 1 -1 1 360\r\nWorldEnd\r\n\x1a");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    EXPECT_EQ(c->frame().primitives.size(), 1u);
}

TEST(Published, TheTeapotIsFourMeshes) {
    auto c = inWorld("Basis \"b-spline\" 1 \"b-spline\" 1 Color [1 0 0] Translate 1 2 3 Geometry \"teapot\"\nSphere 1 -1 1 360");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    ASSERT_EQ(c->frame().primitives.size(), 5u);
    float low[3] = {1e9f, 1e9f, 1e9f}, high[3] = {-1e9f, -1e9f, -1e9f};
    for (size_t i = 0; i < 4; ++i) {
        const scene::Primitive& p = c->primitive(i);
        EXPECT_EQ(p.kind, "PatchMesh");
        EXPECT_EQ(p.place.line, 2) << "where it was asked for";
        EXPECT_EQ(p.attributes->color, Color(1, 0, 0));
        EXPECT_EQ(p.attributes->ubasis.step, 3);
        expectMatrix(p.toWorld.first(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1});
        const scene::Param* P = scene::find(p.params, "P");
        ASSERT_TRUE(P);
        for (size_t k = 0; k < P->numbers.size(); ++k) {
            low[k % 3] = std::min(low[k % 3], P->numbers[k]);
            high[k % 3] = std::max(high[k % 3], P->numbers[k]);
        }
    }
    // Newell's measures: 6.525 from handle to spout, 4 wide, 3 high above its foot.
    EXPECT_FLOAT_EQ(low[0], -3);
    EXPECT_FLOAT_EQ(high[0], 3.525f);
    EXPECT_FLOAT_EQ(low[1], -2);
    EXPECT_FLOAT_EQ(high[1], 2);
    EXPECT_FLOAT_EQ(low[2], 0);
    EXPECT_FLOAT_EQ(high[2], 3);
    EXPECT_EQ(c->primitive(4).attributes->ubasis.step, 1) << "the basis around it stays";
    // In an object, and again in another world.
    auto o = read("ObjectBegin 1 Geometry \"teapot\" ObjectEnd WorldBegin ObjectInstance 1 WorldEnd");
    EXPECT_EQ(o->count(), 0u) << o->messages();
    EXPECT_EQ(o->frame().objects.at(0).primitives.size(), 4u);
}

TEST(Published, TheTeapotsNormalsPointOutwards) {
    auto c = inWorld("Geometry \"teapot\"");
    ASSERT_EQ(c->frame().primitives.size(), 4u);
    // dP/du x dP/dv at inner corners of the nets, against the direction from the axis (of the turned, or of the tube).
    auto normal = [&](size_t mesh, int columns, int column, int row) {
        const std::vector<float>& f = scene::find(c->primitive(mesh).params, "P")->numbers;
        auto at = [&](int i, int j) {
            const float* q = &f[size_t(j * columns + i) * 3];
            return Vec3d(q[0], q[1], q[2]);
        };
        return cross(at(column + 1, row) - at(column, row), at(column, row + 1) - at(column, row));
    };
    EXPECT_GT(normal(0, 13, 0, 3).x, 0) << "the belly, at +x";
    EXPECT_GT(normal(0, 13, 3, 3).y, 0) << "the belly, at +y";
    EXPECT_GT(normal(1, 13, 0, 1).z, 0) << "the lid";
    EXPECT_GT(normal(2, 7, 0, 3).x, 0) << "the inner side of the handle";
    EXPECT_LT(normal(2, 7, 3, 3).x, 0) << "the outer side of the handle";
    EXPECT_GT(normal(3, 7, 0, 0).z, 0) << "the upper side of the spout";
    EXPECT_LT(normal(3, 7, 3, 0).z, 0) << "the lower side of the spout";
}

TEST(Published, TheTeapotTakesVariables) {
    auto c = inWorld("Geometry \"teapot\" \"uniform color Cs\" [0 .5 1] \"constant string data\" [\"x\"]\nSphere 1 -1 1 360");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    ASSERT_EQ(c->frame().primitives.size(), 5u);
    for (size_t i = 0; i < 4; ++i) {
        const scene::Param* Cs = scene::find(c->primitive(i).params, "Cs");
        ASSERT_TRUE(Cs);
        EXPECT_EQ(Cs->cls, scene::Class::Constant);
        EXPECT_EQ(Cs->numbers, (std::vector<float>{0, .5f, 1}));
        EXPECT_TRUE(scene::find(c->primitive(i).params, "data"));
    }
    EXPECT_FALSE(scene::find(c->primitive(4).params, "Cs"));
    auto d = inWorld("Geometry \"teapot\" \"varying color Cs\" [0 .5 1 1]");
    EXPECT_EQ(d->only().code, Rie::Incapable) << "it has no corners";
    EXPECT_EQ(d->frame().primitives.size(), 4u);
}

TEST(Published, AMovingTeapotIsKeptAsItIs) {
    auto c = inWorld("MotionBegin [0 1] Geometry \"teapot\" Geometry \"teapot\" MotionEnd");
    EXPECT_EQ(c->frame().primitives.size(), 1u) << c->messages();
    EXPECT_EQ(c->primitive().kind, "Geometry");
}

TEST(Published, CubesAndSpheresByName) {
    auto c = inWorld("Translate 1 2 3 Geometry \"cube\" \"uniform color Cs\" [0 .5 1]\nGeometry \"sphere\"");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    ASSERT_EQ(c->frame().primitives.size(), 7u);
    double volume = 0; // by the divergence theorem: a third of the sum of P . N over the faces
    for (size_t i = 0; i < 6; ++i) {
        const scene::Primitive& p = c->primitive(i);
        EXPECT_EQ(p.kind, "Patch");
        expectMatrix(p.toWorld.first(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1});
        EXPECT_TRUE(scene::find(p.params, "Cs"));
        const std::vector<float>& f = scene::find(p.params, "P")->numbers;
        ASSERT_EQ(f.size(), 12u);
        const auto at = [&](size_t k) { return Vec3d(f[3 * k], f[3 * k + 1], f[3 * k + 2]); };
        for (float x : f) EXPECT_EQ(std::abs(x), .5f);
        volume += dot(at(0), cross(at(1) - at(0), at(2) - at(0))) / 3;
    }
    EXPECT_DOUBLE_EQ(volume, 1) << "normals to the outside";
    EXPECT_EQ(c->primitive(6).kind, "Sphere");
    EXPECT_EQ(c->primitive(6).numbers, (std::vector<float>{1, -1, 1, 360}));
}

TEST(Published, SignsBeginNumbersAndOneNumberIsAGrey) {
    auto c = inWorld("Translate .5-.25 1e1 Color .3 Opacity [.5] Sphere 1-1 1 360\nPolygon \"P\" [-1-1 0 1-1 0 1 1 0]");
    ASSERT_EQ(c->frame().primitives.size(), 2u) << c->messages();
    EXPECT_EQ(c->primitive().attributes->color, Color(.3f));
    EXPECT_EQ(c->primitive().attributes->opacity, Color(.5f));
    EXPECT_EQ(c->primitive().numbers, (std::vector<float>{1, -1, 1, 360}));
    EXPECT_EQ(scene::find(c->primitive(1).params, "P")->numbers, (std::vector<float>{-1, -1, 0, 1, -1, 0, 1, 1, 0}));
    auto glued = inWorld("Translate .5-.5 1.5 Sphere 1 -1 1 360");
    EXPECT_EQ(glued->count(), 0u) << glued->messages();
    expectMatrix(glued->primitive().toWorld.first(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, .5f, -.5f, 1.5f, 1});
    EXPECT_EQ(inWorld("Color .3 Sphere 1 -1 1 360")->only().severity, Severity::Warning);
    EXPECT_EQ(inWorld("Color [.3 .4] Sphere 1 -1 1 360")->only().severity, Severity::Error);
    EXPECT_EQ(inWorld("Translate 1-x 2 3")->first().severity, Severity::Error);
    // Whole numbers written with a point are integers.
    auto whole =
        inWorld("Sides 2.0 Attribute \"trace\" \"integer maxspeculardepth\" 3.0\nPointsPolygons [3.0] [0.0 1 2] \"P\" [0 "
                "0 0 1 0 0 1 1 0]");
    EXPECT_EQ(whole->count(), 0u) << whole->messages();
    EXPECT_EQ(whole->primitive().ints, (std::vector<int>{3}));
}

} // namespace published_test
