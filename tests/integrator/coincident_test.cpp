// Surfaces that lie at one place, of whatever kind and in whatever order, dim a light as often as there are surfaces: two of
// opacity one half let a quarter through. In scenes that are looked through directly and in those that have a tree.
#include "integrator/floorscene.h"
#include <random>

namespace coincident_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

std::string within(const std::string& transform, const std::string& inside) {
    return "TransformBegin\n" + transform + inside + "TransformEnd\n";
}
std::string polygon(const std::string& points) { return "Polygon \"P\" [" + points + "]\n"; }
/// In the plane y = 1.
std::string disk(const char* radius) {
    return within("Translate 0 1 0\nRotate 90 1 0 0\n", std::string("Disk 0 ") + radius + " 360\n");
}

/// Of 500 points of the floor, those to which not a quarter of the light comes through `first` and `second`.
int wrong(const std::string& first, const std::string& second, const std::string& aside) {
    Scene s("WorldBegin\nSides 2\nLightSource \"coincidentlamp\" 1\nAttributeBegin\nAttribute \"visibility\" \"integer camera\" "
            "[0]\nSurface \"coincident\"\n" +
                aside + first + second + "AttributeEnd\nSurface \"coincidentfloor\"\n" + kFloor + "WorldEnd\n",
            under(Hider::Path));
    std::mt19937 g(5);
    std::uniform_real_distribution<float> r(-.4f, .4f);
    int bad = 0;
    for (int i = 0; i < 500; ++i) {
        const Vec3 at(r(g), 0, r(g));
        bad += std::fabs(s.one(rayTo(at + Vec3(.03f, .08f, -.04f), at)).x - .25f) > 1e-5f;
    }
    return bad;
}

TEST(Coincident, SurfacesOfEveryKind) {
    writeShader("coincident", "surface coincident() { Oi = .5 + 0 * u; Ci = 0; }\n");
    writeShader("coincidentlamp", "light coincidentlamp() { illuminate(point \"world\" (.3, 5, .2)) Cl = 1; }\n");
    writeShader("coincidentfloor", "surface coincidentfloor() { Oi = 1; Ci = 0; illuminance(P) Ci += Cl; }\n");
    std::string aside; // triangles that nothing meets, more than scenes without a tree have
    for (int i = 0; i < 40; ++i)
        aside +=
            polygon(std::to_string(100 + i) + " 0 50 " + std::to_string(100 + i) + " 1 50 " + std::to_string(101 + i) + " 0 50");
    const std::string square = polygon("-3 1 -3  3 1 -3  3 1 3  -3 1 3"),
                      other = polygon("-3.3 1 -3.1  3.7 1 -3  3.1 1 3.9  -3.2 1 3"), tilt = "Rotate 13 1 .3 .2\n";
    for (const std::string& more : {std::string(), aside}) {
        const std::string where = more.empty() ? "direct" : "tree";
        EXPECT_EQ(wrong(square, square, more), 0) << where;
        EXPECT_EQ(wrong(square, other, more), 0) << where;
        EXPECT_EQ(wrong(square, disk("4"), more), 0) << where;
        EXPECT_EQ(wrong(disk("4"), square, more), 0) << where;
        EXPECT_EQ(wrong(disk("4"), disk("4"), more), 0) << where;
        EXPECT_EQ(wrong(disk("4"), disk("3.5"), more), 0) << where;
        EXPECT_EQ(wrong(within(tilt, square), within(tilt, square), more), 0) << where;
        EXPECT_EQ(wrong(within(tilt, square), within(tilt, other), more), 0) << where;
        EXPECT_EQ(wrong(within(tilt, square), within(tilt, disk("4")), more), 0) << where;
        EXPECT_EQ(wrong(within(tilt, disk("4")), within(tilt, disk("4")), more), 0) << where;
    }
}

} // namespace

} // namespace coincident_test
