#include "bench/box_embree.h"
#include "geometry/curves.h"
#include "geometry/placed.h"
#include <cmath>
#include <embree3/rtcore.h>
#include <map>

namespace alpenglow::bench {

namespace {

template <class T> T* buffer(RTCGeometry g, RTCBufferType type, RTCFormat format, size_t n) {
    return static_cast<T*>(rtcSetNewGeometryBuffer(g, type, 0, format, sizeof(T), n));
}
struct Float4 {
    float x, y, z, w;
};

RTCGeometry sphere(RTCDevice device, const geometry::Shape& s) {
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    const auto& m = s.toCamera().m;
    *buffer<Float4>(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 1) = {float(m[3][0]), float(m[3][1]), float(m[3][2]),
                                                                        float(std::fabs(s.source().primitive->numbers[0]))};
    return g;
}

RTCGeometry triangles(RTCDevice device, const geometry::TriMesh& m) {
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, m.P.data(), 0, sizeof(Vec3), m.vertices);
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, m.index.data(), 0, 12, m.triangles());
    return g;
}

RTCGeometry curves(RTCDevice device, const geometry::Shape& s) {
    geometry::CurveSet set;
    Diagnostics said;
    if (!set.take(s.source(), said)) return nullptr;
    const size_t n = set.segments(), each = set.linear() ? 2 : 4;
    RTCGeometry g =
        rtcNewGeometry(device, set.linear() ? RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE : RTC_GEOMETRY_TYPE_ROUND_BEZIER_CURVE);
    auto* p = buffer<Float4>(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, n * each);
    auto* first = buffer<uint32_t>(g, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT, n);
    for (uint32_t i = 0; i < n; ++i) {
        geometry::CurveSegment segment;
        set.load(i, segment);
        first[i] = uint32_t(i * each);
        for (size_t k = 0; k < each; ++k) {
            const Vec3d c = transformPoint(s.toCamera(), segment.p[k + set.linear()]);
            p[i * each + k] = {float(c.x), float(c.y), float(c.z), float(segment.h[k])};
        }
    }
    return g;
}

RTCGeometry geometryOf(RTCDevice device, const geometry::Shape& s) {
    if (!s.exact()) return triangles(device, s.mesh());
    if (s.kind() == "Sphere") return sphere(device, s);
    return s.kind() == "Curves" ? curves(device, s) : nullptr;
}

RTCScene finished(RTCScene scene) {
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(scene);
    return scene;
}

void attach(RTCScene scene, RTCGeometry g) {
    if (!g) return;
    rtcCommitGeometry(g);
    rtcAttachGeometry(scene, g);
    rtcReleaseGeometry(g);
}

RTCRay rayOf(const accel::Ray& r) {
    // A ray that goes on behind what it met begins a little farther: Embree would meet that again.
    const float near = r.passed < 0 ? r.tnear : std::max(r.tnear, float(r.passed * (1 + 1e-5) + 1e-5));
    return {r.org.x, r.org.y, r.org.z, near, r.dir.x, r.dir.y, r.dir.z, 0, r.tfar, ~0u, 0, 0};
}

} // namespace

BareEmbree::BareEmbree(std::span<const geometry::ShapeRef> shapes) {
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = rtcNewScene(device);
    std::map<const geometry::Shape*, RTCScene> placed;
    for (const geometry::ShapeRef& s : shapes) {
        const geometry::Placed* p = s->placed();
        if (!p) {
            attach(scene, geometryOf(device, *s));
            continue;
        }
        RTCScene& of = placed[p->geometry().get()];
        if (!of) {
            of = rtcNewScene(device);
            attach(of, geometryOf(device, *p->geometry()));
            finished(of);
        }
        RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(g, of);
        const geometry::Affine a = p->fromGeometry(0);
        float m[12];
        for (int k = 0; k < 3; ++k)
            m[k] = float(a.x[k]), m[3 + k] = float(a.y[k]), m[6 + k] = float(a.z[k]), m[9 + k] = float(a.o[k]);
        rtcSetGeometryTransform(g, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, m);
        attach(scene, g);
    }
    scene_ = finished(scene);
    for (const auto& [shape, of] : placed) rtcReleaseScene(of);
    device_ = device;
}

BareEmbree::~BareEmbree() {
    rtcReleaseScene(static_cast<RTCScene>(scene_));
    rtcReleaseDevice(static_cast<RTCDevice>(device_));
}

size_t BareEmbree::intersect(std::span<const accel::Ray> rays, float* t) const {
    size_t met = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        RTCRayHit h;
        h.ray = rayOf(rays[i]);
        h.hit.geomID = h.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        RTCIntersectContext c;
        rtcInitIntersectContext(&c);
        rtcIntersect1(static_cast<RTCScene>(scene_), &c, &h);
        const bool hit = h.hit.geomID != RTC_INVALID_GEOMETRY_ID;
        met += hit;
        if (t) t[i] = hit ? h.ray.tfar : INFINITY;
    }
    return met;
}

size_t BareEmbree::occluded(std::span<const accel::Ray> rays, uint8_t* met) const {
    size_t all = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        RTCRay ray = rayOf(rays[i]);
        RTCIntersectContext c;
        rtcInitIntersectContext(&c);
        rtcOccluded1(static_cast<RTCScene>(scene_), &c, &ray);
        const bool hit = ray.tfar < 0;
        all += hit;
        if (met) met[i] = hit;
    }
    return all;
}

} // namespace alpenglow::bench
