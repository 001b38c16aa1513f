// Callbacks of generated code: services and requests find their stage through KernelCall::user.
#include "base/memory.h"
#include "integrator/kernelinputs.h"
#include "integrator/vertex.h"
#include "world/blocksite.h"
#include <bit>

namespace alpenglow::integrator {

namespace {

// Callbacks of generated code: C functions that find their stage through KernelCall::user.
BatchContext& contextOf(rsl::KernelCall* c) { return *static_cast<BatchContext*>(c->user); }

/// Exceptions cannot pass through generated code: an exception in a callback is stored, the kernel is asked to leave its loops,
/// and the caller of the kernel rethrows (BatchContext::ran). Until then callbacks do nothing.
constexpr StopFlag kEnd{1};
void failed(rsl::KernelCall* call) noexcept {
    BatchContext& c = contextOf(call);
    if (!c.failure) c.failure = std::current_exception();
    call->stop = &kEnd;
}

} // namespace

void endTooManyRequests(const BatchContext& c, const rsl::ir::Site& site) {
    if (c.host && !c.host->beginsAnew()) {
        const auto& files = c.bound->kernel->files();
        const auto& at = site.place;
        const SourcePlace place{at.file < int(files.size()) ? files[size_t(at.file)] : "", at.line, at.column};
        c.host->diagnostics().reportOnce(
            "requests:" + place.file + std::to_string(place.line),
            {Severity::Error,
             Rie::Limit,
             place,
             "a shader requests more rays at one point than fit into " + std::to_string(limits::kRequestBytes >> 20) + " MiB",
             "reduce the iterations of loops around such calls",
             {}});
    }
    throw LimitReached();
}

namespace {

/// Reserves memory for another request of a kernel that does not wait. Throws LimitReached if there is too little;
/// Pipeline::trace() then repeats the call with fewer points at a time.
void takeRoom(BatchContext& c, const SiteInfo& s, size_t rows, int lanes, uint64_t mask) {
    const size_t held = c.arena.size() * sizeof(float) + c.emits.size() * sizeof(EmitRecord) + c.emitted * sizeof(LobeVertex);
    c.emitted += size_t(std::popcount(mask));
    if (held + rows * size_t(lanes) * sizeof(float) > limits::kRequestBytes) endTooManyRequests(c, *s.site);
}

/// Values that only the loop has: replaces the row of the light's index by the distance, and appends two rows to the arguments.
void takeReach(const BatchContext& c, const SiteInfo& s, int first, float* arguments, int lanes) {
    const size_t have = std::min(size_t(lanes), c.lightReach.size()), width = size_t(lanes);
    float* more = arguments + size_t(rowsOfArguments(s)) * width;
    std::fill_n(more, 2 * width, 0.f);
    const uint32_t use = kLightPoint + uint32_t(c.lightNow < 0 ? c.host->world().lights().size() : size_t(c.lightNow));
    for (size_t lane = 0; lane < have; ++lane) {
        arguments[size_t(s.rows[0]) * width + lane] = c.lightReach[lane].distance;
        if (!(c.lightReach[lane].radius > 0) || size_t(first) + lane >= c.rays.size()) continue;
        more[lane] = c.lightReach[lane].radius;
        more[width + lane] = std::bit_cast<float>(childVertex(c.rays[size_t(first) + lane].vertex, use, c.lightDraw));
    }
}

void serve(rsl::KernelCall* call, int32_t site, int32_t first, uint64_t mask, int32_t lanes, const float* in, float* out) {
    BatchContext& c = contextOf(call);
    if (c.failure) return;
    if (site == rsl::kSiteMark) {
        for (int i = 0; i < lanes; ++i) out[i] = float(c.emits.size());
        return;
    }
    if (site == rsl::kSiteRescale) { // rows: mark, factor (3), end mark
        uint32_t begin = 0, end = uint32_t(c.emits.size());
        for (int i = 0; i < lanes; ++i)
            if (mask >> i & 1) {
                begin = uint32_t(in[i]);
                end = uint32_t(in[size_t(4) * lanes + i]);
                break;
            }
        for (uint32_t e = begin; e < end && e < c.emits.size(); ++e) {
            EmitRecord& r = c.emits[e];
            for (int k = 0; k < 3; ++k)
                for (int i = 0; i < lanes; ++i)
                    if (mask >> i & 1) c.arena[r.offset + size_t(k) * lanes + i] *= in[size_t(1 + k) * lanes + i];
        }
        return;
    }
    const SiteInfo& s = c.bound->sites[site];
    if (isRequest(s.kind, c.bound->path)) {
        const size_t rows = size_t(rowsOfArguments(s));
        if (c.bound->kernel->facts().suspends) {
            c.requestSite = site;
            c.requestFirst = first;
            c.requestLanes = lanes;
            c.requestMask = mask;
            c.requestIn.assign(in, in + rows * lanes);
            if (s.kind == SiteKind::LightVisibility) {
                c.requestIn.resize((rows + 2) * size_t(lanes));
                takeReach(c, s, first, c.requestIn.data(), lanes);
            }
            c.requestOut = out;
            return;
        }
        takeRoom(c, s, rows + 5, lanes, mask);
        EmitRecord e{site, first, lanes, mask, c.arena.size(), s.kind == SiteKind::LightVisibility ? c.lightNow : -1};
        c.arena.insert(c.arena.end(), in, in + (rows + 3) * lanes);
        if (s.kind == SiteKind::LightVisibility) {
            c.arena.resize(c.arena.size() + 2 * size_t(lanes));
            takeReach(c, s, first, c.arena.data() + e.offset + size_t(3) * size_t(lanes), lanes);
        }
        c.emits.push_back(e);
        return;
    }
    c.host->answers.service(c, site, first, mask, lanes, in, out);
}
void onService(rsl::KernelCall* call, int32_t site, int32_t first, uint64_t mask, int32_t lanes, const float* in, float* out) {
    try {
        serve(call, site, first, mask, lanes, in, out);
    } catch (...) { failed(call); }
}
int32_t onLightBegin(rsl::KernelCall* call, int32_t site, int32_t first, uint64_t mask, int32_t lanes, const float* rows) {
    BatchContext& c = contextOf(call);
    try {
        if (!c.failure) return c.host->answers.lightBegin(c, site, first, mask, lanes, rows);
    } catch (...) { failed(call); }
    return 0;
}
uint64_t onLightFetch(rsl::KernelCall* call, int32_t, int32_t light, int32_t first, uint64_t mask, int32_t lanes, float* out) {
    BatchContext& c = contextOf(call);
    try {
        if (!c.failure) return c.host->answers.lightFetch(c, light, first, mask, lanes, out);
    } catch (...) { failed(call); }
    return 0;
}
void onLightEnd(rsl::KernelCall* call, int32_t, int32_t first, int32_t lanes) {
    BatchContext& c = contextOf(call);
    try {
        if (!c.failure) c.host->answers.lightEnd(c, first, lanes);
    } catch (...) { failed(call); }
}
void* onAlloc(rsl::KernelCall* call, uint64_t bytes) {
    contextOf(call).frame = bytes;
    return ::operator new(bytes, std::align_val_t(64), std::nothrow);
}
void onRelease(rsl::KernelCall*, void* p, uint64_t) { ::operator delete(p, std::align_val_t(64)); }

constexpr StopFlag kGo;

} // namespace

void KernelInputs::bind(rsl::KernelCall& call, BatchContext& c) {
    c.host = this;
    call.user = &c;
    call.service = onService;
    call.lightBegin = onLightBegin;
    call.lightFetch = onLightFetch;
    call.lightEnd = onLightEnd;
    call.alloc = onAlloc;
    call.release = onRelease;
    call.stop = context_.stop ? context_.stop : &kGo;
}

} // namespace alpenglow::integrator
