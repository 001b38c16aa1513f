// The oracle's second way to meet the box: through Embree, as a renderer that does not know that the scene is a box has to. The
// twelve triangles and two of Embree's own spheres, robust flag, one ray at a time, in float; what is shaded stays the oracle's.
#pragma once
#include "oracle/box_oracle.h"
#include <algorithm>
#include <embree3/rtcore.h>
#include <memory>
#include <type_traits>

namespace oracle {

class ThroughEmbree {
public:
    static constexpr double kOff = 1e-5; ///< ten times what float coordinates of the box round by

    ThroughEmbree() : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_.get())) {
        // Corners in turn; the normal is that of the side the oracle lights.
        const float x = 1.48f, lo = -1.25f, hi = 1.19f, back = -1.55f, front = 1.79f, lamp = 1.18f;
        const float quads[6][4][3] = {{{-x, lo, front}, {x, lo, front}, {x, lo, back}, {-x, lo, back}},
                                      {{-x, hi, back}, {x, hi, back}, {x, hi, front}, {-x, hi, front}},
                                      {{-x, lo, back}, {x, lo, back}, {x, hi, back}, {-x, hi, back}},
                                      {{-x, lo, front}, {-x, lo, back}, {-x, hi, back}, {-x, hi, front}},
                                      {{x, lo, back}, {x, lo, front}, {x, hi, front}, {x, hi, back}},
                                      {{-.5f, lamp, -.075f}, {.5f, lamp, -.075f}, {.5f, lamp, .575f}, {-.5f, lamp, .575f}}};
        RTCGeometry g = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* p = static_cast<float*>(rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, 24));
        auto* i = static_cast<unsigned*>(rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, 12));
        for (unsigned q = 0; q < 6; ++q) {
            for (int k = 0; k < 12; ++k) *p++ = quads[q][k / 3][k % 3];
            for (unsigned corner : {0, 1, 2, 0, 2, 3}) *i++ = 4 * q + corner;
        }
        attach(g);
        g = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_SPHERE_POINT);
        p = static_cast<float*>(rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 16, 2));
        for (const Ball& b : kBalls)
            for (double v : {b.centre.x, b.centre.y, b.centre.z, b.radius}) *p++ = float(v);
        attach(g);
        rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
        rtcCommitScene(scene_.get());
    }

    bool meet(V o, V d, Hit& h) const {
        RTCRayHit r;
        r.ray = rayOf(o, d, INFINITY);
        r.hit.geomID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        RTCIntersectContext c;
        rtcInitIntersectContext(&c);
        rtcIntersect1(scene_.get(), &c, &r);
        if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
        h.t = double(r.ray.tfar);
        h.p = o + d * h.t;
        if (r.hit.geomID == 1) {
            const Ball& b = kBalls[r.hit.primID];
            h.n = unit(h.p - b.centre);
            h.m = b.material;
            h.albedo = {1, 1, 1};
        } else {
            const Wall& w = kWalls[r.hit.primID / 2];
            h.n = w.n;
            h.m = w.material;
            h.albedo = w.albedo;
        }
        return true;
    }
    bool hides(V o, V d, double distance) const {
        RTCRay r = rayOf(o, d, float(std::max(distance - 1e-4, 0.0))); // below 0 would mean: something was met
        RTCIntersectContext c;
        rtcInitIntersectContext(&c);
        rtcOccluded1(scene_.get(), &c, &r);
        return r.tfar < 0;
    }

private:
    struct Ball {
        V centre;
        double radius;
        Material material;
    };
    struct Wall {
        V n;
        Material material;
        V albedo;
    };
    static constexpr Ball kBalls[2] = {{{-.65, -.75, -.55}, .5, Mirror}, {{.73, -.80, .10}, .45, Glass}};
    static constexpr Wall kWalls[6] = {{{0, 1, 0}, Diffuse, {.75, .75, .75}},  {{0, -1, 0}, Diffuse, {.75, .75, .75}},
                                       {{0, 0, 1}, Diffuse, {.75, .75, .75}},  {{1, 0, 0}, Diffuse, {.75, .25, .25}},
                                       {{-1, 0, 0}, Diffuse, {.25, .25, .75}}, {{0, -1, 0}, Light, {}}};

    static RTCRay rayOf(V o, V d, float far) {
        return {float(o.x), float(o.y), float(o.z), 0, float(d.x), float(d.y), float(d.z), 0, far, ~0u, 0, 0};
    }
    void attach(RTCGeometry g) {
        rtcCommitGeometry(g);
        rtcAttachGeometry(scene_.get(), g);
        rtcReleaseGeometry(g);
    }
    struct Release {
        void operator()(RTCDevice d) const { rtcReleaseDevice(d); }
        void operator()(RTCScene s) const { rtcReleaseScene(s); }
    };
    std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release> device_;
    std::unique_ptr<std::remove_pointer_t<RTCScene>, Release> scene_;
};

} // namespace oracle
