#include "integrator/loberequests.h"
#include "integrator/occlusioncalls.h"
#include "integrator/photonstage.h"
#include "integrator/raystore.h"
#include "integrator/stageset.h"
#include "integrator/surfacepoints.h"
#include "world/blocksite.h"
#include <algorithm>
#include <bit>

namespace alpenglow::integrator {

LobeRequests::LobeRequests(const StageSet& s, const VertexStages& v)
    : VertexStage(s, v), lanes_(lobeLanes(lobeWidth())), occlusion_(s.occlusion), photons_(s.photons), store_(s.store),
      surfaces_(s.surfaces) {}

bool LobeRequests::read(BatchContext& c) { return findSites(c) && request(c); }

/// Counts the calls of a strip at each call site: in a loop one follows another.
class LobeRequests::CallCount {
public:
    explicit CallCount(const BatchContext& c) : of_(c.bound->sites.size()) {}
    /// Whether a call is the first one of its strip.
    bool begins(const EmitRecord& e) {
        if (e.first == first_) return false;
        first_ = e.first;
        std::fill(of_.begin(), of_.end(), 0u);
        return true;
    }
    /// How many calls of the strip at this call site came before.
    uint32_t next(const EmitRecord& e) { return of_[size_t(e.site)]++; }

private:
    std::vector<uint32_t> of_;
    int first_ = -1;
};

/// Finds the requesting call sites in the order of the calls; a call site in a loop once for each turn. Returns false if points
/// differ in that order, or there are too many.
bool LobeRequests::findSites(const BatchContext& c) {
    v_.count = 0;
    CallCount calls(c);
    size_t next = 0; // index after the position of the previous call
    for (const EmitRecord& e : c.emits) {
        if (!c.bound->sites[size_t(e.site)].block) continue;
        if (calls.begins(e)) next = 0;
        const uint32_t nth = calls.next(e);
        size_t at = 0;
        while (at < v_.count && !(v_.sites[at].number == e.site && v_.sites[at].nth == nth)) ++at;
        if (at < v_.count) {
            if (at < next) return false;
            next = at + 1;
            continue;
        }
        if (v_.count == v_.sites.size()) v_.sites.emplace_back();
        std::rotate(v_.sites.begin() + long(next), v_.sites.begin() + long(v_.count), v_.sites.begin() + long(v_.count) + 1);
        beginSite(v_.sites[next], e.site, c);
        v_.sites[next++].nth = nth;
        ++v_.count;
    }
    return true;
}

/// Whether arguments of a call are read point by point.
static bool readsRows(const BlockLobes& s) {
    return s.walks || s.info->kind == SiteKind::Trace || !s.info->outputs.empty(); // outputs: lights query them
}

/// Whether the rays of a trace() hit other surfaces, or other sides, than rays of lighting shadeops.
static bool hasRaySet(const BlockLobes& s) {
    const shading::RaySet& set = s.rays->set;
    return !s.lighting && (set.only || set.sides != accel::Sides::Front || set.mode != shading::HitMode::Default);
}

void LobeRequests::beginSite(Site& s, int number, const BatchContext& c) {
    s.number = number;
    s.info = &c.bound->sites[size_t(number)];
    s.kind = s.info->lobe;
    s.lanes = &lanes_.lobes[s.kind->index];
    s.lighting = s.info->kind != SiteKind::Trace;
    s.lights = (s.lighting && s.info->kind != SiteKind::Subsurface) || s.info->rowLights >= 0;
    if (s.lighting) s.rays = s.info->kind == SiteKind::Diffuse ? &kDiffuseKind : &kSpecularKind;
    else
        s.rays = store_.kindOf({s.info->rays->rays, true, s.info->rays->set, s.info->label,
                                s.info->trace->hemisphere && world_.globalMaps(), s.lights, s.info->trace->apart});
    s.diffuse = s.rays->type == RayType::Diffuse;
    s.begin(v_.blocks);
    s.walks = s.info->kind == SiteKind::Subsurface;
    s.apart = s.info->kind == SiteKind::Trace && s.info->trace->apart;
    s.direct = s.info->kind == SiteKind::Diffuse && s.info->trace && s.info->trace->apart;
    s.sets = hasRaySet(s);
    s.rows.assign(readsRows(s) ? v_.blocks : 0, nullptr);
}

bool LobeRequests::request(BatchContext& c) {
    CallCount calls(c);
    for (size_t k = 0; k < v_.count; ++k)
        if (v_.sites[k].nth > 0) v_.loops.try_emplace(v_.sites[k].number, v_.points, 0u);
    v_.repeats = !v_.loops.empty();
    for (const EmitRecord& e : c.emits) {
        if (!c.bound->sites[size_t(e.site)].block) continue;
        calls.begins(e);
        const uint32_t nth = calls.next(e);
        const auto site =
            std::find_if(v_.sites.begin(), v_.sites.end(), [&](const Site& s) { return s.number == e.site && s.nth == nth; });
        if (const auto loop = v_.loops.find(e.site); loop != v_.loops.end()) countCalls(*site, e, c, loop->second);
        if (!requestOf(*site, e, c)) return false;
    }
    for (size_t k = 0; k < v_.count; ++k) { // strips narrower than a block: their rows are now contiguous
        Site& s = v_.sites[k];
        for (size_t b = 0; b < v_.blocks && !s.narrow.empty(); ++b) {
            const Lanes asked = std::exchange(s.lobes[b].asked, 0) & v_.vertices[b].points;
            const size_t rows = s.narrow.size() / (v_.blocks * kBlock);
            if (readsRows(s)) s.rows[b] = s.narrow.data() + (b * rows + 3) * kBlock, s.stride = kBlock;
            if (stages_.request(v_.vertices[b], *s.info->block, s.narrow.data() + b * rows * kBlock, kBlock, asked, s.lobes[b]))
                return false;
        }
        if (!v_.waits) noteHemispheres(s, c);
        if (!readOptions(s, c)) return false;
    }
    return true;
}

/// Notes the points of indirectdiffuse(), and normals that face away from the camera there.
void LobeRequests::noteHemispheres(const Site& s, BatchContext& c) {
    if (s.apart) v_.apart.resize(v_.blocks);
    for (size_t b = 0; b < v_.blocks && s.apart; ++b) v_.apart[b] |= s.lobes[b].asked;
    if (s.info->kind != SiteKind::Trace || !s.info->trace->hemisphere) return;
    for (size_t b = 0; b < v_.blocks; ++b)
        for (Lanes left = s.lobes[b].asked; left; left &= left - 1) {
            const size_t i = size_t(std::countr_zero(left)), point = b * kBlock + i;
            if (!c.rays[point].camera()) continue;
            surfaces_.pointsOfRows(c);
            const float(*axis)[kBlock] = &s.lobes[b].lobe[kRowAxis];
            occlusion_.noteTurnedAway(c, *s.info, int(point), {axis[0][i], axis[1][i], axis[2][i]});
        }
}

/// Counts the calls with a weight in a loop. before: by point, those of earlier turns.
void LobeRequests::countCalls(Site& s, const EmitRecord& e, const BatchContext& c, std::vector<uint32_t>& before) {
    s.occurrence.resize(v_.blocks * kBlock);
    const float* weight = c.arena.data() + e.offset;
    for (uint64_t left = e.mask; left; left &= left - 1) {
        const size_t lane = size_t(std::countr_zero(left)), point = size_t(e.first) + lane, lanes = size_t(e.lanes);
        if (point >= v_.points) return;
        s.occurrence[point] = before[point];
        before[point] += weight[lane] != 0 || weight[lanes + lane] != 0 || weight[2 * lanes + lane] != 0;
    }
}

/// Reads the request of a call site at the points of a strip.
bool LobeRequests::requestOf(Site& s, const EmitRecord& e, const BatchContext& c) {
    const float* rows = c.arena.data() + e.offset;
    if (e.lanes >= kBlock) {
        for (int at = 0; at < e.lanes && size_t(e.first + at) < v_.points; at += kBlock) {
            const size_t b = size_t(e.first + at) / kBlock;
            const Lanes asked = Lanes(e.mask >> at) & v_.vertices[b].points;
            if (readsRows(s)) s.rows[b] = rows + 3 * e.lanes + at, s.stride = e.lanes;
            if (asked && stages_.request(v_.vertices[b], *s.info->block, rows + at, e.lanes, asked, s.lobes[b])) return false;
        }
        return true;
    }
    const size_t count = size_t(rowsOfArguments(*s.info)) + 3, b = size_t(e.first) / kBlock, at = size_t(e.first) % kBlock;
    s.narrow.resize(count * v_.blocks * kBlock);
    for (size_t r = 0; r < count; ++r)
        std::copy_n(rows + r * size_t(e.lanes), e.lanes, s.narrow.data() + (b * count + r) * kBlock + at);
    s.lobes[b].asked |= Lanes(e.mask) << at;
    return true;
}

static const geometry::SurfacePoint& surfaceAt(const BatchContext& c, size_t point) {
    return c.points.empty() ? c.surfaces[point] : c.points[point].surface;
}

/// Reads the parameters of a call. A ray with "weight" 0 is not sent. Returns false if a point must be processed on its own.
bool LobeRequests::readOptions(Site& s, BatchContext& c) {
    const auto ownOrigin = [](const LobeBlock& l) { return l.ownOrigin != 0; };
    if (!s.info->block->options && rules_.pickOne && std::none_of(s.lobes.begin(), s.lobes.begin() + long(v_.blocks), ownOrigin))
        return true;
    const SiteInfo& info = *s.info;
    s.options.assign(v_.blocks * kBlock, {});
    for (size_t b = 0; b < v_.blocks; ++b)
        for (Lanes left = s.lobes[b].asked; left; left &= left - 1) {
            const size_t i = size_t(std::countr_zero(left)), point = b * kBlock + i;
            const auto row = [&](int r) { return s.rows[b][size_t(r) * size_t(s.stride) + i]; };
            RayOptions& o = s.options[point] = rayOptionsOf(info, row);
            if ((o.ownOrigin = s.lobes[b].ownOrigin >> i & 1)) {
                if (surfaceAt(c, point).displaced) return false; // then the ray starts at the point after all
                const int from = info.rows[0];
                o.from = {row(from), row(from + 1), row(from + 2)};
            }
            if (photons_.photonTrace() || (o.importance > 0 && rules_.pickOne)) continue; // photons ignore "weight"
            surfaces_.pointsOfRows(c);
            o.samples = occlusion_.samplesOf(samplesAskedOf(info, row), c.points[point].shape, info, c);
            if (o.importance > 0) continue;
            v_.ignored += uint64_t(o.samples);
            s.lobes[b].asked &= ~(1u << i);
        }
    return true;
}

} // namespace alpenglow::integrator
