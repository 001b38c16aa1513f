// Graphics state: stacks, transformations against closed forms, lights, objects, motion (RISpec 3.2, sections 4 to 6).
#include "collect.h"
#include "scene/scene.h"
#include <numbers>

namespace state_test {

using namespace alpenglow;
using namespace alpenglow::ri;

namespace {
const char* kBall = " Sphere 1 -1 1 360 ";
Matrix ctm(const std::string& transforms) { return inWorld(transforms + kBall)->primitive().toWorld.first(); }
} // namespace

TEST(Transforms, EachAgainstItsClosedForm) {
    expectMatrix(ctm("Translate 1 2 3"), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1});
    expectMatrix(ctm("Scale 2 3 4"), {2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 0, 0, 0, 1});
    // Rotate about +z: x' = x cos - y sin, y' = x sin + y cos; row vectors: rows (cos sin) (-sin cos).
    double c = std::cos(std::numbers::pi / 6), s = .5;
    expectMatrix(ctm("Rotate 30 0 0 2"), {c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    // Perspective, RISpec 3.2, 4.3: rows (1 0 0 0) (0 1 0 0) (0 0 t t) (0 0 -t 0), t = tan(45 deg) = 1.
    expectMatrix(ctm("Perspective 90"), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, -1, 0});
    // Skew of y toward x by 45 degrees: x' = x + y.
    expectMatrix(ctm("Skew 45 0 1 0 1 0 0"), {1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    expectMatrix(ctm("Translate 9 9 9 Transform [1 0 0 0 0 1 0 0 0 0 1 0 4 5 6 1]"),
                 {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 4, 5, 6, 1});
    expectMatrix(ctm("Scale 2 2 2 Identity"), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
}

TEST(Transforms, LaterOnesApplyFirst) {
    // CTM = M_new * CTM: a point is scaled, then moved.
    EXPECT_EQ(transformPoint(ctm("Translate 1 0 0 Scale 2 2 2"), {1, 1, 1}), Vec3d(3, 2, 2));
    EXPECT_EQ(transformPoint(ctm("Scale 2 2 2 Translate 1 0 0"), {1, 1, 1}), Vec3d(4, 2, 2));
    EXPECT_EQ(transformPoint(ctm("Scale 2 2 2 ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 1 0 0 1]"), {1, 1, 1}), Vec3d(4, 2, 2));
}

TEST(Transforms, CameraIsTheCtmAtWorldBegin) {
    auto c = read("Translate 0 0 5\nScale 1 1 -1\nWorldBegin Translate 1 0 0 Sphere 1 -1 1 360 WorldEnd");
    EXPECT_TRUE(c->ok);
    expectMatrix(c->frame().options.worldToCamera.first(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 5, 1});
    expectMatrix(c->primitive().toWorld.first(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1});
}

TEST(Transforms, WorldEndRestoresTheCamera) {
    auto c = read("Translate 0 0 5 WorldBegin Translate 1 0 0 WorldEnd WorldBegin WorldEnd");
    ASSERT_EQ(c->frames.size(), 2u);
    EXPECT_EQ(c->frames[1]->options.worldToCamera.first(), translateMatrix(0, 0, 5));
}

TEST(Transforms, ShaderSpaceOfCallsBeforeTheWorld) {
    // Camera: world moved by +5. A shader called before that move stands at the camera: world z = -5.
    auto c = read("Surface \"matte\" LightSource \"pointlight\" 1 CoordinateSystem \"cam\" Translate 0 0 5 WorldBegin Sphere 1 "
                  "-1 1 360 WorldEnd");
    EXPECT_TRUE(c->ok) << c->messages();
    EXPECT_EQ(transformPoint(c->primitive().attributes->surface->toWorld.first(), {0, 0, 0}), Vec3d(0, 0, -5));
    EXPECT_EQ(transformPoint(c->frame().lights.at(0).shader->toWorld.first(), {0, 0, 0}), Vec3d(0, 0, -5));
    EXPECT_EQ(transformPoint(c->frame().coordinateSystems.at("cam").first(), {0, 0, 0}), Vec3d(0, 0, -5));
    EXPECT_EQ(c->frame().options.cameraSpaces.at("cam").first(), Matrix{});
}

TEST(Transforms, CoordinateSystems) {
    auto c = inWorld(
        "AttributeBegin Translate 1 2 3 CoordinateSystem \"here\" AttributeEnd CoordSysTransform \"here\" Sphere 1 -1 1 360\n"
        "AttributeBegin Scale 2 2 2 ScopedCoordinateSystem \"s\" Identity CoordSysTransform \"s\" Sphere 1 -1 1 360 "
        "AttributeEnd\n"
        "CoordSysTransform \"nowhere\"");
    EXPECT_EQ(c->only().code, Rie::BadToken);
    EXPECT_EQ(c->primitive(0).toWorld.first(), translateMatrix(1, 2, 3));
    EXPECT_EQ(c->primitive(1).toWorld.first(), scaleMatrix(2, 2, 2) * translateMatrix(1, 2, 3));
    EXPECT_EQ(c->frame().coordinateSystems.at("here").first(), translateMatrix(1, 2, 3));
}

TEST(Transforms, BadOnesAreRefused) {
    EXPECT_EQ(inWorld("Rotate 10 0 0 0")->only().code, Rie::Range);
    EXPECT_EQ(inWorld("Skew 10 0 1 0 0 2 0")->only().code, Rie::Range);
    EXPECT_EQ(inWorld("Perspective 180")->only().code, Rie::Range);
    EXPECT_EQ(inWorld("Scale 1 0 1")->only().code, Rie::Math);
    EXPECT_EQ(read("Scale 0 0 0 WorldBegin WorldEnd")->diagnostics.all().back().code, Rie::Math);
}

TEST(Attributes, AreSavedAndRestored) {
    auto c = inWorld(
        "Color 1 0 0 AttributeBegin Color 0 1 0 Translate 1 0 0 Sides 1 Sphere 1 -1 1 360 AttributeEnd Sphere 1 -1 1 360\n"
        "TransformBegin Translate 5 0 0 Color 0 0 1 TransformEnd Sphere 1 -1 1 360");
    EXPECT_TRUE(c->ok);
    EXPECT_EQ(c->primitive(0).attributes->color, Color(0, 1, 0));
    EXPECT_EQ(c->primitive(0).attributes->sides, 1);
    EXPECT_EQ(c->primitive(1).attributes->color, Color(1, 0, 0));
    EXPECT_EQ(c->primitive(1).attributes->sides, 2);
    EXPECT_EQ(c->primitive(1).toWorld.first(), Matrix{});
    EXPECT_EQ(c->primitive(2).attributes->color, Color(0, 0, 1)); // TransformEnd restores only the transformation
    EXPECT_EQ(c->primitive(2).toWorld.first(), Matrix{});
}

TEST(Attributes, OrientationAndReverse) {
    auto a = [](const std::string& s) { return inWorld(s + kBall)->primitive().attributes; };
    EXPECT_FALSE(a("")->inside);
    EXPECT_TRUE(a("Orientation \"inside\"")->inside);
    EXPECT_TRUE(a("ReverseOrientation")->inside);
    EXPECT_FALSE(a("Orientation \"inside\" ReverseOrientation")->inside);
    EXPECT_TRUE(a("Orientation \"rh\"")->absoluteHandedness);
    EXPECT_TRUE(a("Orientation \"rh\"")->rightHanded);
    EXPECT_FALSE(a("Orientation \"rh\" ReverseOrientation")->rightHanded);
    EXPECT_FALSE(a("Orientation \"lh\" Orientation \"outside\"")->absoluteHandedness);
    EXPECT_EQ(inWorld("Orientation \"up\"")->only().code, Rie::BadToken);
}

TEST(Attributes, BasisMatrices) {
    auto c = inWorld("Basis \"b-spline\" 1 [1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16] 2 Sphere 1 -1 1 360");
    const auto& a = *c->primitive().attributes;
    EXPECT_EQ(a.ubasis.step, 1);
    EXPECT_DOUBLE_EQ(a.ubasis.m[3][1], 4.0 / 6); // RISpec 3.2, 5.2
    EXPECT_EQ(a.vbasis.m[1][0], 5);
    EXPECT_EQ(a.vbasis.step, 2);
    // Each row set interpolates a constant: the columns of the last row sum to 1, of the others to 0.
    for (const char* name : {"bezier", "b-spline", "catmull-rom"}) {
        auto b =
            inWorld(std::string("Basis \"") + name + "\" 1 \"" + name + "\" 1 Sphere 1 -1 1 360")->primitive().attributes->ubasis;
        for (int r = 0; r < 4; ++r) EXPECT_NEAR(b.m[r][0] + b.m[r][1] + b.m[r][2] + b.m[r][3], r == 3, 1e-15) << name;
    }
    EXPECT_EQ(inWorld("Basis \"bezier\" 0 \"bezier\" 3")->only().code, Rie::Range);
    EXPECT_EQ(inWorld("Basis \"nurbs\" 3 \"bezier\" 3")->only().code, Rie::BadToken);
}

TEST(Attributes, ValuesByClassAndName) {
    auto c = inWorld("Attribute \"identifier\" \"name\" [\"ball\"] Attribute \"user\" \"float x\" 3 \"string y\" \"z\"\n"
                     "Attribute \"grouping\" \"membership\" \"a\" Attribute \"grouping\" \"membership\" \"+b\" Attribute "
                     "\"grouping\" \"membership\" \"-a\"\n"
                     "GeometricApproximation \"motionfactor\" 2 Sphere 1 -1 1 360");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    const auto& a = *c->primitive().attributes;
    EXPECT_EQ(a.value("identifier:name")->strings[0], "ball");
    EXPECT_EQ(a.value("user:x")->numbers[0], 3);
    EXPECT_EQ(a.value("grouping:membership")->strings[0], "b");
    EXPECT_EQ(a.value("GeometricApproximation:motionfactor")->numbers[0], 2);
    EXPECT_EQ(a.value("none"), nullptr);
    auto d = inWorld("Attribute \"radiosity\" \"steps\" [4]");
    EXPECT_TRUE(d->ok);
    EXPECT_EQ(d->only().severity, Severity::Info); // another renderer's name
    EXPECT_EQ(inWorld("Attribute \"trace\" \"bias\" [\"x\"]")->only().code, Rie::Consistency);
}

TEST(Attributes, DetailKeepsItsSpace) {
    auto c = read(
        "WorldBegin Translate 1 2 3 Detail [-1 1 -1 1 -1 1] Translate 5 0 0 DetailRange [0 1 2 3] Sphere 1 -1 1 360 WorldEnd");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    EXPECT_EQ(c->primitive().attributes->detailSpace, translateMatrix(1, 2, 3));
    EXPECT_EQ(c->primitive().attributes->detail, (std::vector<float>{-1, 1, -1, 1, -1, 1}));
}

TEST(Attributes, Resources) {
    auto c = inWorld(
        "Color 1 0 0 Translate 1 0 0 Resource \"r\" \"attributes\" \"string operation\" \"save\" Color 0 1 0 Sides 1 Identity\n"
        "Resource \"r\" \"attributes\" \"string operation\" \"restore\" \"string subset\" \"shading\" Sphere 1 -1 1 360\n"
        "Resource \"r\" \"attributes\" \"string operation\" \"restore\" Sphere 1 -1 1 360\n"
        "ResourceBegin Resource \"q\" \"attributes\" \"operation\" \"save\" ResourceEnd\nResource \"q\" \"attributes\" "
        "\"operation\" \"restore\"");
    EXPECT_EQ(c->only().code, Rie::BadHandle);
    EXPECT_EQ(c->only().place.line, 6);
    EXPECT_EQ(c->primitive(0).attributes->color, Color(1, 0, 0));
    EXPECT_EQ(c->primitive(0).attributes->sides, 1);
    EXPECT_EQ(c->primitive(0).toWorld.first(), Matrix{});
    EXPECT_EQ(c->primitive(1).attributes->sides, 2);
    EXPECT_EQ(c->primitive(1).toWorld.first(), translateMatrix(1, 0, 0));
}

TEST(Lights, ListIsAnAttribute) {
    auto c = inWorld("LightSource \"ambientlight\" 1 AttributeBegin LightSource \"pointlight\" \"two\" Sphere 1 -1 1 360 "
                     "AttributeEnd Sphere 1 -1 1 360\n"
                     "Illuminate \"two\" 1 Illuminate 1 0 Sphere 1 -1 1 360 Illuminate \"1\" 1 Sphere 1 -1 1 360");
    EXPECT_TRUE(c->ok) << c->messages();
    using L = std::vector<int>;
    EXPECT_EQ(c->primitive(0).attributes->lights, (L{0, 1}));
    EXPECT_EQ(c->primitive(1).attributes->lights, (L{0}));
    EXPECT_EQ(c->primitive(2).attributes->lights, (L{1}));
    EXPECT_EQ(c->primitive(3).attributes->lights, (L{0, 1})); // "1" and 1 are one handle; order of declaration
    EXPECT_EQ(c->frame().lights.size(), 2u);
}

TEST(Lights, HandleGivenTwiceIsTwoLights) {
    auto c = inWorld(
        "LightSource \"distantlight\" 2 LightSource \"distantlight\" 2 Sphere 1 -1 1 360 Illuminate 2 0 Sphere 1 -1 1 360");
    EXPECT_EQ(c->primitive(0).attributes->lights, (std::vector<int>{0, 1}));
    EXPECT_EQ(c->primitive(1).attributes->lights, (std::vector<int>{0})); // the handle names the newer one
}

TEST(Lights, AreaLightsOwnWhatFollows) {
    auto c = inWorld("AttributeBegin AreaLightSource \"arealight\" 7 Sphere 1 -1 1 360 AttributeEnd Sphere 2 -2 2 360");
    EXPECT_TRUE(c->frame().lights.at(0).area);
    EXPECT_EQ(c->primitive(0).attributes->areaLight, 0);
    EXPECT_EQ(c->primitive(1).attributes->areaLight, -1);
}

TEST(Lights, DieWithTheWorld) {
    auto c =
        read("LightSource \"a\" 1 WorldBegin LightSource \"b\" 2 WorldEnd WorldBegin Illuminate 1 0 Illuminate 2 1 WorldEnd");
    ASSERT_EQ(c->frames.size(), 2u);
    EXPECT_EQ(c->frames[0]->lights.size(), 2u);
    EXPECT_EQ(c->frames[1]->lights.size(), 1u);
    EXPECT_EQ(c->only().code, Rie::BadHandle); // light 2
}

TEST(Lights, HandleLeftOut) {
    auto c = inWorld("LightSource \"ambientlight\" \"intensity\" .4");
    EXPECT_EQ(c->only().severity, Severity::Warning);
    EXPECT_EQ(c->frame().lights.at(0).shader->params.at(0).name, "intensity");
}

TEST(Objects, AreStoredInTheirOwnSpace) {
    auto c = inWorld("Translate 9 0 0 Color 1 0 0 ObjectBegin \"o\" Translate 1 0 0 Sphere 1 -1 1 360 Color 0 0 1 Sphere 1 -1 1 "
                     "360 ObjectEnd\n"
                     "Color 0 1 0 ObjectInstance \"o\" Identity ObjectInstance \"o\" ObjectInstance 5");
    EXPECT_EQ(c->only().code, Rie::BadHandle);
    ASSERT_EQ(c->frame().objects.size(), 1u);
    const auto& o = c->frame().objects[0];
    ASSERT_EQ(o.primitives.size(), 2u);
    EXPECT_EQ(o.primitives[0]->toWorld.first(), translateMatrix(1, 0, 0));
    EXPECT_FALSE(o.primitives[0]->attributesInside);
    EXPECT_TRUE(o.primitives[1]->attributesInside);
    ASSERT_TRUE(o.primitives[1]->attributesBefore);
    EXPECT_EQ(o.primitives[1]->attributesBefore->color, Color(1, 0, 0));
    EXPECT_TRUE(c->frame().primitives.empty());
    ASSERT_EQ(c->frame().instances.size(), 2u);
    EXPECT_EQ(c->frame().instances[0].toWorld.first(), translateMatrix(9, 0, 0));
    EXPECT_EQ(c->frame().instances[0].attributes->color, Color(0, 1, 0));
    EXPECT_EQ(c->frame().instances[1].toWorld.first(), Matrix{});
}

TEST(Objects, InsideObjectsAreCopied) {
    auto c = read(
        "ObjectBegin 1 Sphere 1 -1 1 360 ObjectEnd ObjectBegin 2 Translate 0 0 1 ObjectInstance 1 ObjectInstance 1 ObjectEnd\n"
        "WorldBegin ObjectInstance 2 WorldEnd WorldBegin ObjectInstance 2 ObjectInstance 1 WorldEnd");
    EXPECT_TRUE(c->ok) << c->messages();
    ASSERT_EQ(c->frames.size(), 2u);
    EXPECT_EQ(c->frames[0]->objects.at(0).primitives.size(), 2u);
    EXPECT_EQ(c->frames[0]->objects[0].primitives[0]->toWorld.first(), translateMatrix(0, 0, 1));
    EXPECT_EQ(c->frames[1]->objects.size(), 2u);
    EXPECT_EQ(c->frames[1]->instances.at(1).object, 1);
}

TEST(Objects, OfAnotherWorldForgetItsLights) {
    auto c = read("LightSource \"a\" 1 WorldBegin LightSource \"b\" 2 ObjectBegin 1 Color 1 0 0 Sphere 1 -1 1 360 ObjectEnd "
                  "ObjectInstance 1\n"
                  "Resource \"r\" \"attributes\" \"operation\" \"save\" WorldEnd WorldBegin ObjectInstance 1\n"
                  "Resource \"r\" \"attributes\" \"operation\" \"restore\" Sphere 1 -1 1 360 WorldEnd");
    EXPECT_TRUE(c->ok) << c->messages();
    ASSERT_EQ(c->frames.size(), 2u);
    EXPECT_EQ(c->frames[0]->objects.at(0).primitives.at(0)->attributes->lights, (std::vector<int>{0, 1}));
    EXPECT_EQ(c->frames[1]->objects.at(0).primitives.at(0)->attributes->lights, (std::vector<int>{0}));
    EXPECT_EQ(c->frames[1]->primitives.at(0)->attributes->lights, (std::vector<int>{0}));
}

TEST(Objects, HandleGivenTwiceIsTwoObjects) {
    auto c = inWorld(
        "ObjectBegin 1 Sphere 1 -1 1 360 ObjectEnd ObjectInstance 1 ObjectBegin 1 Disk 0 1 360 ObjectEnd ObjectInstance 1");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    ASSERT_EQ(c->frame().objects.size(), 2u);
    EXPECT_EQ(c->frame().objects[size_t(c->frame().instances.at(1).object)].primitives.at(0)->kind, "Disk");
}

TEST(Motion, OfTransformations) {
    auto c = inWorld("Translate 0 1 0 MotionBegin [0 1] Translate 0 0 0 Translate 4 0 0 MotionEnd Sphere 1 -1 1 360");
    EXPECT_TRUE(c->ok) << c->messages();
    const auto& t = c->primitive().toWorld;
    ASSERT_EQ(t.keys.size(), 2u);
    EXPECT_EQ(t.times, (std::vector<float>{0, 1}));
    EXPECT_EQ(transformPoint(t.keys[0], {0, 0, 0}), Vec3d(0, 1, 0));
    EXPECT_EQ(transformPoint(t.keys[1], {0, 0, 0}), Vec3d(4, 1, 0));
}

TEST(Motion, KeysOfTwoBlocksAreMerged) {
    auto c = inWorld("MotionBegin [0 1] Translate 0 0 0 Translate 4 0 0 MotionEnd MotionBegin [0.5 1] Scale 1 1 1 Scale 3 3 3 "
                     "MotionEnd Sphere 1 -1 1 360");
    const auto& t = c->primitive().toWorld;
    EXPECT_EQ(t.times, (std::vector<float>{0, .5f, 1}));
    EXPECT_EQ(transformPoint(t.keys[1], {1, 0, 0}), Vec3d(1 + 2, 0, 0));
    EXPECT_EQ(transformPoint(t.keys[2], {1, 0, 0}), Vec3d(3 + 4, 0, 0));
}

TEST(Motion, RotationFollowsTheArc) {
    auto c = inWorld("MotionBegin [0 1] Rotate 0 0 0 1 Rotate 180 0 0 1 MotionEnd Sphere 1 -1 1 360");
    const auto& t = c->primitive().toWorld;
    ASSERT_GE(t.keys.size(), 25u); // 180 / 7.5 + 1
    for (size_t i = 0; i < t.keys.size(); ++i) {
        Vec3d p = transformPoint(t.keys[i], {1, 0, 0});
        double a = double(t.times[i]) * std::numbers::pi;
        EXPECT_NEAR(p.x, std::cos(a), 1e-6); // the time of a key is a float
        EXPECT_NEAR(p.y, std::sin(a), 1e-6);
    }
    EXPECT_EQ(t.times.back(), 1);
}

// Matrices of exporters: the rotation in them turns, stretch and translation go linearly.
TEST(Motion, MatricesTurn) {
    const Matrix a = scaleMatrix(2, 1, 1) * rotateMatrix(20, 1, 2, 3) * translateMatrix(1, 0, 0),
                 b = scaleMatrix(4, 1, 1) * rotateMatrix(120, 1, 2, 3) * translateMatrix(3, 0, 0);
    const auto text = [](const Matrix& m) {
        std::string s = "ConcatTransform [";
        for (auto& row : m.m)
            for (double x : row) s += std::to_string(x) + " ";
        return s + "]\n";
    };
    auto c = inWorld("MotionBegin [0 1]\n" + text(a) + text(b) + "MotionEnd Sphere 1 -1 1 360");
    const auto& t = c->primitive().toWorld;
    ASSERT_GE(t.keys.size(), 40u);
    for (size_t i = 0; i < t.keys.size(); ++i) {
        const double w = t.times[i];
        const Matrix want = scaleMatrix(2 + 2 * w, 1, 1) * rotateMatrix(20 + 100 * w, 1, 2, 3) * translateMatrix(1 + 2 * w, 0, 0);
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 3; ++x) EXPECT_NEAR(t.keys[i].m[y][x], want.m[y][x], 1e-5) << i; // six decimals
    }
    // Mirrored from key to key, and half a turn: as they are.
    EXPECT_EQ(inWorld("MotionBegin [0 1]\n" + text(a) + text(scaleMatrix(-1, 1, 1)) + "MotionEnd Sphere 1 -1 1 360")
                  ->primitive()
                  .toWorld.keys.size(),
              2u);
    EXPECT_EQ(inWorld("MotionBegin [0 1]\n" + text(scaleMatrix(1, 1, 1)) + text(rotateMatrix(180, 0, 0, 1)) +
                      "MotionEnd Sphere 1 -1 1 360")
                  ->primitive()
                  .toWorld.keys.size(),
              2u);
}

TEST(Motion, OfPrimitives) {
    auto c = inWorld("MotionBegin [0 1] Sphere 1 -1 1 360 Sphere 2 -2 2 360 MotionEnd");
    EXPECT_TRUE(c->ok) << c->messages();
    EXPECT_EQ(c->frame().primitives.size(), 1u);
    ASSERT_EQ(c->primitive().motionKeys.size(), 1u);
    EXPECT_EQ(c->primitive().motionTimes, (std::vector<float>{0, 1}));
    EXPECT_EQ(c->primitive().motionKeys[0]->numbers[0], 2);
}

TEST(Motion, OfTheCamera) {
    auto c = read("MotionBegin [0 1] Translate 0 0 5 Translate 0 0 6 MotionEnd WorldBegin WorldEnd");
    EXPECT_EQ(c->frame().options.worldToCamera.keys.size(), 2u);
}

TEST(Motion, Violations) {
    auto code = [](const std::string& s) { return inWorld(s)->only().code; };
    EXPECT_EQ(code("MotionBegin [0 1] Translate 0 0 0 MotionEnd"), Rie::BadMotion);
    EXPECT_EQ(code("MotionBegin [0 1] Translate 0 0 0 Translate 0 0 0 Translate 0 0 1 MotionEnd"), Rie::BadMotion);
    EXPECT_EQ(code("MotionBegin [1 0] Translate 0 0 0 MotionEnd"), Rie::BadMotion);
    EXPECT_EQ(code("MotionBegin [0 1] MotionEnd"), Rie::BadMotion);
    EXPECT_EQ(code("MotionBegin [0 1] Translate 0 0 0 Sides 1 Translate 0 0 1 MotionEnd"), Rie::BadMotion);
    EXPECT_EQ(code("MotionEnd"), Rie::Nesting);
    EXPECT_EQ(code("MotionBegin [0 1] Polygon \"P\" [0 0 0 1 0 0 1 1 0] Polygon \"P\" [0 0 0 1 0 0 1 1 0 0 1 0] MotionEnd"),
              Rie::BadMotion);
    auto c = inWorld("MotionBegin [0 1] Sphere 1 -1 1 360 WorldEnd");
    EXPECT_EQ(c->frame().primitives.size(), 1u); // the sample that was there
    // One time is no motion, and no fault.
    EXPECT_EQ(inWorld("MotionBegin [0] Translate 1 0 0 MotionEnd Sphere 1 -1 1 360")->primitive().toWorld.keys.size(), 1u);
    auto d = inWorld("MotionBegin [0 1] Color 1 0 0 Color 0 1 0 MotionEnd Sphere 1 -1 1 360");
    EXPECT_EQ(d->only().code, Rie::Incapable);
    EXPECT_EQ(d->primitive().attributes->color, Color(1, 0, 0));
}

TEST(ColorSamples, BecomeRgb) {
    // Two samples: the first is (1,0,.5), the second (0,1,.5): colour a b -> (a, b, (a+b)/2).
    auto c = read("ColorSamples [1 0 .5 0 1 .5] [1 0 .5 0 1 .5] WorldBegin Color .25 .75 Surface \"x\" \"color k\" [1 2] Sphere "
                  "1 -1 1 360 WorldEnd");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    EXPECT_EQ(c->primitive().attributes->color, Color(.25f, .75f, .5f));
    EXPECT_EQ(c->primitive().attributes->surface->params.at(0).numbers, (std::vector<float>{1, 2, 1.5f}));
}

TEST(Textures, AreMadeWithinFramesToo) {
    // As published scenes of several passes do, after the world whose depth they use.
    auto c = read("FrameBegin 1 WorldBegin WorldEnd MakeShadow \"a.z\" \"a.shd\" FrameEnd FrameBegin 2 MakeShadow \"b.z\" "
                  "\"b.shd\" WorldBegin WorldEnd FrameEnd");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    EXPECT_EQ(c->textures.size(), 2u);
}

TEST(Textures, ReachTheConsumerInOrder) {
    auto c = read("MakeTexture \"a.tif\" \"a.tx\" \"periodic\" \"clamp\" \"box\" 2 3\nMakeCubeFaceEnvironment \"a\" \"b\" \"c\" "
                  "\"d\" \"e\" \"f\" \"g\" 95 \"box\" 1 1\nMakeShadow \"z\" \"s\"");
    EXPECT_TRUE(c->ok) << c->messages();
    ASSERT_EQ(c->textures.size(), 3u);
    EXPECT_EQ(c->textures[0].files, (std::vector<std::string>{"a.tif", "a.tx", "periodic", "clamp", "box"}));
    EXPECT_EQ(scene::find(c->textures[0].args, "twidth")->numbers[0], 3);
    EXPECT_EQ(c->textures[1].files[6], "g");
    EXPECT_EQ(scene::find(c->textures[1].args, "fov")->numbers[0], 95);
    EXPECT_EQ(c->textures[2].kind, "MakeShadow");
}

} // namespace state_test
