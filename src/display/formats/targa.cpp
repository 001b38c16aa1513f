// Targa pictures (.tga), read only: colour maps, true colour and grey, with or without run lengths, 8 to 32 bits, rows in both
// directions. The format has no magic number; looksLikeTarga() checks the header. Source: Truevision TGA file format
// specification 2.0.
#include "display/formats/codecs.h"
#include <cstring>

namespace alpenglow::display {
namespace {

struct TargaHeader {
    unsigned idLength, mapType, type, mapFirst, mapLength, mapBits, width, height, bits, descriptor;
    explicit TargaHeader(Bytes b) {
        const auto word = [&](size_t i) { return unsigned(b[i]) | unsigned(b[i + 1]) << 8; };
        idLength = b[0], mapType = b[1], type = b[2];
        mapFirst = word(3), mapLength = word(5), mapBits = b[7];
        width = word(12), height = word(14);
        bits = b[16], descriptor = b[17];
    }
    bool mapped() const { return (type & 7) == 1; }
    bool grey() const { return (type & 7) == 3; }
    bool runs() const { return type & 8; }
    unsigned alphaBits() const { return descriptor & 15; }
    /// Bits of a colour: of the map's entries, else of pixels.
    unsigned colourBits() const { return mapped() ? mapBits : bits; }
    bool good() const {
        if (mapType > 1 || (type & ~8u) < 1 || (type & ~8u) > 3 || width == 0 || height == 0 || (descriptor & 0xc0)) return false;
        const auto colour = [](unsigned n) { return n == 15 || n == 16 || n == 24 || n == 32; };
        if (mapped()) return mapType == 1 && (bits == 8 || bits == 16) && colour(mapBits) && mapLength > 0;
        return grey() ? bits == 8 || bits == 16 : colour(bits);
    }
};

constexpr size_t kHeader = 18;

/// A colour as r g b a, 0 to 1. 5 bits each in 15 and 16, else b g r and perhaps a.
void colourOf(const uint8_t* p, unsigned bits, float* to) {
    if (bits <= 16) {
        const unsigned v = unsigned(p[0]) | unsigned(p[1]) << 8;
        for (int c = 0; c < 3; ++c) to[c] = float(v >> (10 - 5 * c) & 31) / 31.0f;
        to[3] = float(v >> 15);
        return;
    }
    for (int c = 0; c < 3; ++c) to[c] = float(p[2 - c]) / 255.0f;
    to[3] = bits == 32 ? float(p[3]) / 255.0f : 1.0f;
}

/// The stored pixels after run length decoding; returns false if the file is too short.
bool unpack(Bytes b, size_t at, const TargaHeader& h, std::vector<uint8_t>& pixels) {
    const size_t size = (h.bits + 7) / 8, all = size_t(h.width) * h.height * size;
    if (!h.runs()) {
        if (b.size() - at < all) return false;
        pixels.assign(b.begin() + std::ptrdiff_t(at), b.begin() + std::ptrdiff_t(at + all));
        return true;
    }
    pixels.reserve(all);
    while (pixels.size() < all) {
        if (at >= b.size()) return false;
        const bool run = b[at] & 128;
        size_t n = size_t(b[at++] & 127) + 1;
        const size_t from = run ? size : n * size;
        if (b.size() - at < from) return false;
        n = std::min(n, (all - pixels.size()) / size);
        for (size_t i = 0; i < n; ++i) {
            const uint8_t* p = b.data() + at + (run ? 0 : i * size);
            pixels.insert(pixels.end(), p, p + size);
        }
        at += from;
    }
    return true;
}

} // namespace

static bool looksLikeTarga(Bytes b) { return b.size() > kHeader && TargaHeader(b).good(); }

static std::optional<Image> decodeTarga(Bytes b, const DecodeContext& ctx) {
    const TargaHeader h(b);
    // The fourth byte of a pixel, or the sixteenth bit, is opacity if the header declares it.
    const bool alpha = !h.grey() && (h.colourBits() == 32 ? h.alphaBits() != 0 : h.colourBits() == 16 && h.alphaBits() == 1);
    const int channels = h.grey() ? h.bits == 16 ? 2 : 1 : alpha ? 4 : 3;
    if (!ctx.sizeAllowed(h.width, h.height, uint64_t(channels))) return {};
    size_t at = kHeader + h.idLength;
    const size_t entry = (h.mapBits + 7) / 8, map = at;
    if (h.mapType == 1) at += size_t(h.mapLength) * entry;
    std::vector<uint8_t> pixels;
    if (at > b.size() || !unpack(b, at, h, pixels)) return ctx.refuse("it is truncated");
    Image m = makeImage(int(h.width), int(h.height), defaultChannels(channels));
    m.bits = 8;
    m.floating = false;
    const size_t size = (h.bits + 7) / 8;
    for (unsigned y = 0; y < h.height; ++y)
        for (unsigned x = 0; x < h.width; ++x) {
            const uint8_t* p = &pixels[(size_t(y) * h.width + x) * size];
            float* to = m.pixel(int(h.descriptor & 16 ? h.width - 1 - x : x), int(h.descriptor & 32 ? y : h.height - 1 - y));
            if (h.grey()) {
                for (int c = 0; c < channels; ++c) to[c] = float(p[c]) / 255.0f;
                continue;
            }
            float rgba[4];
            if (h.mapped()) {
                const unsigned k = (unsigned(p[0]) | (h.bits == 16 ? unsigned(p[1]) << 8 : 0u)) - h.mapFirst;
                if (k >= h.mapLength) return ctx.refuse("a pixel has an index beyond its colour map");
                colourOf(b.data() + map + size_t(k) * entry, h.mapBits, rgba);
            } else {
                colourOf(p, h.bits, rgba);
            }
            std::memcpy(to, rgba, size_t(channels) * sizeof(float));
        }
    return m;
}

PictureFormat targaFormat() {
    return {"Targa", [](Bytes b) { return looksLikeTarga(b); }, decodeTarga};
}

} // namespace alpenglow::display
