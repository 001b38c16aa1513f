// ggx() and beckmann(): the facets of bsdf() summed over lights, as specular() sums its own.
#include "shadeops/describe.h"

namespace alpenglow::shadeops {

std::vector<Shadeop> facetShadeops() {
    const auto make = [](const std::string& name, const char* distribution) {
        Shadeop op;
        op.section = "Lighting";
        op.source = "bsdf(); " + std::string(distribution);
        op.name = name;
        op.contexts = kSurface | kVolume;
        op.lowering = Lowering::Rsl;
        op.derivative = DerivativeRule::Inherent;
        const std::string brief = "color " + name + "(normal n; vector v; float roughness)",
                          full = "color " + name +
                                 "(normal n; vector v; float roughness, float roughnessv; vector udir; color eta, color k)";
        op.signatures = {parseSignature(brief.c_str(), ""), parseSignature(full.c_str(), "")};
        op.doc =
            "The highlight of rough facets: sum over lights of Cl PI f (1 - __nonspecular), f the value of bsdf(L, n, "
            "\"distribution\", \"" +
            name +
            "\") with \"wo\" v, its cosine included. n is made unit; v leads toward the eye. roughness is the slope along udir "
            "and roughnessv that across it (a udir of 0: any direction, for equal ones). eta and k are the index and the "
            "extinction of a metal, each a colour; eta 0, and the short form, reflect all (Fresnel 1). Direct light alone: "
            "trace() with the same distribution brings the light of other surfaces.";
        // Straight over facets with l = n = v the value of f is D / 4 = 1 / (4 PI roughness^2).
        op.examples = {
            {name + "(N, vector(N), 1)", "0.25 0.25 0.25", "", kOneLight},
            {name + "(N, vector(N), 0.5, 0.5, vector(1,0,0), color(3,3,3), color(0,0,0))", "0.25 0.25 0.25", "", kOneLight}};
        op.rsl = "color " + name +
                 "(normal n; vector v; float roughness; float roughnessv; vector udir; color eta; color k) {\n" +
                 R"(    extern point P;
    color sum = 0;
    normal nn = normalize(n);
    vector vn = normalize(v);
    color index[2] = {eta, k};
    illuminance(P, nn, PI/2) {
        extern vector L;
        extern color Cl;
        float nonspecular = 0;
        lightsource("__nonspecular", nonspecular);
        sum += Cl * (PI * (1 - nonspecular)) * bsdf(normalize(L), nn, "distribution", ")" +
                 name + R"(", "wo", vn, "roughness", roughness,
                                                    "roughnessv", roughnessv, "udir", udir, "eta", index);
    }
    return sum;
}
)" + "color " + name +
                 "(normal n; vector v; float roughness) {\n    return " + name +
                 "(n, v, roughness, roughness, vector 0, color 0, color 0);\n}\n";
        return op;
    };
    return {make("ggx", "Walter et al. 2007"), make("beckmann", "Beckmann and Spizzichino 1963; Walter et al. 2007")};
}

} // namespace alpenglow::shadeops
