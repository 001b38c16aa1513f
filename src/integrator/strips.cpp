// Suspended strips of waiting kernels.
#include "integrator/strips.h"
#include "integrator/accumulator.h"
#include "integrator/gatherrows.h"
#include "integrator/requests.h"
#include "integrator/shadowrays.h"
#include "integrator/surfaceshading.h"

namespace alpenglow::integrator {

void putResult(const SiteInfo& site, const shading::TargetValue& value, const TraceSums* sums, float* out, int lanes, int lane) {
    const auto put = [&](int row, int rows, const Color& v) {
        for (int r = 0; row >= 0 && r < rows; ++r) out[size_t(row + r) * size_t(lanes) + size_t(lane)] = v[r];
    };
    const SiteInfo::Results& rows = site.results;
    if (site.givesDistance()) put(rows.value, 1, Color(value.distance));
    else if (site.kind == SiteKind::Occlusion) put(rows.value, 1, value.radiance);
    else put(rows.value, 3, value.radiance);
    put(rows.distance, 1, Color(value.distance));
    put(rows.transmission, 3, sums ? Color(1) - sums->value(TraceSums::Blocked) : value.transmission);
    put(rows.normal, 3, value.normal);
    if (!sums) return;
    put(rows.open, 3, sums->value(TraceSums::Open));
    put(rows.environment, 3, sums->value(TraceSums::Environment));
    put(rows.unshadowedEnvironment, 3, sums->value(TraceSums::UnshadowedEnvironment));
    put(rows.areaLight, 3, sums->value(TraceSums::AreaLight));
    put(rows.unshadowedAreaLight, 3, sums->value(TraceSums::UnshadowedAreaLight));
}

KernelStrip::KernelStrip(WaitingKernels& stages, std::shared_ptr<BatchContext> c, void* handle, int first, int depth)
    : stages_(stages), c_(std::move(c)), handle_(handle), first_(first), depth_(depth), bytes_(c_->frame),
      m_(stages.takeMemory()) {}

KernelStrip::~KernelStrip() {
    if (handle_) c_->bound->kernel->destroy(handle_);
    stages_.giveBack(std::move(m_), std::move(c_));
}

bool KernelStrip::resume(Sched& s, std::span<const shading::TargetValue> results) {
    const SiteInfo& site = c_->bound->sites[size_t(site_)];
    if (gather_) {
        for (size_t k = 0; k < results.size(); ++k) {
            stages_.gathers.gathered.erase(m_.ids[k]);
            if (!sent_[k].quiet) endGatherRay(*sent_[k].site, results[k], sent_[k].row);
        }
        for (int lane : m_.laneOf) out_[lane] = float(gather_->counts[size_t(lane)]);
        gather_ = nullptr;
        c_->bound->kernel->resume(handle_);
        c_->ran();
        return advance(s, s.takeResuming());
    }
    const bool sums = site.trace && site.trace->sums;
    for (size_t k = 0; k < results.size(); ++k) {
        putResult(site, results[k], sums ? stages_.accumulator.sumsOf(m_.ids[k]) : nullptr, out_, lanes_, m_.laneOf[k]);
        if (sums) stages_.accumulator.traceSums.erase(m_.ids[k]);
    }
    c_->bound->kernel->resume(handle_);
    c_->ran();
    return advance(s, s.takeResuming());
}

bool KernelStrip::advance(Sched& s, std::unique_ptr<Sched::Strip> self) {
    const auto& kernel = *c_->bound->kernel;
    if (kernel.finished(handle_)) {
        std::erase_if(c_->gathers, [&](const auto& g) { return g.first.second == first_; });
        stages_.shading.finish(*c_, first_, kernel.lanes(), s, asked_);
        for (int i = first_; i < points(); ++i) s.release(c_->targets[size_t(i)]);
        return true;
    }
    site_ = c_->requestSite;
    lanes_ = c_->requestLanes;
    out_ = c_->requestOut;
    m_.in.swap(c_->requestIn);
    m_.laneOf.clear();
    for (int lane = 0; lane < lanes_; ++lane)
        if ((c_->requestMask >> lane & 1) && first_ + lane < int(c_->points.size())) m_.laneOf.push_back(lane);
    if (m_.occurrences.empty()) m_.occurrences.resize(c_->bound->sites.size() * 64);
    if (c_->bound->sites[size_t(site_)].kind == SiteKind::Gather) askGather();
    m_.ids.resize(gather_ ? sent_.size() : m_.laneOf.size());
    s.wait(std::move(self), int(m_.ids.size()), [&](int i, AccumulatorId id) {
        m_.ids[size_t(i)] = id;
        s.hold(id);
    });
    if (m_.ids.empty()) return false; // ready at once
    const SiteInfo& site = c_->bound->sites[size_t(site_)];
    if (site.trace && site.trace->sums)
        for (AccumulatorId id : m_.ids) stages_.accumulator.traceSums[id] = {};
    stages_.waiting.push_back(this);
    return false;
}

/// Intersects the rays of a gather(). The strip waits for the hits that must be shaded.
void KernelStrip::askGather() {
    const SiteInfo& site = c_->bound->sites[size_t(site_)];
    const std::span<uint32_t> occurrences(m_.occurrences.data() + size_t(site_) * 64, 64);
    uint64_t mask = 0;
    for (int lane : m_.laneOf) {
        mask |= uint64_t(1) << lane;
        // The statement starts again with its first rays.
        if (m_.in[size_t(site.rows[4]) * size_t(lanes_) + size_t(lane)] < 0.5f) ++occurrences[size_t(lane)];
    }
    gather_ = &stages_.gathers.cast(*c_, site, first_, mask, lanes_, m_.in.data(), occurrences, asked_, sent_);
    gatherBytes_ = sent_.size() * sizeof(GatherSent);
    for (const auto& [key, g] : c_->gathers)
        if (key.second == first_) gatherBytes_ += g.rows.size() * sizeof(float);
}

void KernelStrip::ask(Sched& s) {
    if (gather_) {
        for (size_t k = 0; k < m_.ids.size(); ++k) {
            const PathRay& r = sent_[k].ray;
            stages_.gathers.gathered[m_.ids[k]] = &sent_[k];
            s.spawn(r.bounces + r.layers, m_.ids[k], r);
            stages_.sawDepth(r.bounces);
        }
        return;
    }
    const SiteInfo& site = c_->bound->sites[size_t(site_)];
    for (size_t k = 0; k < m_.ids.size(); ++k) {
        const int lane = m_.laneOf[k], point = first_ + lane;
        const uint32_t occurrence = m_.occurrences[size_t(site_) * 64 + size_t(lane)]++;
        if (site.kind == SiteKind::LightVisibility) {
            stages_.requests.lightVisibility(*c_, site, point, m_.in.data(), lanes_, lane, Color(1), m_.ids[k]);
            continue;
        }
        if (c_->rays[size_t(point)].quiet && (site.lobe || site.kind == SiteKind::Ambient)) continue; // its light is discarded
        const size_t had = stages_.requests.lobes.size();
        if (stages_.shadows.queue.size() > kShadowsAtOnce) stages_.shadows.flush(s);
        stages_.requests.request(*c_, site, point, m_.in.data(), lanes_, lane, Color(1), m_.ids[k], true, occurrence);
        if (stages_.requests.lobes.size() == had) continue;
        uint32_t& asked = asked_[size_t(lane)];
        stages_.requests.lobes.back().before = asked;
        asked += uint32_t(stages_.requests.lobes.back().samples);
    }
}

void KernelStrip::noteAsked(uint64_t lobes) {
    for (const int lane : m_.laneOf) {
        ++m_.occurrences[size_t(site_) * 64 + size_t(lane)];
        asked_[size_t(lane)] += lobes >> lane & 1;
    }
}

void KernelStrip::asked(Sched& s) {
    for (AccumulatorId id : m_.ids) s.release(id);
}

} // namespace alpenglow::integrator
