// Diffuse interreflection between the points of a cloud: adds light of other points to "_radiosity", bounce by bounce.
#pragma once
#include "pointcloud/pointcloud.h"

namespace alpenglow::pointcloud {

/// Options of bounce().
struct BounceOptions {
    int bounces = 1;           ///< how many times light is reflected, >= 1
    std::string albedoChannel; ///< a colour or float; "": the same everywhere, `albedo`
    Color albedo{.5f};         ///< reflected fraction of irradiance, linear, 0 to 1
    float maxSolidAngle = .1f; ///< of hemisphere.h
    int threads = 1;           ///< threads that compute; the result does not depend on them
};

/// Each point gets radiosity + albedo times light from the others, `bounces` times, each with the light of the previous one.
/// Disks receive and send on the side of their normal; spheres are unchanged. Returns "", or what is missing. The same bits for
/// any number of threads. Biased, as hemisphere.h is.
std::string bounce(PointCloud&, const BounceOptions&);

} // namespace alpenglow::pointcloud
