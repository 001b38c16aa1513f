// What is seen where a scene has neither lights nor surface shaders, and which side given normals make the front.
#include "integrator/floorscene.h"

namespace surfacedefaults_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

float seen(const std::string& inside, Hider h, const CameraRay& from = kView, std::string* said = nullptr) {
    Scene s(inWorld(inside), withShaders(h));
    if (said) *said = s.messages();
    return s.one(from).x;
}

// The shader defaultsurface: .2 + .8 cos^2 of the angle of view. (.3, .8, -.4) sees the floor with cos^2 = .64 / .89.
TEST(SurfaceDefaults, LitFromTheEyeWithoutLightsAndShaders) {
    const double want = .2 + .8 * .64 / .89;
    for (const Hider h : {Hider::Path, Hider::Hidden, Hider::Raytrace}) {
        std::string said;
        EXPECT_NEAR(seen(kFloor, h, kView, &said), want, 1e-5) << int(h);
        EXPECT_EQ(said.find("lit from the eye") != said.npos, h == Hider::Path) << said;
    }
    // Whatever may give light decides under path: a light, even one that is off, and shaders.
    EXPECT_EQ(seen("LightSource \"pointlight\" 1 \"intensity\" 0\n" + std::string(kFloor), Hider::Path), 0);
    EXPECT_EQ(seen(std::string(kFloor) + "Surface \"matte\"\nTranslate 0 -5 0\n" + kFloor, Hider::Path), 0);
}

// RISpec: ReverseOrientation turns primitives inside out. Files that give "N" as well mean the side of "N", whatever the request:
// faceforward() then takes the normal that faces the eye, which faces the light.
TEST(GivenNormals, SayWhichSideIsTheFront) {
    writeShader("frontlit", R"(surface frontlit() {
    normal n = faceforward(normalize(N), I);
    Oi = 1;
    Ci = color(n . vector "world" (0, 1, 0), normalize(Ng) . normalize(N), normalize(calculatenormal(P)) . normalize(N));
}
)");
    const std::string shapes[] = {"Polygon \"P\" [-60 0 -60  -60 0 60  60 0 60  60 0 -60] ",
                                  "Polygon \"P\" [-60 0 -60  60 0 -60  60 0 60  -60 0 60] ", // the other winding
                                  "PointsPolygons [4] [0 1 2 3] \"P\" [-60 0 -60  -60 0 60  60 0 60  60 0 -60] ",
                                  "Patch \"bilinear\" \"P\" [-60 0 -60  60 0 -60  -60 0 60  60 0 60] "};
    for (const std::string& shape : shapes)
        for (const char* request : {"", "ReverseOrientation\n", "Orientation \"rh\"\n"})
            for (const char* n : {" 0 1 0", " 0 -1 0"})
                for (const Hider h : {Hider::Path, Hider::Hidden}) {
                    const std::string normals = std::string("\"N\" [") + n + n + n + n + "]\n";
                    Scene s(inWorld("Surface \"frontlit\"\n" + std::string(request) + shape + normals), withShaders(h));
                    const Color c = s.one(kView);
                    for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], 1, 1e-5) << k << " " << request << shape << normals;
                }
}

// Instances share the geometry, which was made for another orientation.
TEST(GivenNormals, OfInstances) {
    writeShader("frontside", "surface frontside() { Oi = 1; Ci = normalize(Ng) . normalize(N); }\n");
    std::string mesh = "PointsPolygons [";
    std::string index = "[", points = "[", normals = "[";
    for (int i = 0; i < 400; ++i) { // large enough to be shared
        mesh += "3 ";
        index += std::to_string(3 * i) + " " + std::to_string(3 * i + 1) + " " + std::to_string(3 * i + 2) + " ";
        points += "-60 0 -60  -60 0 60  60 0 60 ";
        normals += "0 1 0 0 1 0 0 1 0 ";
    }
    mesh += "] " + index + "] \"P\" " + points + "] \"N\" " + normals + "]\n";
    Settings set = withShaders(Hider::Path);
    for (const char* place : {"", "ReverseOrientation\n", "Scale -1 1 1\n", "Scale -1 1 1\nReverseOrientation\n"}) {
        Scene s("WorldBegin\nSides 2\nSurface \"frontside\"\nObjectBegin 1\n" + mesh +
                    "ObjectEnd\nAttributeBegin\nTranslate 0 -9 0\n" + "ObjectInstance 1\nAttributeEnd\n" + place +
                    "ObjectInstance 1\nWorldEnd\n",
                set);
        EXPECT_NEAR(s.one(rayTo({-8, 3, 5}, {place[0] == 'S' ? 9.f : -9.f, 0, 5})).x, 1, 1e-5) << place;
    }
}

// Half of the faces wind one way, half the other: that cannot be put right, and is said.
TEST(GivenNormals, OnBothSidesAreTold) {
    Scene s(
        inWorld("Surface \"constant\"\nPointsPolygons [3 3] [0 1 2 0 1 2] \"P\" [-1 0 -1  -1 0 1  1 0 1] \"facevarying normal "
                "N\" [0 1 0 0 "
                "1 0 0 1 0  0 -1 0 0 -1 0 0 -1 0]\n"),
        withShaders(Hider::Path));
    EXPECT_NE(s.messages().find("on the front of some faces and on the back of others (1 of 2 places"), std::string::npos)
        << s.messages();
}

} // namespace

} // namespace surfacedefaults_test
