#include "world/arealight.h"
#include "base/limits.h"
#include "geometry/placed.h"
#include "lobes/sampling.h"
#include "scene/solids.h"
#include <algorithm>

namespace alpenglow::transport {

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
        const geometry::Shape* s = shapes[i];
        double a = s->area();
        if (!(a > 0) || !std::isfinite(a)) continue;
        Entry e{s, a, 0};
        if (i < visibility.size()) e.visibility = visibility[i];
        e.sphere = wholeSphere(*s, e.centre, e.radius);
        e.inner = e.sphere && scene::solidTakenAway(s->attributes());
        entries_.push_back(e);
        area_ += a;
    }
    double sum = 0;
    for (auto& e : entries_) {
        e.share /= area_;
        e.cumulative = sum += e.share;
        entryOf_[e.shape] = int(&e - entries_.data());
    }
    if (entries_.size() <= size_t(limits::kLightsSampled)) return;
    std::vector<LightBound> bounds;
    for (const Entry& e : entries_) {
        const geometry::Bounds b = e.shape->bounds();
        bounds.push_back({(b.lo + b.hi) * .5f, length(b.hi - b.lo) * .5f, float(e.share), false});
    }
    chooser_ = LightChooser(bounds, 1);
}

bool Emitter::findDisplaced() {
    bool all = true;
    for (Entry& e : entries_) {
        const geometry::Shape& geometry = e.shape->placed() ? *e.shape->placed()->geometry() : *e.shape;
        const geometry::TriMesh& m = geometry.mesh();
        if (e.facets >= 0 || m.triangles() == 0 || !geometry.evaluateHit(0, 1 / 3., 1 / 3.).displaced) continue;
        e.sphere = false;
        if (e.shape->placed()) {
            all = false;
            continue;
        }
        Facets f;
        double sum = 0;
        for (uint32_t t = 0; t < m.triangles(); ++t) {
            const Vec3d a(m.P[m.index[3 * t]]), b(m.P[m.index[3 * t + 1]]), c(m.P[m.index[3 * t + 2]]);
            f.cumulative.push_back(sum += .5 * length(cross(b - a, c - a)));
        }
        if (!(sum > 0) || !std::isfinite(sum)) {
            all = false;
            continue;
        }
        e.facets = int(facets_.size());
        facets_.push_back(std::move(f));
    }
    return all;
}

void Emitter::place(const Entry& e, const Vec3& from, Vec2 u, float time, geometry::SurfacePoint& point, uint32_t needs) const {
    if (e.facets < 0) {
        if (const geometry::Placed* p = e.shape->placed()) p->sampleFromAt(from, u.x, u.y, time, point, needs);
        else e.shape->sampleFrom(from, u.x, u.y, point, needs);
        return;
    }
    const std::vector<double>& sums = facets_[size_t(e.facets)].cumulative;
    const double at = double(u.x) * sums.back();
    const size_t t = size_t(std::upper_bound(sums.begin(), sums.end() - 1, at) - sums.begin());
    const double before = t ? sums[t - 1] : 0, width = sums[t] - before;
    // What is left of the number says where on the facet: even over a triangle, as its corner is cut off by the root.
    const double side = std::sqrt(width > 0 ? std::clamp((at - before) / width, 0.0, 1.0) : 0.5);
    e.shape->evaluateHit(uint32_t(t), side * (1 - double(u.y)), side * double(u.y), point, needs);
}

double Emitter::density(const Entry& e, const geometry::SurfacePoint& p) const {
    return e.facets < 0 ? e.shape->sampleDensity(p) : 1 / facets_[size_t(e.facets)].cumulative.back();
}

geometry::Bounds Emitter::bounds() const {
    geometry::Bounds b;
    for (const Entry& e : entries_) b.add(e.shape->bounds());
    return b;
}

float Emitter::areaPdf(const Entry& e, double share, const geometry::SurfacePoint& p, const Vec3& from) const {
    Vec3 d = meetsAt(p) - from;
    float d2 = dot(d, d), cosine = std::fabs(dot(d, meetsNormal(p))) / std::sqrt(d2);
    if (!(d2 > 0) || !(cosine > 1e-7f)) return 0;
    return float(share * density(e, p) * d2 / cosine);
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

bool Emitter::sample(const Vec3& from, Vec2 u, float choose, float time, Sample& out, geometry::SurfacePoint& point,
                     uint32_t needs) const {
    if (entries_.empty()) return false;
    double share;
    const Entry& e = entryFrom(from, choose, share);
    out.shape = e.shape;
    out.visibility = e.visibility;
    if (e.sphere) {
        Vec3 axis = e.centre - from;
        double dc = length(Vec3d(axis));
        if (dc > e.radius * 1.0001) {
            double cap = capOneMinusCos(e.radius, dc);
            Vec3 w = Basis(normalize(axis)).toWorld(sampleCone(float(cap), u));
            geometry::ExactHit hits[4];
            Vec3d far = Vec3d(from);
            int n = e.shape->exactHits(far, Vec3d(w), hits);
            // The line grazes the rim in rounding: then this draw is lost, with a probability of the order of float epsilon.
            int k = 0;
            while (k < n && !(hits[k].t > 0)) ++k;
            if (k == n) return false;
            if (e.inner) k = n - 1;
            e.shape->evaluateHit(0, hits[k].u, hits[k].v, point, needs);
            out.pdf = float(share / (2 * kPi * cap));
            out.direction = w;
            out.distance = float(hits[k].t);
            return true;
        }
    }
    place(e, from, u, time, point, needs);
    Vec3 d = meetsAt(point) - from;
    out.distance = length(d);
    if (!(out.distance > 0)) return false;
    out.direction = d / out.distance;
    out.pdf = areaPdf(e, share, point, from);
    return out.pdf > 0 && std::isfinite(out.pdf);
}

bool Emitter::sampleSurface(const Vec3& from, Vec2 u, float choose, float time, Sample& out, geometry::SurfacePoint& point,
                            uint32_t needs) const {
    if (entries_.empty()) return false;
    const Entry& e = entryAt(choose);
    out.shape = e.shape;
    out.visibility = e.visibility;
    place(e, from, u, time, point, needs);
    const Vec3 d = meetsAt(point) - from;
    out.distance = length(d);
    if (!(out.distance > 0)) return false;
    out.direction = d / out.distance;
    out.pdf = float(density(e, point) * e.share * area_); // the share of a shape is its part of the area
    return out.pdf > 0 && std::isfinite(out.pdf);
}

const geometry::Shape* Emitter::samplePoint(Vec2 u, float choose, float time, geometry::SurfacePoint& point,
                                            float& perArea) const {
    const Entry& e = entryAt(choose);
    if (e.facets >= 0) place(e, {}, u, time, point, geometry::kNeedAll);
    else if (e.shape->placed()) e.shape->sampleAreaAt(u.x, u.y, time, point, geometry::kNeedAll);
    else e.shape->sampleArea(u.x, u.y, point, geometry::kNeedAll);
    perArea = float(e.share * density(e, point));
    return e.shape;
}

float Emitter::pdf(const geometry::Shape* shape, const geometry::SurfacePoint& hit, const Vec3& from) const {
    const auto i = entryOf_.find(shape);
    if (i == entryOf_.end()) return 0;
    const Entry& e = entries_[size_t(i->second)];
    const double share = chooser_.empty() ? e.share : double(chooser_.pmf(i->second, from));
    if (e.sphere) {
        double dc = length(Vec3d(e.centre) - Vec3d(from));
        if (dc > e.radius * 1.0001) return float(share / (2 * kPi * capOneMinusCos(e.radius, dc)));
    }
    return areaPdf(e, share, hit, from);
}

} // namespace alpenglow::transport
