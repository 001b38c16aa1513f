// Pictures of the renderer as arrays of NumPy.
#pragma once
#include "python/memorywatcher.h"
#include "python/python.h"

namespace alpenglow::python {

/// A dictionary: name, type, frame, size (width, height of the whole picture), window (x0, y0, x1, y1), pixel_aspect, variables
/// (list of name, first channel, count), channels (names), and data: float32, height x width x channels, which owns the pixels.
py::dict pictureDict(KeptPicture);
/// The same of several.
py::list pictureList(std::vector<KeptPicture>);

/// fraction, samples, total, noise, rays_per_ms, what.
py::dict progressDict(const MemoryWatcher::Progress&);

} // namespace alpenglow::python
