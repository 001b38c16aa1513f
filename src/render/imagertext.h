// What an imager sees of its frame as JSON, for part files: merging runs it without the scene.
#pragma once
#include "integrator/integrator.h"
#include "scene/fwd.h"
#include <optional>
#include <string>

namespace alpenglow::render {

/// The key under which a film keeps what imagerToText() made.
inline constexpr const char* kImagerKey = "alpenglow:imager";

/// A frame without geometry and lights, and how it was rendered: all that World::runImager() asks for.
struct ImagerScene {
    std::shared_ptr<const scene::Frame> frame;
    transport::Settings settings;
};

/// "" where the frame has no imager, or where it would fill a part file's header. Folders become absolute: parts are merged
/// anywhere on the machine. Whether plug-ins may be loaded is not kept: each program is asked anew.
std::string imagerToText(const scene::Frame&, const transport::Settings&);
/// Nothing: the text is not ours (an error was reported).
std::optional<ImagerScene> imagerFromText(const std::string&, const std::string& file, Diagnostics&);

} // namespace alpenglow::render
