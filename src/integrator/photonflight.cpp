#include "integrator/photonflight.h"
#include "base/hash.h"
#include "bsdf/sampling.h"
#include "integrator/accumulator.h"
#include "integrator/lobeselection.h"
#include "integrator/photongather.h"
#include "integrator/photonstage.h"
#include "integrator/raystore.h"
#include "integrator/scatterrays.h"
#include "integrator/stageset.h"
#include "integrator/subsurfacewalks.h"
#include "integrator/transparency.h"
#include "integrator/vertexlight.h"
#include "services/random.h"
#include <algorithm>
#include <bit>
#include <cmath>

namespace alpenglow::integrator {

PhotonFlight::PhotonFlight(const StageSet& s, const VertexStages& v)
    : VertexStage(s, v), set_(s), lanes_(lobeLanes(lobeWidth())), accumulator_(s.accumulator), batches_(s.batches),
      gathered_(v.gather), inputs_(s.inputs), intersector_(s.intersector), photons_(s.photons), scatter_(v.scatter),
      selection_(v.selection), store_(s.store), subsurface_(s.subsurface), transparency_(s.transparency) {}

PhotonFlight::~PhotonFlight() = default;

bool PhotonFlight::on() const { return photons_.photonTrace() != nullptr; }

static Vec3 rowsAt(const Row* rows, size_t i) { return {rows[0][i], rows[1][i], rows[2][i]}; }

void PhotonFlight::takeModels(const BatchContext& c, bool all) {
    PhotonStage& stage = photons_;
    std::vector<Lanes> modelled(v_.blocks);
    for (size_t i = 0; i < v_.points; ++i)
        modelled[i / kBlock] |= Lanes(stage.modelAt(c, i, all) != PhotonModel::Shader) << i % kBlock;
    if (std::all_of(modelled.begin(), modelled.end(), [](Lanes l) { return l == 0; })) return;
    for (size_t k = 0; k < v_.count; ++k)
        for (size_t b = 0; b < v_.blocks; ++b) v_.sites[k].lobes[b].asked &= ~modelled[b];
    const auto empty = [&](const Site& s) {
        return std::all_of(s.lobes.begin(), s.lobes.begin() + long(v_.blocks), [](const LobeBlock& l) { return l.asked == 0; });
    };
    const auto end = std::stable_partition(v_.sites.begin(), v_.sites.begin() + long(v_.count), std::not_fn(empty));
    v_.count = size_t(end - v_.sites.begin());
    const size_t first = v_.count;
    for (size_t i = 0; i < v_.points; ++i) {
        const PhotonModel model = stage.modelAt(c, i, all);
        if (model == PhotonModel::Shader || !(v_.vertices[i / kBlock].points >> i % kBlock & 1)) continue;
        ModelLobe lobes[kModelLobes];
        const int count =
            PhotonStage::lobesOfModel(model, c.points[i], world_.bindings()[size_t(c.bindings[i])].attributes->color, lobes);
        for (int k = 0; k < count; ++k) {
            LobeBlock& l = modelSite(first, k, lobes[k]).lobes[i / kBlock];
            const size_t lane = i % kBlock;
            const Vec3 wo = -normalize(c.points[i].I);
            l.asked |= 1u << lane;
            l.lobe[kRowA][lane] = lobes[k].a;
            l.lobe[kRowHasHorizon][lane] = 0;
            for (int q = 0; q < 3; ++q) {
                l.weight[q][lane] = lobes[k].weight[q];
                l.lobe[kRowAxis + q][lane] = lobes[k].axis[q];
                l.lobe[kRowWo + q][lane] = wo[q];
            }
        }
    }
}

/// The call site that stands for lobe k of a photon shading model; the sites from `first` on are such.
BlockLobes& PhotonFlight::modelSite(size_t first, int k, const ModelLobe& lobe) {
    const int number = int(kModelSite) + k;
    size_t at = first;
    for (; at < v_.count && v_.sites[at].number <= number; ++at)
        if (v_.sites[at].number == number && v_.sites[at].kind == lobe.kind) return v_.sites[at];
    if (v_.count == v_.sites.size()) v_.sites.emplace_back();
    std::rotate(v_.sites.begin() + long(at), v_.sites.begin() + long(v_.count), v_.sites.begin() + long(v_.count) + 1);
    ++v_.count;
    Site& s = v_.sites[at];
    s.number = number;
    s.info = nullptr;
    s.kind = lobe.kind;
    s.lanes = &lanes_.lobes[lobe.kind->index];
    s.rays = lobe.rays;
    s.lighting = true;
    s.lights = false;
    s.diffuse = lobe.rays->type == RayType::Diffuse;
    s.begin(v_.blocks);
    s.rows.clear();
    return s;
}

void PhotonFlight::follow(BatchContext& c, Sched& sched) {
    scatter_.playsRoulette(); // the rules were set before this pipeline's
    mark(c);
    limitDepths(c);
    for (size_t b = 0; b < v_.blocks; ++b)
        for (size_t i = 0; i < size_t(kBlock) && v_.vertices[b].through; ++i) {
            const Color on = transparency_.goesOn(c, int(std::min(b * kBlock + i, v_.points - 1)));
            for (int q = 0; q < 3; ++q) v_.vertices[b].beyond[q][i] = on[q];
        }
    selection_.select(c);
    pick(c);
    lookBack(c, sched);
    rest(c);
    for (size_t b = 0; b < v_.blocks; ++b) send(b, c, sched);
    if (!subsurface_.media.empty()) subsurface_.walk(c, sched); // may run further batches in blocks
}

void PhotonFlight::mark(BatchContext& c) {
    const float width = photons_.photonTrace()->job->width;
    for (size_t k = 0; k < v_.count; ++k)
        for (size_t b = 0; b < v_.blocks; ++b) {
            const Site& s = v_.sites[k];
            LobeBlock& l = v_.sites[k].lobes[b];
            for (Lanes left = l.asked; left; left &= left - 1) {
                const int i = std::countr_zero(left);
                if (!gathered_.isNarrow(s, b * kBlock + size_t(i), width, c)) continue;
                l.narrow |= 1u << i;
                l.boundless |= l.lights & Lanes(v_.vertices[b].bounces[i] == 0) << i;
            }
        }
}

/// Applies depth limits. Those of caustic photons are the limits of the paths that run in reverse.
void PhotonFlight::limitDepths(const BatchContext& c) {
    for (size_t b = 0; b < v_.blocks; ++b) {
        if (photons_.photonTrace()->job->caustics) limitDepth(b, c);
        if (!world_.settings().indirect) v_.vertices[b].deep[1] = ~Lanes(0);
    }
}

void PhotonFlight::limitDepth(size_t b, const BatchContext& c) {
    VertexBlock& v = v_.vertices[b];
    v.deep[0] = v.deep[1] = v.last;
    for (size_t i = 0; i < size_t(kBlock); ++i) {
        const size_t point = std::min(b * kBlock + i, v_.points - 1);
        for (const bool diffuse : {false, true}) {
            const bool deep = c.rays[point].scattered >= limits::kPathDepth ||
                              !depthsBehind(c.rays[point], world_.bindings()[size_t(c.bindings[point])], diffuse);
            v.deep[diffuse] |= Lanes(deep) << i;
        }
    }
}

/// A path runs in reverse, and the depth limits of its surfaces count from its end: each leaves some bounces to the vertices that
/// a photon meets after it. Without a value these limits end the photon.
std::optional<PhotonDepths> PhotonFlight::depthsBehind(const PathRay& from, const SurfaceBinding& b, bool diffuse) const {
    const PhotonDepths before = PhotonDepths::of(from);
    const auto left = [](int until, int most, bool takes) {
        const int now = std::min(until, most < 0 ? PhotonDepths::kAll : std::min(most, PhotonDepths::kAll - 1));
        return now == PhotonDepths::kAll ? now : now - takes;
    };
    const PhotonDepths d{left(before.diffuse, b.maxDiffuse, diffuse), left(before.specular, b.maxSpecular, !diffuse)};
    if (d.diffuse < 0 || d.specular < 0) return {};
    return d;
}

/// Whether a lobe with a probability sends photons on: for caustics only mirrors do. Its probability is not given to another one.
bool PhotonFlight::follows(const Site& s, size_t point, const BatchContext& c) const {
    return !photons_.photonTrace()->job->caustics || gathered_.mirrors(s, point, c);
}

/// Picks the lobe of each point that a photon follows, and samples its direction.
void PhotonFlight::pick(BatchContext& c) {
    const bool chooses = !c.between && (v_.count > 1 || !c.clear.empty()); // in a medium each point has one lobe
    if (chooses) v_.drawNumbers(kChooseLobe << 1 | SampleNumbers::kSingle, v_.choices, false);
    v_.pairs.resize(1);
    v_.turn = 0;
    picked_.resize(std::max(picked_.size(), v_.blocks));
    turned_.clear();
    for (size_t b = 0; b < v_.blocks; ++b) {
        ScatterBlock& next = v_.next;
        stages_.pick(v_.vertices[b], v_.lobesOf(b).data(), int(v_.count), chooses ? v_.choices[b].x : v_.whole, next);
        const size_t n = std::min(v_.points - b * kBlock, size_t(kBlock));
        for (size_t i = 0; i < n; ++i) {
            const size_t point = b * kBlock + i;
            if (!c.clear.empty()) c.passes[point] = v_.vertices[b].passes[i];
            if (next.site[i] >= 0 && !follows(v_.sites[size_t(next.site[i])], point, c)) next.site[i] = -1;
        }
        scatter_.drawDirections(b);
        picked_[b] = next;
        for (Lanes left = next.goes; left; left &= left - 1) {
            const size_t i = size_t(std::countr_zero(left));
            if (v_.sites[size_t(next.site[i])].lobes[b].narrow >> i & 1) turned_.push_back({b * kBlock + i, next.site[i]});
        }
    }
}

/// Stores the photons.
void PhotonFlight::rest(const BatchContext& c) {
    PhotonTrace& t = *photons_.photonTrace();
    Lanes asked = 0;
    for (size_t k = 0; k < v_.count; ++k)
        for (size_t b = 0; b < v_.blocks; ++b) asked |= v_.sites[k].lobes[b].asked;
    if (!asked) return;
    for (size_t point = 0; world_.moves() && point < v_.points; ++point)
        if (const ShadePoint& p = c.points[point]; p.shape) t.fastest = std::max(t.fastest, length(p.shape->velocity(p.surface)));
    for (size_t point = 0; point < v_.points && !c.between && t.probes.empty(); ++point) restAt(point, c);
}

void PhotonFlight::restAt(size_t point, const BatchContext& c) {
    PhotonTrace& t = *photons_.photonTrace();
    const size_t b = point / kBlock, i = point % kBlock;
    const ShadePoint& p = c.points[point];
    const PathRay& from = c.rays[point];
    Color given(0);
    bool spread = false;
    for (size_t k = 0; k < v_.count; ++k) {
        const Site& s = v_.sites[k];
        const LobeBlock& l = s.lobes[b];
        if (!(l.asked >> i & 1)) continue;
        if (l.lobe[kRowDelta][i] == 0 && !(l.narrow >> i & 1)) {
            spread = true;
            given += rowsAt(l.weight, i) * l.lobe[kRowAlbedo][i];
        }
        // Paths that walk below a surface gather at their exit; photons of maps are stored at their exit.
        spread |= s.walks && t.job->caustics;
    }
    const bool caustic = from.bounces > 0 && !(from.trail & shading::kTrailSpread);
    const Color power = t.power[size_t(from.sample->path)] * from.weight * photonTransmittance(c, point) * float(t.job->scale);
    if (!spread || (t.job->caustics && !caustic) || !isFinite(power) || !(maxComponent(power) > 0)) return;
    StoredPhoton s;
    const Vec3& n = p.surface.displaced ? p.surface.displacedN : p.surface.n;
    s.photon.P = p.surface.displaced ? p.surface.displacedP : p.surface.P;
    s.photon.power = {std::max(power.x, 0.f), std::max(power.y, 0.f), std::max(power.z, 0.f)};
    s.photon.from = photonmap::packUnit(-from.dir);
    s.photon.normal = photonmap::packUnit(dot(n, from.dir) > 0 ? -n : n);
    for (int k = 0; k < 3; ++k) s.photon.reflected[k] = uint8_t(std::clamp(given[k], 0.f, 1.f) * 255 + .5f);
    s.photon.bounces = uint8_t(std::min<int>(from.bounces, 255));
    s.number = t.first + uint32_t(from.sample->path);
    s.binding = c.bindings[point];
    s.caustic = caustic;
    s.way = from.lobeOrigin - s.photon.P;
    s.time = from.sample->shutter;
    t.out->push_back(s);
}

/// Sends the photons of a block on.
void PhotonFlight::send(size_t b, BatchContext& c, Sched& sched) {
    v_.next = picked_[b];
    if (!v_.next.goes) return;
    v_.beginNumbers(b, v_.pairs[0]);
    scatter_.throwDice(b);
    extend(b, c);
    scatter_.walkBelow(b, c);
    if (!v_.next.goes) return;
    scatter_.makeRays(b, c);
    keep(b, c);
    scatter_.spawn(v_.rays[b], sched);
}

void PhotonFlight::extend(size_t b, BatchContext& c) {
    const bool probes = !photons_.photonTrace()->probes.empty();
    for (Lanes left = v_.next.goes; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        if (!extendAt(b, size_t(i), c) || (probes && endsProbe(b, size_t(i), c))) v_.next.goes &= ~(1u << i);
    }
}

/// Whether directions at the points of a batch may depend on random numbers: then paths by them are not found again.
static bool drawsNumbers(const BatchContext& c) {
    return c.bound && std::any_of(c.bound->sites.begin(), c.bound->sites.end(),
                                  [](const SiteInfo& s) { return s.kind == SiteKind::Random; });
}

/// Notes how a probe leaves a point; true: it ends there.
bool PhotonFlight::endsProbe(size_t b, size_t i, const BatchContext& c) {
    PhotonTrace& t = *photons_.photonTrace();
    const ScatterBlock& next = v_.next;
    const size_t point = b * kBlock + i;
    const PathRay& from = c.rays[point];
    ProbeEnd& end = t.ends[size_t(from.sample->path)];
    if (drawsNumbers(c)) return true;
    end.chance /= next.scale[i];
    const uint64_t site = uint64_t(uint32_t(c.bindings[point])) << 32 | uint32_t(v_.sites[size_t(next.site[i])].number);
    end.way = mix64(end.way ^ mix64(site + 0x9e3779b97f4a7c15ull));
    if (from.bounces + 1 < t.probes[size_t(from.sample->path)].bounces) return false;
    end.arrives = true;
    end.origin = rowsAt(next.origin, i), end.dir = rowsAt(next.direction, i);
    end.light = rowsAt(next.weight, i) * t.power[size_t(from.sample->path)] * end.chance;
    return true;
}

/// Sets power, direction and origin of a photon behind a point; false: it ends there.
bool PhotonFlight::extendAt(size_t b, size_t i, BatchContext& c) {
    ScatterBlock& next = v_.next;
    const Site& s = v_.sites[size_t(next.site[i])];
    const LobeBlock& l = s.lobes[b];
    const size_t point = b * kBlock + i;
    const ShadePoint& p = c.points[point];
    const PathRay& from = c.rays[point];
    Vec3 w = rowsAt(next.direction, i);
    if (!c.between && p.shape->oneSided() && !(dot(w, intersectsNormal(p.surface)) > 0)) return false; // invisible from there
    const Color colour = rowsAt(next.colour, i), request = rowsAt(l.weight, i);
    const Color f = next.single >> i & 1 ? colour : next.pdf[i] > 0 ? colour / next.pdf[i] : Color(0);
    const float indirect = (s.lighting && !s.walks ? v_.vertices[b].energyScale[i] : 1) * v_.indirectOf(s, point);
    const Color through = l.narrow >> i & 1 ? back_[point] : request * (f * (next.scale[i] * indirect));
    Color weight = from.weight * through;
    weight *= photonTransmittance(c, point) * photonWay(s, point, c, w);
    if (!isFinite(weight)) {
        accumulator_.notFinite(c, from, uint32_t(s.number));
        return false;
    }
    if (weight == Color(0)) return false;
    const float q = survival(from, request, weight, next.dice[i]);
    if (!(q > 0)) return false;
    weight = weight / q;
    const Vec3 origin = v_.originOf(s, point, w);
    for (int k = 0; k < 3; ++k) next.weight[k][i] = weight[k], next.direction[k][i] = w[k], next.origin[k][i] = origin[k];
    return true;
}

/// Survival probability of a photon; 0: it ends.
float PhotonFlight::survival(const PathRay& from, const Color& request, const Color& weight, float dice) const {
    const int bounces = from.bounces + 1;
    if (!photons_.photonTrace()->probes.empty()) return 1;
    if (world_.settings().localRoulette) return std::max(rouletteLocal(bounces, request, dice), 0.f);
    if (bounces <= 3) return 1;
    // A light that traces sends rays at every vertex: throughput ends this tree of rays.
    if (world_.lightTraces() > 0) return std::max(rouletteLocal(bounces, absolute(weight), dice), 0.f);
    return std::max(rouletteOfPath(weight, [&] { return dice; }), 0.f);
}

/// Outgoing direction of a photon, and the factor of its power beyond the lobe's weight. A photon along the normal reveals no
/// index of refraction: its shader sees it from a slightly tilted direction (PhotonStage::tilt), and the outgoing direction is
/// corrected here.
float PhotonFlight::photonWay(const Site& s, size_t point, const BatchContext& c, Vec3& w) const {
    const LobeBlock& l = s.lobes[point / kBlock];
    const size_t i = point % kBlock;
    const ShadePoint& p = c.points[point];
    const PathRay& from = c.rays[point];
    const Vec3 n = p.surface.displaced ? p.surface.displacedN : p.surface.n, N = normalize(p.N);
    if (l.narrow >> i & 1) return safeCosine(dot(w, n)) / safeCosine(dot(from.dir, n));
    const bool delta = l.lobe[kRowDelta][i] != 0;
    const Vec3 in = normalize(p.I), tilt = in - from.dir;
    const float factor = photonFactor(&l.lobe[0][i], *s.kind, delta, -in, w, n, N);
    if (delta && length(tilt) > kLeastTilt / 4) {
        const Vec3 across = tilt - N * dot(tilt, N);
        const float si = sine(in, N), index = si > 0 ? sine(w, N) / si : 1;
        w = normalize(w - across * index);
    }
    return factor;
}

/// Stores in the rays of a block what only photons have, after keepLobes().
void PhotonFlight::keep(size_t b, const BatchContext& c) {
    const PhotonTrace& t = *photons_.photonTrace();
    const RayKind* const kinds[] = {store_.kindOf(t.specular), store_.kindOf(t.diffuse)};
    RayBlock& r = v_.rays[b];
    for (Lanes left = v_.next.goes; left; left &= left - 1) {
        const size_t i = size_t(std::countr_zero(left)), point = b * kBlock + i;
        const Site& s = v_.sites[size_t(v_.next.site[i])];
        const LobeBlock& l = s.lobes[b];
        const PathRay& from = c.rays[point];
        const uint64_t kind = reinterpret_cast<uintptr_t>(kinds[s.diffuse]);
        r.kind[0][i] = uint32_t(kind), r.kind[1][i] = uint32_t(kind >> 32);
        r.pdf[i] = -1;
        const bool sampled = s.lightsAt(point) && !((v_.next.single | l.ownOrigin) >> i & 1);
        r.binding[i] = sampled || !c.between ? c.bindings[point] : -1;
        const auto depths = l.boundless >> i & 1 ? PhotonDepths::of(from)
                                                 : depthsBehind(from, world_.bindings()[size_t(c.bindings[point])], s.diffuse);
        PathRay to = from;
        if (depths) depths->to(to);
        const uint32_t trail = gathered_.mirrors(s, point, c) ? from.trail : uint32_t(shading::kTrailSpread);
        r.flags[i] = (r.flags[i] & ~(kAskedBits | 0xff000000u)) | to.asked | trail << 24;
    }
}

} // namespace alpenglow::integrator
