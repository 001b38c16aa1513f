#include "accel/accel.h"
#include "accel/impl.h"
#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

namespace alpenglow::accel {

Accel::Impl::Ball Accel::Impl::ballAround(uint32_t s) const {
    const Shape& shape = *shapes[s];
    geometry::Bounds b = shape.bounds();
    Vec3d lo(b.lo), hi(b.hi), centre = (lo + hi) * 0.5;
    double radius = 0.5 * length(hi - lo) * (1 + 1e-9);
    // A sphere that its transform keeps spherical is its own bounding sphere; bounds are a box around it.
    const auto& numbers = shape.source().primitive->numbers;
    const auto& m = shape.toCamera().m;
    if (shape.kind() == "Sphere" && !numbers.empty() && !shape.placed()) {
        Vec3d row[3];
        for (int i = 0; i < 3; ++i) row[i] = {m[i][0], m[i][1], m[i][2]};
        double l = dot(row[0], row[0]);
        bool round = m[0][3] == 0 && m[1][3] == 0 && m[2][3] == 0 && m[3][3] == 1;
        for (int i = 0; i < 3; ++i)
            round =
                round && std::fabs(dot(row[i], row[i]) - l) <= 1e-6 * l && std::fabs(dot(row[i], row[(i + 1) % 3])) <= 1e-6 * l;
        Vec3d own(m[3][0], m[3][1], m[3][2]);
        double r = std::fabs(double(numbers[0])) * std::sqrt(l) * (1 + 1e-5) + 1e-12 * length(own);
        if (round && r < radius) return {s, own, r * r};
    }
    return {s, centre, radius * radius};
}

bool Accel::Impl::readyDirect() {
    for (const auto& g : geometries)
        if (!g->tree.empty()) return false;
    size_t count = 0, exact = 0;
    for (const ShapeRef& s : shapes) {
        if (s->exact()) exact += s->exactPrims();
        else count += s->mesh().triangles();
        if (count > DirectTriangles::kMost || exact > kDirectExact || (s->exact() && s->exactPrims() != 1)) return false;
        if (!s->exact() && std::any_of(s->mesh().P.begin(), s->mesh().P.end(), Bvh::reaches))
            return false; // trees leave such shapes out
    }
    for (uint32_t s = 0; s < shapes.size(); ++s) {
        const Shape& shape = *shapes[s];
        bounds.add(shape.bounds());
        if (shape.exact()) {
            balls.push_back(ballAround(s));
            continue;
        }
        const geometry::TriMesh& m = shape.mesh();
        for (uint32_t p = 0; p < m.triangles(); ++p) {
            const uint32_t* i = &m.index[3 * size_t(p)];
            triangles.add({m.P[i[0]], m.P[i[1]], m.P[i[2]], s, p});
        }
    }
    for (const ShapeRef& s : shapes) anyOneSided |= s->oneSided();
    readyBlocks();
    return direct = true;
}

/// Returns the result in q.best.
void Accel::Impl::intersectDirect(Query& q) const {
    const Ray& r = *q.ray;
    const Vec3d o(r.org), d(r.dir);
    alignas(64) DirectTriangles::Near near;
    for (uint32_t left = triangles.candidates(r, near); left; left &= left - 1) {
        size_t i = size_t(std::countr_zero(left));
        if (double(near[i]) > q.best.t) continue;
        // The plane that the ray starts on, or that of the light that a shadow ray ends on: most candidates end here.
        if (q.any || !(near[i] > r.tnear)) {
            double margin, plane = triangles.planeT(i, o, d, triangles.planeError(o), margin);
            if (plane + margin < double(r.tnear) || plane - margin > std::min(double(r.tfar), q.best.t)) continue;
        }
        const DirectTriangles::Triangle& t = triangles[i];
        if (meetOne(q, t.shape, t.prim, t.a, t.b, t.c) && q.any) return;
    }
    double dd = dot(d, d);
    for (const Ball& b : balls) {
        Vec3d to = b.centre - o;
        double along = dot(to, d), gap = dot(to, to) - b.radius2;
        if (gap > 0 && (along < 0 || along * along < gap * dd * (1 - 1e-9)))
            continue; // starts outside, and points away or misses
        if (intersectExact(q, b.shape, 0) && q.any) return;
    }
}

Accel::Accel(std::vector<ShapeRef> shapes, std::vector<uint32_t> visibility, Diagnostics& diag, bool quick)
    : impl_(std::make_unique<Impl>()) {
    impl_->shapes = std::move(shapes);
    impl_->visibility = std::move(visibility);
    impl_->visibility.resize(impl_->shapes.size(), kAll);
    try {
        impl_->readyPlaced();
    } catch (const std::length_error&) {
        impl_->refuse(diag);
        return;
    }
    for (const auto& g : impl_->geometries)
        if (g->tree.beyond()) impl_->sayBeyond(g->tree, *g->shape, diag);
    impl_->readyTrimmed();
    if (impl_->readyDirect()) return;
    impl_->readyForms();
    impl_->bounds = {};
    for (const ShapeRef& s : impl_->shapes)
        if (s->exact()) impl_->bounds.add(s->bounds());
    try {
        impl_->buildTree(quick ? Building::Quick : Building::Best);
        impl_->bounds.add(impl_->tree.bounds());
        if (impl_->tree.beyond()) impl_->sayBeyond(impl_->tree, *impl_->shapes[impl_->tree.beyondOf()], diag);
    } catch (const std::length_error&) { impl_->refuse(diag); }
}

void Accel::Impl::readyForms() {
    for (size_t s = 0; s < shapes.size(); ++s) {
        if (isPlaced(uint32_t(s))) continue;
        const auto form = geometry::quadricForm(*shapes[s]);
        if (!form) continue;
        formNumbers.resize(shapes.size(), kNone);
        formNumbers[s] = uint32_t(forms.size());
        forms.push_back(*form);
    }
}

void Accel::Impl::refuse(Diagnostics& diag) { // without a tree the picture would be black
    sound = false;
    tree = Bvh();
    shapes.clear();
    geometryOf.clear();
    diag.report(Severity::Severe, Rie::Limit, {},
                "the frame has more than a thousand million triangles, curve segments and points");
}

void Accel::Impl::sayBeyond(const Bvh& tree, const Shape& first, Diagnostics& diag) {
    diag.report(Severity::Warning, Rie::Range, first.place(),
                std::to_string(tree.beyond()) + " triangles, of this " + first.kind() +
                    " among others, extend beyond 1e30 and are not drawn");
}

Accel::~Accel() = default;

bool Accel::sound() const { return impl_->sound; }

void Accel::setLevels(std::vector<Levels> levels) {
    levels.resize(impl_->shapes.size());
    impl_->levels = std::move(levels);
}

void Accel::makeSolids(Diagnostics& diag) { impl_->solids = Solids::of(impl_->shapes, diag); }

bool Accel::hasSolids() const { return impl_->solids != nullptr; }

bool Accel::keeps(uint32_t shape, const Vec3& point, const Vec3& normal, float time) const {
    if (!impl_->solids || !impl_->solids->in(shape)) return true;
    Ray r;
    r.org = point - normal; // along the normal: a grazing ray would miss a rounded point
    r.dir = normal;
    r.time = time;
    return impl_->solids->keeps(r, shape, 1, nullptr);
}

const std::vector<ShapeRef>& Accel::shapes() const { return impl_->shapes; }
geometry::Bounds Accel::bounds() const { return impl_->bounds; }

bool Accel::Impl::intersectOne(const Ray& r, Hit& hit) const {
    if (!direct) {
        walkNearest({&r, 1}, {&hit, 1});
        return hit.valid();
    }
    hit = Hit();
    if (!usable(r)) return false;
    Query q{&r, {INFINITY, kNone, kNone, 0, 0}, false};
    intersectDirect(q);
    if (q.best.shape == kNone) return false;
    hit = {float(q.best.t), q.best.shape, q.best.prim, r.time, q.best.b1, q.best.b2, q.best.t};
    return true;
}

bool Accel::Impl::occludedOne(const Ray& r) const {
    if (!direct) {
        uint8_t met;
        walkAny({&r, 1}, {&met, 1});
        return met;
    }
    if (!usable(r)) return false;
    Query q{&r, {INFINITY, kNone, kNone, 0, 0}, true};
    intersectDirect(q);
    return q.best.shape != kNone;
}

bool Accel::intersect(const Ray& r, Hit& hit) const { return impl_->intersectOne(r, hit); }
bool Accel::occluded(const Ray& r) const { return impl_->occludedOne(r); }

void Accel::intersect(std::span<const Ray> rays, std::span<Hit> hits, const StopFlag* stop) const {
    if (!impl_->direct) return impl_->walkNearest(rays, hits, false, stop);
    if (rays.size() > 1 && impl_->takesBlocks()) return impl_->nearestInBlocks(rays, hits);
    for (size_t i = 0; i < rays.size(); ++i) impl_->intersectOne(rays[i], hits[i]);
}

void Accel::intersectTogether(std::span<const Ray> rays, std::span<Hit> hits, const StopFlag* stop) const {
    if (impl_->direct) intersect(rays, hits, stop);
    else impl_->walkNearestTogether(rays, hits, false, stop);
}

void Accel::occluded(std::span<const Ray> rays, std::span<uint8_t> out, const StopFlag* stop) const {
    if (!impl_->direct) return impl_->walkAny(rays, out, stop);
    if (rays.size() > 1 && impl_->takesBlocks()) return impl_->anyInBlocks(rays, out);
    for (size_t i = 0; i < rays.size(); ++i) out[i] = impl_->occludedOne(rays[i]);
}

} // namespace alpenglow::accel
