#include "bench/box_embree.h"
#include <cmath>
#include <embree3/rtcore.h>

namespace alpenglow::bench {

BareEmbree::BareEmbree(std::span<const geometry::ShapeRef> shapes) {
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = rtcNewScene(device);
    for (const geometry::ShapeRef& s : shapes) {
        RTCGeometry g;
        if (s->exact()) {
            g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
            auto* p = static_cast<float*>(rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 16, 1));
            const auto& m = s->toCamera().m;
            for (int k = 0; k < 3; ++k) p[k] = float(m[3][k]);
            p[3] = float(std::fabs(s->source().primitive->numbers[0]));
        } else {
            const geometry::TriMesh& m = s->mesh();
            g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
            rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, m.P.data(), 0, sizeof(Vec3), m.vertices);
            rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, m.index.data(), 0, 12, m.triangles());
        }
        rtcCommitGeometry(g);
        rtcAttachGeometry(scene, g);
        rtcReleaseGeometry(g);
    }
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(scene);
    device_ = device;
    scene_ = scene;
}

BareEmbree::~BareEmbree() {
    rtcReleaseScene(static_cast<RTCScene>(scene_));
    rtcReleaseDevice(static_cast<RTCDevice>(device_));
}

size_t BareEmbree::intersect(std::span<const accel::Ray> rays) const {
    size_t met = 0;
    for (const accel::Ray& r : rays) {
        RTCRayHit h;
        h.ray = {r.org.x, r.org.y, r.org.z, 0, r.dir.x, r.dir.y, r.dir.z, 0, r.tfar, ~0u, 0, 0};
        h.hit.geomID = h.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        RTCIntersectContext c;
        rtcInitIntersectContext(&c);
        rtcIntersect1(static_cast<RTCScene>(scene_), &c, &h);
        met += h.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    }
    return met;
}

} // namespace alpenglow::bench
