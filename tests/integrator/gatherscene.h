// A small floor and surfaces that call gather(), for its tests.
#pragma once
#include "integrator/floorscene.h"

namespace alpenglow::integrator::gatherscene {

inline constexpr Hider kAll[] = {Hider::Hidden, Hider::Raytrace, Hider::Path};
inline const std::string kSeen =
    "Attribute \"visibility\" \"integer transmission\" 1 \"integer diffuse\" 1 \"integer specular\" 1\n";
inline const std::string kSmall = "Polygon \"P\" [-.01 0 -.01  -.01 0 .01  .01 0 .01  .01 0 -.01]\n";
inline const CameraRay kNear = testing::rayTo({.03f, .08f, -.04f}, {0, 0, 0});

/// A surface that runs `body` and shows `value`.
inline std::string runs(const std::string& name, const std::string& body, const std::string& value,
                        const std::string& functions = "") {
    testing::writeShader(name,
                         functions + "surface " + name +
                             "() { vector up = vector \"world\" (0, 1, 0), aside = vector \"world\" (1, 0, 0), d = 0; point "
                             "o = 0; color c = 0, sum = 0; float f = 0, g = 0, hits = 0, misses = 0; string text = "
                             "\"none\";\n" +
                             body + "\nCi = " + value + "; Oi = 1; }\n");
    return "Surface \"" + name + "\"\n";
}

} // namespace alpenglow::integrator::gatherscene
