#include "world/blocksite.h"
#include <algorithm>

namespace alpenglow::world {

bool asksLobes(SiteKind k) {
    return k == SiteKind::Diffuse || k == SiteKind::Specular || k == SiteKind::Phong || k == SiteKind::Trace ||
           k == SiteKind::Subsurface || k == SiteKind::Gather;
}

namespace {
/// Whether a trace() has only parameters that blocks support.
bool isPlainTrace(const SiteInfo& s) {
    const TraceSite& t = *s.trace;
    const RaySite& r = *s.rays;
    const bool rays = r.fixed && r.base < 0;
    return rays && t.distribution < 0 && !t.map && !t.sums && !t.onlyLights && !t.axis && !t.openness && t.records.call == 0;
}

/// Finds the rows of a distribution's parameters (DistributionParams).
void bindDistribution(const SiteInfo& s, LobeArguments& a) {
    const TraceSite& t = *s.trace;
    a.surface = true;
    std::fill(std::begin(a.rows), std::end(a.rows), -1);
    const auto row = [&](int lobeRow, int from, int count) {
        for (int k = 0; k < count && from >= 0; ++k) a.rows[lobeRow - kRowRoughness + k] = from + k;
    };
    row(kRowRoughness, t.roughness, 1);
    row(kRowRoughnessV, t.roughnessv >= 0 ? t.roughnessv : t.roughness, 1);
    row(kRowUdir, t.udir, 3);
    row(kRowAbsorption, t.absorption, 3);
    for (int k = 0; k < 3; ++k) a.numbers[kRowEta - kRowRoughness + k] = s.lobe->eta;
    for (size_t k = 0; k < t.eta.size() && k < 2; ++k)
        for (int q = 0; q < 3; ++q) row((k ? kRowK : kRowEta) + q, t.eta[k].first + (t.eta[k].second == 1 ? 0 : q), 1);
    a.numbers[kRowPart - kRowRoughness] = float(t.part);
    const int count = std::min(int(t.lobes.size()), kMostLobeNumbers);
    a.numbers[kRowCount - kRowRoughness] = float(count);
    for (int k = 0; k < count; ++k) row(kRowLobes + k, t.lobes[size_t(k)], 1);
}
} // namespace

std::shared_ptr<const LobeArguments> blockSite(const SiteInfo& s, bool path) {
    if (!path && s.kind != SiteKind::Trace) return nullptr;
    if (!s.lobe || (s.lobe->distribution && s.kind != SiteKind::Trace)) return nullptr;
    LobeArguments a;
    a.needsWo = (lobeLanes(1).lobes[s.lobe->index].needs & kNeedsWo) != 0;
    switch (s.kind) {
    case SiteKind::Diffuse:
        a.axis = s.rows[0];
        break;
    case SiteKind::Specular:
    case SiteKind::Phong:
        a.axis = s.rows[0];
        a.wo = s.rows[1];
        a.a = s.rows[2];
        if (s.kind == SiteKind::Specular) a.perRow = s.exponent;
        break;
    case SiteKind::Trace:
        if (!isPlainTrace(s)) return nullptr;
        a.options = s.rays->bias >= 0 || s.rays->maxDistance >= 0 || s.rays->maxHit >= 0 || s.trace->weight >= 0 ||
                    s.trace->fade.strength >= 0;
        a.traces = !s.trace->hemisphere; // indirectdiffuse() has the normal for a zero direction
        if (s.trace->hemisphere && a.needsWo) return nullptr;
        a.from = s.rows[0];
        a.axis = s.rows[1];
        a.wo = s.rowWo;
        a.horizon = s.rowHorizon;
        a.samples = s.rays->samples;
        a.lights = s.rowLights;
        if (s.lobe->distribution) bindDistribution(s, a);
        a.a = s.lobe->has(kTakesExponent) ? s.rowExponent : s.rowCone;
        a.otherwise = s.lobe->has(kTakesExponent) ? 1000 : 0;
        break;
    case SiteKind::Subsurface: // a walk starts at the point, whatever the direction
        break;
    default:
        return nullptr;
    }
    return std::make_shared<LobeArguments>(a);
}

bool asksBlocks(const BoundKernel& b) {
    if (b.kernel->facts().suspends) return false;
    for (const SiteInfo& s : b.sites)
        if (asksLobes(s.kind) && isRequest(s.kind, b.path) && !s.block) return false;
    return true;
}

} // namespace alpenglow::world
