// Instanced shapes: trees of their geometry, and the transformation of rays into its space.
#include "accel/impl.h"
#include "base/parallel.h"
#include <unordered_map>

namespace alpenglow::accel {

void Accel::Impl::readyPlaced() {
    std::unordered_map<const Shape*, uint32_t> known;
    for (uint32_t s = 0; s < shapes.size(); ++s) {
        const geometry::Placed* p = shapes[s]->placed();
        if (!p) continue;
        if (geometryOf.empty()) geometryOf.assign(shapes.size(), kNone);
        const auto [at, fresh] = known.try_emplace(p->geometry().get(), uint32_t(geometries.size()));
        geometryOf[s] = at->second;
        if (!fresh) continue;
        auto g = std::make_unique<Geometry>();
        g->shape = p->geometry();
        if (p->deforming() && p->deforming()->keys().size() == 1) g->shape = p->deforming()->keys()[0]; // its keys did not match
        if (const geometry::Deforming* d = p->deforming()) g->tree.build({&d->keys()[0], 1}, d->keys(), d->times());
        else if (!g->shape->exact() || g->shape->exactPrims() > 1) g->tree.build({&g->shape, 1});
        geometries.push_back(std::move(g));
    }
}

namespace {

/// Bounding box of a transformed box; rounded outwards, and enlarged by the error of rays in the geometry's space.
geometry::Bounds placed(const geometry::Bounds& of, const geometry::Affine& m) {
    Vec3d lo = m.o, hi = m.o;
    const auto axis = [&](const Vec3d& x, double from, double to) {
        for (int a = 0; a < 3; ++a) {
            lo[a] += std::min(x[a] * from, x[a] * to);
            hi[a] += std::max(x[a] * from, x[a] * to);
        }
    };
    axis(m.x, double(of.lo.x), double(of.hi.x));
    axis(m.y, double(of.lo.y), double(of.hi.y));
    axis(m.z, double(of.lo.z), double(of.hi.z));
    Vec3 far;
    for (int a = 0; a < 3; ++a) far[a] = float(std::max(std::fabs(lo[a]), std::fabs(hi[a])));
    const float room = 4 * geometry::roundingError(far);
    geometry::Bounds b;
    b.lo = Vec3(lo) - Vec3(room);
    b.hi = Vec3(hi) + Vec3(room);
    return b;
}

} // namespace

std::vector<Bvh::Part> Accel::Impl::partsOfPlaces() {
    // More parts of an instance make camera rays through foliage a fifth faster, but slow down all other rays and building.
    constexpr size_t kParts = 8, kMost = 2'000'000;
    for (uint32_t s = 0; s < shapes.size(); ++s) {
        if (!isPlaced(s) || geometryAt(s).tree.empty()) continue;
        const auto* p = shapes[s]->placed();
        Place place{{}, &geometryAt(s), p, p->deforming(), s, p->placeMoves()};
        if (!p->toGeometry(0, place.in)) continue;
        placesMove |= place.moves || place.deforming;
        places.push_back(place);
    }
    std::vector<Bvh::Part> parts;
    if (places.empty()) return parts;
    const size_t each = std::clamp(kMost / places.size(), size_t(1), kParts);
    std::vector<std::vector<std::pair<Bvh::Child, geometry::Bounds>>> opened(geometries.size());
    for (size_t g = 0; g < geometries.size(); ++g)
        if (!geometries[g]->tree.empty()) opened[g] = geometries[g]->tree.opened(each);
    std::vector<size_t> first{0};
    for (const Place& p : places) first.push_back(first.back() + opened[geometryOf[p.shape]].size());
    parts.resize(first.back());
    parallelFor(size_t(0), places.size(), [&](size_t i) {
        const Place& p = places[i];
        const auto& boxes = opened[geometryOf[p.shape]];
        for (size_t k = 0; k < boxes.size(); ++k) {
            Bvh::Part& part = parts[first[i] + k];
            part.shape = p.shape;
            part.as = {Bvh::kPart | uint32_t(i), boxes[k].first};
            if (p.placed->deforming()) part.bounds = p.placed->bounds();
            else if (!p.moves) part.bounds = placed(boxes[k].second, p.placed->fromGeometry(0));
            else
                for (const auto& [time, out] : p.placed->placeKeys()) part.bounds.add(placed(boxes[k].second, out));
        }
    });
    return parts;
}

void Accel::Impl::readyTrimmed() {
    for (uint32_t s = 0; s < shapes.size(); ++s) {
        const Shape* shape = shapes[s].get();
        if (const geometry::Placed* p = shape->placed())
            shape = p->deforming() ? p->deforming()->keys()[0].get() : p->geometry().get();
        if (!shape->trimmed()) continue;
        trimmed.resize(shapes.size());
        trimmed[s] = shape;
    }
}

bool Accel::Impl::intersectPlaced(Query& q, uint32_t s) const {
    const Ray& r = *q.ray;
    if (r.passed < 0 && r.excludeShape == s && r.excludePrim == kNone) return false;
    const Geometry& g = geometryAt(s);
    const auto* place = static_cast<const geometry::Placed*>(shapes[s].get());
    geometry::Affine in;
    if (!place->toGeometry(r.time, in)) return false;
    const Inside at{&g, place, s, in.point(Vec3d(r.org)), in.vector(Vec3d(r.dir))};
    return !place->deforming() && intersectInside(q, at, 0);
}

bool Accel::Impl::intersectInside(Query& q, const Inside& at, uint32_t prim) const {
    const Ray& r = *q.ray;
    if (r.passed < 0 && excluded(r, at.shape, prim)) return false;
    geometry::ExactHit h[4];
    const Shape& shape = *at.geometry->shape;
    const double from = exactFrom(r, at.shape, prim), to = std::min(double(r.tfar), q.best.t);
    const Shape::Wanted wanted = wantedOf(q, at.shape, *at.place);
    const geometry::KeyedShape* keyed = at.place->keyed();
    const int n = keyed ? keyed->exactHitsAt(prim, at.org, at.dir, from, to, wanted, r.time, h)
                        : shape.exactHits(prim, at.org, at.dir, from, to, wanted, h);
    const auto normal = [&](const geometry::ExactHit& hit) {
        if (!keyed || !keyed->joined()) return shape.hitNormal(prim, hit.u, hit.v);
        geometry::SurfacePoint p;
        const geometry::HitRef ref{prim, hit.u, hit.v, &p, r.time};
        keyed->points({&ref, 1}, 0);
        return Vec3d(p.n);
    };
    bool taken = false;
    for (int i = 0; i < n && !(taken && q.any); ++i)
        taken |= take(q, at.shape, prim, h[i].t, h[i].u, h[i].v, [&] { return at.place->side() * dot(normal(h[i]), at.dir); });
    return taken;
}

/// As for other shapes: the neighbours of a triangle that the ray continues behind.
bool Accel::Impl::sameCrossing(const Query& q, const Inside& at, double t, const Vec3d corner[3]) const {
    const Ray& r = *q.ray;
    if (!(t <= r.passed * (1 + kSame)) || r.excludeShape != at.shape || r.excludePrim == kNone) return false;
    Vec3d last[3];
    if (const geometry::Deforming* d = at.place->deforming()) {
        d->corners(r.excludePrim, r.time, last);
    } else {
        const geometry::TriMesh& m = at.geometry->shape->mesh();
        for (size_t k = 0; k < 3; ++k) last[k] = Vec3d(m.P[m.index[3 * size_t(r.excludePrim) + k]]);
    }
    const auto side = [&](const Vec3d p[3]) { return dot(cross(p[1] - p[0], p[2] - p[0]), at.dir) > 0; };
    if (side(corner) != side(last)) return false;
    const auto same = [](const Vec3d& a, const Vec3d& b) { return a.x == b.x && a.y == b.y && a.z == b.z; };
    for (int k = 0; k < 3; ++k)
        if (same(last[k], corner[0]) || same(last[k], corner[1]) || same(last[k], corner[2])) return true;
    return false;
}

bool Accel::Impl::intersectInside(Query& q, const Inside& at, uint32_t prim, const Vec3d& a, const Vec3d& b,
                                  const Vec3d& c) const {
    const Ray& r = *q.ray;
    if (excluded(r, at.shape, prim)) return false;
    double t, b1, b2, outside;
    if (!intersectTriangle(at.org, at.dir, a, b, c, t, b1, b2, outside, [&](double t_) { return mayTake(q, t_); })) return false;
    if (outside > kEdge && outside > edgeRoom(at.org, at.dir, a, b, c)) return false;
    const Vec3d corner[3] = {a, b, c};
    if (sameCrossing(q, at, t, corner)) return false;
    return take(q, at.shape, prim, t, b1, b2,
                [&] { return at.place->side() * double(at.geometry->shape->orientation()) * dot(cross(b - a, c - a), at.dir); });
}

} // namespace alpenglow::accel
