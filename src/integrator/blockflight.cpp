#include "integrator/blockflight.h"
#include "bsdf/sampling.h"
#include "integrator/accumulator.h"
#include "integrator/blockphotons.h"
#include "integrator/photonstage.h"
#include "integrator/raystore.h"
#include "integrator/stageset.h"
#include "integrator/subsurfacewalks.h"
#include "integrator/transparency.h"
#include "services/random.h"
#include <algorithm>
#include <bit>
#include <cmath>

namespace alpenglow::integrator {

BlockVertices::Flight::Flight(BlockVertices& b, const StageSet& s)
    : b_(b), set_(s), intersector_(s.intersector), transparency_(s.transparency) {}

BlockVertices::Flight::~Flight() = default;

bool BlockVertices::Flight::on() const { return b_.photons_.photonTrace() != nullptr; }

static Vec3 rowsAt(const Row* rows, size_t i) { return {rows[0][i], rows[1][i], rows[2][i]}; }

void BlockVertices::Flight::takeModels(const BatchContext& c, bool all) {
    PhotonStage& stage = b_.photons_;
    std::vector<Lanes> modelled(b_.blocks_);
    for (size_t i = 0; i < b_.points_; ++i)
        modelled[i / kBlock] |= Lanes(stage.modelAt(c, i, all) != PhotonModel::Shader) << i % kBlock;
    if (std::all_of(modelled.begin(), modelled.end(), [](Lanes l) { return l == 0; })) return;
    for (size_t k = 0; k < b_.count_; ++k)
        for (size_t b = 0; b < b_.blocks_; ++b) b_.sites_[k].lobes[b].asked &= ~modelled[b];
    const auto empty = [&](const Site& s) {
        return std::all_of(s.lobes.begin(), s.lobes.begin() + long(b_.blocks_), [](const LobeBlock& l) { return l.asked == 0; });
    };
    const auto end = std::stable_partition(b_.sites_.begin(), b_.sites_.begin() + long(b_.count_), std::not_fn(empty));
    b_.count_ = size_t(end - b_.sites_.begin());
    const size_t first = b_.count_;
    for (size_t i = 0; i < b_.points_; ++i) {
        const PhotonModel model = stage.modelAt(c, i, all);
        if (model == PhotonModel::Shader || !(b_.vertices_[i / kBlock].points >> i % kBlock & 1)) continue;
        ModelLobe lobes[kModelLobes];
        const int count =
            PhotonStage::lobesOfModel(model, c.points[i], b_.world_.bindings_[size_t(c.bindings[i])].attributes->color, lobes);
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
BlockVertices::Site& BlockVertices::Flight::modelSite(size_t first, int k, const ModelLobe& lobe) {
    const int number = int(kModelSite) + k;
    size_t at = first;
    for (; at < b_.count_ && b_.sites_[at].number <= number; ++at)
        if (b_.sites_[at].number == number && b_.sites_[at].kind == lobe.kind) return b_.sites_[at];
    if (b_.count_ == b_.sites_.size()) b_.sites_.emplace_back();
    std::rotate(b_.sites_.begin() + long(at), b_.sites_.begin() + long(b_.count_), b_.sites_.begin() + long(b_.count_) + 1);
    ++b_.count_;
    Site& s = b_.sites_[at];
    s.number = number;
    s.info = nullptr;
    s.kind = lobe.kind;
    s.lanes = &b_.lanes_.lobes[lobe.kind->index];
    s.rays = lobe.rays;
    s.lighting = true;
    s.lights = false;
    s.diffuse = lobe.rays->type == RayType::Diffuse;
    s.begin(b_.blocks_);
    s.rows.clear();
    return s;
}

void BlockVertices::Flight::follow(BatchContext& c, Sched& sched) {
    const Settings& set = b_.world_.settings_;
    b_.roulette_ = set.localRoulette ? Roulette::Local : Roulette::Throughput; // the rules were set before this pipeline's
    mark(c);
    limitDepths(c);
    for (size_t b = 0; b < b_.blocks_; ++b)
        for (size_t i = 0; i < size_t(kBlock) && b_.vertices_[b].through; ++i) {
            const Color on = transparency_.goesOn(c, int(std::min(b * kBlock + i, b_.points_ - 1)));
            for (int q = 0; q < 3; ++q) b_.vertices_[b].beyond[q][i] = on[q];
        }
    b_.select(c);
    pick(c);
    lookBack(c, sched);
    rest(c);
    for (size_t b = 0; b < b_.blocks_; ++b) send(b, c, sched);
    if (!b_.subsurface_.below.empty()) b_.subsurface_.walk(c, sched); // may run further batches in blocks
}

/// Sets LobeBlock::narrow, and boundless: paths sample the light from which a photon arrives here at any depth.
void BlockVertices::Flight::mark(BatchContext& c) {
    const float width = b_.photons_.photonTrace()->job->width;
    for (size_t k = 0; k < b_.count_; ++k)
        for (size_t b = 0; b < b_.blocks_; ++b) {
            const Site& s = b_.sites_[k];
            LobeBlock& l = b_.sites_[k].lobes[b];
            for (Lanes left = l.asked; left; left &= left - 1) {
                const int i = std::countr_zero(left);
                if (!b_.gathered_->isNarrow(s, b * kBlock + size_t(i), width, c)) continue;
                l.narrow |= 1u << i;
                l.boundless |= l.lights & Lanes(b_.vertices_[b].bounces[i] == 0) << i;
            }
        }
}

/// Applies depth limits. Those of caustic photons are the limits of the paths that run in reverse.
void BlockVertices::Flight::limitDepths(const BatchContext& c) {
    for (size_t b = 0; b < b_.blocks_; ++b) {
        if (b_.photons_.photonTrace()->job->caustics) limitDepth(b, c);
        if (!b_.world_.settings_.indirect) b_.vertices_[b].deep[1] = ~Lanes(0);
    }
}

void BlockVertices::Flight::limitDepth(size_t b, const BatchContext& c) {
    VertexBlock& v = b_.vertices_[b];
    v.deep[0] = v.deep[1] = v.last;
    for (size_t i = 0; i < size_t(kBlock); ++i) {
        const size_t point = std::min(b * kBlock + i, b_.points_ - 1);
        for (const bool diffuse : {false, true}) {
            const bool deep = c.rays[point].scattered >= limits::kPathDepth ||
                              !depthsBehind(c.rays[point], b_.world_.bindings_[size_t(c.bindings[point])], diffuse);
            v.deep[diffuse] |= Lanes(deep) << i;
        }
    }
}

/// A path runs in reverse, and the depth limits of its surfaces count from its end: each leaves some bounces to the vertices that
/// a photon meets after it. Without a value these limits end the photon.
std::optional<PhotonDepths> BlockVertices::Flight::depthsBehind(const PathRay& from, const SurfaceBinding& b,
                                                                bool diffuse) const {
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
bool BlockVertices::Flight::follows(const Site& s, size_t point, const BatchContext& c) const {
    return !b_.photons_.photonTrace()->job->caustics || b_.gathered_->mirrors(s, point, c);
}

/// Picks the lobe of each point that a photon follows, and samples its direction.
void BlockVertices::Flight::pick(BatchContext& c) {
    const bool chooses = !c.between && (b_.count_ > 1 || !c.clear.empty()); // in a medium each point has one lobe
    if (chooses) b_.drawNumbers(kChooseLobe << 1 | render::SampleNumbers::kSingle, b_.choices_, false);
    b_.pairs_.resize(1);
    b_.turn_ = 0;
    picked_.resize(std::max(picked_.size(), b_.blocks_));
    turned_.clear();
    for (size_t b = 0; b < b_.blocks_; ++b) {
        ScatterBlock& next = b_.next_;
        b_.stages_.pick(b_.vertices_[b], b_.lobesOf(b).data(), int(b_.count_), chooses ? b_.choices_[b].x : b_.whole_, next);
        const size_t n = std::min(b_.points_ - b * kBlock, size_t(kBlock));
        for (size_t i = 0; i < n; ++i) {
            const size_t point = b * kBlock + i;
            if (!c.clear.empty()) c.passes[point] = b_.vertices_[b].passes[i];
            if (next.site[i] >= 0 && !follows(b_.sites_[size_t(next.site[i])], point, c)) next.site[i] = -1;
        }
        b_.drawDirections(b);
        picked_[b] = next;
        for (Lanes left = next.goes; left; left &= left - 1) {
            const size_t i = size_t(std::countr_zero(left));
            if (b_.sites_[size_t(next.site[i])].lobes[b].narrow >> i & 1) turned_.push_back({b * kBlock + i, next.site[i]});
        }
    }
}

/// Stores the photons.
void BlockVertices::Flight::rest(const BatchContext& c) {
    PhotonTrace& t = *b_.photons_.photonTrace();
    Lanes asked = 0;
    for (size_t k = 0; k < b_.count_; ++k)
        for (size_t b = 0; b < b_.blocks_; ++b) asked |= b_.sites_[k].lobes[b].asked;
    if (!asked) return;
    for (size_t point = 0; b_.world_.moves_ && point < b_.points_; ++point)
        if (const ShadePoint& p = c.points[point]; p.shape) t.fastest = std::max(t.fastest, length(p.shape->velocity(p.surface)));
    for (size_t point = 0; point < b_.points_ && !c.between; ++point) restAt(point, c);
}

void BlockVertices::Flight::restAt(size_t point, const BatchContext& c) {
    PhotonTrace& t = *b_.photons_.photonTrace();
    const size_t b = point / kBlock, i = point % kBlock;
    const ShadePoint& p = c.points[point];
    const PathRay& from = c.rays[point];
    Color given(0);
    bool spread = false;
    for (size_t k = 0; k < b_.count_; ++k) {
        const Site& s = b_.sites_[k];
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
    const Color power = t.power[size_t(from.sample->path)] * from.weight * leftOfPhoton(c, point) * float(t.job->scale);
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
void BlockVertices::Flight::send(size_t b, BatchContext& c, Sched& sched) {
    b_.next_ = picked_[b];
    if (!b_.next_.goes) return;
    b_.beginNumbers(b, b_.pairs_[0]);
    b_.throwDice(b);
    extend(b, c);
    b_.walkBelow(b, c);
    if (!b_.next_.goes) return;
    b_.turnRays(b, c);
    b_.applyOptions(b, c);
    b_.keepLobes(b, c);
    keep(b, c);
    b_.spawn(b_.rays_[b], sched);
}

void BlockVertices::Flight::extend(size_t b, BatchContext& c) {
    for (Lanes left = b_.next_.goes; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        if (!extendAt(b, size_t(i), c)) b_.next_.goes &= ~(1u << i);
    }
}

/// Sets power, direction and origin of a photon behind a point; false: it ends there.
bool BlockVertices::Flight::extendAt(size_t b, size_t i, BatchContext& c) {
    ScatterBlock& next = b_.next_;
    const Site& s = b_.sites_[size_t(next.site[i])];
    const LobeBlock& l = s.lobes[b];
    const size_t point = b * kBlock + i;
    const ShadePoint& p = c.points[point];
    const PathRay& from = c.rays[point];
    Vec3 w = rowsAt(next.direction, i);
    if (p.shape->oneSided() && !(dot(w, intersectsNormal(p.surface)) > 0)) return false; // invisible from there
    const Color colour = rowsAt(next.colour, i), request = rowsAt(l.weight, i);
    const Color f = next.single >> i & 1 ? colour : next.pdf[i] > 0 ? colour / next.pdf[i] : Color(0);
    const float indirect = (s.lighting && !s.walks ? b_.vertices_[b].energyScale[i] : 1) * b_.indirectOf(s, point);
    const Color through = l.narrow >> i & 1 ? back_[point] : request * (f * (next.scale[i] * indirect));
    Color weight = from.weight * through;
    weight *= leftOfPhoton(c, point) * photonWay(s, point, c, w);
    if (!isFinite(weight)) {
        b_.accumulator_.notFinite(c, from, uint32_t(s.number));
        return false;
    }
    if (weight == Color(0)) return false;
    const float q = survival(from, request, weight, next.dice[i]);
    if (!(q > 0)) return false;
    weight = weight / q;
    const Vec3 origin = b_.originOf(s, point, w);
    for (int k = 0; k < 3; ++k) next.weight[k][i] = weight[k], next.direction[k][i] = w[k], next.origin[k][i] = origin[k];
    return true;
}

/// Survival probability of a photon; 0: it ends.
float BlockVertices::Flight::survival(const PathRay& from, const Color& request, const Color& weight, float dice) const {
    const int bounces = from.bounces + 1;
    if (b_.world_.settings_.localRoulette) return std::max(rouletteLocal(bounces, request, dice), 0.f);
    if (bounces <= 3) return 1;
    // A light that traces sends rays at every vertex: throughput ends this tree of rays.
    if (b_.world_.lightTraces_ > 0) return std::max(rouletteLocal(bounces, absolute(weight), dice), 0.f);
    return std::max(rouletteOfPath(weight, [&] { return dice; }), 0.f);
}

/// Outgoing direction of a photon, and the factor of its power beyond the lobe's weight. A photon along the normal reveals no
/// index of refraction: its shader sees it from a slightly tilted direction (PhotonStage::tilt), and the outgoing direction is
/// corrected here.
float BlockVertices::Flight::photonWay(const Site& s, size_t point, const BatchContext& c, Vec3& w) const {
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
        const Vec3 aside = tilt - N * dot(tilt, N);
        const float si = sine(in, N), index = si > 0 ? sine(w, N) / si : 1;
        w = normalize(w - aside * index);
    }
    return factor;
}

/// Stores in the rays of a block what only photons have, after keepLobes().
void BlockVertices::Flight::keep(size_t b, const BatchContext& c) {
    const PhotonTrace& t = *b_.photons_.photonTrace();
    const RayKind* const kinds[] = {b_.store_.kindOf(t.specular), b_.store_.kindOf(t.diffuse)};
    RayBlock& r = b_.rays_[b];
    for (Lanes left = b_.next_.goes; left; left &= left - 1) {
        const size_t i = size_t(std::countr_zero(left)), point = b * kBlock + i;
        const Site& s = b_.sites_[size_t(b_.next_.site[i])];
        const LobeBlock& l = s.lobes[b];
        const PathRay& from = c.rays[point];
        const uint64_t kind = reinterpret_cast<uintptr_t>(kinds[s.diffuse]);
        r.kind[0][i] = uint32_t(kind), r.kind[1][i] = uint32_t(kind >> 32);
        r.pdf[i] = -1;
        const bool sampled = s.lightsAt(point) && !((b_.next_.single | l.elsewhere) >> i & 1);
        r.binding[i] = sampled || !c.between ? c.bindings[point] : -1;
        const auto depths = l.boundless >> i & 1 ? PhotonDepths::of(from)
                                                 : depthsBehind(from, b_.world_.bindings_[size_t(c.bindings[point])], s.diffuse);
        PathRay to = from;
        if (depths) depths->to(to);
        const uint32_t trail = b_.gathered_->mirrors(s, point, c) ? from.trail : uint32_t(shading::kTrailSpread);
        r.flags[i] = (r.flags[i] & ~(kAskedBits | 0xff000000u)) | to.asked | trail << 24;
    }
}

} // namespace alpenglow::integrator
