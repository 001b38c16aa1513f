// Ray tracing: rsl.md 12.1 and 12.2 (seed 6.4.5). Answered by rays; here are signatures and optional parameters.
#include "shadeops/describe.h"

namespace alpenglow::rsl {
namespace {

constexpr Type kF{Base::Float, 0}, kS{Base::String, 0}, kC{Base::Color, 0}, kV{Base::Vector, 0}, kFs{Base::Float, -1}, kCs{Base::Color, -1};

/// Table 6.10.
std::vector<OptionalParameter> rayParameters() {
    return {{kS, "label", false, "\"\"", "label of the rays, for rayinfo"},
            {kS, "subset", false, "\"\"", "groups of objects considered (attribute grouping:membership), \"-g\" leaves one out; none: attribute grouping:tracesubset"},
            {kF, "bias", false, "-1", "offset of the ray's start; negative: attribute trace:bias, and without that the error of the point"},
            {kS, "hitmode", false, "\"default\"", "shader runs the shaders that are met, primitive takes Color and Opacity; default: attributes shade:specularhitmode, diffusehitmode, transmissionhitmode"},
            {kS, "hitsides", false, "", "from where surfaces with Sides 1 are met: front, back, both, reversed (back); not given: front, for transmission both"},
            {kF, "maxdist", false, "1e38", "no intersections beyond this distance"},
            {kF, "samplecone", false, "0", "half angle of the cone of directions, radians"},
            {kF, "samples", false, "1", "number of samples"},
            {kS, "type", false, "\"specular\"", "specular, diffuse or transmission: which visibility counts"},
            {kC, "weight", false, "1", "importance of the ray; accepted, the renderer has its own"},
            {kF, "minsamples", false, "samples", "accepted and ignored"},
            {kF, "samplebase", false, "0", "part of the footprint over which trace() starts its rays"},
            {kS, "excludesubset", false, "\"\"", "groups of objects left out"},
            {kS, "raytype", false, "\"specular\"", "another name of type"},
            {kS, "raylabel", false, "\"\"", "another name of label"},
            {kF, "maxhitdist", false, "1e38", "another name of maxdist"}};
}

/// Table 6.11.
std::vector<OptionalParameter> hemisphereParameters() {
    return {{kF, "coneangle", false, "PI/2", "half angle of the cone of directions, radians"},
            {kV, "axis", false, "0", "only directions toward the axis"},
            {kF, "samplebase", false, "0", "jitter of the ray's start over the footprint"},
            {kF, "adaptive", false, "1", "adaptive sampling"},
            {kF, "minsamples", false, "samples / 4", "lower bound of adaptive sampling"},
            {kS, "distribution", false, "\"cosine\"", "uniform or cosine"},
            {kF, "falloffmode", false, "0", "0 exponential, 1 polynomial"},
            {kF, "falloff", false, "0", "strength of the falloff"},
            {kF, "maxvariation", false, "0", "accepted and ignored"},
            {kF, "maxerror", false, "0", "accepted and ignored"},
            {kF, "maxpixeldist", false, "0", "accepted and ignored"},
            {kF, "brightnesswarp", false, "0", "accepted and ignored"},
            {kS, "environmentmap", false, "\"\"", "light of directions that hit nothing"},
            {kS, "environmentspace", false, "\"current\"", "space of the map"},
            {kC, "environmentcolor", true, "", "environment light of unoccluded rays"},
            {kV, "environmentdir", true, "", "mean unoccluded direction"},
            {kF, "occlusion", true, "", "occlusion, computed at the same time"},
            {kF, "pointbased", false, "0", "1 uses point clouds"},
            {kS, "filename", false, "\"\"", "point cloud"},
            {{Base::String, -1}, "filenames", false, "{}", "point clouds"},
            {kF, "maxsolidangle", false, "0.1", "opening criterion of clusters"},
            {kF, "clamp", false, "1", "clamp to 1"},
            {kF, "sortbleeding", false, "0", "bleeding in order of distance"},
            {kS, "coordsystem", false, "\"world\"", "space of the point cloud"}};
}

std::vector<OptionalParameter> subsurfaceParameters() {
    return {{kS, "type", false, "\"pointcloud\"", "raytrace or pointcloud"},
            {kF, "samples", false, "attribute subsurface:samples", "rays"},
            {kS, "model", false, "\"jensen\"", "jensen or grosjean"},
            {kC, "irradiance", false, "from the first pass", "light entering here"},
            {kC, "scattering", false, "attribute", "coefficient"},
            {kC, "absorption", false, "attribute", "coefficient"},
            {kC, "meanfreepath", false, "attribute", "alternative specification"},
            {kC, "reflectance", false, "attribute", "alternative specification"},
            {kF, "ior", false, "1.3", "index of refraction"},
            {kF, "refractionindex", false, "1.3", "index of refraction"},
            {kF, "scale", false, "1", "scene unit"},
            {kS, "groupname", false, "attribute", "primitives that share light"}};
}

} // namespace

std::vector<OptionalParameter> distributionParameters() {
    return {{kS, "distribution", false, "\"uniform\"", "uniform cosine oren-nayar blinn ashikhmin-shirley cook-torrance ward glass-ggx hair"},
            {kS, "bsdf", false, "\"uniform\"", "another name of distribution"},
            {kV, "wo", false, "0", "toward the viewer"},
            {kV, "horizon", false, "0", "normal of a plane that cuts the distribution"},
            {kF, "roughness", false, "0", "0..1 (oren-nayar unbounded)"},
            {kF, "roughnessv", false, "roughness", "roughness of the second axis"},
            {kV, "udir", false, "0", "axis of roughness; hair: orientation and eccentricity"},
            {kCs, "eta", false, "0; glass-ggx 1.5; hair 1.55", "index of refraction (float, color, or two colours: index and extinction)"},
            {kC, "absorption", false, "0", "hair absorption"},
            {kFs, "lobeparameters", false, "{}", "hair: 4 values per lobe; glass-ggx: reflection and refraction weights"}};
}

std::vector<Shadeop> raytracingShadeops() {
    std::vector<Shadeop> list;
    const auto add = [&](const char* name, std::vector<Signature> signatures, Lowering lowering, const char* doc) -> Shadeop& {
        Shadeop op;
        op.section = "Ray tracing";
        op.source = "seed";
        op.name = name;
        op.signatures = std::move(signatures);
        op.contexts = kSurface | kVolume | kLight;
        op.lowering = lowering;
        op.derivative = DerivativeRule::ZeroWarn;
        op.pure = false; // each call draws its own random numbers
        op.doc = doc;
        op.optional = rayParameters();
        list.push_back(std::move(op));
        return list.back();
    };
    Shadeop& trace = add("trace",
                         sigs({{"color trace(point p; vector r; pairs)"},
                               {"color trace(point p; vector r; output float dist; pairs)"},
                               {"color[] trace(point p; vector r; pairs)"},
                               {"color[] trace(point p; vector r; output float dist; pairs)"},
                               {"float trace(point p; vector r)"}}),
                         Lowering::Request,
                         "Light arriving at p from direction r, or gathered over a distribution about r. An array gets the parts of glass-ggx (reflected, refracted) or of hair (one a lobe), each by rays of its own. dist: distance of the nearest hit, above 1e30 for none. "
                         "The float form is that distance, among objects visible to transmission. Current space.");
    list.back().examples = {{"trace(P, N)", "1 1 1", "", kWhite}};
    trace.lastResort = {Base::Float};
    trace.optional = trace.optional + distributionParameters() +
                     std::vector<OptionalParameter>{{kS, "environmentmap", false, "\"\"", "light of directions that hit nothing"},
                                                    {kS, "environmentspace", false, "\"current\"", "space of the map"},
                                                    {kC, "environmenttint", false, "1", "multiplies the map"},
                                                    {kF, "exponent", false, "1000", "\"slphong\": Phong exponent; 1000 and above is one direction"},
                                                    {kF, "samplearealights", false, "0", "1: area lights with strategy \"trace\" are seen"},
                                                    {kC, "transmission", true, "", "transmission along the rays"},
                                                    {kV, "hitnormal", true, "", "ours: normal of the surface at the nearest hit, 0 for none"},
                                                    {kC, "environmentcontribution", true, "", "part of the environment map; an array when the result is one, as the next three"},
                                                    {kC, "unshadowedenvironment", true, "", "the same without geometry"},
                                                    {kC, "arealightcontribution", true, "", "part of the area lights"},
                                                    {kC, "unshadowedarealight", true, "", "the same without geometry"}};
    add("transmission", sigs({{"color transmission(point a, point b; pairs)"}}), Lowering::Request,
        "Visibility between a and b among objects visible to transmission: 1 free, 0 blocked, a colour through translucent surfaces.");
    list.back().examples = {{"transmission(P, P + N)", "1 1 1", "", kNothing}};
    Shadeop& occlusion = add("occlusion", sigs({{"float occlusion(point p; vector r; pairs)"}, {"float occlusion(point p; vector r; float samples; pairs)"},
                                  {"float occlusion(string map; point p; vector r; float samples; pairs)"},
                                  {"color occlusion(point p; vector r; float angle; output vector bent; pairs)"}}),
                             Lowering::Unavailable,
                             "Part of the hemisphere about r that is blocked. The form with a half angle and a variable for the mean free direction is AIR's.");
    list.back().examples = {{"occlusion(P, N, 16)", "0"}};
    occlusion.optional = occlusion.optional + hemisphereParameters();
    Shadeop& indirect = add("indirectdiffuse",
                            sigs({{"color indirectdiffuse(point p; vector r; pairs)"},
                                  {"color indirectdiffuse(point p; vector r; float samples; pairs)"},
                                  {"color indirectdiffuse(string map; point p; vector r; float samples; pairs)"},
                                  {"color indirectdiffuse(string envmap; vector dir)"}}),
                            Lowering::Unavailable, "Diffuse light that arrives by way of other surfaces, or from an environment map.");
    list.back().examples = {{"indirectdiffuse(P, N, 16)", "0 0 0"}};
    indirect.optional = indirect.optional + hemisphereParameters();
    Shadeop& subsurface = add("subsurface", sigs({{"color subsurface(point p; pairs)"},
                                                  {"color subsurface(point p; normal n; pairs)"},
                                                  {"color subsurface(string type; point p; normal n; pairs)"}}),
                              Lowering::Unavailable,
                              "Light that leaves at p after scattering below the surface. The form that begins with the type (\"raytrace\", \"raytraced\", "
                              "\"pointcloud\") is that of PRMan 16.");
    list.back().examples = {{"subsurface(P)", "0 0 0"}};
    subsurface.optional = subsurface.optional + subsurfaceParameters();
    subsurface.contexts = kSurface | kLight; // classes that are both
    Shadeop& photonmap = add("photonmap", sigs({{"color photonmap(string name; point p; vector n; pairs)"}, {"float photonmap(string name; point p; vector n; pairs)"}}),
                             Lowering::Unavailable, "Irradiance or radiance from a photon map.");
    list.back().examples = {{"photonmap(\"none.map\", P, N)", "0"}};
    photonmap.bias = Bias::Biased;
    photonmap.biasReason = "density estimate over a disc";
    photonmap.optional = {{kF, "estimator", false, "50", "number of photons"},
                          {kS, "lookuptype", false, "\"irradiance\"", "irradiance or radiance"},
                          {kF, "mindepth", false, "0", "smallest number of bounces"}};
    Shadeop& caustic = add("caustic", sigs({{"color caustic(point p; vector n)"}, {"float caustic(point p; vector n)"}}), Lowering::Unavailable,
                           "photonmap() of the attributes photon:causticmap and photon:estimator.");
    list.back().examples = {{"color caustic(P, N)", "0 0 0"}};
    caustic.bias = Bias::Biased;
    caustic.biasReason = "density estimate over a disc";
    caustic.optional.clear();
    add("gather", sigs({{"float gather(string category; point p; vector dir; float angle, float samples; pairs)"}}), Lowering::Unavailable,
        "A statement of the language: its body runs for every ray that hits, its else for every miss.");
    list.back().examples = {{"misses", "1", "float misses = 0; gather(\"illuminance\", P, N, 0.5, 4) { } else misses += 1;"}};
    return list;
}

} // namespace alpenglow::rsl
