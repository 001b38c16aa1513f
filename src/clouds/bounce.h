// Light that goes to and fro between the points of a cloud: "_radiosity" with what other points send added, bounce by bounce.
#pragma once
#include "clouds/pointcloud.h"

namespace alpenglow::clouds {

struct BounceOptions {
    int bounces = 1;
    std::string albedoChannel; ///< a colour or float; "": the same everywhere, `albedo`
    Color albedo{.5f};
    float maxSolidAngle = .1f; ///< of hemisphere.h
    int threads = 1;
};

/// Every point gets radiosity + albedo times what arrives from the others, `bounces` times, each with the light of the one
/// before. Disks get and send on the side to which their normal looks; balls are left as they are. "": done; else what is
/// missing. The same bits for any number of threads. An estimate with a bias, as hemisphere.h is.
std::string bounce(PointCloud&, const BounceOptions&);

} // namespace alpenglow::clouds
