#include "bench/scene_parts.h"
#include <algorithm>
#include <string_view>
#include <vector>

namespace alpenglow::bench {
namespace {

template <class Of> struct RuleOf {
    Of part;
    std::vector<std::string_view> parts;
};
using Rule = RuleOf<Part>;

// The first rule of which one text is in the symbol decides.
const std::vector<Rule>& rules() {
    static const std::vector<Rule> all{
        {kKernels, {"[kernel code]"}},
        {kRequests, {"7shading5Batch6assign"}}, // names rsl:: among its parameters
        {kTraversal, {"embree", "5accel", "exactHits", "Quadric5roots", "Quadric6accept", "solveQuadratic", "hitNormal"}},
        {kMemory, {"libc.so", "libm.so", "libgcc", "libstdc++", "libtbbmalloc", "[vdso]", "linux-vdso"}},
        {kTextures, {"7texture", "imfTexture", "Imf"}},
        {kSampling,
         {"7Sampler", "13SampleNumbers", "nestedS", "6render6nested", "6sobol", "13FilterSampler", "6Camera", "7pathRay",
          "8imageRay"}},
        {kPoints, {"8geometry"}},
        {kLobes, {"4bsdf", "lobe", "Lobe", "Distribution", "distribution", "al_bsdf", "3rsl"}},
        {kLights,
         {"evaluateLight", "sampleLight", "atmosphereOf", "lightAt", "Light", "light", "illuminance", "shadow", "Shadow",
          "transmittance", "Emitter", "emitter", "AreaLight", "arealight", "emission", "chooseL", "chanceOf", "occlu"}},
        {kFilm, {"4Film", "6render"}},
        {kRequests, {"10integrator", "8services", "5world", "5lanes", "7shading"}}};
    return all;
}

const std::vector<RuleOf<Stage>>& stageRules() {
    static const std::vector<RuleOf<Stage>> all{
        {kShade, {"[kernel code]", "7texture"}},
        {kSystem, {"libc.so", "libm.so", "libgcc", "libstdc++", "libtbbmalloc", "[vdso]", "linux-vdso"}},
        {kAccumulate,
         {"E3addEi", "10contribute", "10RowShading6finish", "14SurfaceShading6finish", "9tellAsker", "13CameraOutputs",
          "8ExactSum"}},
        {kSearch,
         {"5accel", "exactHits", "Quadric5roots", "Quadric6accept", "solveQuadratic", "hitNormal", "11Intersector8castRows"}},
        {kNumbers, {"drawNumbers", "drawBlocks", "13SampleNumbers", "nestedS", "6render6nested", "6sobol"}},
        {kLightSamples, {"12ChosenLights",  "chooseLights",  "placeFar",     "placeOnEmitter",   "placeInRows",
                         "takeLightOf",     "takeRows",      "takePlace",    "13LightSampling",  "10Connection",
                         "contributeLight", "aimShadow",     "connectBlock", "sendShadow",       "sampleLight",
                         "Emitter",         "evaluateLight", "tellLit",      "placeLightSample", "9LightRows"}},
        {kShadows, {"blockInRows", "10ShadowRays", "9Opacities"}},
        {kQueues,
         {"9Scheduler", "9HitQueues", "Records", "8turnRays", "9keepLobes", "8takeRays", "11ScatterRays5spawn", "9shadeHits",
          "8Pipeline6follow", "9BatchPool", "11Intersector4cast", "11Intersector5rayOf"}},
        {kSurfaces,
         {"8geometry", "placeSurfaces", "10RowShading3run", "7shading5Batch", "10loadPoints", "completePoint", "pointsOfRows",
          "viewsOf"}},
        {kChoose,
         {"4bsdf", "Lobe", "11ScatterRays", "14SingleRequests", "11VertexLight", "12LastVertices", "12GuideScatter",
          "12PhotonGather", "12PhotonFlight", "takeDirections", "takeValues", "extendPaths", "nameVertices", "sampleBlock",
          "evaluateBlock", "prepareBlock"}},
        {kCamera, {"4Film", "6render", "6Camera", "8traceAll", "8beginRay", "12SampleResult"}}};
    return all;
}

template <class Of> Of partBy(const std::vector<RuleOf<Of>>& list, const std::string& s, Of otherwise) {
    for (const RuleOf<Of>& r : list)
        if (std::any_of(r.parts.begin(), r.parts.end(), [&](std::string_view what) { return s.find(what) != s.npos; }))
            return r.part;
    return otherwise;
}

} // namespace

Part partOfSymbol(const std::string& s) { return partBy(rules(), s, kOther); }
Stage stageOfSymbol(const std::string& s) { return partBy(stageRules(), s, kElsewhere); }

} // namespace alpenglow::bench
