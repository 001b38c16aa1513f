// Lighting: 3Delight manual, 6.4.4. Code for all lane widths above, descriptors below (host only).
#pragma once
#include "shadeops/call.h"
#include "shadeops/geometry.h"
#include "shadeops/lighting_fresnel.h"
#include "shadeops/specular.h"

namespace alpenglow::shadeops::AL_NAMESPACE {

template <class T>
AL_INLINE Triple<T> opSpecularBrdf(const Triple<T>& l, const Triple<T>& n, const Triple<T>& v, const T& roughness) {
    const T cosine = larger(T(vf(0)), dot(n, opNormalize(opNormalize(l) + v)));
    const T p = power(cosine, divide(T(vf(kSpecularExponent)), roughness));
    const T r = select(value(roughness) > 0, p, T(vf(0)));
    return {r, r, r};
}

template <class T> AL_INLINE void opFresnel(const Triple<T>& i, const Triple<T>& n, const T& eta, T& kr, T& kt) {
    kr = dielectricReflectance(smaller(absolute(dot(i, n)), T(vf(1))), eta);
    kt = vf(1) - kr;
}
template <class T>
AL_INLINE void opFresnelRt(const Triple<T>& i, const Triple<T>& n, const T& eta, T& kr, T& kt, Triple<T>& reflected,
                           Triple<T>& refracted) {
    opFresnel(i, n, eta, kr, kt);
    reflected = opReflect(i, n);
    refracted = opRefract(i, n, eta);
}

AL_RUNTIME(al_specularbrdf, opSpecularBrdf)
AL_RUNTIME(al_fresnel, opFresnel)
AL_RUNTIME(al_fresnelrt, opFresnelRt)

} // namespace alpenglow::shadeops::AL_NAMESPACE

#ifdef ALPENGLOW_DESCRIBE
#include "shadeops/describe.h"

namespace alpenglow::shadeops {
namespace {

/// Adds a shadeop with what most of the section have in common.
Shadeop& addLighting(std::vector<Shadeop>& list, const char* name, std::vector<Signature> signatures, Lowering lowering,
                     const char* doc) {
    Shadeop op;
    op.section = "Lighting";
    op.source = "3Delight manual, 6.4.4";
    op.name = name;
    op.signatures = std::move(signatures);
    op.contexts = kSurface | kVolume;
    op.lowering = lowering;
    op.derivative = lowering == Lowering::Runtime ? DerivativeRule::Jet
                    : lowering == Lowering::Rsl   ? DerivativeRule::Inherent
                                                  : DerivativeRule::ZeroWarn;
    op.doc = doc;
    list.push_back(std::move(op));
    return list.back();
}

/// Light without highlights.
void addDiffuseLight(std::vector<Shadeop>& list) {
    addLighting(
        list, "ambient", sigs({{"color ambient()"}}), Lowering::Service,
        "Sum of Cl over the ambient lights: those without illuminate() and solar(). Under path, what of it comes through: the "
        "part of the hemisphere about N that surfaces block is dark. No other shadeop finds ambient light.");
    list.back().examples = {{"ambient()", "0.2 0.2 0.2", "", "there is one light \"ambientlight\" of intensity 0.2"}};

    Shadeop& diffuse =
        addLighting(list, "diffuse", sigs({{"color diffuse(vector n)"}}), Lowering::Rsl,
                    "Sum over lights of Cl max(0, n . L) (1 - __nondiffuse), L unit; no 1/PI. n is unit. Under path the "
                    "indirect light of the "
                    "same lobe is added by the light transport engine.");
    list.back().examples = {{"diffuse(N)", "1 1 1", "", kOneLight}};
    diffuse.rsl = R"(
color diffuse(vector n) {
    extern point P;
    color sum = 0;
    illuminance(P, n, PI/2) {
        extern vector L;
        extern color Cl;
        float nondiffuse = 0;
        lightsource("__nondiffuse", nondiffuse);
        sum += Cl * (max(0, normalize(L) . n) * (1 - nondiffuse));
    }
    return sum;
}
)";
}

void addSpecular(std::vector<Shadeop>& list) {
    Shadeop& specular = addLighting(
        list, "specular", sigs({{"color specular(vector n, vector v; float roughness)"}}), Lowering::Rsl,
        "Sum over lights of Cl specularbrdf(L, n, v, roughness) (1 - __nonspecular). n and v are unit, v toward the eye.");
    list.back().examples = {{"specular(N, N, 0.1)", "1 1 1", "", kOneLight}};
    specular.source = "3Delight manual, 6.4.4, which does not publish its model; see specularbrdf";
    specular.rsl = R"(
color specular(vector n, v; float roughness) {
    extern point P;
    color sum = 0;
    illuminance(P, n, PI/2) {
        extern vector L;
        extern color Cl;
        float nonspecular = 0;
        lightsource("__nonspecular", nonspecular);
        sum += Cl * (1 - nonspecular) * specularbrdf(normalize(L), n, v, roughness);
    }
    return sum;
}
)";
    Shadeop& brdf = addLighting(
        list, "specularbrdf", sigs({{"color specularbrdf(vector l, vector n, vector v; float roughness)", "al_specularbrdf"}}),
        Lowering::Runtime,
        "One direction of specular(): pow(max(0, n . h), 8 / roughness), h = normalize(l + v), l, n, v unit. 0 for roughness 0. "
        "1 / roughness, as RISpec prints it, with Option \"shade\" \"specular\" \"rispec\" or --dialect rispec.");
    brdf.source = "3Delight manual, 6.4.4; fitted on published pictures, docs/gallery.md";
    brdf.contexts = kAnyContext;
    brdf.examples = {{"specularbrdf(vector(0,0,1), vector(0,0,1), vector(0,0,1), 0.1)", "1 1 1"},
                     {"specularbrdf(vector(1,0,0), vector(0,0,1), vector(0,0,1), 4)", "0.5 0.5 0.5"}};
}

/// Highlights of other models.
void addHighlights(std::vector<Shadeop>& list) {
    Shadeop& standard =
        addLighting(list, "specularstd", sigs({{"color specularstd(normal n; vector v; float roughness)"}}), Lowering::Rsl,
                    "The text-book model: sum over lights of Cl pow(max(0, n . h), 1 / roughness) (1 - __nonspecular), h "
                    "= normalize(normalize(L) + v).");
    list.back().examples = {{"specularstd(N, N, 0.1)", "1 1 1", "", kOneLight}};
    standard.rsl = R"(
color specularstd(normal n; vector v; float roughness) {
    extern point P;
    color sum = 0;
    vector nn = normalize(n);
    vector vn = normalize(v);
    illuminance(P, nn, PI/2) {
        extern vector L;
        extern color Cl;
        float nonspecular = 0;
        lightsource("__nonspecular", nonspecular);
        vector h = normalize(normalize(L) + vn);
        sum += Cl * ((1 - nonspecular) * pow(max(0, nn . h), 1 / roughness));
    }
    return sum;
}
)";
    Shadeop& phong = addLighting(
        list, "phong", sigs({{"color phong(vector n, vector v; float size)"}}), Lowering::Rsl,
        "Phong's highlight: sum over lights of Cl pow(max(0, r . L), size) (1 - __nonspecular), r = reflect(-v, n), L unit.");
    list.back().examples = {{"phong(N, N, 10)", "1 1 1", "", kOneLight}};
    phong.rsl = R"(
color phong(vector n, v; float size) {
    extern point P;
    color sum = 0;
    vector r = reflect(-normalize(v), n);
    illuminance(P, n, PI/2) {
        extern vector L;
        extern color Cl;
        float nonspecular = 0;
        lightsource("__nonspecular", nonspecular);
        sum += Cl * ((1 - nonspecular) * pow(max(0, r . normalize(L)), size));
    }
    return sum;
}
)";
}

/// What a surface does with light of one direction.
void addReflectance(std::vector<Shadeop>& list) {
    Shadeop& bsdf =
        addLighting(list, "bsdf", sigs({{"color bsdf(vector l; normal n; pairs)"}, {"color[] bsdf(vector l; normal n; pairs)"}}),
                    Lowering::Special,
                    "One of the distributions of trace() for a single direction l toward the light: the reflection function "
                    "times the cosine n . l, so "
                    "that PI bsdf(\"oren-nayar\", roughness 0) is the weight of diffuse(). An array gets the parts of "
                    "glass-ggx (reflected, refracted) or of hair "
                    "(one a lobe). wo defaults to -I. samplecone (uniform, cosine) defaults to PI/2. What lies beyond the "
                    "plane of \"horizon\" is 0. The "
                    "hidden shadeops __bsdf_NAME document each distribution.");
    bsdf.source = "3Delight manual, 6.4.4 and 6.4.5.2; models: docs/design/rsl.md";
    bsdf.derivative = DerivativeRule::Inherent;
    bsdf.optional = distributionParameters();
    bsdf.optional.push_back(
        {{Base::Float, 0}, "samplecone", false, "PI/2", "half angle of the cone of uniform and cosine, radians"});
    bsdf.examples = {{"bsdf(vector(0,0,1), normal(0,0,1), \"distribution\", \"cosine\")", "0.3183099 0.3183099 0.3183099"}};

    Shadeop& fresnel = addLighting(
        list, "fresnel",
        sigs({{"void fresnel(vector i, vector n; float eta; output float Kr, output float Kt)", "al_fresnel"},
              {"void fresnel(vector i, vector n; float eta; output float Kr, output float Kt; output vector R, output vector T)",
               "al_fresnelrt"}}),
        Lowering::Runtime,
        "Fresnel reflectance Kr of an unpolarised ray i (unit) at the unit normal n facing it, eta = index of the side of i / "
        "index "
        "entered; Kt = 1 - Kr. R and T are the reflected and refracted directions; T is 0 and Kr 1 on total reflection.");
    list.back().examples = {
        {"round(kr * 9)", "1", "float kr = 0, kt = 0; fresnel(vector(0, 0, 1), vector(0, 0, -1), 0.5, kr, kt);"}};
    fresnel.contexts = kAnyContext;
    fresnel.source = "3Delight manual, 6.4.4; Kt = 1 - Kr is ours";
}

} // namespace

std::vector<Shadeop> lightingShadeops() {
    std::vector<Shadeop> list;
    addDiffuseLight(list);
    addSpecular(list);
    addHighlights(list);
    addReflectance(list);
    return list;
}
} // namespace alpenglow::shadeops
#endif
