// Lights of RIS except for their units (ris_test.cpp): how maps and days are turned, filters, profiles, links. Closed forms.
#include "integrator/harness.h"
#include "integrator/maps.h"

namespace rislights_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const char* kSquare = "Polygon \"P\" [-1 -1 2  1 -1 2  1 1 2  -1 1 2]\n";

Settings path() {
    Settings s;
    s.hider = Hider::Path;
    return s;
}
void writePaint() {
    writeShader("rispaint", "surface rispaint(varying color diffuseColor = 1;) { Oi = 1; Ci = diffuseColor * "
                            "diffuse(faceforward(normalize(N), I)); }\n");
}
/// diffuse() of white paint at a point of the square, which faces lights behind the eye.
Moments paint(const std::string& lights, Vec3 at = {0, 0, 2}, int errors = 0) {
    writePaint();
    Scene s("WorldBegin\n" + lights + "Bxdf \"rispaint\" \"b\"\n" + kSquare + "WorldEnd\n", path(), errors);
    return s.estimate(rayTo({.5f, 0, 0}, at), samples(3000, 100'000));
}
std::string block(const std::string& text) { return "AttributeBegin\n" + text + "\nAttributeEnd\n"; }

/// The form factor of a rectangle of half sides a and b, parallel to an element on its axis at distance h (Siegel and Howell,
/// Thermal Radiation Heat Transfer, B-4, four times).
double ofRectangle(double a, double b, double h) {
    const double x = a / h, y = b / h, p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
    return 2 / M_PI * (x / p * std::atan(y / p) + y / q * std::atan(x / q));
}

const std::string kLamp = "Light \"PxrRectLight\" \"l\" \"float intensity\" 4";
/// A disk of radius .05 about the origin, which is nearly a point.
const std::string kSmall = "Scale .1 .1 .1\nLight \"PxrDiskLight\" \"l\" \"float intensity\" 400";

// The layout of OpenEXR as OpenUSD turns PRMan's domes to it: the left edge of the map is +x, a quarter from it -y, its top +z.
TEST(RisLights, MapsOfDomesAreTurnedAsPublished) {
    const std::string map = writeMap("risdome.exr", 8, 4, [](int x, int y, int c) {
        return c == 0 ? float(x + 1) : c == 1 ? float(y + 1) : 1.f;
    });
    writeShader("rislooks",
                "surface rislooks(float x = 0, y = 0, z = 0;) { Oi = 1; Ci = trace(P, vtransform(\"world\", \"current\", "
                "vector(x, y, z))); }\n");
    for (int column = 0; column < 8; ++column)
        for (int row = 1; row < 3; ++row) {
            if (!chosen(size_t(column + row), 2)) continue;
            const double phi = -2 * M_PI * (column + .5) / 8, theta = M_PI * (row + .5) / 4;
            std::ostringstream looks;
            looks << "\"float x\" " << std::sin(theta) * std::cos(phi) << " \"float y\" " << std::sin(theta) * std::sin(phi)
                  << " \"float z\" " << std::cos(theta);
            Scene s("WorldBegin\nLight \"PxrDomeLight\" \"l\" \"string lightColorMap\" " + map + "\nBxdf \"rislooks\" \"b\" " +
                        looks.str() + "\n" + kSquare + "WorldEnd\n",
                    path());
            const Color c = s.one(rayTo({0, 0, 0}, {.1f, .1f, 2}));
            EXPECT_NEAR(c.x, column + 1, .2) << column << ' ' << row;
            EXPECT_NEAR(c.y, row + 1, .2) << column << ' ' << row;
        }
}

// The light of the shape is that of its radiance, intensity / area, through the form factor.
TEST(RisLights, GeometryThatShinesMayKeepItsPowerAtAnySize) {
    for (const char* light : {"AreaLightSource \"PxrStdAreaLight\" \"a\" \"float intensity\" 4",
                              "Light \"PxrMeshLight\" \"a\" \"float intensity\" 4 \"int areaNormalize\" 1"})
        for (double half : {.05, .5}) {
            std::ostringstream shape;
            shape << light << "\nBxdf \"PxrBlack\" \"k\"\nScale " << half << ' ' << half
                  << " 1\nPolygon \"P\" [-1 -1 0  1 -1 0  1 1 0  -1 1 0]";
            const double want = 4 / (4 * half * half) * ofRectangle(half, half, 2);
            expectMean(paint(block(shape.str())), want, .01 * want, light);
        }
    for (const char* light : {"Light \"PxrMeshLight\" \"a\" \"float intensity\" 4",
                              "AreaLightSource \"PxrStdAreaLight\" \"a\" \"float intensity\" 4 \"int areaNormalize\" 0"})
        expectMean(paint(block(std::string(light) + "\nBxdf \"PxrBlack\" \"k\"\nPolygon \"P\" [-1 -1 0  1 -1 0  1 1 0  -1 1 0]")),
                   4 * ofRectangle(1, 1, 2), .02, light);
}

TEST(RisLights, ShadowsKeepWhatIsNotShadowColor) {
    const std::string sheet = "Bxdf \"PxrSurface\" \"s\" \"float diffuseGain\" 0 \"color shadowColor\" [.3 .3 .3]\n"
                              "Polygon \"P\" [-9 -9 -1  9 -9 -1  9 9 -1  -9 9 -1]";
    expectMean(paint("Light \"PxrDistantLight\" \"l\" \"float intensity\" 2 \"int areaNormalize\" 1\n" + block(sheet)),
               .3 * 2 / M_PI, .001, "behind a sheet");
}

// A wall between lamp and paint: with enableShadows 0 the form factor is as without it, for lamps that rays of lobes meet, too.
TEST(RisLights, WithoutShadowsLightPassesWhatIsInTheWay) {
    const std::string wall = block("Attribute \"visibility\" \"int camera\" 0\nSurface \"constant\"\nColor 0 0 0\n"
                                   "Polygon \"P\" [-9 -9 1  9 -9 1  9 9 1  -9 9 1]");
    for (const double half : {.5, 3.0}) {
        std::ostringstream size;
        size << "Scale " << 2 * half << ' ' << 2 * half << " 1\n";
        const std::string lamp = size.str() + "Light \"PxrRectLight\" \"l\" \"float intensity\" 4 \"int enableShadows\" ";
        const double want = 4 * ofRectangle(half, half, 2);
        expectMean(paint(block(lamp + "0") + wall), want, .02, "none");
        EXPECT_EQ(paint(block(lamp + "1") + wall).mean(), 0);
    }
    for (const char* far :
         {"PxrDistantLight\" \"l\" \"int areaNormalize\" 1", "PxrDomeLight\" \"l\"", "PxrEnvDayLight\" \"l\""}) {
        const std::string sky = std::string("Light \"") + far + " \"int enableShadows\" ";
        const Moments free = paint(block(sky + "1")), behind = paint(block(sky + "0") + wall);
        EXPECT_GT(free.mean(), .01) << far;
        EXPECT_NEAR(free.mean(), behind.mean(), 4.753 * (free.se() + behind.se()) + 1e-6) << far;
    }
}

TEST(RisLights, AMissingMapIsSaidAndTheLightShinesWithoutIt) {
    expectMean(
        paint("Light \"PxrDomeLight\" \"l\" \"float intensity\" .5 \"string lightColorMap\" \"nowhere.tex\"\n", {0, 0, 2}, 1), .5,
        .01, "sky of a map that is missing");
}

// In Greenwich at the solstice the sun is in the east in the morning, in the south at noon: +y and -x of the light's space.
TEST(RisLights, TheSunOfADayRisesInTheEast) {
    const auto lit = [&](const char* hour, const char* turn) {
        return paint(block(std::string(turn) + "\nLight \"PxrEnvDayLight\" \"l\" \"int month\" 6 \"int day\" 21 \"float hour\" " +
                           hour + " \"float latitude\" 51 \"float longitude\" 0 \"float zone\" 0"))
            .mean();
    };
    // The square faces the eye, that is -z of the world: turned there are the directions of the light's space in question.
    const char *y = "Rotate 90 1 0 0", *minusY = "Rotate -90 1 0 0", *x = "Rotate -90 0 1 0", *minusX = "Rotate 90 0 1 0";
    const double east = std::max(lit("6", y), lit("6", minusY)), west = std::min(lit("6", y), lit("6", minusY));
    EXPECT_GT(east, 3 * west);
    // The turn that shows the square the east in the morning shows it the west in the evening.
    const char* eastTurn = lit("6", y) > lit("6", minusY) ? y : minusY;
    EXPECT_LT(3 * lit("18", eastTurn), lit("18", eastTurn == y ? minusY : y));
    EXPECT_GT(std::max(lit("12", x), lit("12", minusX)), 2 * std::min(lit("12", x), lit("12", minusX)));
    EXPECT_STREQ(eastTurn, minusY); // which brings +y of the light's space to -z of the world
    EXPECT_GT(lit("12", x), lit("12", minusX));
}

TEST(RisFilters, IntensityIsMultipliedAndEndsWithItsBlock) {
    const double whole = 4 * ofRectangle(.5, .5, 2);
    expectMean(paint(block("LightFilter \"PxrIntMultLightFilter\" \"f\" \"float intensity\" .25 \"float exposure\" 1\n" + kLamp)),
               .5 * whole, .01, "a quarter, doubled");
    expectMean(paint(block("LightFilter \"PxrIntMultLightFilter\" \"f\" \"float intensity\" 4 \"int invert\" 1\n" + kLamp)),
               whole / 4, .01, "divided");
    expectMean(paint(block("LightFilter \"PxrIntMultLightFilter\" \"f\" \"float intensity\" 0") + block(kLamp)), whole, .01,
               "of another block");
    expectMean(
        paint(block(
            "LightFilter \"PxrIntMultLightFilter\" \"f\" \"float intensity\" .5\nLightFilter \"PxrIntMultLightFilter\" \"g\" "
            "\"float intensity\" .5\n" +
            kLamp)),
        whole / 4, .01, "two");
}

TEST(RisFilters, ABarnIsAWindow) {
    // Seen from the square, .4 by .2 at a distance of 1 before a lamp of 3 by 3.
    const std::string wide = "Scale 3 3 1\n" + kLamp;
    const std::string barn =
        "TransformBegin\nTranslate 0 0 1\nLightFilter \"PxrBarnLightFilter\" \"f\" \"float width\" .4 \"float height\" .2 "
        "\"float radius\" 0\nTransformEnd\n";
    expectMean(paint(block(barn + wide)), 4 * ofRectangle(.2, .1, 1), .08, "window");
    expectMean(paint(block(barn + "LightFilter \"PxrIntMultLightFilter\" \"g\" \"float intensity\" .5\n" + wide)),
               2 * ofRectangle(.2, .1, 1), .08, "window and half");
}

TEST(RisFilters, ARodDarkensWhatIsInIt) {
    const auto rod = [](const std::string& more) {
        return "TransformBegin\nTranslate 0 0 2\nLightFilter \"PxrRodLightFilter\" \"f\" " + more + "\nTransformEnd\n";
    };
    const double whole = 4 * ofRectangle(.5, .5, 2);
    EXPECT_EQ(paint(block(rod("") + kLamp)).mean(), 0);
    expectMean(paint(block(rod("\"float density\" .25") + kLamp)), .75 * whole, .01, "density");
    expectMean(paint(block(rod("\"float intensity\" 2") + kLamp)), 2 * whole, .01, "brighter");
    // A ball of radius .25 with an edge of .5: at .5 from its middle half of the way, where the smooth step has 1/2.
    const std::string soft =
        rod("\"float width\" .5 \"float height\" .5 \"float depth\" .5 \"float radius\" .25 \"float edge\" .5");
    const Vec3 at{.5f, 0, 2};
    const double there = paint(block(kSmall), at).mean();
    EXPECT_NEAR(paint(block(soft + kSmall), at).mean() / there, .5, .01);
}

TEST(RisFilters, ARampGoesByTheDistance) {
    const double whole = paint(block(kSmall)).mean();
    const auto ramp = [&](const std::string& more) {
        return paint(block("LightFilter \"PxrRampLightFilter\" \"f\" \"float beginDist\" 0 \"float endDist\" 4 " + more + "\n" +
                           kSmall))
            .mean();
    };
    EXPECT_NEAR(ramp("") / whole, .5, .002); // from 1 to 0, at half of the way
    EXPECT_NEAR(ramp("\"float[3] ramp_Knots\" [0 .25 .75] \"float[3] ramp_Floats\" [0 1 .5]") / whole, .75, .002);
    EXPECT_NEAR(ramp("\"int rampType\" 1 \"float[2] ramp_Knots\" [0 1] \"float[2] ramp_Floats\" [1 0]") / whole, .5,
                1e-4); // z is 2
}

TEST(RisFilters, AGoboIsAPictureBeforeTheLight) {
    const std::string map = writeMap("risgobo.exr", 4, 4, Color(.5f, .25f, 1));
    const auto gobo = [&](const std::string& more) {
        return paint(block("TransformBegin\nTranslate 0 0 .5\nLightFilter \"PxrGoboLightFilter\" \"f\" \"string map\" " + map +
                           more + "\nTransformEnd\n" + kLamp));
    };
    const double whole = 4 * ofRectangle(.5, .5, 2);
    const Moments all = gobo(" \"float width\" 8 \"float height\" 8");
    EXPECT_NEAR(all.mean(0), .5 * whole, .02 * whole);
    EXPECT_NEAR(all.mean(1), .25 * whole, .02 * whole);
    EXPECT_NEAR(all.mean(2), whole, .02 * whole);
    // Nothing passes beside it: it is .6 across, 1.5 before the square, as .8 at the distance of the lamp.
    expectMean(gobo(" \"float width\" .6 \"float height\" .6 \"color fillColor\" [0 0 0]"), .5 * 4 * ofRectangle(.3, .3, 1.5),
               .03, "in a frame");
}

TEST(RisFilters, WhatIsNotKnownIsSaidOnce) {
    writePaint();
    Scene s("WorldBegin\nLightFilter \"PxrNoSuchLightFilter\" \"f\"\nLightFilter \"PxrNoSuchLightFilter\" \"g\"\nLightFilter "
            "\"PxrRodLightFilter\" \"h\" \"string coordsys\" \"nowhere\"\nBxdf \"rispaint\" \"b\"\n" +
                std::string(kSquare) + "WorldEnd\n",
            path(), 1);
    const std::string said = "LightFilter \"PxrNoSuchLightFilter\" is left out";
    EXPECT_NE(s.messages().find(said), std::string::npos);
    EXPECT_EQ(s.messages().find(said), s.messages().rfind(said)) << s.messages();
}

/// A profile of 3 angles from the axis, the same all around: 200, 100 and 0 candelas.
std::string profile(const std::string& name, const std::string& text) {
    std::ofstream(shaderFolder() + "/" + name) << text;
    return shaderFolder() + "/" + name;
}
const char* kProfile = "IESNA:LM-63-2002\n[TEST] none\nTILT=NONE\n1 1000 1 3 1 1 2 0 0 0\n1 1 50\n0 45 90\n0\n200 100 0\n";

TEST(RisProfiles, LightIsAsItsPhotometrySays) {
    profile("ris.ies", kProfile);
    const auto with = [&](Vec3 at) {
        writePaint();
        Scene s(
            "Option \"searchpath\" \"string archive\" \"" + shaderFolder() + "\"\nWorldBegin\n" +
                block("Scale .1 .1 .1\nLight \"PxrDiskLight\" \"l\" \"float intensity\" 400 \"string iesProfile\" \"ris.ies\"") +
                "Bxdf \"rispaint\" \"b\"\nPolygon \"P\" [-9 -9 2  9 -9 2  9 9 2  -9 9 2]\nWorldEnd\n",
            path());
        return s.estimate(rayTo({.5f, 0, 0}, at), 2000).mean();
    };
    const auto without = [&](Vec3 at) {
        writePaint();
        Scene s("WorldBegin\n" + block(kSmall) +
                    "Bxdf \"rispaint\" \"b\"\nPolygon \"P\" [-9 -9 2  9 -9 2  9 9 2  -9 9 2]\nWorldEnd\n",
                path());
        return s.estimate(rayTo({.5f, 0, 0}, at), 2000).mean();
    };
    for (const auto& [x, want] : {std::pair{0.f, 1.}, {.828427f, .75}, {2.f, .5}, {4.828427f, .25}}) // 0, 22.5, 45, 67.5 degrees
        EXPECT_NEAR(with({x, 0, 2}) / without({x, 0, 2}), want, .02) << x;
}

/// Two halves of the square, side by side; the first has the attributes.
Moments half(const std::string& lights, const std::string& attributes, double x, Hider hider) {
    writePaint();
    Settings set;
    set.hider = hider;
    const auto part = [](const char* points) { return std::string("Bxdf \"rispaint\" \"b\"\nPolygon \"P\" [") + points + "]\n"; };
    Scene s("WorldBegin\n" + lights + block(attributes + part("-1 -1 2  0 -1 2  0 1 2  -1 1 2")) +
                part("0 -1 2  1 -1 2  1 1 2  0 1 2") + "WorldEnd\n",
            set);
    return s.estimate(rayTo({.5f, 0, 0}, {float(x), 0, 2}), samples(3000, 100'000));
}

// Each filter multiplies the light by a number of its own, so their product says which of them acted.
TEST(RisLinks, FiltersActOnWhatSubscribesToTheirGroups) {
    const std::string plain = "LightFilter \"PxrIntMultLightFilter\" \"f\" \"float intensity\" .5\n";
    const std::string grouped =
        "LightFilter \"PxrIntMultLightFilter\" \"g\" \"float intensity\" .2 \"string linkingGroups\" [\"a, b\"]\n";
    const std::string subset = "Attribute \"lightfilter\" \"string subset\" [\"b\"]\n";
    const std::string off = "EnableLightFilter \"l\" \"f\" 0\n";
    const std::string lamp =
        "AttributeBegin\n" + plain + grouped + "Translate 0 0 -1\nScale 40 40 1\nLight \"PxrRectLight\" \"l\"\nAttributeEnd\n";
    const std::string sky = block(plain + grouped + "Light \"PxrDomeLight\" \"l\"");
    const std::string distant =
        block(plain + grouped + "Light \"PxrDistantLight\" \"l\" \"float intensity\" 3.14159265 \"int areaNormalize\" 1");
    // At x = +-.5 of a plane 3 before it the lamp of 40 by 40 has the form factor of four rectangles from the foot: two of 20.5 x
    // 20 and two of 19.5 x 20, which is the mean of two centred ones.
    const double whole = .5 * (ofRectangle(20.5, 20, 3) + ofRectangle(19.5, 20, 3));
    // A disk of half angle h has the solid angle 2 pi (1 - cos h), its light is divided by pi sin^2 h; loops take it from its
    // middle.
    const double middle = 1 / std::pow(std::cos(.53 / 4 / 180 * M_PI), 2);
    const struct {
        std::string text;
        double path, loops;
    } lights[] = {{lamp, whole, 0}, {sky, 1, 1}, {distant, 1, middle}};
    for (const auto& [light, inPath, inLoops] : lights)
        for (const Hider hider : {Hider::Path, Hider::Raytrace}) {
            const double full = hider == Hider::Path ? inPath : inLoops;
            if (full == 0) continue; // under raytrace lamps have other units
            const double tolerance = .01;
            expectMean(half(light, subset, -.5, hider), .1 * full, tolerance, light + "subscribes");
            expectMean(half(light, subset, .5, hider), .5 * full, tolerance, light + "does not");
            expectMean(half(light, subset + off, -.5, hider), .2 * full, tolerance, light + "one is off");
            expectMean(half(light, off, -.5, hider), full, tolerance, light + "none");
        }
}

// A sun in a map, 1/2000 of all directions, is sampled whatever filters the sky has: lobes alone would leave an error of 40 %.
TEST(RisLinks, SkiesWithLinkedFiltersAreSampledByTheirMaps) {
    const std::string map = writeMap("rissun.exr", 128, 64, [](int x, int y, int) {
        return (y == 50 || y == 51) && (x == 40 || x == 41) ? 4000.f : .01f; // about the direction toward which the square looks
    });
    const std::string dome = "Light \"PxrDomeLight\" \"l\" \"string lightColorMap\" " + map;
    const std::string filters =
        "LightFilter \"PxrIntMultLightFilter\" \"f\" \"float intensity\" .5\nLightFilter \"PxrIntMultLightFilter\" \"g\" \"float "
        "intensity\" .2 \"string linkingGroups\" \"b\"\nLightFilter \"PxrIntMultLightFilter\" \"h\" \"float intensity\" 0 "
        "\"string linkingGroups\" \"c\"\n";
    const Moments plain = half(block(dome), "", .5, Hider::Path);
    const auto with = [&](const std::string& subset) {
        return half(block(filters + dome), "Attribute \"lightfilter\" \"string subset\" \"" + subset + "\"\n", -.5, Hider::Path);
    };
    for (const auto& [subset, part] : {std::pair{"a", .5}, {"b", .1}, {"c", 0.}}) {
        const Moments m = with(subset);
        EXPECT_NEAR(m.mean() / plain.mean(), part, .01 * part) << subset;
        EXPECT_LE(m.se(), .005 * part * plain.mean()) << subset;
    }
}

TEST(RisLinks, SubsetsChooseLightsAndMutedOnesAreOff) {
    const std::string two =
        block("Attribute \"grouping\" \"string membership\" \"key\"\nLight \"PxrDomeLight\" \"a\" \"float intensity\" .5") +
        block("Light \"PxrDomeLight\" \"b\" \"float intensity\" .25");
    const auto linked = [&](const std::string& subset) { return paint(two + subset); };
    expectMean(linked(""), .75, .01, "all");
    expectMean(linked("Attribute \"lighting\" \"string subset\" \"key\"\n"), .5, .01, "a group");
    expectMean(linked("Attribute \"lighting\" \"string subset\" \"b\"\n"), .25, .01, "a handle");
    expectMean(linked("Attribute \"lighting\" \"string subset\" \"default,key\"\n"), .75, .01, "both");
    expectMean(linked("Attribute \"lighting\" \"string excludesubset\" \"key\"\n"), .25, .01, "without");
    EXPECT_EQ(linked("Attribute \"lighting\" \"string subset\" \"rim\"\n").mean(), 0);
    expectMean(paint(block("Attribute \"lighting\" \"int mute\" 1\nLight \"PxrDomeLight\" \"a\"") + two), .75, .01, "muted");
}

} // namespace
} // namespace rislights_test
