// Writes Pixar's native textures, for tests: every coding of a tile, both byte orders, versions 2 and 3. Written from the
// description of the layout, apart from the reader. Values are codes 0..255 for samples of one byte, floats for those of four.
#pragma once
#include "display/image.h"
#include <bit>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <string>
#include <vector>
#include <zlib.h>

namespace alpenglow::display::test {

using ByteList = std::vector<uint8_t>;

enum class Coding : int { Raw = 0, Constant = 1, Runs = 2, Lzw = 3, Huffman = 5, Zlib = 6 };

struct PixarFile {
    bool big = true, floats = false, compressedFlag = true;
    int version = 3, type = 1, wrap[2] = {1, 1};
    std::vector<Image> levels;         ///< from the largest on; sides are powers of two
    std::vector<float> matrices;       ///< 32 numbers, or none
    std::function<Coding(int)> coding; ///< of the n-th tile of the file; Raw where it is not set

    ByteList bytes() const;
};

namespace pixar_writer {

struct Out {
    ByteList b;
    bool big;
    void u8(unsigned v) { b.push_back(uint8_t(v)); }
    void u16(unsigned v) {
        u8(big ? v >> 8 : v & 255);
        u8(big ? v & 255 : v >> 8);
    }
    void u32(uint32_t v) {
        u16(big ? v >> 16 : v & 0xffff);
        u16(big ? v & 0xffff : v >> 16);
    }
    void put32(size_t at, uint32_t v) {
        Out o{{}, big};
        o.u32(v);
        std::copy(o.b.begin(), o.b.end(), b.begin() + std::ptrdiff_t(at));
    }
};

inline int log2Of(int n) { return std::bit_width(unsigned(n)) - 1; }

inline ByteList runLengths(const ByteList& t, size_t sample) {
    ByteList out;
    const size_t n = t.size() / sample;
    const auto same = [&](size_t a, size_t b) { return std::memcmp(&t[a * sample], &t[b * sample], sample) == 0; };
    const auto copy = [&](size_t from, size_t count) {
        out.insert(out.end(), &t[from * sample], &t[from * sample] + count * sample);
    };
    for (size_t i = 0; i < n;) {
        size_t run = 1;
        while (i + run < n && run < 128 && same(i, i + run)) ++run;
        if (run > 1) {
            out.push_back(uint8_t(run - 1));
            copy(i, 1);
        } else {
            while (i + run < n && run < 128 && !(i + run + 1 < n && same(i + run, i + run + 1))) ++run;
            out.push_back(uint8_t(0x80 | (run - 1)));
            copy(i, run);
        }
        i += run;
    }
    return out;
}

inline ByteList lzw(const ByteList& t) {
    ByteList out;
    std::map<std::string, unsigned> codes;
    for (unsigned v = 0; v < 256; ++v) codes[std::string(1, char(v))] = v;
    unsigned next = 257;
    int width = 9, bits = 0;
    uint64_t held = 0;
    const auto put = [&](unsigned code) {
        held |= uint64_t(code) << bits;
        for (bits += width; bits >= 8; bits -= 8, held >>= 8) out.push_back(uint8_t(held));
    };
    std::string run;
    bool first = true;
    const auto emit = [&] {
        put(codes[run]);
        // The reader has an entry less than the writer: it widens its codes when the number of ITS next entry needs it.
        if (!first && ++next == 1u << width) ++width;
        first = false;
    };
    unsigned made = 257;
    for (uint8_t v : t) {
        std::string longer = run + char(v);
        if (codes.count(longer)) {
            run = longer;
            continue;
        }
        emit();
        codes[longer] = made++;
        run = std::string(1, char(v));
    }
    emit();
    if (bits > 0) out.push_back(uint8_t(held));
    return out;
}

/// Codes as the layout allows them, not canonical: the more frequent value is a string of ones and a zero, up to 16 bits; many
/// values: eight bits each, the bits turned over.
inline ByteList huffman(const ByteList& t) {
    std::map<int, size_t> count;
    for (uint8_t v : t) ++count[v];
    ByteList out(32);
    for (auto& [v, n] : count) out[size_t(v) >> 3] |= uint8_t(1 << (7 - (v & 7)));
    std::map<int, std::string> codes;
    if (count.size() <= 16) {
        std::string ones;
        for (auto& [v, n] : count) {
            codes[v] = ones + "0";
            ones += "1";
        }
    } else {
        for (auto& [v, n] : count)
            for (int k = 0; k < 8; ++k) codes[v] += v >> k & 1 ? '0' : '1';
    }
    unsigned nibbles = 0, held = 0;
    for (auto& [v, code] : codes) {
        held = held << 4 | unsigned(code.size() - 1);
        if (++nibbles % 2 == 0) out.push_back(uint8_t(held));
    }
    if (nibbles % 2) out.push_back(uint8_t(held << 4));
    std::string text;
    for (auto& [v, code] : codes) text += code;
    while (text.size() % 8) text += '0';
    for (uint8_t v : t) text += codes[v];
    text += std::string(8 - text.size() % 8, '0'); // always one byte more
    for (size_t i = 0; i < text.size(); i += 8) out.push_back(uint8_t(std::stoi(text.substr(i, 8), nullptr, 2)));
    return out;
}

inline ByteList deflated(const ByteList& t, size_t sample, bool big) {
    Out d{{}, big};
    if (sample == 1)
        for (size_t i = 0; i < t.size(); ++i) d.u8(uint8_t(t[i] - (i ? t[i - 1] : 0)));
    else
        for (size_t i = 0; i < t.size(); i += 4) {
            const auto word = [&](size_t at) {
                uint32_t v = 0;
                for (size_t k = 0; k < 4; ++k) v |= uint32_t(t[at + k]) << (8 * (big ? 3 - k : k));
                return v;
            };
            d.u32(word(i) - (i ? word(i - 4) : 0));
        }
    uLongf n = compressBound(uLong(d.b.size()));
    ByteList out(n);
    compress(out.data(), &n, d.b.data(), uLong(d.b.size()));
    out.resize(n);
    return out;
}

inline ByteList coded(const ByteList& t, Coding how, size_t sample, bool big) {
    switch (how) {
    case Coding::Constant:
        return {};
    case Coding::Runs:
        return runLengths(t, sample);
    case Coding::Lzw:
        return lzw(t);
    case Coding::Huffman:
        return huffman(t);
    case Coding::Zlib:
        return deflated(t, sample, big);
    case Coding::Raw:
        break;
    }
    return t;
}

/// The tiles of one channel of a level, raster by raster.
inline std::vector<ByteList> tilesOf(const Image& m, int channel, bool floats, bool big) {
    const int side = floats ? 32 : 64, tw = std::min(side, m.width), th = std::min(side, m.height);
    std::vector<ByteList> tiles;
    for (int y0 = 0; y0 < m.height; y0 += th)
        for (int x0 = 0; x0 < m.width; x0 += tw) {
            Out o{{}, big};
            for (int y = y0; y < y0 + th; ++y)
                for (int x = x0; x < x0 + tw; ++x) {
                    const float v = m.pixel(x, y)[channel];
                    if (floats) o.u32(std::bit_cast<uint32_t>(v));
                    else o.u8(unsigned(v));
                }
            tiles.push_back(o.b);
        }
    return tiles;
}

} // namespace pixar_writer

inline ByteList PixarFile::bytes() const {
    using namespace pixar_writer;
    const int lo = version == 2 ? 2 : 0, hi = 14, n = hi - lo + 1, channels = levels[0].channelCount(), sample = floats ? 4 : 1;
    Out o{{}, big};
    for (unsigned v : {0xfaceu, unsigned(version), 0x1000u, version == 2 ? 4u : 0x400u}) o.u16(v);
    for (int v : {type, 8, lo, hi, log2Of(levels.back().width), log2Of(levels[0].width), log2Of(levels.back().height),
                  log2Of(levels[0].height), wrap[0], wrap[1], channels, version == 3 && compressedFlag ? 1 : 0})
        o.u8(unsigned(v));
    for (int c = 0; c < 8; ++c) o.u8(unsigned(c < channels ? sample : 0));
    o.b.resize(0x3c);
    o.u32(std::bit_cast<uint32_t>(1.0f));
    o.b.resize(size_t(0x48 + 4 * n * n * channels));
    if (!matrices.empty()) {
        o.put32(0x40, uint32_t(o.b.size()));
        for (float v : matrices) o.u32(std::bit_cast<uint32_t>(v));
    }
    struct Directory {
        size_t at;
        std::vector<ByteList> tiles;
    };
    std::vector<Directory> directories;
    for (int c = 0; c < channels; ++c)
        for (const Image& m : levels) {
            o.b.resize((o.b.size() + 3) & ~size_t(3));
            o.put32(size_t(0x48 + 4 * (c * n * n + (log2Of(m.height) - lo) * n + log2Of(m.width) - lo)), uint32_t(o.b.size()));
            Directory d{o.b.size(), tilesOf(m, c, floats, big)};
            if (version == 2 || !compressedFlag)
                for (const ByteList& t : d.tiles) o.b.insert(o.b.end(), t.begin(), t.end());
            else {
                o.b.resize(o.b.size() + 8 + 6 * d.tiles.size());
                directories.push_back(std::move(d));
            }
        }
    int number = 0;
    for (const Directory& d : directories)
        for (size_t t = 0; t < d.tiles.size(); ++t) {
            const ByteList& tile = d.tiles[t];
            const Coding how = coding ? coding(number++) : Coding::Raw;
            const ByteList body = coded(tile, how, size_t(sample), big);
            Out word{{}, big};
            word.u16(unsigned(how) << 13 | unsigned(body.size()));
            std::copy(word.b.begin(), word.b.end(), o.b.begin() + std::ptrdiff_t(d.at + 8 + 4 * d.tiles.size() + 2 * t));
            uint32_t value = uint32_t(o.b.size());
            if (how == Coding::Constant) {
                value = 0;
                for (int k = 0; k < sample; ++k) value |= uint32_t(tile[size_t(k)]) << (floats && !big ? 8 * k : 24 - 8 * k);
            }
            o.put32(d.at + 8 + 4 * t, value);
            o.b.insert(o.b.end(), body.begin(), body.end());
        }
    return o.b;
}

/// Levels below a picture of codes by the mean of four, rounded half up: as the files that were seen have them.
inline std::vector<Image> withCodeLevels(Image m, int smallest = 1) {
    std::vector<Image> all{std::move(m)};
    while (all.back().width > smallest && all.back().height > smallest) {
        const Image& a = all.back();
        Image half = makeImage(a.width / 2, a.height / 2, a.channels);
        for (int y = 0; y < half.height; ++y)
            for (int x = 0; x < half.width; ++x)
                for (int c = 0; c < a.channelCount(); ++c)
                    half.pixel(x, y)[c] = float((int(a.pixel(2 * x, 2 * y)[c]) + int(a.pixel(2 * x + 1, 2 * y)[c]) +
                                                 int(a.pixel(2 * x, 2 * y + 1)[c]) + int(a.pixel(2 * x + 1, 2 * y + 1)[c]) + 2) >>
                                                2);
        all.push_back(std::move(half));
    }
    return all;
}

} // namespace alpenglow::display::test
