// Provenance of a picture: program, scene, options. Written into pictures and --stats.
#pragma once
#include "render/outputs.h"
#include "render/settings.h"
#include "scene/fwd.h"

namespace alpenglow::render {

/// The command line options that change pixels, in a form that can be given again ("--hider path --max-depth 3"); without number
/// and range of samples, which differ between the parts of a picture.
std::string pixelOptions(const RenderSettings&);

/// Adds Software, scene, sceneHash, frame, hider, fov, options. They are equal for equal pixels of one scene and program,
/// independent of machine, time and threads: so files of the same picture are equal byte by byte, also those merged from parts.
void addProvenance(PictureFacts&, const RenderSettings&, const scene::Frame&, const std::string& hider,
                   const std::string& sceneHash);

/// --stamp: adds command, host, date, seconds, threads, which differ from run to run.
void addStamp(PictureFacts&, const RenderSettings&, double seconds);

/// This machine's name; "" if it has none.
std::string hostName();
/// Now, UTC, "2026-03-01T12:30:05Z".
std::string dateText();

} // namespace alpenglow::render
