// A black shade a thousandth of the distance before a light takes all of its light: shadow rays go as far as the light. And how
// far trace() sees. No statistics: the answers are 0.
#include "integrator/floorscene.h"

namespace nearshade_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

void writeLooks() {
    writeShader("bydiffuse", "surface bydiffuse() { Oi = 1; Ci = diffuse(normal(0, 1, 0)); }\n");
    writeShader("byloop", R"(surface byloop() {
    normal up = normal(0, 1, 0);
    Oi = 1;
    Ci = 0;
    illuminance(P, up, PI / 2) Ci += Cl * max(0, normalize(L) . up);
}
)");
    writeShader("bytrace", R"(surface bytrace() {
    Oi = 1;
    Ci = trace(P, vector(0, 1, 0), "distribution", "cosine", "samplecone", PI / 2, "samplearealights", 1, "type", "diffuse");
}
)");
    writeShader("radiant", "light radiant(float radiance = 1) { illuminate(P, N, PI / 2) Cl = radiance; }\n");
    writeShader("traced", R"(light traced(float radiance = 9) {
    point at = point "world" (0, 2, 0);
    illuminate(at) Cl = radiance * transmission(Ps, at);
}
)");
}
std::string number(double x) {
    char t[40];
    std::snprintf(t, sizeof t, "%.9g", x);
    return t;
}
struct Light {
    const char* name;
    std::string rib; ///< its lowest point is 2 above the origin
    bool area;
};
std::vector<Light> lights() {
    const std::string shadows = "Attribute \"light\" \"string shadows\" \"on\"\n";
    auto area = [&](const std::string& shape) {
        return "AttributeBegin\nAttribute \"visibility\" \"trace\" 1\nAttribute \"light\" \"string units\" \"radiance\"\n" +
               shadows + "AreaLightSource \"radiant\" 7 \"radiance\" 9\nSurface \"constant\"\nColor 0 0 0\n" + shape +
               "AttributeEnd\nIlluminate 7 1\n";
    };
    return {{"point", shadows + "LightSource \"pointlight\" 7 \"intensity\" 36 \"from\" [0 2 0]\n", false},
            {"spot", shadows + "LightSource \"spotlight\" 7 \"intensity\" 36 \"from\" [0 2 0] \"to\" [0 0 0] \"coneangle\" .5\n",
             false},
            {"disk", area("Translate 0 2 0\nRotate 90 1 0 0\nDisk 0 .7 360\n"), true},
            {"polygon", area("Polygon \"P\" [-.5 2 -.5  .5 2 -.5  .5 2 .5  -.5 2 .5]\n"), true},
            {"ball", area("Translate 0 2.5 0\nSphere .5 -.5 .5 360\n"), true},
            {"asks itself", "LightSource \"traced\" 7\n", false}};
}
/// A card over the whole floor, so far above it.
std::string card(double height, const std::string& opacity = "1 1 1") {
    const std::string y = number(height);
    return "AttributeBegin\nAttribute \"visibility\" \"trace\" 1\nAttribute \"visibility\" \"transmission\" \"Os\"\n"
           "Surface \"constant\"\nColor 0 0 0\nOpacity " +
           opacity + "\nPolygon \"P\" [-60 " + y + " -60  60 " + y + " -60  60 " + y + " 60  -60 " + y + " 60]\nAttributeEnd\n";
}

} // namespace

// Point, spot and area lights by diffuse(), by a loop and by trace(), under each hider; the card hangs .002 below lights at a
// distance of 2.
TEST(NearShade, TakesAll) {
    writeLooks();
    for (Hider h : {Hider::Path, Hider::Raytrace, Hider::Hidden})
        for (const char* look : {"bydiffuse", "byloop", "bytrace"})
            for (const Light& l : lights()) {
                const bool byTrace = std::string(look) == "bytrace";
                if (byTrace && (!l.area || h == Hider::Hidden)) continue; // trace() meets what has a surface
                const std::string what = std::string(l.name) + " " + look + " hider " + std::to_string(int(h));
                const std::string floor = std::string("Surface \"") + look + "\"\n" + kFloor;
                EXPECT_GT(Scene(inWorld(l.rib + floor), under(h)).estimate(kView, 400).mean(), .1) << what << " without a card";
                EXPECT_EQ(Scene(inWorld(l.rib + card(1.998) + floor), under(h)).estimate(kView, 400).mean(), 0) << what;
                if (h == Hider::Path && std::string(l.name) == "asks itself") continue; // path takes a quarter once more
                Moments half = Scene(inWorld(l.rib + card(1.998, ".25 .25 .25") + floor), under(h)).estimate(kView, 4000);
                Moments open = Scene(inWorld(l.rib + floor), under(h)).estimate(kView, 4000);
                EXPECT_NEAR(half.mean(), .75 * open.mean(), kZ * std::hypot(half.se(), open.se()) + 1e-5)
                    << what << " behind a card that takes a quarter";
            }
}
// The lamp in a closed ball of radius .002, 2 away.
TEST(NearShade, ALampInABall) {
    writeLooks();
    const std::string ball = "AttributeBegin\nAttribute \"visibility\" \"trace\" 1\n"
                             "Attribute \"visibility\" \"transmission\" \"opaque\"\nSurface \"constant\"\nColor 0 0 0\nTranslate "
                             "0 2 0\nSphere .002 -.002 .002 360\nAttributeEnd\n";
    for (Hider h : {Hider::Path, Hider::Raytrace, Hider::Hidden})
        for (const char* look : {"bydiffuse", "byloop"})
            for (const Light& l : {lights()[0], lights()[1], lights()[5]})
                EXPECT_EQ(
                    Scene(inWorld(l.rib + ball + "Surface \"" + look + "\"\n" + kFloor), under(h)).estimate(kView, 16).mean(), 0)
                    << l.name << " " << look << " hider " << int(h);
}
// "maxdist" ends the ray before what lies beyond; where it meets nothing until then it has met nothing, and shows the sky (under
// path) as any ray that misses.
TEST(TraceMaxDistance, TheSkyIsBehindIt) {
    const std::string sky = "LightSource \"envlight\" 1 \"intensity\" 1\n", wall = card(10);
    auto shows = [&](const char* name, const std::string& things, const std::string& pairs, int n) {
        writeShader(name, std::string("surface ") + name + "() { Oi = 1; Ci = trace(P, vector(0, 1, 0)" + pairs + "); }\n");
        return Scene(inWorld(things + "Surface \"" + name + "\"\n" + kFloor), under(Hider::Path)).estimate(kView, n);
    };
    EXPECT_NEAR(shows("maxdist1", sky, ", \"maxdist\", 5", 4).mean(), 1, 1e-6);
    EXPECT_NEAR(shows("maxdist2", sky + wall, ", \"maxdist\", 5", 4).mean(), 1, 1e-6) << "a wall beyond it is not met";
    EXPECT_EQ(shows("maxdist3", sky + wall, ", \"maxdist\", 20", 4).mean(), 0) << "a wall before it is";
    EXPECT_EQ(shows("maxdist4", sky + wall, "", 4).mean(), 0);
    const std::string lobe = ", \"distribution\", \"cosine\", \"samplecone\", 1, \"samplearealights\", 1, \"maxdist\", 5";
    EXPECT_NEAR(shows("maxdist5", sky, lobe, 400).mean(), 1, 1e-5);
    EXPECT_NEAR(shows("maxdist6", sky + wall, lobe, 400).mean(), 1, 1e-5);
}

} // namespace nearshade_test
