#include "world/arealight.h"
#include "base/limits.h"
#include "bsdf/sampling.h"
#include "scene/solids.h"
#include <algorithm>

namespace alpenglow::world {

namespace {
// A whole sphere whose transform keeps it one: rows of the upper 3x3 of equal length and orthogonal.
bool wholeSphere(const geometry::Shape& s, Vec3& centre, float& radius) {
    const auto& p = *s.source().primitive;
    if (p.kind != "Sphere" || p.numbers.size() < 4 || !s.exact() || s.placed()) return false;
    double r = std::fabs(p.numbers[0]);
    double lo = std::min(p.numbers[1], p.numbers[2]), hi = std::max(p.numbers[1], p.numbers[2]);
    if (lo > -r || hi < r || std::fabs(p.numbers[3]) < 360) return false;
    const auto& m = s.toCamera().m;
    Vec3d rows[3];
    for (int i = 0; i < 3; ++i) rows[i] = {m[i][0], m[i][1], m[i][2]};
    double l = dot(rows[0], rows[0]);
    for (int i = 0; i < 3; ++i) {
        if (std::fabs(dot(rows[i], rows[i]) - l) > 1e-6 * l) return false;
        if (std::fabs(dot(rows[i], rows[(i + 1) % 3])) > 1e-6 * l) return false;
    }
    centre = Vec3(Vec3d(m[3][0], m[3][1], m[3][2]));
    radius = float(r * std::sqrt(l));
    return true;
}

// 1 - cos of the half angle under which the sphere is seen from outside, without cancellation.
double capOneMinusCos(double radius, double distance) {
    double s2 = radius * radius / (distance * distance);
    return s2 / (1 + std::sqrt(std::max(0.0, 1 - s2)));
}
} // namespace

Emitter::Emitter(std::vector<const geometry::Shape*> shapes, std::vector<uint32_t> visibility) {
    for (size_t i = 0; i < shapes.size(); ++i) {
        Entry e{shapes[i], 0, 0};
        if (i < visibility.size()) e.visibility = visibility[i];
        entries_.push_back(e);
    }
    takeDiced();
}

void Emitter::takeDiced(const std::function<bool(const geometry::Shape&)>& seenThrough) {
    facets_.clear();
    triangles_.clear();
    groups_.clear();
    turns_.clear();
    for (Entry& e : entries_) {
        e.facets = e.triangles = e.groups = e.turn = -1;
        if (!EmitterFacets::has(*e.shape)) {
            e.share = e.shape->area();
        } else {
            e.facets = int(facets_.size());
            facets_.emplace_back(*e.shape);
            e.share = facets_.back().area();
        }
        if (TriangleLamp::has(*e.shape)) {
            e.triangles = int(triangles_.size());
            triangles_.emplace_back(*e.shape);
        }
        e.sphere = wholeSphere(*e.shape, e.centre, e.radius);
        e.inner = e.sphere && scene::solidTakenAway(e.shape->attributes());
        e.through = e.sphere && seenThrough && seenThrough(*e.shape);
        // Through a transparent front, and in solids, the far side may be what is seen.
        const bool both = (seenThrough && seenThrough(*e.shape)) || !scene::solidPath(e.shape->attributes()).empty();
        if (FacetGroups::has(*e.shape)) {
            e.groups = int(groups_.size());
            groups_.emplace_back(*e.shape, both);
        } else if (!e.sphere && e.facets < 0 && !both && HalfTurn::has(*e.shape)) {
            e.turn = int(turns_.size());
            turns_.emplace_back(*e.shape);
        }
    }
    weigh();
    shinesTo(Shines::Both);
}

/// Converts the areas of the entries to probabilities, and drops entries without area.
void Emitter::weigh() {
    std::erase_if(entries_, [](const Entry& e) { return !(e.share > 0) || !std::isfinite(e.share); });
    area_ = 0;
    for (const Entry& e : entries_) area_ += e.share;
    entryOf_.clear();
    double sum = 0;
    for (Entry& e : entries_) {
        e.share /= area_;
        e.cumulative = sum += e.share;
        entryOf_[e.shape] = int(&e - entries_.data());
    }
    flat_.clear();
    const auto flat = [](const Entry& e) { return e.triangles >= 0 && e.facets < 0 && TriangleLamp::flat(*e.shape); };
    if (entries_.size() > size_t(limits::kLightsSampled) || !std::all_of(entries_.begin(), entries_.end(), flat)) return;
    for (const Entry& e : entries_) flat_.push_back(triangles_[size_t(e.triangles)].inBlocks(*e.shape));
}

void Emitter::shinesTo(Shines to) {
    for (Entry& e : entries_) {
        e.front = {};
        const int side = e.shape->oneSided() || to == Shines::Front ? 1 : to == Shines::Back ? -1 : 0;
        if (e.turn >= 0) turns_[size_t(e.turn)].shinesTo(side);
        if (e.groups >= 0) groups_[size_t(e.groups)].shinesTo(side);
        if (to == Shines::Both && !e.shape->oneSided()) continue;
        e.front = normalsOf(*e.shape);
        if (to == Shines::Back && !e.shape->oneSided()) e.front = e.front.opposite();
    }
    makeChooser();
}

Cone Emitter::front() const {
    Cone all;
    for (const Entry& e : entries_) all = &e == entries_.data() ? e.front : around(all, e.front);
    return all;
}

void Emitter::makeChooser() {
    chooser_ = {};
    // A few shapes that all emit in every direction are chosen by area alone.
    const bool faces = std::any_of(entries_.begin(), entries_.end(), [](const Entry& e) { return !e.front.all(); });
    if (entries_.size() <= (faces ? 1 : size_t(limits::kLightsSampled))) return;
    std::vector<LightBound> bounds;
    for (const Entry& e : entries_) {
        const geometry::Bounds b = e.shape->bounds();
        bounds.push_back({(b.lo + b.hi) * .5f, length(b.hi - b.lo) * .5f, float(e.share), false, e.front});
    }
    chooser_ = LightChooser(bounds, 1);
}

bool Emitter::place(const Entry& e, const Vec3& from, Vec2 u, float time, geometry::SurfacePoint& point, uint32_t needs) const {
    if (e.facets >= 0) return facets_[size_t(e.facets)].place(u, time, point, needs);
    if (const geometry::Placed* p = e.shape->placed()) p->sampleFromAt(from, u.x, u.y, time, point, needs);
    else e.shape->sampleFrom(from, u.x, u.y, point, needs);
    return true;
}

geometry::Bounds Emitter::bounds() const {
    geometry::Bounds b;
    for (const Entry& e : entries_) b.add(e.shape->bounds());
    return b;
}

float Emitter::asSeen(const Entry& e, double perArea, const geometry::SurfacePoint& p, const Vec3& from) {
    Vec3 d = intersectsAt(p) - from;
    float d2 = dot(d, d), cosine = std::fabs(dot(d, intersectsNormal(p))) / std::sqrt(d2);
    if (!(d2 > 0) || !(cosine > 1e-7f)) return 0;
    return float(perArea * e.shape->turnedDensity(p, from) * d2 / cosine);
}

float Emitter::areaPdf(const Entry& e, double share, const geometry::SurfacePoint& p, const Vec3& from) const {
    if (e.turn >= 0) share *= turns_[size_t(e.turn)].factor(p, from);
    return asSeen(e, share * (e.groups >= 0 ? groups_[size_t(e.groups)].density(p, from) : density(e, p)), p, from);
}

const Emitter::Entry& Emitter::entryAt(float choose) const {
    const auto above = [](float c, const Entry& e) { return c < e.cumulative; };
    return *std::upper_bound(entries_.begin(), entries_.end() - 1, choose, above);
}

const Emitter::Entry& Emitter::entryFrom(const Vec3& from, float choose, double& share) const {
    if (chooser_.empty()) {
        const Entry& e = entryAt(choose);
        share = e.share;
        return e;
    }
    float chance;
    const int i = chooser_.pick(from, choose, chance);
    share = chance;
    return entries_[size_t(i)];
}

bool Emitter::outside(const Entry& e, const Vec3& from, double& cap) {
    const double distance = length(Vec3d(e.centre) - Vec3d(from));
    if (!(distance > e.radius * 1.0001)) return false;
    cap = capOneMinusCos(e.radius, distance);
    return true;
}

bool Emitter::sampleSphere(const Entry& e, const Vec3& from, Vec2 u, double cap, double share, Sample& out,
                           geometry::SurfacePoint& point, uint32_t needs) const {
    bool far = e.inner;
    if (e.through) { // each side with probability 1/2
        far = u.x >= .5f;
        u.x = far ? 2 * u.x - 1 : 2 * u.x;
        share *= .5;
    }
    const Vec3 w = Basis(normalize(e.centre - from)).toWorld(sampleCone(float(cap), u));
    geometry::ExactHit hits[4];
    const int n = e.shape->exactHits(Vec3d(from), Vec3d(w), hits);
    // Rounding at the silhouette: this sample is lost, with a probability of about float epsilon.
    int k = 0;
    while (k < n && !(hits[k].t > 0)) ++k;
    if (k == n) return false;
    if (far) k = n - 1;
    e.shape->evaluateHit(0, hits[k].u, hits[k].v, point, needs);
    out.pdf = float(share / (2 * kPi * cap));
    out.direction = w;
    out.distance = float(hits[k].t);
    return true;
}

bool Emitter::sample(const Vec3& from, Vec2 u, float choose, float time, Sample& out, geometry::SurfacePoint& point,
                     uint32_t needs) const {
    if (entries_.empty()) return false;
    double share, cap;
    const Entry& e = entryFrom(from, choose, share);
    out.shape = e.shape;
    out.visibility = e.visibility;
    if (e.sphere && outside(e, from, cap)) return sampleSphere(e, from, u, cap, share, out, point, needs);
    TriangleLamp::Seen seen;
    double perArea = 0;
    const bool angle = e.triangles >= 0 && triangles_[size_t(e.triangles)].see(from, seen);
    if (angle) {
        const geometry::HitRef at = triangles_[size_t(e.triangles)].place(from, seen, u);
        e.shape->evaluateHit(at.prim, at.b1, at.b2, point, needs);
    } else if (e.groups >= 0) {
        perArea = groups_[size_t(e.groups)].place(from, u, time, point, needs);
    } else if (!place(e, from, u, time, point, needs)) {
        return false;
    }
    if (e.turn >= 0 && turns_[size_t(e.turn)].turns(point, from, u.x))
        place(e, from, {HalfTurn::turned(u.x), u.y}, time, point, needs);
    Vec3 d = intersectsAt(point) - from;
    out.distance = length(d);
    if (!(out.distance > 0)) return false;
    out.direction = d / out.distance;
    if (angle) out.pdf = float(share / seen.total);
    else out.pdf = e.groups >= 0 ? asSeen(e, share * perArea, point, from) : areaPdf(e, share, point, from);
    return out.pdf > 0 && std::isfinite(out.pdf);
}

bool Emitter::followsDirections() const { return flat_.size() == 1 && triangles_[size_t(entries_[0].triangles)].planar(); }

bool Emitter::sampleToward(const Vec3& from, const Vec3& w, Sample& out, geometry::SurfacePoint& point, uint32_t needs) const {
    const Entry& e = entries_[0];
    geometry::HitRef at;
    if (!triangles_[size_t(e.triangles)].meet(from, w, at)) return false;
    e.shape->evaluateHit(at.prim, at.b1, at.b2, point, needs);
    const Vec3 d = intersectsAt(point) - from;
    out.shape = e.shape;
    out.visibility = e.visibility;
    out.distance = length(d);
    if (!(out.distance > 0)) return false;
    out.direction = d / out.distance;
    TriangleLamp::Seen seen;
    const bool angle = triangles_[size_t(e.triangles)].see(from, seen);
    out.pdf = angle ? float(e.share / seen.total) : areaPdf(e, e.share, point, from);
    return std::isfinite(out.pdf);
}

bool Emitter::sampleSurface(const Vec3& from, Vec2 u, float choose, float time, Sample& out, geometry::SurfacePoint& point,
                            uint32_t needs) const {
    if (entries_.empty()) return false;
    const Entry& e = entryAt(choose);
    out.shape = e.shape;
    out.visibility = e.visibility;
    if (!place(e, from, u, time, point, needs)) return false;
    const Vec3 d = intersectsAt(point) - from;
    out.distance = length(d);
    if (!(out.distance > 0)) return false;
    out.direction = d / out.distance;
    out.pdf = float(density(e, point) * e.share * area_); // the share of a shape is its fraction of the area
    return out.pdf > 0 && std::isfinite(out.pdf);
}

const geometry::Shape* Emitter::samplePoint(Vec2 u, float choose, float time, const Vec3& toward, geometry::SurfacePoint& point,
                                            float& perArea) const {
    constexpr float kFar = 1e6f; // relative to the shape's size: from there rays to it are parallel within rounding
    const Entry& e = entryAt(choose);
    bool there = true;
    const auto eye = [&] {
        const geometry::Bounds b = e.shape->bounds();
        return (b.lo + b.hi) * .5f + toward * (kFar * length(b.hi - b.lo));
    };
    if (e.facets >= 0) there = place(e, {}, u, time, point, geometry::kNeedAll);
    else if (e.shape->facesRays()) there = place(e, eye(), u, time, point, geometry::kNeedAll);
    else if (e.shape->placed()) e.shape->sampleAreaAt(u.x, u.y, time, point, geometry::kNeedAll);
    else e.shape->sampleArea(u.x, u.y, point, geometry::kNeedAll);
    perArea = there ? float(e.share * density(e, point)) : 0;
    return e.shape;
}

float Emitter::pdf(const geometry::Shape* shape, const geometry::SurfacePoint& hit, const Vec3& from) const {
    const auto i = entryOf_.find(shape);
    if (i == entryOf_.end()) return 0;
    const Entry& e = entries_[size_t(i->second)];
    const double share = chooser_.empty() ? e.share : double(chooser_.pmf(i->second, from));
    if (double cap; e.sphere && outside(e, from, cap)) {
        const bool far = dot(hit.P - e.centre, hit.P - from) > 0;
        return e.through || far == e.inner ? float((e.through ? .5 : 1) * share / (2 * kPi * cap)) : 0;
    }
    if (TriangleLamp::Seen seen; e.triangles >= 0 && triangles_[size_t(e.triangles)].see(from, seen))
        return float(share / seen.total);
    return areaPdf(e, share, hit, from);
}

} // namespace alpenglow::world
