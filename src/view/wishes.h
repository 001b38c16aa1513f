// Settings of viewers: the controls of the page, to and from JSON.
#pragma once
#include "view/materials.h"
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>

namespace alpenglow::view {

/// Maximum number of outputs in addition to the picture.
inline constexpr size_t kMostChannels = 16;
/// Maximum number of distinguishable lights: one less than light path labels, with room for the scene's own.
inline constexpr size_t kMostLights = 24;

/// What viewers have set, in addition to the scene.
struct Wishes {
    bool continuous = true, paused = false;    ///< continuous: rendering continues until something changes
    uint32_t spp = 64;                         ///< samples a pixel, where it is not continuous
    int depth = -1;                            ///< -1: as in the scene
    bool direct = true, indirect = true;       ///< kinds of light that are shown
    double factor = 1;                         ///< of the resolution
    double clamp = 0;                          ///< of samples; 0: off
    std::string hider;                         ///< "": the scene's
    std::optional<std::array<double, 4>> crop; ///< x0 x1 y0 y1 in 0..1: rendered first
    std::vector<std::string> channels;         ///< outputs in addition to the picture: mode of a display, or "lpe:..."
    bool lights = false;                       ///< lights apart, so that they can be dimmed
    std::map<std::string, double> dim;         ///< by a light's handle: times its light
    ParameterChanges parameters;               ///< of shaders

    /// Applies the members of the object. Returns "", or an error; then nothing is changed.
    std::string take(const nlohmann::json&);
    nlohmann::json json() const;
    /// Key of the settings that need a new world.
    std::string worldKey() const;
};

/// Reads a parameter of a shader call: {"shader": 0, "name": "Kd", "value": [.5]}; a type is required if the call does not name
/// it. Returns "" or an error.
std::string takeParameter(const nlohmann::json&, const std::vector<ShaderUse>&, ParameterChanges&);

} // namespace alpenglow::view
