// solar(): lights of one direction, of a cone of directions, and skies.
#include "services/lightloopscene.h"

namespace lightloop_test {
namespace {

// solar(axis, angle): one direction without an angle; under path, directions of the cone. L of a sky is where its light goes.
TEST(Solar, ConeOfDirections) {
    writeShader("sun", "light sun(float angle = 0;) { solar(vector \"world\" (0, -1, 0), angle) Cl = 2; }\n");
    surfaceOf("meancosine", "    illuminance(P) Ci += Cl * (normalize(L) . normalize(vector \"world\" (0, 1, 0)));");
    const double half = .6; // the mean cosine over a cone is (1 + cos a) / 2
    Scene sharp(scene("LightSource \"sun\" 1\n", "\"meancosine\""), under(Hider::Path));
    EXPECT_NEAR(sharp.one(kView).x, 2, 1e-5);
    Scene hidden(scene("LightSource \"sun\" 1 \"float angle\" .6\n", "\"meancosine\""), under(Hider::Hidden));
    EXPECT_NEAR(hidden.one(kView).x, 2, 1e-5);
    for (const char* look : {"\"meancosine\"", "\"matte\" \"float Ka\" 0 \"float Kd\" 1"})
        for (const char* count : {"", "Attribute \"light\" \"integer samples\" [3]\n"}) {
            Scene soft(scene(count + std::string("LightSource \"sun\" 1 \"float angle\" .6\n"), look), under(Hider::Path));
            expectMean(soft.estimate(kView, samples(4000)), 1 + std::cos(half), .01, look);
        }
    // A half plane that hides half of the cone takes half of its light.
    const std::string wall = "AttributeBegin\nSurface \"constant\"\nColor 0 0 0\nPolygon \"P\" [0 .5 -90  90 .5 -90  90 .5 90  0 "
                             ".5 90]\nAttributeEnd\n";
    Scene shaded(scene("LightSource \"sun\" 1 \"float angle\" .6\n" + wall, "\"matte\" \"float Ka\" 0 \"float Kd\" 1"),
                 under(Hider::Path));
    expectMean(shaded.estimate(rayTo({-.3f, .2f, -.4f}, {0, 0, 0}), samples(20000)), (1 + std::cos(half)) / 2, .02, "half");
}

TEST(Solar, TheSkyKnowsItsDirection) {
    writeShader(
        "upsky",
        "light upsky() { solar() { vector d = normalize(vtransform(\"world\", L)); Cl = -ycomp(d); } }\n"); // cosine above
    surfaceOf("skyloop", "    illuminance(P, normal \"world\" (0, 1, 0), PI / 2) Ci += Cl * (normalize(L) . normalize(vector "
                         "\"world\" (0, 1, 0)));");
    // Mean of cos^2 over the hemisphere by 1 / pi: 2 pi / 3 / pi.
    for (const char* look : {"\"skyloop\"", "\"matte\" \"float Ka\" 0 \"float Kd\" 1"}) {
        Scene s(scene("LightSource \"upsky\" 1\n", look), under(Hider::Path));
        expectMean(s.estimate(kView, samples(20000)), 2 / 3.0, .01, look);
    }
}

// Without rays a sky is one light that faces the surface: diffuse() gets from it what an even sky gives, from either side.
TEST(Solar, WithoutRaysTheSkyFacesTheSurface) {
    writeShader("evensky", "light evensky() { solar() Cl = color(2, .5, .25); }\n");
    surfaceOf(
        "onelight",
        "    illuminance(P, faceforward(normalize(N), I), PI / 2) Ci += Cl * (normalize(L) . faceforward(normalize(N), I));");
    surfaceOf("anylight",
              "    shader all[] = getlights(); illuminance(P) Ci += Cl * arraylength(all) * abs(normalize(L) . normalize(N));");
    for (const char* look : {"\"matte\" \"float Ka\" 0 \"float Kd\" 1", "\"onelight\"", "\"anylight\""})
        for (const char* attribute : {"", "Attribute \"light\" \"integer samples\" [4]\n"}) {
            Scene s(scene(attribute + std::string("LightSource \"evensky\" 1\n"), look), under(Hider::Hidden));
            const Color c = s.one(kView);
            EXPECT_NEAR(c.x, 2, 1e-5) << look;
            EXPECT_NEAR(c.y, .5, 1e-5) << look;
            EXPECT_NEAR(c.z, .25, 1e-5) << look;
        }
}

// A light without area has no normal: N is that of the lit point, as Ns, however the light is found (RISpec 3.2, table 12.3).
TEST(Solar, TheSkyHasTheNormalOfTheLitPoint) {
    writeShader("litsky", "light litsky() { solar() {\n"
                          "    float up = normalize(N) . normalize(vtransform(\"world\", \"current\", vector(0, 1, 0)));\n"
                          "    Cl = color(abs(up), abs(normalize(Ns) . normalize(N)), 0); } }\n");
    writeShader("facingsky", "light facingsky() { solar() Cl = abs(normalize(I) . normalize(N)); }\n");
    surfaceOf("facing", "    Ci = abs(normalize(I) . normalize(N));");
    const double facing = Scene(scene("", "\"facing\""), under(Hider::Hidden)).one(kView).x;
    surfaceOf("tracedsky",
              "    Ci = trace(P, faceforward(normalize(N), I), \"distribution\", \"cosine\", \"samplecone\", PI / 2);");
    for (const Hider h : {Hider::Hidden, Hider::Path})
        for (const char* look : {"\"matte\" \"float Ka\" 0 \"float Kd\" 1", "\"tracedsky\""}) {
            if (h == Hider::Hidden && std::string(look) == "\"tracedsky\"") continue; // no ray sees it there
            Scene s(scene("LightSource \"litsky\" 1\n", look), under(h));
            const Color c = s.one(kView);
            EXPECT_NEAR(c.x, 1, 1e-5) << int(h) << look << s.messages();
            EXPECT_NEAR(c.y, 1, 1e-5) << int(h) << look;
            Scene viewed(scene("LightSource \"facingsky\" 1\n", look), under(h));
            EXPECT_NEAR(viewed.one(kView).x, facing, 1e-5) << int(h) << look;
        }
}

// Ns and I of the lit point are known to an area light where a ray meets it, too.
TEST(Solar, LampsThatRaysMeetKnowTheLitPoint) {
    writeShader("litlamp",
                "light litlamp() { illuminate(P, N, PI / 2) Cl = 3 * abs(normalize(Ns) . normalize(vtransform(\"world\", "
                "\"current\", vector(0, 1, 0)))); }\n");
    writeShader("plainlamp", "light plainlamp() { illuminate(P, N, PI / 2) Cl = 3; }\n");
    const auto lit = [](const std::string& lamp) {
        Scene s(
            scene(
                "AttributeBegin\nAreaLightSource \"" + lamp +
                    "\" 1\nSurface \"constant\"\nPolygon \"P\" [-1 1 -1  -1 1 1  1 1 1  1 1 -1]\nAttributeEnd\nIlluminate 1 1\n",
                "\"matte\" \"float Ka\" 0 \"float Kd\" 1"),
            under(Hider::Path));
        return s.estimate(kView, samples(4000));
    };
    const auto plain = lit("plainlamp");
    EXPECT_GT(plain.mean(), .1);
    const auto asked = lit("litlamp");
    EXPECT_NEAR(asked.mean(), plain.mean(), 4.753 * (asked.se() + plain.se()));
}

} // namespace
} // namespace lightloop_test
