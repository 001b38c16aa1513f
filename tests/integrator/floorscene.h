// What tests of shaders in small rendered scenes share: settings of one hider, a world, a wide floor and a camera ray that meets
// it.
#pragma once
#include "integrator/harness.h"

namespace alpenglow::integrator::testing {

inline Settings under(Hider h, bool suspend = false) {
    Settings s;
    s.hider = h;
    s.suspend = suspend;
    return s;
}
/// The same with the shaders that are shipped.
inline Settings withShaders(Hider h) {
    Settings s = under(h);
    s.shaderPaths.push_back(std::string(ALPENGLOW_SOURCE_DIR) + "/shaders");
    return s;
}
inline std::string inWorld(const std::string& inside) { return "WorldBegin\nSides 2\n" + inside + "WorldEnd\n"; }
/// The plane y = 0, up to 60 from the origin.
inline const char* const kFloor = "Polygon \"P\" [-60 0 -60  -60 0 60  60 0 60  60 0 -60]\n";
/// Meets the floor at the origin from above.
inline const CameraRay kView = rayTo({.3f, .8f, -.4f}, {0, 0, 0});

} // namespace alpenglow::integrator::testing
