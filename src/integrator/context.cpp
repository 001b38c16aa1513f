// The context of a thread, and its counters.
#include "integrator/context.h"

namespace alpenglow::integrator {

Context::Context(std::shared_ptr<const WorldImpl> w, Diagnostics& d, bool beforeTracing)
    : frame(std::move(w)), world(*frame), diagnostics(d), building(beforeTracing), seed(world.settings().seed),
      totalReflection(rsl::internString("totalreflection")), rules(world.settings()) {}

void Counters::operator+=(const Counters& o) {
    reflected += o.reflected;
    refracted += o.refracted;
    totalReflected += o.totalReflected;
    ignored += o.ignored;
    tests += o.tests;
    hits += o.hits;
    camera += o.camera;
    diffuse += o.diffuse;
    specular += o.specular;
    transmission += o.transmission;
    shadow += o.shadow;
    points += o.points;
    inRows += o.inRows;
    batches += o.batches;
    lanesUsed += o.lanesUsed;
    lanesRun += o.lanesRun;
    nonFinite += o.nonFinite;
    overLimit += o.overLimit;
    depthCap += o.depthCap;
    depthSum += o.depthSum;
    paths += o.paths;
    guided += o.guided;
    guidedLit += o.guidedLit;
    guidedLight += o.guidedLight;
    searches += o.searches;
    searchesFound += o.searchesFound;
    probes += o.probes;
    records += o.records;
    interpolated += o.interpolated;
    depthMax = std::max(depthMax, o.depthMax);
    peakFrameBytes = std::max(peakFrameBytes, o.peakFrameBytes);
    threadBytes = std::max(threadBytes, o.threadBytes);
    if (media.size() < o.media.size()) media.resize(o.media.size());
    for (size_t i = 0; i < o.media.size(); ++i) media[i].all += o.media[i].all, media[i].lost += o.media[i].lost;
    if (lightRuns.size() < o.lightRuns.size()) lightRuns.resize(o.lightRuns.size());
    for (size_t i = 0; i < o.lightRuns.size(); ++i) lightRuns[i] += o.lightRuns[i];
}

uint64_t& Context::raysOf(RayType t) {
    switch (t) {
    case RayType::Camera:
        return counters.camera;
    case RayType::Diffuse:
        return counters.diffuse;
    case RayType::Specular:
        return counters.specular;
    default:
        return counters.transmission;
    }
}

} // namespace alpenglow::integrator
