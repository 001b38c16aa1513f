// The frame data that an imager reads, as JSON for part files: merging runs the imager without the scene.
#pragma once
#include "integrator/integrator.h"
#include "scene/fwd.h"
#include <optional>
#include <string>

namespace alpenglow::render {

/// Metadata key of a film for the result of imagerToText().
inline constexpr const char* kImagerKey = "alpenglow:imager";

/// A frame without geometry and lights, and its settings: all that World::runImager() needs.
struct ImagerScene {
    std::shared_ptr<const scene::Frame> frame;
    world::Settings settings;
};

/// Returns "" if the frame has no imager, or if the text is too long for a part file's header. Folders become absolute, as parts
/// may be merged anywhere on the machine. The permission to load plug-ins is not stored: each program sets its own.
std::string imagerToText(const scene::Frame&, const world::Settings&);
/// Returns nothing if the text is invalid (an error is reported).
std::optional<ImagerScene> imagerFromText(const std::string&, const std::string& file, Diagnostics&);

} // namespace alpenglow::render
