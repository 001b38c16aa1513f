#include "accel/accel.h"
#include "accel/direct.h"
#include <algorithm>
#include <bit>
#include <cmath>
#include <embree3/rtcore.h>
#include <new>
#include <optional>
#include <pmmintrin.h>
#include <xmmintrin.h>

namespace alpenglow::accel {

using geometry::Shape;
using geometry::ShapeRef;

namespace {

// Embree wants denormals flushed; ours elsewhere must not be, so the caller's state comes back.
class FlushDenormals {
public:
    FlushDenormals() : old_(_mm_getcsr()) { _mm_setcsr(old_ | 0x8040); }
    ~FlushDenormals() { _mm_setcsr(old_); }
private:
    unsigned old_;
};

struct Best { double t; uint32_t shape, prim; double b1, b2; };

struct Query {
    RTCIntersectContext rtc; // first: Embree hands back a pointer to it
    const Ray* ray;
    Best best;
    bool any;                // occlusion
};

bool before(double t, uint32_t shape, uint32_t prim, const Best& b) {
    if (t != b.t) return t < b.t;
    if (shape != b.shape) return shape < b.shape;
    return prim < b.prim;
}

// Triangles of shapes below this many share one Embree geometry; a geometry of its own costs about a kilobyte.
constexpr uint32_t kShareBelow = 1024;
// Candidates this much farther than the best (relative to t) are still looked at: Embree's own t is rounded differently.
constexpr double kSlack = 4e-6;
// Exact shapes of a scene that is looked through directly.
constexpr size_t kDirectExact = 4;
// Weights of a triangle may be this far outside of it: twice what double arithmetic makes of a ray through a shared edge, so that none
// slips between two triangles.
constexpr double kEdge = 1e-12;
// Neighbours that a ray meets along their edge are this far apart at most: single precision, in which Embree finds them.
constexpr double kSame = 1e-6;

} // namespace

struct Accel::Impl {
    std::vector<ShapeRef> shapes;
    std::vector<uint32_t> visibility;
    std::vector<Levels> levels; ///< empty: all are met
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    geometry::Bounds bounds;
    bool sound = true;

    /// What an Embree geometry holds: whole shapes, one after the other.
    struct Group {
        Impl* owner = nullptr;
        std::vector<uint32_t> shape, firstPrim; ///< by first primitive
        std::vector<uint32_t> slotOf;           ///< by primitive: index into both; empty: one shape
        std::vector<Vec3> P;                    ///< shared groups: all points
        std::vector<uint32_t> index;
        void find(uint32_t prim, uint32_t& s, uint32_t& local) const {
            size_t k = slotOf.empty() ? 0 : slotOf[prim];
            s = shape[k];
            local = prim - firstPrim[k];
        }
    };
    std::vector<std::unique_ptr<Group>> groups;

    /// Scenes of few primitives have no tree.
    struct Ball { uint32_t shape; Vec3d centre; double radius2; }; ///< an exact shape and a sphere around it
    bool direct = false;
    DirectTriangles triangles;
    std::vector<Ball> balls;
    Ball ballAround(uint32_t shape) const;
    bool readyDirect();
    void meetDirect(Query&) const;

    ~Impl() {
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }

    bool visible(const Ray& r, uint32_t s) const { return (visibility[s] & r.mask) != 0 && (!r.only || r.only[s]) && (levels.empty() || (r.level >= levels[s].from && r.level < levels[s].to)); }
    static bool excluded(const Ray& r, uint32_t s, uint32_t prim) {
        return r.excludeShape == s && (r.excludePrim == kNone || r.excludePrim == prim);
    }

    /// A ray that goes on behind a triangle through its edge has met the neighbours as well, those that show it the same side: it leaves a
    /// small thing far away right behind where it came in.
    bool sameCrossing(const Ray& r, uint32_t s, double t, const Vec3& a, const Vec3& b, const Vec3& c) const {
        if (!(t <= r.passed * (1 + kSame)) || r.excludeShape != s || r.excludePrim == kNone) return false;
        const geometry::TriMesh& m = shapes[s]->mesh();
        const uint32_t* last = &m.index[3 * size_t(r.excludePrim)];
        const auto side = [&](const Vec3& p, const Vec3& q, const Vec3& w) { return dot(cross(Vec3d(q) - Vec3d(p), Vec3d(w) - Vec3d(p)), Vec3d(r.dir)) > 0; };
        if (side(a, b, c) != side(m.P[last[0]], m.P[last[1]], m.P[last[2]])) return false;
        for (int k = 0; k < 3; ++k) // by place: meshes have a seam where they close
            if (const Vec3& p = m.P[last[k]]; p == a || p == b || p == c) return true;
        return false;
    }

    /// Whether a candidate counts; then q.best is it. t is ours.
    bool take(Query& q, uint32_t s, uint32_t prim, double t, double b1, double b2) const {
        const Ray& r = *q.ray;
        if (!(t > r.tnear && t < r.tfar)) return false;
        if (t <= r.passed && (t < r.passed || std::pair(s, prim) <= std::pair(r.excludeShape, r.excludePrim))) return false;
        if (!q.any && !before(t, s, prim, q.best)) return false;
        const Shape& shape = *shapes[s];
        if (shape.oneSided() && r.sides != Sides::Both && (dot(shape.hitNormal(prim, b1, b2), Vec3d(r.dir)) >= 0) != (r.sides == Sides::Back)) return false;
        q.best = {t, s, prim, b1, b2};
        return true;
    }
    /// Embree's far limit once q.best is taken.
    static float far(const Query& q) { return float(std::min(double(q.ray->tfar), q.best.t * (1 + kSlack) + 1e-37)); }

    static void triangleFilter(const RTCFilterFunctionNArguments* a) {
        if (a->valid[0] != -1) return;
        Query& q = *reinterpret_cast<Query*>(a->context);
        const Group& g = *static_cast<const Group*>(a->geometryUserPtr);
        auto& ray = *reinterpret_cast<RTCRay*>(a->ray);
        uint32_t s, prim;
        g.find(RTCHitN_primID(a->hit, a->N, 0), s, prim);
        a->valid[0] = 0;
        const Impl& me = *g.owner;
        if (!me.visible(*q.ray, s) || excluded(*q.ray, s, prim)) return;
        const geometry::TriMesh& m = me.shapes[s]->mesh();
        const uint32_t* i = &m.index[3 * size_t(prim)];
        double t, b1, b2, outside;
        if (!meetTriangle(q.ray->org, q.ray->dir, m.P[i[0]], m.P[i[1]], m.P[i[2]], t, b1, b2, outside)) return;
        if (me.sameCrossing(*q.ray, s, t, m.P[i[0]], m.P[i[1]], m.P[i[2]]) || !me.take(q, s, prim, t, b1, b2)) return;
        a->valid[0] = -1;
        if (!q.any) ray.tfar = far(q);
    }

    /// Points of an exact shape count behind this t. The shape that the ray goes on behind may be met again (a ball twice), another that
    /// lies at its place and comes after it is yet to be met there.
    static double exactFrom(const Ray& r, uint32_t s) {
        const double near = r.tnear;
        if (r.passed < 0) return near;
        if (s == r.excludeShape) return std::max(near, double(std::nextafter(float(r.passed), INFINITY)));
        return std::max(near, s < r.excludeShape ? r.passed : std::nextafter(r.passed, 0.0));
    }
    /// Tries all points of one exact shape; true when one was taken.
    bool meetExact(Query& q, uint32_t s) const {
        const Ray& r = *q.ray;
        if (!visible(r, s) || (r.passed < 0 && excluded(r, s, 0))) return false;
        geometry::ExactHit h[4];
        const Shape& shape = *shapes[s];
        const auto wanted = shape.oneSided() && q.ray->sides != Sides::Both ? Shape::Wanted::All : q.any ? Shape::Wanted::Any : Shape::Wanted::Nearest;
        int n = shape.exactHits(Vec3d(r.org), Vec3d(r.dir), exactFrom(r, s), std::min(double(r.tfar), q.best.t), wanted, h);
        bool taken = false;
        for (int i = 0; i < n; ++i) {
            taken |= take(q, s, 0, h[i].t, h[i].u, h[i].v);
            if (taken && q.any) break;
        }
        return taken;
    }
    static void exactBounds(const RTCBoundsFunctionArguments* a) {
        const Group& g = *static_cast<const Group*>(a->geometryUserPtr);
        geometry::Bounds b = g.owner->shapes[g.shape[a->primID]]->bounds();
        a->bounds_o->lower_x = b.lo.x; a->bounds_o->lower_y = b.lo.y; a->bounds_o->lower_z = b.lo.z;
        a->bounds_o->upper_x = b.hi.x; a->bounds_o->upper_y = b.hi.y; a->bounds_o->upper_z = b.hi.z;
    }
    static void exactIntersect(const RTCIntersectFunctionNArguments* a) {
        if (a->valid[0] != -1) return;
        Query& q = *reinterpret_cast<Query*>(a->context);
        const Group& g = *static_cast<const Group*>(a->geometryUserPtr);
        if (!g.owner->meetExact(q, g.shape[a->primID])) return;
        auto& rh = *reinterpret_cast<RTCRayHit*>(a->rayhit);
        rh.ray.tfar = far(q);
        rh.hit.geomID = a->geomID;
        rh.hit.primID = a->primID;
    }
    static void exactOccluded(const RTCOccludedFunctionNArguments* a) {
        if (a->valid[0] != -1) return;
        Query& q = *reinterpret_cast<Query*>(a->context);
        const Group& g = *static_cast<const Group*>(a->geometryUserPtr);
        if (g.owner->meetExact(q, g.shape[a->primID])) reinterpret_cast<RTCRay*>(a->ray)->tfar = -INFINITY;
    }

    void attachTriangles(std::unique_ptr<Group> g, const Vec3* P, size_t points, const uint32_t* index, size_t triangles) {
        RTCGeometry geom = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(geom, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, P, 0, sizeof(Vec3), points);
        rtcSetSharedGeometryBuffer(geom, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, index, 0, 3 * sizeof(uint32_t), triangles);
        rtcSetGeometryIntersectFilterFunction(geom, triangleFilter);
        rtcSetGeometryOccludedFilterFunction(geom, triangleFilter);
        attach(std::move(g), geom);
    }
    void attach(std::unique_ptr<Group> g, RTCGeometry geom) {
        g->owner = this;
        rtcSetGeometryUserData(geom, g.get());
        rtcCommitGeometry(geom);
        rtcAttachGeometry(scene, geom);
        rtcReleaseGeometry(geom);
        groups.push_back(std::move(g));
    }
    void build();
    bool intersectOne(const Ray&, Hit&) const;
    bool occludedOne(const Ray&) const;
};

Accel::Impl::Ball Accel::Impl::ballAround(uint32_t s) const {
    const Shape& shape = *shapes[s];
    geometry::Bounds b = shape.bounds();
    Vec3d lo(b.lo), hi(b.hi), centre = (lo + hi) * 0.5;
    double radius = 0.5 * length(hi - lo) * (1 + 1e-9);
    // A sphere whose transform keeps it one is its own ball; bounds are a box around it.
    const auto& numbers = shape.source().primitive->numbers;
    const auto& m = shape.toCamera().m;
    if (shape.kind() == "Sphere" && !numbers.empty()) {
        Vec3d row[3];
        for (int i = 0; i < 3; ++i) row[i] = {m[i][0], m[i][1], m[i][2]};
        double l = dot(row[0], row[0]);
        bool round = m[0][3] == 0 && m[1][3] == 0 && m[2][3] == 0 && m[3][3] == 1;
        for (int i = 0; i < 3; ++i)
            round = round && std::fabs(dot(row[i], row[i]) - l) <= 1e-6 * l && std::fabs(dot(row[i], row[(i + 1) % 3])) <= 1e-6 * l;
        Vec3d own(m[3][0], m[3][1], m[3][2]);
        double r = std::fabs(double(numbers[0])) * std::sqrt(l) * (1 + 1e-5) + 1e-12 * length(own);
        if (round && r < radius) return {s, own, r * r};
    }
    return {s, centre, radius * radius};
}

bool Accel::Impl::readyDirect() {
    size_t count = 0, exact = 0;
    for (const ShapeRef& s : shapes) {
        if (s->exact()) ++exact;
        else count += s->mesh().triangles();
        if (count > DirectTriangles::kMost || exact > kDirectExact) return false;
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
    return direct = true;
}

/// The answer in q.best.
void Accel::Impl::meetDirect(Query& q) const {
    const Ray& r = *q.ray;
    const Vec3d o(r.org), d(r.dir);
    alignas(32) DirectTriangles::Near near;
    for (uint32_t left = triangles.candidates(r, near); left; left &= left - 1) {
        size_t i = size_t(std::countr_zero(left));
        if (double(near[i]) > q.best.t) continue;
        // The plane that the ray leaves, or that of the light a shadow ray goes to: most candidates end here.
        if (q.any || !(near[i] > r.tnear)) {
            double margin, plane = triangles.planeT(i, o, d, triangles.planeError(o), margin);
            if (plane + margin < double(r.tnear) || plane - margin > std::min(double(r.tfar), q.best.t)) continue;
        }
        const DirectTriangles::Triangle& t = triangles[i];
        if (!visible(r, t.shape) || excluded(r, t.shape, t.prim)) continue;
        double at, b1, b2, outside;
        if (!meetTriangle(r.org, r.dir, t.a, t.b, t.c, at, b1, b2, outside) || outside > kEdge) continue;
        if (!sameCrossing(r, t.shape, at, t.a, t.b, t.c) && take(q, t.shape, t.prim, at, b1, b2) && q.any) return;
    }
    double dd = dot(d, d);
    for (const Ball& b : balls) {
        Vec3d to = b.centre - o;
        double along = dot(to, d), gap = dot(to, to) - b.radius2;
        if (gap > 0 && (along < 0 || along * along < gap * dd * (1 - 1e-9))) continue; // begins outside, and looks away or passes by
        if (meetExact(q, b.shape) && q.any) return;
    }
}

void Accel::Impl::build() {
    auto exact = std::make_unique<Group>(), shared = std::make_unique<Group>();
    auto flush = [&] {
        if (shared->shape.empty()) return;
        size_t points = shared->P.size();
        shared->P.push_back(Vec3(0.f)); // Embree reads 16 bytes a point
        Group& g = *shared;
        attachTriangles(std::move(shared), g.P.data(), points, g.index.data(), g.index.size() / 3);
        shared = std::make_unique<Group>();
    };
    for (uint32_t s = 0; s < shapes.size(); ++s) {
        const Shape& shape = *shapes[s];
        bounds.add(shape.bounds());
        if (shape.exact()) {
            exact->firstPrim.push_back(uint32_t(exact->shape.size()));
            exact->shape.push_back(s);
            continue;
        }
        const geometry::TriMesh& m = shape.mesh();
        if (m.triangles() >= kShareBelow) {
            auto own = std::make_unique<Group>();
            own->shape = {s};
            own->firstPrim = {0};
            attachTriangles(std::move(own), m.P.data(), m.vertices, m.index.data(), m.triangles());
            continue;
        }
        if (m.triangles() == 0) continue;
        uint32_t base = uint32_t(shared->P.size());
        shared->shape.push_back(s);
        shared->firstPrim.push_back(uint32_t(shared->index.size() / 3));
        shared->P.insert(shared->P.end(), m.P.begin(), m.P.begin() + m.vertices);
        for (uint32_t i : m.index) shared->index.push_back(base + i);
        shared->slotOf.resize(shared->index.size() / 3, uint32_t(shared->shape.size() - 1));
        if (shared->P.size() > (size_t(1) << 28)) flush();
    }
    flush();
    if (!exact->shape.empty()) {
        RTCGeometry geom = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(geom, unsigned(exact->shape.size()));
        exact->owner = this;
        rtcSetGeometryUserData(geom, exact.get());
        rtcSetGeometryBoundsFunction(geom, exactBounds, nullptr);
        rtcSetGeometryIntersectFunction(geom, exactIntersect);
        rtcSetGeometryOccludedFunction(geom, exactOccluded);
        attach(std::move(exact), geom);
    }
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
    rtcCommitScene(scene);
}

Accel::Accel(std::vector<ShapeRef> shapes, std::vector<uint32_t> visibility, Diagnostics& diag)
    : impl_(std::make_unique<Impl>()) {
    impl_->shapes = std::move(shapes);
    impl_->visibility = std::move(visibility);
    impl_->visibility.resize(impl_->shapes.size(), kAll);
    if (impl_->readyDirect()) return;
    FlushDenormals flush;
    // A scene without its tree would be a black picture.
    const auto giveUp = [&](RTCError e, const char* what) {
        impl_->sound = false;
        if (e == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
        diag.report(Severity::Severe, Rie::System, {}, std::string(what) + " (code " + std::to_string(int(e)) + ")");
    };
    impl_->device = rtcNewDevice(nullptr);
    if (!impl_->device) {
        giveUp(rtcGetDeviceError(nullptr), "Embree did not start");
        return;
    }
    impl_->scene = rtcNewScene(impl_->device);
    if (impl_->scene) impl_->build();
    if (RTCError e = rtcGetDeviceError(impl_->device); e != RTC_ERROR_NONE) giveUp(e, "Embree could not build the scene");
}

Accel::~Accel() = default;

bool Accel::sound() const { return impl_->sound; }

void Accel::setLevels(std::vector<Levels> levels) {
    levels.resize(impl_->shapes.size());
    impl_->levels = std::move(levels);
}

const std::vector<ShapeRef>& Accel::shapes() const { return impl_->shapes; }
geometry::Bounds Accel::bounds() const { return impl_->bounds; }

namespace {

bool usable(const Ray& r) {
    // An infinite far end is usual; anything else infinite or NaN would wander through every box.
    // Embree takes coordinates below 1.8e18 (and asserts it).
    constexpr float kFar = 1e18f;
    auto near = [](float c) { return std::fabs(c) < kFar; };
    // Without branches: nearly all rays pass.
    const bool sound = int(near(r.org.x)) & int(near(r.org.y)) & int(near(r.org.z)) & int(near(r.dir.x)) & int(near(r.dir.y)) & int(near(r.dir.z)) &
                       int(r.tnear < r.tfar) & int((std::fabs(r.dir.x) + std::fabs(r.dir.y) + std::fabs(r.dir.z)) > 0);
    return sound;
}

bool fill(const Ray& r, RTCRay& o) {
    if (!usable(r)) return false;
    o.org_x = r.org.x; o.org_y = r.org.y; o.org_z = r.org.z;
    o.dir_x = r.dir.x; o.dir_y = r.dir.y; o.dir_z = r.dir.z;
    // Embree's own t is rounded differently: what lies at the place that the ray goes on from must not be lost.
    o.tnear = std::max(0.f, r.passed < 0 ? r.tnear : r.tnear * float(1 - kSlack));
    o.tfar = r.tfar;
    o.time = 0;
    o.mask = kAll;
    o.id = 0;
    o.flags = 0;
    return true;
}

} // namespace

// Direct scenes need none of Embree's floating-point state.
bool Accel::Impl::intersectOne(const Ray& r, Hit& hit) const {
    hit = Hit();
    Query q;
    q.ray = &r;
    q.best = {INFINITY, kNone, kNone, 0, 0};
    q.any = false;
    if (direct) {
        if (!usable(r)) return false;
        meetDirect(q);
    } else {
        RTCRayHit rh;
        if (!scene || !fill(r, rh.ray)) return false;
        rh.hit.geomID = rh.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        rtcInitIntersectContext(&q.rtc);
        rtcIntersect1(scene, &q.rtc, &rh);
    }
    if (q.best.shape == kNone) return false;
    hit = {float(q.best.t), q.best.shape, q.best.prim, q.best.b1, q.best.b2, q.best.t};
    return true;
}

bool Accel::Impl::occludedOne(const Ray& r) const {
    Query q;
    q.ray = &r;
    q.best = {INFINITY, kNone, kNone, 0, 0};
    q.any = true;
    if (direct) {
        if (!usable(r)) return false;
        meetDirect(q);
        return q.best.shape != kNone;
    }
    RTCRay o;
    if (!scene || !fill(r, o)) return false;
    rtcInitIntersectContext(&q.rtc);
    rtcOccluded1(scene, &q.rtc, &o);
    return o.tfar < 0;
}

bool Accel::intersect(const Ray& r, Hit& hit) const {
    if (impl_->direct) return impl_->intersectOne(r, hit);
    FlushDenormals flush;
    return impl_->intersectOne(r, hit);
}

bool Accel::occluded(const Ray& r) const {
    if (impl_->direct) return impl_->occludedOne(r);
    FlushDenormals flush;
    return impl_->occludedOne(r);
}

// One ray at a time on purpose: packets round differently at shared edges, and a result would depend on a ray's neighbours.
void Accel::intersect(std::span<const Ray> rays, std::span<Hit> hits) const {
    std::optional<FlushDenormals> flush;
    if (!impl_->direct) flush.emplace();
    for (size_t i = 0; i < rays.size(); ++i) impl_->intersectOne(rays[i], hits[i]);
}

void Accel::occluded(std::span<const Ray> rays, std::span<uint8_t> out) const {
    std::optional<FlushDenormals> flush;
    if (!impl_->direct) flush.emplace();
    for (size_t i = 0; i < rays.size(); ++i) out[i] = impl_->occludedOne(rays[i]);
}

} // namespace alpenglow::accel
