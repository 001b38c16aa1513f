#include "shading/point.h"
#include "base/exact.h"
#include <algorithm>

namespace alpenglow::shading {

const char* toString(RayType t) {
    switch (t) {
    case RayType::Camera:
        return "camera";
    case RayType::Diffuse:
        return "diffuse";
    case RayType::Specular:
        return "specular";
    default:
        return "transmission";
    }
}

float Fade::at(double distance) const {
    if (!polynomial) return float(exact::exp(-double(strength) * distance));
    const double left = reach < 1e30f ? std::clamp(1 - distance / reach, 0.0, 1.0) : 1;
    return left > 0 ? float(exact::exp(double(strength) * exact::log(left))) : 0;
}

Vec2 footprintAt(const geometry::SurfacePoint& p, const Footprint& footprint, const Vec3& dir, float distance,
                 float shadingRate) {
    // Two steps across the ray, as long as the footprint is wide, are projected along the ray onto the tangent plane and
    // expressed in dPdu, dPdv by least squares; the larger of the two steps counts.
    float w = 2 * footprint.at(distance);
    const Vec3 &a = p.dPdu, &b = p.dPdv;
    Vec3 n = p.n, d = dir;
    Vec3 ex = normalize(std::fabs(d.x) > 0.6f ? cross(d, Vec3(0, 1, 0)) : cross(d, Vec3(1, 0, 0))), ey = cross(d, ex);
    float dn = dot(d, n);
    if (std::fabs(dn) < 0.05f) dn = dn < 0 ? -0.05f : 0.05f; // a grazing footprint has no useful limit
    float aa = dot(a, a), bb = dot(b, b), ab = dot(a, b), det = aa * bb - ab * ab;
    float best[2] = {0, 0};
    for (const Vec3& e : {ex, ey}) {
        Vec3 step = (e - d * (dot(e, n) / dn)) * w;
        float sa = dot(step, a), sb = dot(step, b), u, v;
        if (det > 1e-12f * aa * bb) {
            u = (sa * bb - sb * ab) / det;
            v = (sb * aa - sa * ab) / det;
        } else { // a pole or a collapsed edge
            u = aa > 0 ? sa / aa : 0;
            v = bb > 0 ? sb / bb : 0;
        }
        best[0] = std::max(best[0], std::fabs(u));
        best[1] = std::max(best[1], std::fabs(v));
    }
    const float rate = std::sqrt(std::clamp(shadingRate > 0 ? shadingRate : 0, 1e-6f, 1e30f));
    return {std::max(best[0] * rate, 1e-12f), std::max(best[1] * rate, 1e-12f)};
}

} // namespace alpenglow::shading
