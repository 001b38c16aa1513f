// Maps that tests write into the folder of their shaders.
#pragma once
#include "display/imageio.h"
#include "integrator/harness.h"

namespace alpenglow::integrator::testing {

/// An EXR file of three channels; value(x, y, c) is channel c of the pixel in column x and row y. `wrap`: modes in s and t, as
/// textures carry them ("" none). The result is the path in the quotes of a RIB.
template <class F> std::string writeMap(const std::string& name, int width, int height, F value, const std::string& wrap = "") {
    display::Image m = display::makeImage(width, height, display::defaultChannels(3));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c) m.pixel(x, y)[c] = value(x, y, c);
    if (!wrap.empty()) m.metadata["wrapmodes"] = wrap;
    Diagnostics d;
    display::WriteOptions o;
    o.format = display::Format::Exr;
    o.sample = display::Sample::Float;
    o.policy = {shaderFolder(), false, -1};
    EXPECT_TRUE(display::writeImage(name, m, o, d));
    return "\"" + shaderFolder() + "/" + name + "\"";
}

/// One of a single colour.
inline std::string writeMap(const std::string& name, int width, int height, Color colour) {
    return writeMap(name, width, height, [&](int, int, int c) { return colour[c]; });
}

} // namespace alpenglow::integrator::testing
