// The Display request and the options of displays.
#pragma once
#include "scene/param.h"
#include <string>

namespace alpenglow::scene {

/// PixelFilter: the name and the widths in pixels.
struct PixelFilter {
    std::string name = "gaussian";
    float xwidth = 2, ywidth = 2; ///< full widths, pixels
};
/// Quantize; one = 0: floating point.
struct Quantize {
    float one = 0, min = 0, max = 0, dither = 0; ///< the request's numbers
    bool set = false;                            ///< the scene has set it
};

/// One Display request.
struct Display {
    std::string name = "ri.pic", type = "file", mode = "rgba"; ///< as in the request; several modes are separated by commas
    ParamList params;                                          ///< "quantize", "exposure", "filter", "filterwidth", "dither" etc.
    SourcePlace place;                                         ///< of the request
    bool read = false;                                         ///< a Make request of the scene reads its file
};

} // namespace alpenglow::scene
