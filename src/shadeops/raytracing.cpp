// Ray tracing: 3Delight manual, 6.4.5. Answered by rays; here are signatures and optional parameters.
#include "shadeops/describe.h"
#include "shadeops/distributions.h"
#include <array>

namespace alpenglow::shadeops {
namespace {

/// Table 6.10. type: the default of "type".
std::vector<OptionalParameter> rayParameters(const char* type = "\"specular\"") {
    return {
        {kS, "label", false, "\"\"", "label of the rays, for rayinfo"},
        {kS, "subset", false, "\"\"",
         "groups of objects considered (attribute grouping:membership), \"-g\" leaves one out; none: attribute "
         "grouping:tracesubset"},
        {kF, "bias", false, "-1",
         "offset of the ray's start; negative: attribute trace:bias, and without that the error of the point"},
        {kS, "hitmode", false, "\"default\"",
         "shader runs the shaders that are met, primitive takes Color and Opacity; default: attributes shade:specularhitmode, "
         "diffusehitmode, transmissionhitmode"},
        {kS, "hitsides", false, "",
         "from where surfaces with Sides 1 are met: front, back, both, reversed (back); not given: front, seen from the shaded "
         "point"},
        {kF, "maxdist", false, "1e38", "no intersections beyond this distance"},
        {kF, "samplecone", false, "0", "half angle of the cone of directions, radians"},
        {kF, "samples", false, "1", "number of samples"},
        {kS, "type", false, type, "specular, diffuse or transmission: which visibility counts"},
        {kC, "weight", false, "1",
         "importance of the ray: rayinfo(\"weight\") where it arrives gives the product of those on its way; 0: trace() sends no "
         "ray"},
        {kF, "minsamples", false, "samples", "accepted and ignored"},
        {kF, "samplebase", false, "0", "part of the footprint over which trace() starts its rays"},
        {kS, "excludesubset", false, "\"\"", "groups of objects left out"},
        {kS, "raytype", false, type, "another name of type"},
        {kS, "raylabel", false, "\"\"", "another name of label"},
        {kF, "maxhitdist", false, "1e38", "another name of maxdist"}};
}

/// Table 6.11. Every ray is traced, and nothing is interpolated, but where a call asks for that.
std::vector<OptionalParameter> hemisphereParameters(const char* falloff, const char* adaptive) {
    constexpr const char* kExact = "accepted and ignored: the result is exact for its rays";
    constexpr const char* kRecords = "above 0 light is interpolated between records, about this relative error: biased. Whole "
                                     "hemispheres without outputs; others are exact";
    return {{kF, "coneangle", false, "PI/2", "half angle of the cone of directions, radians"},
            {kV, "axis", false, "0", "only directions toward the axis: a sky that is half a ball; none: all"},
            {kF, "adaptive", false, "0", adaptive},
            {kS, "distribution", false, "\"cosine\"", "of the directions: uniform or cosine"},
            {kF, "falloffmode", false, "0", falloff},
            {kF, "falloff", false, "0", falloff},
            {kF, "maxvariation", false, "0", kRecords},
            {kF, "maxerror", false, "0", kExact},
            {kF, "maxpixeldist", false, "20", "with \"maxvariation\": pixels that a record reaches at most"},
            {kF, "brightnesswarp", false, "0", kExact},
            {kS, "environmentmap", false, "\"\"", "light of directions that hit nothing"},
            {kS, "environmentspace", false, "\"current\"", "space of the map"},
            {kC, "environmentcolor", true, "", "the map's part: mean over the directions, 0 where they are blocked"},
            {kV, "environmentdir", true, "", "mean unoccluded direction, length 1; 0 where all is blocked"},
            {kF, "occlusion", true, "", "occlusion by the same rays"},
            {kF, "pointbased", false, "0",
             "1: point clouds are looked at, and no ray is sent: biased; mean error against rays below .03 "
             "(docs/pointclouds.md). Of the others only coneangle, axis, distribution, falloff, falloffmode, maxdist, bias, "
             "hitsides (not given: both), environmentmap and outputs count then"},
            {kS, "filename", false, "\"\"", "of point clouds: a file of bake3d() with _area, for light _radiosity, too"},
            {{Base::String, -1}, "filenames", false, "{}", "of point clouds: several files"},
            {kF, "maxsolidangle", false, "0.1",
             "of point clouds: steradians; clusters of points that look larger are taken apart. Smaller is slower and truer"},
            {kF, "clamp", false, "1", "of point clouds: 1, what covers a direction several times counts once; 0, sums"},
            {kF, "sortbleeding", false, "0",
             "of point clouds: 1, what is near hides what is behind it, also among clusters far away"},
            {kS, "coordsystem", false, "\"world\"", "of point clouds: space of the files"}};
}

/// Those that occlusion() and indirectdiffuse() have of table 6.10: "samples" and "samplecone" are other names there.
std::vector<OptionalParameter> commonOfHemispheres() {
    std::vector<OptionalParameter> all = rayParameters();
    for (OptionalParameter& p : all) {
        if (p.name == "samples")
            p.defaultText = "attribute irradiance:nsamples", p.doc = "number of rays, 4096 at most; the argument comes first";
        if (p.name == "samplecone") p.defaultText = "coneangle", p.doc = "another name of coneangle";
        if (p.name == "minsamples") p.doc = "accepted and ignored: the result is exact for its rays";
        if (p.name == "samplebase") p.doc = "part of the footprint over which rays start";
    }
    return all;
}

std::vector<OptionalParameter> subsurfaceParameters() {
    return {
        {kS, "type", false, "\"raytrace\"",
         "raytrace; pointcloud: what enters is read from the clouds of filename, by diffusion (Jensen and Buhler 2002): biased. "
         "Without a file rays are traced"},
        {kS, "filename", false, "\"\"",
         "of pointcloud: a file of bake3d() with _area and _radiosity, the light that enters over PI, as diffuse() gives it"},
        {{Base::String, -1}, "filenames", false, "{}", "of pointcloud: several files"},
        {kF, "maxsolidangle", false, "0.1", "of pointcloud: steradians; clusters that look larger are taken apart"},
        {kS, "coordsystem", false, "\"world\"", "of pointcloud: space of the files"},
        {kF, "samples", false, "attribute subsurface:samples; else 1 under path, 16 elsewhere", "walks of a call, 4096 at most"},
        {kS, "model", false, "\"walk\"",
         "walk: light is followed as it scatters; jensen: dipole (2001, 2002), grosjean: better dipole (d'Eon 2012), both biased "
         "where the surface is no half space"},
        {kC, "irradiance", false, "from the lights",
         "what enters at P, as diffuse() gives it; may be made of light that the shader gathers. Walks that come out here take "
         "it, by a run of the shader that prints and bakes nothing; not where it must wait for rays (a warning says so)"},
        {kC, "scattering", false, "attribute subsurface:scattering", "coefficient, 1/mm"},
        {kC, "absorption", false, "attribute subsurface:absorption", "coefficient, 1/mm"},
        {kC, "meanfreepath", false, "attribute subsurface:meanfreepath", "with reflectance: 1 / (scattering + absorption), mm"},
        {kC, "reflectance", false, "attribute subsurface:reflectance",
         "what a half space gives back of diffuse light; decides the single-scattering albedo"},
        {kF, "ior", false, "1.3",
         "index of refraction inside, relative to outside: what leaves is reflected in part (Fresnel); 1: nothing is"},
        {kF, "refractionindex", false, "1.3", "another name of ior; not given: attribute subsurface:refractionindex"},
        {kF, "scale", false, "attribute subsurface:scale, 1", "millimetres in a unit of current space"},
        {kS, "groupname", false, "attribute subsurface:groupname",
         "primitives of a group bound one inside; no group: those with the same attributes"},
        {kC, "albedo", false, "", "another name of reflectance (PRMan)"},
        {kC, "diffusemeanfreepath", false, "", "in place of meanfreepath (PRMan): 1 / sqrt(3 absorption extinction), mm"},
        {kF, "unitlength", false, "1", "another name of scale (PRMan)"},
        {kF, "anisotropy", false, "0", "ours: mean cosine of Henyey and Greenstein; of walks"}};
}

/// Which lights a lobe of trace() samples.
std::vector<OptionalParameter> lightParameters() {
    return {{kF, "samplearealights", false, "0", "1: area lights with strategy \"trace\" are seen"},
            {kF, "samplelights", false, "0",
             "ours: 1: all lights are seen as diffuse() sees them, point, spot and distant ones too, but those with strategy "
             "\"illuminance\"; in place of samplearealights. A shader that loops over lights for the same lobe leaves it out"}};
}

} // namespace

std::vector<OptionalParameter> distributionParameters() {
    return {{kS, "distribution", false, "\"uniform\"", distributionNames(" ")},
            {kS, "bsdf", false, "\"uniform\"", "another name of distribution"},
            {kV, "wo", false, "0", "toward the viewer"},
            {kV, "horizon", false, "0", "normal of a plane that cuts the distribution"},
            {kF, "roughness", false, "0", "0..1 (oren-nayar unbounded)"},
            {kF, "roughnessv", false, "roughness", "roughness of the second axis"},
            {kV, "udir", false, "0", "axis of roughness; hair: orientation and eccentricity"},
            {kCs, "eta", false, "0; glass-ggx 1.5; hair 1.55",
             "index of refraction (float, color, or two colours: index and extinction)"},
            {kC, "absorption", false, "0", "hair absorption"},
            {kFs, "lobeparameters", false, "{}", "hair: 4 values per lobe; glass-ggx: reflection and refraction weights"}};
}

namespace {

/// Adds a shadeop with the optional parameters of rays.
Shadeop& addRays(std::vector<Shadeop>& list, const char* name, std::vector<Signature> signatures, Lowering lowering,
                 const char* doc) {
    Shadeop op;
    op.section = "Ray tracing";
    op.source = "3Delight manual, 6.4.5";
    op.name = name;
    op.signatures = std::move(signatures);
    op.contexts = kSurface | kVolume | kLight;
    op.lowering = lowering;
    op.derivative = DerivativeRule::ZeroWarn;
    op.pure = false; // each call draws its own random numbers
    op.doc = doc;
    op.optional = rayParameters(std::string_view(name) == "transmission" ? "\"transmission\"" : "\"specular\"");
    list.push_back(std::move(op));
    return list.back();
}

void addTrace(std::vector<Shadeop>& list) {
    Shadeop& trace =
        addRays(list, "trace",
                sigs({{"color trace(point p; vector r; pairs)"},
                      {"color trace(point p; vector r; output float dist; pairs)"},
                      {"color[] trace(point p; vector r; pairs)"},
                      {"color[] trace(point p; vector r; output float dist; pairs)"},
                      {"float trace(point p; vector r)"}}),
                Lowering::Request,
                "Light arriving at p from direction r, or gathered over a distribution about r. An array gets the parts "
                "of glass-ggx (reflected, refracted) or of hair (one a lobe), each by rays of its own. dist: distance "
                "of the nearest hit, above 1e30 for none. "
                "The float form is that distance, among objects visible to transmission. Current space. From the zero "
                "vector comes nothing.");
    list.back().examples = {{"trace(P, N)", "1 1 1", "", kWhite}};
    trace.lastResort = {Base::Float};
    trace.optional = trace.optional + distributionParameters() + lightParameters() +
                     std::vector<OptionalParameter>{
                         {kS, "environmentmap", false, "\"\"", "light of directions that hit nothing"},
                         {kS, "environmentspace", false, "\"current\"", "space of the map"},
                         {kC, "environmenttint", false, "1", "multiplies the map"},
                         {kF, "exponent", false, "1000", "\"slphong\": Phong exponent; 1000 and above is one direction"},
                         {kC, "transmission", true, "", "transmission along the rays"},
                         {kV, "hitnormal", true, "", "ours: normal of the surface at the nearest hit, 0 for none"},
                         {kC, "environmentcontribution", true, "",
                          "part of the environment map; an array when the result is one, as the next three"},
                         {kC, "unshadowedenvironment", true, "", "the same without geometry"},
                         {kC, "arealightcontribution", true, "", "part of the area lights"},
                         {kC, "unshadowedarealight", true, "", "the same without geometry"}};
    addRays(list, "transmission", sigs({{"color transmission(point a, point b; pairs)"}}), Lowering::Request,
            "Visibility between a and b among objects visible to transmission: 1 free, 0 blocked, a colour through translucent "
            "surfaces.");
    list.back().examples = {{"transmission(P, P + N)", "1 1 1", "", kNothing}};
}

/// Light and its absence over a hemisphere.
void addHemispheres(std::vector<Shadeop>& list) {
    Shadeop& occlusion = addRays(
        list, "occlusion",
        sigs({{"float occlusion(point p; vector r; pairs)"},
              {"float occlusion(point p; vector r; float samples; pairs)"},
              {"float occlusion(string map; point p; vector r; float samples; pairs)"},
              {"color occlusion(point p; vector r; float angle; output vector bent; pairs)"}}),
        Lowering::Request,
        "Part of the hemisphere about r, or of a cone, that is blocked by what is visible to transmission: 0 open, 1 closed, "
        "weighted by the cosine to r. What is translucent counts by its opacity, and shaders run only where that must be known. "
        "No samples, or 0: attribute irradiance:nsamples. The form with a half angle and a variable for the mean free "
        "direction is AIR's; that with a map traces rays.");
    list.back().examples = {{"occlusion(P, N, 16)", "0", "", kNothing}};
    occlusion.optional =
        commonOfHemispheres() +
        hemisphereParameters("a hit at distance d blocks by: mode 0 exp(-falloff d), mode 1 (1 - d / maxdist)^falloff",
                             "above 0: \"minsamples\" rays are sent first, and the others only where those disagree: biased");
    for (OptionalParameter& p : occlusion.optional)
        if (p.name == "minsamples")
            p.defaultText = "a quarter of samples",
            p.doc = "rays that are sent first where \"adaptive\" is above 0, or this is given without it";
        else if (p.name == "type" || p.name == "raytype") p.defaultText = "\"transmission\"";
    Shadeop& indirect = addRays(
        list, "indirectdiffuse",
        sigs({{"color indirectdiffuse(point p; vector r; pairs)"},
              {"color indirectdiffuse(point p; vector r; float samples; pairs)"},
              {"color indirectdiffuse(string map; point p; vector r; float samples; pairs)"},
              {"color indirectdiffuse(string envmap; vector dir)"}}),
        Lowering::Request,
        "Light that arrives from the hemisphere about r by way of surfaces visible to diffuse rays, and of an environment map "
        "where "
        "they meet nothing: irradiance / PI, which is 1 where everything shows 1. The same as trace() with distribution "
        "\"cosine\" and samplecone PI/2. The form with a map and a direction alone is the same of the map, with nothing before "
        "it, "
        "integrated without noise; its directions are those of environment(). No samples, or 0: attribute irradiance:nsamples.");
    list.back().examples = {{"indirectdiffuse(P, N, 16)", "1 1 1", "", kWhite},
                            {"indirectdiffuse(\"sky.env\", N)", "0.5 0.7 1", "", "the map has this colour everywhere"}};
    indirect.optional =
        commonOfHemispheres() + hemisphereParameters("a hit at distance d counts by: mode 0 exp(-falloff d), mode 1 (1 - d / "
                                                     "maxdist)^falloff; the rest shows the environment map",
                                                     "accepted and ignored: the result is exact for its rays");
    for (OptionalParameter& p : indirect.optional)
        if (p.name == "type" || p.name == "raytype") p.defaultText = "\"diffuse\"";
}

void addSubsurface(std::vector<Shadeop>& list) {
    Shadeop& subsurface = addRays(
        list, "subsurface",
        sigs({{"color subsurface(point p; pairs)"},
              {"color subsurface(point p; normal n; pairs)"},
              {"color subsurface(string type; point p; normal n; pairs)"}}),
        Lowering::Request,
        "Light that leaves at p after scattering below the surface: 1 where radiance 1 comes from everywhere and nothing is "
        "absorbed. Light enters the closed surface (primitives of one group) evenly from all sides, is followed from event to "
        "event, and leaves evenly to all sides; where it enters it is what the shader there says by \"irradiance\", else that "
        "of lights and of diffuse rays, as diffuse() has it. What the boundary reflects outside is left to other lobes. It "
        "begins at p, about n, which points out of the surface (not given: of the geometry): a p near a surface of the "
        "group is put onto it along n, one inside of it stays there. The form that begins with the type is that of PRMan 16.");
    list.back().examples = {{"subsurface(P)", "0 0 0", "", kNothing}};
    std::erase_if(subsurface.optional, [](const OptionalParameter& p) { return p.name == "type" || p.name == "samples"; });
    for (OptionalParameter& p : subsurface.optional) p.doc = "accepted and ignored";
    subsurface.optional = subsurfaceParameters() + subsurface.optional;
    subsurface.contexts = kSurface | kLight; // classes that are both
}

void addPhotonMaps(std::vector<Shadeop>& list) {
    Shadeop& photonmap =
        addRays(list, "photonmap",
                sigs({{"color photonmap(string name; point p; vector n; pairs)"},
                      {"float photonmap(string name; point p; vector n; pairs)"}}),
                Lowering::Service,
                "Light from a photon map at p on the side of n: irradiance / PI, which is 1 where light of radiance "
                "1 arrives from everywhere, "
                "as of indirectdiffuse(); or radiance, what the surface there gives back of it as diffuse light. "
                "The power of the nearest photons "
                "is divided by the area of the disc that reaches to the one after them. Hider \"photon\" writes "
                "maps; where there is no file of "
                "the name and a light has attribute light:emitphotons 1, the map is made before the picture begins. "
                "The float form is the luminance. Without n (Pixie), N.");
    list.back().examples = {{"photonmap(\"none.map\", P, N)", "0"}, {"photonmap(\"none.map\", P)", "0"}};
    photonmap.bias = Bias::Biased;
    photonmap.biasReason = "density estimate over a disc";
    photonmap.optional = {
        {kF, "estimator", false, "50", "number of photons, 1 to 4096"},
        {kS, "lookuptype", false, "\"irradiance\"", "irradiance or radiance"},
        {kF, "mindepth", false, "0", "smallest number of bounces: 1 leaves out what comes from the lights themselves"}};
    Shadeop& caustic = addRays(
        list, "caustic", sigs({{"color caustic(point p; vector n)"}, {"float caustic(point p; vector n)"}}), Lowering::Service,
        "photonmap() of the map and the number of photons in the attributes photon:causticmap and photon:estimator of the "
        "surface (in a light: of "
        "the surface that it lights); 0 where it has no such map.");
    list.back().examples = {{"color caustic(P, N)", "0 0 0"}};
    caustic.bias = Bias::Biased;
    caustic.biasReason = "density estimate over a disc";
    caustic.optional.clear();
}

/// Directions drawn from maps, for lights that are written in RSL.
void addSkySamples(std::vector<Shadeop>& list) {
    for (const auto& [name, rest, doc] :
         {std::array<const char*, 3>{"__skysample", "float a, b; output vector w; output color light",
                                     "Density per steradian of w, drawn in proportion to the light of an environment map, and "
                                     "that light; w in the map's space."},
          std::array<const char*, 3>{
              "__skydensity", "vector w; output color light",
              "Density with which __skysample() gives a direction of the map's space, and the light there."}}) {
        Shadeop& sky = addRays(list, name, sigs({{("float " + std::string(name) + "(string map; " + rest + ")").c_str()}}),
                               Lowering::Service, doc);
        sky.source = "Alpenglow";
        sky.optional.clear();
    }
}

void addGather(std::vector<Shadeop>& list) {
    Shadeop& gather = addRays(
        list, "gather", sigs({{"float gather(string category; point p; vector dir; float angle, float samples; pairs)"}}),
        Lowering::Request,
        "A statement of the language: gather(category, P, dir, angle, samples, pairs) body else other. Its body runs for "
        "each ray that hits "
        "something, what stands behind else for each that misses. Rays are spread over the cone of half angle `angle` about "
        "dir, each "
        "standing for the same part of it; 4096 at most. Categories: \"illuminance\" and \"\" cast rays; \"samplepattern\" "
        "casts none, and all "
        "count as misses; \"environment:MAP\" draws directions in proportion to the light of a map, from all around, and all "
        "count as hits. "
        "Pairs with a prefix name variables that the turn fills; what is not there leaves them as they were: surface:x "
        "displacement:x volume:x "
        "(outputs and parameters of shaders at the hit; surface:Ci and volume:Ci are what trace() would bring, surface:Oi and "
        "volume:Oi its opacity, surface:x also P N Ng I Cs Os u v s t dPdu dPdv there), primitive:x (variables "
        "of the primitive), attribute:x, ray:origin ray:direction ray:length (of misses too; 1e38), environment:color "
        "environment:direction "
        "environment:solidangle (that of one sample: the sum of color times solidangle is the integral of the map). Shaders "
        "run at a hit only "
        "where a pair asks for what they give; send:surface:x (displacement, volume, light) gives parameter x a value.");
    gather.examples = {
        {"misses", "4", "float misses = 0; gather(\"illuminance\", P, N, 0.5, 4) { } else misses += 1;", kNothing}};
    std::erase_if(gather.optional, [](const OptionalParameter& p) {
        return p.name == "samplecone" || p.name == "samples" || p.name == "weight" || p.name == "minsamples";
    });
    gather.optional =
        gather.optional +
        std::vector<OptionalParameter>{{kS, "distribution", false, "\"uniform\"", "of the rays in the cone: uniform or cosine"},
                                       {kC, "othreshold", false, "0", "surfaces are passed until their opacity adds up to this"}};
}

} // namespace

std::vector<Shadeop> raytracingShadeops() {
    std::vector<Shadeop> list;
    addTrace(list);
    addHemispheres(list);
    addSubsurface(list);
    addPhotonMaps(list);
    addSkySamples(list);
    addGather(list);
    return list;
}

} // namespace alpenglow::shadeops
