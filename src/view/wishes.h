// What viewers have set: the switches of the page. As JSON on the way to and from it.
#pragma once
#include "view/materials.h"
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>

namespace alpenglow::view {

/// Outputs beside the picture at one time.
inline constexpr size_t kMostChannels = 16;
/// Lights that can be told apart: one less than light path expressions have labels, with room for the scene's own.
inline constexpr size_t kMostLights = 24;

struct Wishes {
    bool continuous = true, paused = false;
    uint32_t spp = 64; ///< samples a pixel, where it is not continuous
    int depth = -1;    ///< -1: as the scene says
    bool direct = true, indirect = true;
    double factor = 1;                         ///< of the resolution
    double clamp = 0;                          ///< of samples; 0: off
    std::string hider;                         ///< "": the scene's
    std::optional<std::array<double, 4>> crop; ///< x0 x1 y0 y1 in 0..1: rendered first
    std::vector<std::string> channels;         ///< outputs beside the picture, as a display's mode names them, or "lpe:..."
    bool lights = false;                       ///< lights apart, so that they can be dimmed
    std::map<std::string, double> dim;         ///< by a light's handle: times its light
    ParameterChanges parameters;               ///< of shaders

    /// Takes what the object names, and leaves the rest. "": fine; else what is wrong, and then nothing was taken.
    std::string take(const nlohmann::json&);
    nlohmann::json json() const;
    /// What another world has to be built for.
    std::string worldKey() const;
};

/// A parameter of a shader call: {"shader": 0, "name": "Kd", "value": [.5]}; a type for what the call does not name. "": fine.
std::string takeParameter(const nlohmann::json&, const std::vector<ShaderUse>&, ParameterChanges&);

} // namespace alpenglow::view
