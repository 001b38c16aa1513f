// Shared by the tests of this room: pictures with known values, single lookups, files to read.
#pragma once
#include "../display/support.h"
#include "texture/texture.h"

namespace alpenglow::texture::test {

inline display::Image withWrap(display::Image m, const std::string& wrap) {
    m.metadata["wrapmodes"] = wrap + "," + wrap;
    return m;
}

inline display::Image constant(int w, int h, float v, int channels = 3) {
    display::Image m = display::makeImage(w, h, display::defaultChannels(channels));
    for (float& x : m.data) x = v;
    return m;
}

inline LookupOptions blurred(float b, Filter f = Filter::Gaussian) {
    LookupOptions o;
    o.sblur = o.tblur = b;
    o.filter = f;
    return o;
}

/// Writes a picture that a test then reads.
inline void save(const display::test::Scratch& s, const std::string& name, const display::Image& m,
                 display::Format f = display::Format::Tiff, display::Sample sample = display::Sample::UInt8) {
    Diagnostics d;
    display::WriteOptions o;
    o.format = f;
    o.sample = sample;
    o.policy = s.policy();
    ASSERT_TRUE(display::writeImage(name, m, o, d)) << display::test::messages(d);
}

} // namespace alpenglow::texture::test
