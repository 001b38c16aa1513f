// Forms with a medium inside, five units before the eye.
#pragma once
#include "integrator/floorscene.h"

namespace medium_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

inline std::string three(const std::string& x) { return "[" + x + " " + x + " " + x + "]"; }
inline const char* const kBall = "Sphere 1 -1 1 360\n";
inline std::string inside(const std::string& parameters, const std::string& shape = kBall, const std::string& surface = "null") {
    return "AttributeBegin Surface \"" + surface + "\" Interior \"medium\" " + parameters + " " + shape + " AttributeEnd\n";
}
/// Behind everything, seen along +z, the same under every hider.
inline std::string wall(const std::string& colour = "1 1 1") {
    writeShader("shine", "surface shine() { Oi = 1; Ci = Cs; }\n");
    return "AttributeBegin Surface \"shine\" Color " + colour +
           " Polygon \"P\" [-99 -99 9  -99 99 9  99 99 9  99 -99 9] AttributeEnd\n";
}
/// Along z, so far beside the axis.
inline CameraRay along(float x = 0) { return rayTo({x, 0, 0}, {x, 0, 1}); }
/// The origin is 5 before the eye, which is in no ball about it.
inline std::string at5(const std::string& inside) { return inWorld("Translate 0 0 5\n" + inside); }
inline constexpr Hider kHiders[] = {Hider::Hidden, Hider::Raytrace, Hider::Path};

} // namespace medium_test
