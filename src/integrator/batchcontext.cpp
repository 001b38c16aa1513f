#include "integrator/batchcontext.h"
#include "integrator/raystore.h"

namespace alpenglow::integrator {

BatchContext::~BatchContext() {
    if (extrasOf) extrasOf->freeExtras(*this);
}

void BatchContext::move(size_t from, size_t to) {
    if (from == to) return;
    points[to] = points[from];
    rays[to] = rays[from];
    targets[to] = targets[from];
    bindings[to] = bindings[from];
    hits[to] = hits[from];
    if (!depths.empty()) depths[to] = depths[from];
    points[to].ray = &rays[to];
}

void BatchContext::keepFirst(size_t count) {
    points.resize(count);
    rays.resize(count);
    targets.resize(count);
    bindings.resize(count);
    hits.resize(count);
    if (!depths.empty()) depths.resize(count);
}

} // namespace alpenglow::integrator
