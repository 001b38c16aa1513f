// Radiance pictures (.hdr), reading only: RGBE, flat or run-length coded rows, orientation "-Y h +X w" (others are refused).
// Light probes are published in this format. Source: the format's description in the Radiance manual ("picture" file format).
#include "display/formats/codecs.h"
#include <cmath>
#include <cstdio>
#include <cstring>

namespace alpenglow::display {
namespace {

/// One row of RGBE into `row` (4 bytes a pixel); false: damaged.
bool readRow(Bytes b, size_t& at, size_t width, std::vector<uint8_t>& row) {
    if (b.size() - at < 4) return false;
    bool coded = width >= 8 && width < 32768 && b[at] == 2 && b[at + 1] == 2 && (size_t(b[at + 2]) << 8 | b[at + 3]) == width;
    if (!coded) {
        if (b.size() - at < width * 4) return false;
        std::memcpy(row.data(), b.data() + at, width * 4);
        at += width * 4;
        return true;
    }
    at += 4;
    for (size_t c = 0; c < 4; ++c)
        for (size_t x = 0; x < width;) {
            if (b.size() - at < 2) return false;
            size_t n = b[at++];
            bool run = n > 128;
            if (run) n -= 128;
            if (n == 0 || n > width - x || (!run && b.size() - at < n)) return false;
            for (size_t i = 0; i < n; ++i) row[4 * x++ + c] = run ? b[at] : b[at + i];
            at += run ? 1 : n;
        }
    return true;
}

} // namespace

static std::optional<Image> decodeRadiance(Bytes b, const DecodeContext& ctx) {
    size_t at = 0;
    auto line = [&](std::string& s) {
        s.clear();
        while (at < b.size() && b[at] != '\n' && s.size() < 4096) s += char(b[at++]);
        if (at >= b.size()) return false;
        return b[at++] == '\n';
    };
    std::string s;
    do {
        if (!line(s)) return ctx.refuse("it is truncated");
        if (s.rfind("FORMAT=", 0) == 0 && s != "FORMAT=32-bit_rle_rgbe")
            return ctx.refuse("its colour format is not RGBE", Rie::Unimplement);
    } while (!s.empty());
    if (!line(s)) return ctx.refuse("it is truncated");
    unsigned w = 0, h = 0;
    char end = 0;
    if (std::sscanf(s.c_str(), "-Y %8u +X %8u%c", &h, &w, &end) != 2)
        return ctx.refuse("its orientation is not supported", Rie::Unimplement);
    if (!ctx.sizeAllowed(w, h, 3)) return {};
    Image m = makeImage(int(w), int(h), defaultChannels(3));
    m.bits = 8;
    std::vector<uint8_t> row(size_t(w) * 4);
    for (unsigned y = 0; y < h; ++y) {
        if (!readRow(b, at, w, row)) return ctx.refuse("it is truncated or damaged");
        float* to = m.pixel(0, int(y));
        for (size_t x = 0; x < w; ++x, to += 3) {
            const uint8_t* p = &row[4 * x];
            float scale = p[3] ? std::ldexp(1.0f, int(p[3]) - 136) : 0.0f; // exponent excess 128, mantissa of 8 bits
            for (int c = 0; c < 3; ++c) to[c] = float(p[c]) * scale;
        }
    }
    return m;
}

PictureFormat radianceFormat() {
    return {"Radiance", [](Bytes b) { return starts(b, {'#', '?'}); }, decodeRadiance};
}

} // namespace alpenglow::display
