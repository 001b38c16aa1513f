// Equiangular sampling: lights with a position inside of media or near them. Their light falls off with the square of the
// distance, which distance sampling ignores.
#include "base/exact.h"
#include "bsdf/sampling.h"
#include "integrator/accumulator.h"
#include "integrator/batchpool.h"
#include "integrator/blocklobes.h"
#include "integrator/lightkernels.h"
#include "integrator/lightpathstates.h"
#include "integrator/mediastacks.h"
#include "integrator/medium.h"
#include "integrator/raystore.h"
#include "integrator/shadowrays.h"
#include "integrator/vertexlight.h"

namespace alpenglow::integrator {

bool Equiangular::look(const FreeFlight& f, const BoundLight& l, MediumSampling how) {
    if (!l.placed || how == MediumSampling::Distance) return false;
    const Vec3d to = Vec3d(l.place) - Vec3d(f.origin), dir(f.dir);
    length_ = f.length;
    nearest_ = dot(to, dir);
    const Vec3d across = to - dir * nearest_;
    away_ = std::max({std::sqrt(dot(across, across)), 1e-5 * double(f.length), 0.5 * double(l.extent)});
    const double sigma = (double(f.extinction.x) + f.extinction.y + f.extinction.z) / 3;
    const double reach = sigma * f.length > 4 ? 4 / sigma : double(f.length); // beyond it little light is left
    if (!(away_ > 0) || (how == MediumSampling::Both && !(away_ < 2 * reach))) return false;
    const double behind = length_ - nearest_, square = away_ * away_;
    return away_ * length_ > 1e-9 * std::sqrt((square + nearest_ * nearest_) * (square + behind * behind)); // sine of the angle
}

std::optional<Equiangular> Equiangular::of(const FreeFlight& f, const BoundLight& l, MediumSampling how) {
    Equiangular q;
    if (!q.look(f, l, how)) return {};
    q.from_ = exact::atan2(-q.nearest_, q.away_);
    q.to_ = exact::atan2(q.length_ - q.nearest_, q.away_);
    return q;
}

float Equiangular::at(float u) const {
    const double t = nearest_ + away_ * exact::tan(from_ + double(u) * (to_ - from_));
    return float(std::clamp(t, 0.0, length_));
}

double Equiangular::density(float t) const {
    const double d = double(t) - nearest_;
    return away_ / ((to_ - from_) * (away_ * away_ + d * d));
}

/// Whether equiangular samples alone estimate a light. On thin segments distance samples are no better and cost a shadow ray; for
/// spotlights they still help.
static bool alone(const FreeFlight& f, const BoundLight& l, MediumSampling how) {
    return how == MediumSampling::Equiangular || (f.thin && l.kind == LightKind::Area);
}

/// Position for which the lights of a whole segment are chosen.
static Vec3 middle(const FreeFlight& f) { return f.origin + f.dir * (0.5f * f.length); }

float MediumEvents::shareOfDistance(const FreeFlight& f, const BoundLight& l) const {
    const WorldImpl& w = world_;
    const MediumSampling how = w.settings().mediumSampling;
    if (!rules_.lightsAtRequests || !Equiangular::sees(f, l, how)) return 1;
    if (alone(f, l, how)) return 0;
    const auto q = Equiangular::of(f, l, how);
    const float chance = lightKernels_.chanceOf(int(&l - w.lights().data()), w.media()[size_t(f.medium)].binding, middle(f), 0);
    return misWeight(float(f.density(f.t)), float(q->density(f.t) * chance));
}

namespace {

/// A point chosen for a light, and its weight in that light's estimate.
struct Near {
    const FreeFlight* way;
    const RaySegment* flight;
    const Color* weight;
    float t, scale;
};

} // namespace

/// Light of one light at the points chosen for it.
class MediumEvents::NearLight {
public:
    NearLight(MediumEvents& stage, const Medium& m, const BoundLight& l, std::span<const Near> points)
        : stage_(stage), medium_(m), light_(l), points_(points), area_(l.kind == LightKind::Area) {}
    void run() {
        if (runInRows()) return;
        at_.resize(points_.size());
        drawn_.resize(area_ ? points_.size() : 0);
        query_.resize(points_.size());
        value_.resize(points_.size());
        for (size_t i = 0; i < points_.size(); ++i) ask(i);
        const std::vector<char> inMedium(points_.size(), 1);
        LightCall call;
        call.inMedium = &inMedium;
        stage_.lightKernels_.evaluateLight(light_, query_, value_, call);
        for (size_t i = 0; i < points_.size(); ++i) send(i);
    }

private:
    uint32_t use() const { return kLightPoint + uint32_t(&light_ - stage_.world_.lights().data()); }
    static uint32_t vertexOf(const PathRay& r) { return childVertex(r.vertex, kSegmentEvent, 5); }
    /// In blocks, where the light supports them.
    bool runInRows() {
        auto c = stage_.batches_.take();
        c->between = true;
        c->binding = &stage_.world_.bindings()[size_t(medium_.binding)];
        c->points.clear();
        for (const Near& n : points_) {
            c->rays.push_back(*n.flight->ray);
            c->rays.back().vertex = vertexOf(*n.flight->ray);
            c->targets.push_back(n.flight->target);
            c->flown.emplace_back().t = n.t;
        }
        std::vector<BlockLit> found;
        const bool done = stage_.vertexLight_.lightMedium(*c, *medium_.homogeneous, light_, found);
        for (const BlockLit& l : found) {
            const PathRay& r = c->rays[l.point];
            const Vec3 from = r.origin + r.dir * points_[l.point].t, way = l.end - from;
            const float far = area_ ? length(way) : l.far;
            if (!(far > 0)) continue;
            const Color light = scattered(points_[l.point], l.Cl, l.phase, l.kept, area_ ? l.density : 0);
            if (light == Color(0)) continue;
            ShadowRay s{from, l.w, far, light, points_[l.point].flight->target, r.shutter()};
            if (area_) s.dir = way / far, s.distance = far * (1 - 1e-6f);
            if (l.shadowRadius > 0) toDisk(s, l.L, l.w, l.shadowRadius, points_[l.point]);
            queue(s, points_[l.point]);
        }
        stage_.batches_.giveBack(std::move(c));
        return done;
    }
    void ask(size_t i) {
        const WorldImpl& w = stage_.world_;
        const PathRay& r = *points_[i].flight->ray;
        ShadePoint& p = query_[i];
        p.Ps = at_[i].P = r.origin + r.dir * points_[i].t;
        p.lit = &at_[i];
        p.Ns = -r.dir;
        p.viewI = p.I = p.Ps - r.begin();
        p.E = r.origin;
        p.shutter = w.shadesAtOpen() ? 0 : r.shutter();
        w.setTime(p);
        p.P = Vec3(transformPoint(light_.instance->toCurrentAt(p.shutter), {0, 0, 0}));
        p.ray = &r;
        if (!area_) return;
        Emitter::Sample& s = drawn_[i];
        const Random numbers = stage_.store_.random(r);
        const float choose = light_.emitter->chooses() ? numbers.one(vertexOf(r), use(), 0) : 0;
        const Vec2 u = numbers.pair(vertexOf(r), use(), 0);
        bool there = light_.emitter->sample(p.Ps, u, choose, p.shutter, s, p.surface, light_.pointNeeds);
        if (there && w.accel().hasSolids())
            there =
                w.accel().keeps(w.numberOfShape().at(s.shape), intersectsAt(p.surface), intersectsNormal(p.surface), p.shutter);
        if (!there || (s.shape->oneSided() && dot(intersectsNormal(p.surface), s.direction) >= 0)) s.pdf = 0; // or from its back
        p.shape = s.shape;
        p.P = intersectsAt(p.surface);
        p.N = p.surface.n;
    }
    void send(size_t i) {
        static const LobeKind* const kind = findLobe("henyey-greenstein");
        const Near& n = points_[i];
        const PathRay& r = *n.flight->ray;
        const LightValue& v = value_[i];
        const ShadePoint& p = query_[i];
        if (!v.lit || (area_ && !(drawn_[i].pdf > 0))) return;
        if (!isFinite(v.Cl)) return stage_.accumulator_.notFinite(&r, "Cl", light_.instance.get());
        const Vec3 way = area_ ? leavesFrom(p.surface, -drawn_[i].direction) - p.Ps : -v.L;
        const float far = length(way);
        if (!(far > 0)) return;
        const Vec3 to = area_ ? drawn_[i].direction : way / far;
        const float phase = Bsdf(*kind, {r.dir, -r.dir, {}, medium_.homogeneous->anisotropy}).value(to).fcos;
        const Color c = scattered(n, v.Cl, phase, v.kept(RayType::Diffuse), area_ ? drawn_[i].pdf : 0);
        if (c == Color(0)) return;
        ShadowRay shadow{p.Ps, way / far, far * (1 - (area_ ? 1e-6f : 1e-5f)), c, n.flight->target, p.shutter};
        if (v.shadowRadius > 0) toDisk(shadow, v.L, to, v.shadowRadius, n);
        if (v.ownShadow) shadow.distance = 0; // its shader computed visibility itself
        queue(shadow, n);
    }
    /// Light scattered back along the segment for light Cl at its point. density: of the sample on an emitter; 0: another light.
    Color scattered(const Near& n, const Color& Cl, float phase, float kept, float density) const {
        const Homogeneous& h = *medium_.homogeneous;
        const Color c = *n.weight * h.scattering * h.transmittance(n.t) * Cl;
        return c * (phase * n.scale * kept * (density > 0 ? 1 / density : float(kPi))); // Cl is irradiance / pi
    }
    /// Redirects a shadow ray to a point on the disk around a light.
    void toDisk(ShadowRay& s, const Vec3& L, const Vec3& to, float radius, const Near& n) const {
        const PathRay& r = *n.flight->ray;
        const Vec2 u = stage_.store_.random(r).pair(vertexOf(r), use(), 0);
        const Vec3 onDisk = onShadowDisk(s.origin - L, to, radius, u) - s.origin;
        s.dir = normalizeOr(onDisk, to);
        s.distance = length(onDisk) * (1 - 1e-5f);
    }
    void queue(ShadowRay& s, const Near& n) const {
        const PathRay& r = *n.flight->ray;
        if (light_.shadowless) s.distance = 0;
        s.ray = &r;
        s.media = r.media;
        s.share = stage_.store_.extraOf(r).share;
        s.path = stage_.paths_.next(r.path, stage_.paths_.volume);
        if (s.path) s.light = stage_.paths_.lights[size_t(&light_ - stage_.world_.lights().data())];
        stage_.shadows_.queue.push_back(s);
    }

    MediumEvents& stage_;
    const Medium& medium_;
    const BoundLight& light_;
    std::span<const Near> points_;
    const bool area_;
    std::vector<geometry::SurfacePoint> at_;
    std::vector<Emitter::Sample> drawn_;
    std::vector<ShadePoint> query_;
    std::vector<LightValue> value_;
};

void MediumEvents::nearLights(std::span<RaySegment> segmentEvents, std::span<const Crossing> crossings, Sched& sched) {
    const WorldImpl& w = world_;
    const Medium& m = w.media()[size_t(crossings[0].way.medium)];
    const MediumSampling how = w.settings().mediumSampling;
    const WorldImpl::LightList& list = w.lightLists()[size_t(w.bindings()[size_t(m.binding)].lightList)];
    const LightChooser& chooser = w.chooserOf(list);
    const std::vector<int>& on = w.sampledOf(list);
    LightChooser::Chosen chosen;
    for (size_t k = 0; k < on.size() && chooser.empty(); ++k) chosen.emplace_back(int(k), 1.f);
    struct Asked {
        const Crossing* crossing;
        int light;
        float chance;
        Equiangular points;
    };
    std::vector<Asked> asked;
    numbers_.clear();
    for (const Crossing& x : crossings) {
        const RaySegment& f = segmentEvents[x.flight];
        const uint32_t vertex = childVertex(f.ray->vertex, kSegmentEvent, 2);
        if (!chooser.empty()) chooser.choose(middle(x.way), store_.random(*f.ray).one(vertex, kChooseLight, 0), chosen);
        for (const auto& [k, chance] : chosen) {
            const int light = on[size_t(k)];
            if (list.ofAll && !list.lights.contains(light)) continue;
            const auto q = Equiangular::of(x.way, w.lights()[size_t(light)], how);
            if (!q) continue;
            asked.push_back({&x, light, chance, *q});
            numbers_.askOne(store_.random(*f.ray).numbers(), vertex, kLightPoint + uint32_t(light), 0);
        }
    }
    numbers_.draw();
    std::map<int, std::vector<Near>> near; // by light
    for (size_t i = 0; i < asked.size(); ++i) {
        const auto& [x, light, chance, points] = asked[i];
        const float t = points.at(numbers_.one(i));
        const double density = points.density(t) * chance;
        const float share =
            alone(x->way, w.lights()[size_t(light)], how) ? 1 : misWeight(float(density), float(x->way.density(t)));
        if (density > 0 && share > 0)
            near[light].push_back({&x->way, &segmentEvents[x->flight], &x->weight, t, float(share / density)});
    }
    for (const auto& [light, points] : near) {
        NearLight(*this, m, w.lights()[size_t(light)], points).run();
        if (shadows_.queue.size() > kShadowsAtOnce) shadows_.flush(sched);
    }
}

} // namespace alpenglow::integrator
