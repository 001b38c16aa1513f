// What is seen where a scene has neither lights nor surface shaders, and which side given normals make the front.
#include "transport/floorscene.h"

namespace surfacedefaults_test {

using namespace alpenglow;
using namespace alpenglow::transport;
using namespace alpenglow::transport::testing;

namespace {

float seen(const std::string& inside, Hider h, const CameraRay& from = kView, std::string* said = nullptr) {
    Scene s(world(inside), withShaders(h));
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

} // namespace

} // namespace surfacedefaults_test
