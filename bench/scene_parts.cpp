#include "bench/scene_parts.h"
#include <algorithm>
#include <string_view>
#include <vector>

namespace alpenglow::bench {
namespace {

struct Rule {
    Part part;
    std::vector<std::string_view> parts;
};

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
        {kLobes,
         {"5lobes", "lobe", "Lobe", "Distribution", "distribution", "al_bsdf", "9transport4draw", "9transport5value", "3rsl"}},
        {kLights,
         {"evaluateLight", "sampleLight", "hazeOf", "lightAt", "Light", "light", "illuminance", "shadow", "Shadow",
          "transmittance", "Emitter", "emitter", "AreaLight", "arealight", "emission", "chooseL", "chanceOf", "occlu"}},
        {kFilm, {"4Film", "6render"}},
        {kRequests, {"9transport", "7shading"}}};
    return all;
}

} // namespace

Part partOfSymbol(const std::string& s) {
    for (const Rule& r : rules())
        if (std::any_of(r.parts.begin(), r.parts.end(), [&](std::string_view what) { return s.find(what) != s.npos; }))
            return r.part;
    return kOther;
}

} // namespace alpenglow::bench
