// The principled surface shaders/standard.sl and the materials of RIS that are made of the same layers: in white furnaces,
// compared with closed forms of point lights, and through clear glass.
#include "integrator/floorscene.h"

namespace standard_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

constexpr const char* kSky = "LightSource \"envlight\" 1 \"intensity\" 1\n";
CameraRay viewAt(double degrees) {
    const double a = degrees * kPi / 180;
    return rayTo({float(std::sin(a)), float(std::cos(a)), 0}, {0, 0, 0});
}
struct Furnace {
    const char* surface;
    double least, most;  ///< of what it gives back of a sky of radiance 1
    bool closed = false; ///< a ball, for light that goes through
};
void expectFurnace(const Furnace& f, int n = 3000) {
    const std::string shape = f.closed ? "Translate 0 -1 0\nSphere 1 -1 1 360\n" : kFloor;
    Settings s = withShaders(Hider::Path);
    s.unbiased = true;
    Scene scene(inWorld(std::string(kSky) + "Surface " + f.surface + "\n" + shape), s);
    for (const double angle : {0., 45., 75.}) {
        const Moments m = scene.estimate(viewAt(angle), samples(n));
        for (int k = 0; k < 3; ++k) {
            EXPECT_GE(m.mean(k) + kZ * m.se(k), f.least) << f.surface << " at " << angle << " +- " << m.se(k);
            EXPECT_LE(m.mean(k) - kZ * m.se(k), f.most) << f.surface << " at " << angle << " +- " << m.se(k);
            EXPECT_LE(m.se(k), .012) << f.surface << ": not precise enough to decide";
        }
    }
}

/// F of a dielectric seen from outside.
double dielectric(double c, double eta) {
    const double g = std::sqrt(eta * eta - 1 + c * c), s = (g - c) / (g + c), p = (c * (g + c) - 1) / (c * (g - c) + 1);
    return .5 * s * s * (1 + p * p);
}
/// Walter et al. 2007 with Smith's shadowing at heights: D G F / (4 n.v), by the definition.
double facets(double a, double eta, Vec3d l, Vec3d v) {
    const auto lambda = [&](const Vec3d& w) { return (std::sqrt(1 + a * a * (1 / (w.y * w.y) - 1)) - 1) / 2; };
    const Vec3d sum = l + v, h = sum * (1 / std::sqrt(dot(sum, sum)));
    const double c2 = h.y * h.y, t = c2 * (a * a - 1) + 1, d = a * a / (kPi * t * t);
    return d * dielectric(dot(h, v), eta) / (4 * v.y * (1 + lambda(l) + lambda(v)));
}
/// The integral of facets over the hemisphere, by midpoints.
double facetsInAll(double a, double eta, Vec3d v) {
    double sum = 0;
    const int n = 600;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double z = (i + .5) / n, s = std::sqrt(1 - z * z), f = 2 * kPi * (j + .5) / n;
            sum += facets(a, eta, {s * std::cos(f), z, s * std::sin(f)}, v);
        }
    return sum * 2 * kPi / n / n;
}

} // namespace

// Each layer over a white base, and white metals: what arrives leaves, within the error of the fits (2 %).
TEST(Standard, WhiteFurnaceOfLayers) {
    const Furnace all[] = {
        {"\"standard\" \"base_color\" [1 1 1]", .98, 1.02},
        {"\"standard\" \"base_color\" [1 1 1] \"specular_roughness\" 0", .98, 1.01},
        {"\"standard\" \"base_color\" [1 1 1] \"specular_roughness\" .7 \"specular_IOR\" 1.8", .98, 1.02},
        {"\"standard\" \"base_color\" [1 1 1] \"specular\" 0", .999, 1.001},
        {"\"standard\" \"base_color\" [1 1 1] \"specular\" 0 \"sheen\" 1 \"sheen_roughness\" .4", .99, 1.01},
        {"\"standard\" \"base_color\" [1 1 1] \"coat\" 1 \"coat_roughness\" .3", .97, 1.03},
        {"\"standard\" \"base_color\" [1 1 1] \"metalness\" 1 \"specular_roughness\" .3", .97, 1.02},
        {"\"standard\" \"base_color\" [1 1 1] \"metalness\" 1 \"specular_roughness\" .8", .97, 1.02},
        {"\"standard\" \"base_color\" [1 1 1] \"metalness\" 1 \"specular_roughness\" 0", .99, 1.001},
        {"\"standard\" \"base_color\" [1 1 1] \"metalness\" .5 \"coat\" .5 \"sheen\" .5", .97, 1.03},
        {"\"standard\" \"base\" 0 \"specular\" 0 \"emission\" 1 \"emission_color\" [1 1 1]", .9999, 1.0001},
    };
    for (const Furnace& f : all) expectFurnace(f);
}
// Light that goes through a ball or a sheet and below a surface.
TEST(Standard, WhiteFurnaceOfWhatComesThrough) {
    const Furnace all[] = {
        {"\"standard\" \"transmission\" 1 \"specular_roughness\" 0", .999, 1.001, true},
        // Facets that lose light to others: docs/bsdfs.md, several times on the way.
        {"\"standard\" \"transmission\" 1 \"specular_roughness\" .3", .84, 1.001, true},
        {"\"standard\" \"transmission\" .5 \"base_color\" [1 1 1] \"specular_roughness\" .2", .95, 1.02, true},
        {"\"standard\" \"transmission\" 1 \"thin_walled\" 1 \"specular_roughness\" 0", .999, 1.001},
        {"\"standard\" \"transmission\" 1 \"thin_walled\" 1 \"specular_roughness\" .5", .98, 1.02},
        {"\"standard\" \"specular\" 0 \"subsurface\" 1 \"subsurface_color\" [.999 .999 .999] \"subsurface_scale\" .05", .95, 1.01,
         true},
    };
    for (const Furnace& f : all) expectFurnace(f, 2000);
}
// None of RIS' materials makes light; white ones that are to keep it do.
TEST(Standard, WhiteFurnaceOfRis) {
    const Furnace all[] = {
        {"\"ris/PxrDiffuse\" \"diffuseColor\" [1 1 1]", .9999, 1.0001},
        {"\"ris/PxrDisney\" \"baseColor\" [1 1 1]", .97, 1.02},
        {"\"ris/PxrDisney\" \"baseColor\" [1 1 1] \"clearcoat\" 1 \"clearcoatGloss\" .5 \"sheen\" 0", .97, 1.02},
        {"\"ris/PxrDisney\" \"baseColor\" [1 1 1] \"specular\" 0 \"sheen\" 1", .999, 1.001},
        {"\"ris/PxrDisney\" \"baseColor\" [1 1 1] \"sheen\" 1 \"clearcoat\" 1", .97, 1.02},
        {"\"ris/PxrDisneyBsdf\" \"baseColor\" [1 1 1] \"specReflectScale\" 0 \"sheen\" 1", .999, 1.001},
        {"\"ris/PxrDisney\" \"baseColor\" [1 1 1] \"metallic\" 1 \"roughness\" .2", .93, 1.001},
        {"\"ris/PxrDisneyBsdf\" \"baseColor\" [1 1 1] \"specTrans\" 1 \"roughness\" 0", .999, 1.001, true},
        {"\"ris/PxrSurface\" \"diffuseColor\" [.5 .5 .5]", .4999, .5001},
        {"\"ris/PxrSurface\" \"diffuseColor\" [1 1 1] \"specularFaceColor\" [.2 .2 .2] \"specularEdgeColor\" [1 1 1] "
         "\"specularEnergyCompensation\" 1 \"specularModelType\" 1",
         .97, 1.02},
        {"\"ris/PxrSurface\" \"diffuseGain\" 0 \"specularFresnelMode\" 1 \"specularEdgeColor\" [1 1 1] \"specularModelType\" 1 "
         "\"specularIor\" [.2 .2 .2] \"specularExtinctionCoeff\" [5 5 5]",
         .9, 1},
        {"\"ris/PxrSurface\" \"diffuseGain\" 0 \"refractionGain\" 1 \"reflectionGain\" 1 \"glassRoughness\" 0", .999, 1.001,
         true},
        {"\"ris/PxrSurface\" \"diffuseGain\" 0 \"refractionGain\" 1 \"reflectionGain\" 1 \"glassRoughness\" .2 "
         "\"glassRefractionRoughness\" .1",
         .9, 1.01, true},
        {"\"ris/PxrGlass\" \"reflectionColor\" [1 1 1] \"transmissionColor\" [1 1 1]", .999, 1.001, true},
        {"\"ris/PxrLMGlass\" \"refractionColor\" [1 1 1] \"roughness\" 0", .999, 1.001, true},
        {"\"ris/PxrLMGlass\" \"refractionColor\" [1 1 1] \"roughness\" 0 \"thin\" 1", .999, 1.001},
        {"\"ris/PxrLMDiffuse\" \"frontColor\" [1 1 1] \"backColor\" [1 1 1] \"translucence\" .4", .9999, 1.0001},
        {"\"ris/PxrConstant\" \"emitColor\" [1 1 1]", .9999, 1.0001},
        {"\"ris/PxrBlack\"", 0, 1e-6},
        {"\"ris/PxrLMPlastic\" \"diffuseColor\" [1 1 1] \"clearcoatColor\" [1 1 1]", .97, 1.03},
        {"\"ris/LamaDiffuse\" \"diffuseColor\" [1 1 1]", .9999, 1.0001},
        {"\"ris/LamaConductor\" \"fresnelMode\" 1 \"reflectivity\" [1 1 1] \"edgeColor\" [1 1 1] \"roughness\" .4", .97, 1.02},
        {"\"ris/LamaConductor\" \"fresnelMode\" 1 \"reflectivity\" [1 1 1] \"edgeColor\" [1 1 1] \"roughness\" .1 \"tailMix\" .5",
         .97, 1.02},
        {"\"ris/LamaDielectric\" \"roughness\" 0", .999, 1.001, true},
        {"\"ris/LamaEmission\" \"emissionColor\" [1 1 1]", .9999, 1.0001},
    };
    for (const Furnace& f : all) expectFurnace(f);
}
// Light that walks below a white sky's floor leaves it by the albedos of the three ranges together: weight times colour of each.
TEST(Standard, AlbedosOfSubsurfaceRangesAddUp) {
    Settings s = withShaders(Hider::Path);
    s.shaderPaths.push_back(std::string(ALPENGLOW_SOURCE_DIR) + "/shaders/ris");
    Scene scene(
        inWorld(
            std::string(kSky) +
            "Bxdf \"PxrLMSubsurface\" \"b\" \"color nearColor\" [1 1 1] \"float nearWeight\" [.2] \"color midColor\" [1 .5 0] "
            "\"float midWeight\" [.3] \"color farColor\" [1 0 0] \"float farWeight\" [.4] \"float unitLength\" [1e-3]\n" +
            kFloor),
        s);
    const Moments m = scene.estimate(viewAt(30), samples(20000));
    const double want[3] = {.9, .35, .2};
    for (int k = 0; k < 3; ++k) {
        EXPECT_LE(m.se(k), .012);
        EXPECT_NEAR(m.mean(k), want[k], .015 + kZ * m.se(k)) << k;
    }
}

/// A floor of that material under a white sky.
void expectNodes(const std::string& nodes, const double (&want)[3], double within) {
    Settings s = withShaders(Hider::Path);
    s.shaderPaths.push_back(std::string(ALPENGLOW_SOURCE_DIR) + "/shaders/ris");
    Scene scene(inWorld(std::string(kSky) + nodes + kFloor), s);
    const Moments m = scene.estimate(viewAt(30), samples(2000));
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(m.mean(k), want[k], within + kZ * m.se(k)) << nodes;
}

// Layers of PRMan 20: lambertian ones of albedo a and mask m leave (1 - m) of what is below. In a white furnace the albedo is
// seen.
TEST(Standard, LayersOfLmMaterials) {
    const std::string plain = " \"color specularColor\" [0 0 0]", take = " \"reference struct lmlayer\" [\"%:result\"]";
    const auto from = [&](const char* handle) {
        std::string t = take;
        return t.replace(t.find('%'), 1, handle);
    };
    const std::string red = "Pattern \"PxrLMLayer\" \"red\" \"float layerMask\" [.25] \"color diffuseColor\" [1 0 0]" + plain +
                            "\n",
                      base = "Bxdf \"PxrLMDiffuse\" \"b\" \"color frontColor\" [.2 .2 .2] \"color backColor\" [.2 .2 .2]";
    const auto green = [&](const char* mask) {
        return std::string("Pattern \"PxrLMLayer\" \"green\" \"float layerMask\" [") + mask + "] \"color diffuseColor\" [0 1 0]" +
               plain + from("red") + "\n";
    };
    const struct {
        std::string nodes;
        double want[3], within;
    } all[] = {
        {red + base + from("red") + "\n", {.4, .15, .15}, 1e-4},
        {red + green("0") + base + from("green") + "\n", {.4, .15, .15}, 1e-4}, // a layer that is not there changes nothing
        {red + green(".5") + base + from("green") + "\n",
         {.325, .45, .075},
         1e-4}, // red on top: .25 red + .375 green + .375 base
        {red + "Pattern \"PxrLMLayer\" \"blue\" \"float layerMask\" [.5] \"color diffuseColor\" [0 0 1]" + plain +
             "\nPattern \"PxrLMMixer\" \"m\" \"reference struct baselayer\" [\"red:result\"] \"reference struct layer1\" "
             "[\"blue:result\"] \"float layer1Mask\" [.5]\n" +
             base + from("m") + "\n", // .25 blue, then .25 of .75 red, the rest base
         {.3, .1125, .3625},
         1e-4},
        {"Pattern \"PxrLMLayer\" \"white\" \"color diffuseColor\" [1 1 1] \"color clearcoatColor\" [1 1 1]\n" + base +
             from("white") + "\n",
         {1, 1, 1},
         .03}};
    for (const auto& a : all) expectNodes(a.nodes, a.want, a.within);
}

// Nodes of Lama that are made of others: weights of mixtures and sums, and a layer that leaves the rest to the one below.
TEST(Standard, LamaOfNodes) {
    const std::string two = "Bxdf \"LamaDiffuse\" \"a\" \"color diffuseColor\" [.8 .4 0]\nBxdf \"LamaDiffuse\" \"b\" \"color "
                            "diffuseColor\" [.2 .2 .2]\n",
                      ends = "\"reference bxdf material1\" [\"a:bxdf_out\"] \"reference bxdf material2\" [\"b:bxdf_out\"]";
    const struct {
        std::string nodes;
        double want[3], within;
    } all[] = {{two + "Bxdf \"LamaMix\" \"m\" " + ends + " \"float mix\" [.25]\n", {.65, .35, .05}, 1e-4},
               {two + "Bxdf \"LamaAdd\" \"m\" " + ends + " \"float weight1\" [.5] \"float weight2\" [1]\n", {.6, .4, .2}, 1e-4},
               {two + "Bxdf \"LamaMix\" \"m\" " + ends +
                    " \"float mix\" [.5]\nBxdf \"LamaSurface\" \"s\" \"reference bxdf "
                    "materialFront\" [\"m:bxdf_out\"]\n",
                {.5, .3, .1},
                1e-4},
               {"Bxdf \"LamaDiffuse\" \"a\" \"color diffuseColor\" [1 1 1]\nBxdf \"LamaDielectric\" \"b\" \"float roughness\" "
                "[.3]\nBxdf \"LamaLayer\" \"l\" \"reference bxdf materialTop\" [\"b:bxdf_out\"] \"reference bxdf materialBase\" "
                "[\"a:bxdf_out\"]\n",
                {1, 1, 1},
                .02}};
    for (const auto& c : all) expectNodes(c.nodes, c.want, c.within);
}
// Lambert and facets under a point light: each sees it once. The fit of what the facets leave for Lambert is within .006.
TEST(Standard, PointLightOverLambertAndFacets) {
    const Vec3d eye = Vec3d(.6, .8, 0), to = Vec3d(-.5, 1, .3);
    const double d2 = dot(to, to), roughness = .5, a = roughness * roughness, albedo = .6;
    const Vec3d l = to * (1 / std::sqrt(d2));
    const double cl = 7 / d2, below = 1 - facetsInAll(a, 1.5, eye);
    const double want = cl * (albedo * below * l.y + kPi * facets(a, 1.5, l, eye));
    const std::string light = "LightSource \"pointlight\" 1 \"intensity\" 7 \"point from\" [-.5 1 .3]\n";
    for (const Hider h : {Hider::Path, Hider::Raytrace}) {
        Scene s(inWorld(light + "Surface \"standard\" \"base_color\" [.6 .6 .6] \"specular_roughness\" .5\n" + kFloor),
                withShaders(h));
        EXPECT_NEAR(s.one(rayTo({.6f, .8f, 0}, {0, 0, 0})).x, want, cl * albedo * .008);
    }
    // The highlight alone is exact.
    Scene shine(inWorld(light + "Surface \"standard\" \"base\" 0 \"specular_roughness\" .5\n" + kFloor),
                withShaders(Hider::Path));
    EXPECT_NEAR(shine.one(rayTo({.6f, .8f, 0}, {0, 0, 0})).x, cl * kPi * facets(a, 1.5, l, eye), 2e-4 * want);
    // PxrSurface adds its lobes up.
    Scene sum(inWorld(light +
                      "Surface \"ris/PxrSurface\" \"diffuseColor\" [.6 .6 .6] \"specularFresnelMode\" 1 \"specularEdgeColor\" "
                      "[1 1 1] \"specularModelType\" 1 \"specularRoughness\" .5\n" +
                      kFloor),
              withShaders(Hider::Path));
    EXPECT_NEAR(sum.one(rayTo({.6f, .8f, 0}, {0, 0, 0})).x, cl * (albedo * l.y + kPi * facets(a, 1.5, l, eye)), 2e-4 * want);
}
// A pane of clear glass before an emitter: (1 - R)^2 of its radiance by Fresnel's law, and R (1 - R)^2 T^2 ... of further
// bounces.
TEST(Standard, ClearGlassAndDepth) {
    const std::string lamp =
        "AttributeBegin\nSurface \"constant\"\nPolygon \"P\" [-9 -3 -9  -9 -3 9  9 -3 9  9 -3 -9]\nAttributeEnd\n";
    const std::string slab =
        "Surface \"standard\" \"transmission\" 1 \"specular_roughness\" 0 \"transmission_color\" [.5 .25 .8] "
        "\"transmission_depth\" 2\n"
        "Polygon \"P\" [-60 0 -60  -60 0 60  60 0 60  60 0 -60]\n"
        "Polygon \"P\" [-60 -1 -60  60 -1 -60  60 -1 60  -60 -1 60]\n";
    Scene s(inWorld(lamp + slab), withShaders(Hider::Path));
    const double r = .04;
    const Moments m = s.estimate(rayTo({0, 2, 0}, {0, 0, 0}), samples(20000));
    const double kept[3] = {std::sqrt(.5), .5, std::sqrt(.8)}; // of one way through the slab
    for (int k = 0; k < 3; ++k) {
        const double want = (1 - r) * (1 - r) * kept[k] / (1 - r * r * kept[k] * kept[k]);
        EXPECT_NEAR(m.mean(k), want, kZ * m.se(k) + 1e-5) << "channel " << k;
        EXPECT_LE(m.se(k), .01);
    }
}

} // namespace standard_test
