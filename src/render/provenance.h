// What made a picture: program, scene, options. It is written into pictures and into --stats.
#pragma once
#include "render/outputs.h"
#include "render/settings.h"
#include "scene/fwd.h"

namespace alpenglow::render {

/// The options of the command line that change pixels, as one would write them again ("--hider path --max-depth 3"); without
/// those that say how many samples there are, and which, because the parts of a picture differ in them.
std::string pixelOptions(const RenderSettings&);

/// Adds Software, scene, sceneHash, frame, hider, fov, options. Equal for equal pixels of one scene and program, whatever the
/// machine, the time and the number of threads: files of the same picture are equal byte by byte, and so are those that merge
/// makes of parts.
void addProvenance(PictureFacts&, const RenderSettings&, const scene::Frame&, const std::string& hider,
                   const std::string& sceneHash);

/// --stamp: adds command, host, date, seconds, threads, which differ from run to run.
void addStamp(PictureFacts&, const RenderSettings&, double seconds);

/// This machine's name; "" when it has none.
std::string hostName();
/// Now, UTC, "2026-03-01T12:30:05Z".
std::string dateText();

} // namespace alpenglow::render
