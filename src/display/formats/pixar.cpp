// Pixar's native textures, latitude-longitude environments and shadow maps: magic FA CE (or CE FA, the other byte order),
// versions 2 and 3. The layout is not published and was derived from files: a header of 72 bytes; for each channel a table of the
// levels by log2 of height and width; for shadows two matrices; then levels in tiles of one channel and at most 4096 bytes,
// uncompressed in version 2, each with its own compression after a directory in version 3. Row 0 is the top.
#include "display/formats/pixar.h"
#include "display/formats/codecs.h"
#include <algorithm>
#include <bit>
#include <cstring>

namespace alpenglow::display {
namespace {

constexpr size_t headerBytes = 0x48, matrixBytes = 128, tileBytes = 4096;
constexpr int mostChannels = 8, mostLog = 15;

enum class SampleType { Texture = 1, Shadow = 2, LatLong = 3 };

/// Numbers in the byte order of the file. Callers check positions first.
struct PixarReader {
    Bytes b;
    bool big;
    uint32_t u16(size_t at) const { return big ? uint32_t(b[at]) << 8 | b[at + 1] : uint32_t(b[at + 1]) << 8 | b[at]; }
    uint32_t u32(size_t at) const { return big ? u16(at) << 16 | u16(at + 2) : u16(at + 2) << 16 | u16(at); }
    bool holds(uint64_t at, uint64_t n) const { return at <= b.size() && n <= b.size() - at; }
};

struct PixarHeader {
    int version, type, lo, hi, logWidth, logHeight, channels;
    int wrap[2];
    bool compressed;
    uint8_t sampleBytes[mostChannels];
    uint32_t matrices;
    size_t entries() const { return size_t(hi - lo + 1); } ///< along one side of a table
    size_t tablesEnd() const { return headerBytes + 4 * entries() * entries() * size_t(channels); }
};

/// The header, or why it is not one that can be read ("" of `why`: it can).
PixarHeader headerOf(const PixarReader& r, std::string& why) {
    const Bytes& b = r.b;
    PixarHeader h{int(r.u16(2)), b[8], b[10], b[11], b[13], b[15], b[18], {b[16], b[17]}, b[19] != 0, {}, r.u32(0x40)};
    std::copy_n(&b[0x14], mostChannels, h.sampleBytes);
    const bool sizes = h.lo <= h.hi && h.hi <= mostLog && b[12] <= h.logWidth && b[14] <= h.logHeight && h.logWidth <= h.hi &&
                       h.logHeight <= h.hi && h.logWidth >= h.lo && h.logHeight >= h.lo;
    if (h.version != 2 && h.version != 3)
        why = "it is in version " + std::to_string(h.version) + " of Pixar's native format; 2 and 3 are known";
    else if (h.type > int(SampleType::LatLong))
        why = "it is a map of type " + std::to_string(h.type) +
              " in Pixar's native format; textures, latitude-longitude environments and shadow maps can be read, cube faces not: "
              "make the "
              "environment again from its six pictures";
    else if (h.type == 0 || !sizes || h.channels < 1 || h.channels > mostChannels) why = "its header is damaged";
    else if (!r.holds(0, h.tablesEnd())) why = "it is truncated";
    for (int c = 0; why.empty() && c < h.channels; ++c) {
        if (h.sampleBytes[c] == 2)
            why = "it has samples of 16 bits, for which the layout of Pixar's native format is not known; make it again from the "
                  "picture";
        else if (h.sampleBytes[c] != 1 && h.sampleBytes[c] != 4) why = "its header is damaged";
    }
    if (why.empty() && h.type == int(SampleType::Shadow) && (h.channels != 1 || h.sampleBytes[0] != 4))
        why = "its header is damaged";
    return h;
}

/// One file being read.
class Decoder {
public:
    Decoder(const PixarReader& r, const PixarHeader& h, const DecodeContext& ctx) : r_(r), h_(h), ctx_(ctx) {}

    /// The picture with the requested levels.
    std::optional<Image> picture() {
        if (!ctx_.sizeAllowed(1ull << h_.logWidth, 1ull << h_.logHeight, uint64_t(h_.channels))) return {};
        raw_ = h_.version == 2 || (!h_.compressed && rawToTheEnd());
        if (!levelThere(h_.logHeight, h_.logWidth)) return ctx_.refuse("its largest level is missing");
        auto m = level(h_.logHeight, h_.logWidth);
        if (!m) return {};
        describe(*m);
        if (h_.matrices != 0 && !matrices(*m)) return ctx_.refuse("its matrices lie outside of the file");
        if (!ctx_.options.levels || h_.type == int(SampleType::Shadow)) return m;
        for (int y = h_.logHeight, x = h_.logWidth; y > 0 || x > 0;) {
            y = std::max(0, y - 1);
            x = std::max(0, x - 1);
            if (!levelThere(y, x)) break;
            auto l = level(y, x);
            if (!l) return {};
            l->bits = m->bits;
            l->floating = m->floating;
            m->levels.push_back(std::move(*l));
        }
        return m;
    }

private:
    bool inTable(int y, int x) const { return y >= h_.lo && x >= h_.lo && y <= h_.hi && x <= h_.hi; }
    uint32_t entry(int channel, int y, int x) const {
        const size_t n = h_.entries();
        return r_.u32(headerBytes + 4 * (size_t(channel) * n * n + size_t(y - h_.lo) * n + size_t(x - h_.lo)));
    }
    bool levelThere(int y, int x) const {
        if (!inTable(y, x)) return false;
        for (int c = 0; c < h_.channels; ++c)
            if (entry(c, y, x) == 0) return false;
        return true;
    }
    /// Whether uncompressed levels end exactly at the end of the file, as in version 2. No uncompressed file of version 3 is
    /// known: this says whether it has the layout of version 2, or directories.
    bool rawToTheEnd() const {
        uint64_t end = 0;
        for (int c = 0; c < h_.channels; ++c)
            for (int y = h_.lo; y <= h_.hi; ++y)
                for (int x = h_.lo; x <= h_.hi; ++x)
                    if (const uint64_t o = entry(c, y, x)) end = std::max(end, o + (uint64_t(h_.sampleBytes[c]) << (x + y)));
        return end == r_.b.size();
    }

    std::optional<Image> level(int y, int x) {
        Image m = makeImage(1 << x, 1 << y,
                            h_.type == int(SampleType::Shadow) ? std::vector<std::string>{"z"} : defaultChannels(h_.channels));
        for (int c = 0; c < h_.channels; ++c)
            if (!plane(m, c, entry(c, y, x))) return {};
        return m;
    }

    /// One channel of a level; false after an error.
    bool plane(Image& m, int c, uint64_t at) {
        const size_t sample = h_.sampleBytes[c];
        const int side = sample == 1 ? 64 : 32, tw = std::min(side, m.width), th = std::min(side, m.height);
        const size_t across = size_t(m.width / tw), count = across * size_t(m.height / th),
                     need = size_t(tw) * size_t(th) * sample;
        const uint64_t values = at + 8, codes = values + 4 * count;
        if (!r_.holds(at, raw_ ? count * need : 8 + 6 * count)) return refuse("a level is outside of the file");
        uint8_t bytes[tileBytes];
        const std::span<uint8_t> tile(bytes, need);
        for (size_t t = 0; t < count; ++t) {
            if (raw_) std::memcpy(bytes, &r_.b[at + t * need], need);
            else if (!decode(r_.u32(values + 4 * t), r_.u16(codes + 2 * t), tile, sample)) return false;
            put(m, c, tile, int(t % across) * tw, int(t / across) * th, tw);
        }
        return true;
    }

    /// A tile of version 3: the upper three bits of `code` are its coding, the others the number of bytes at `value`.
    bool decode(uint32_t value, uint32_t code, std::span<uint8_t> tile, size_t sample) {
        const uint32_t mode = code >> 13, length = code & 0x1fff;
        if (mode == 1) { // the sample itself, left-justified
            for (size_t i = 0; i < tile.size(); ++i) {
                const size_t k = i % sample;
                tile[i] = uint8_t(value >> (sample == 1 ? 24 : 8 * (r_.big ? 3 - k : k)));
            }
            return true;
        }
        if (!r_.holds(value, length)) return refuse("a tile is outside of the file");
        const Bytes from = r_.b.subspan(value, length);
        const auto check = [&](const char* what, const char* why) { return !why || refuse(std::string(what) + " " + why); };
        switch (mode) {
        case 0:
            if (length < tile.size()) return refuse("a tile ends too early");
            std::copy_n(from.begin(), tile.size(), tile.begin());
            return true;
        case 2:
            return check("the run lengths of a tile", pixar::runLengths(from, tile, sample));
        case 3:
            return check("the LZW codes of a tile", pixar::lzw(from, tile));
        case 5:
            return check("the Huffman codes of a tile", pixar::huffman(from, tile));
        case 6:
            return check("the zlib bytes of a tile", pixar::deflated(from, tile, sample, r_.big));
        default:
            return refuse("a tile has coding " + std::to_string(mode) +
                          " of Pixar's native format, which is not known; make the map again from the picture");
        }
    }

    void put(Image& m, int c, std::span<const uint8_t> tile, int x0, int y0, int tw) const {
        const size_t sample = h_.sampleBytes[c], rows = tile.size() / (size_t(tw) * sample), n = m.channels.size();
        const PixarReader in{tile, r_.big};
        for (size_t y = 0, i = 0; y < rows; ++y) {
            float* to = m.pixel(x0, y0 + int(y)) + c;
            for (int x = 0; x < tw; ++x, i += sample, to += n)
                *to = sample == 1 ? float(tile[i]) / 255.0f : std::bit_cast<float>(in.u32(i));
        }
    }

    void describe(Image& m) const {
        const bool codes = std::all_of(h_.sampleBytes, h_.sampleBytes + h_.channels, [](uint8_t n) { return n == 1; });
        m.bits = codes ? 8 : 32;
        m.floating = !codes;
        m.metadata["textureformat"] = h_.type == int(SampleType::Shadow)    ? "Shadow"
                                      : h_.type == int(SampleType::LatLong) ? "LatLong Environment"
                                                                            : "Plain Texture";
        static constexpr const char* names[] = {"black", "clamp", "periodic"};
        std::string modes;
        for (int w : h_.wrap) {
            const bool known = w >= 1 && w <= 3;
            if (!known) ctx_.warn("its wrap mode " + std::to_string(w) + " is not known; \"black\" is used");
            modes += (modes.empty() ? "" : ",") + std::string(names[known ? w - 1 : 0]);
        }
        m.metadata["wrapmodes"] = modes;
    }

    /// World to screen, then world to camera, for row vectors; false: not in the file.
    bool matrices(Image& m) const {
        if (!r_.holds(h_.matrices, matrixBytes)) return false;
        m.worldToNDC.emplace();
        m.worldToCamera.emplace();
        for (size_t i = 0; i < 16; ++i) {
            m.worldToNDC->m[i / 4][i % 4] = std::bit_cast<float>(r_.u32(h_.matrices + 4 * i));
            m.worldToCamera->m[i / 4][i % 4] = std::bit_cast<float>(r_.u32(h_.matrices + 64 + 4 * i));
        }
        m.worldToNDC = *m.worldToNDC * screenToNDC();
        return true;
    }

    bool refuse(const std::string& why) const {
        ctx_.refuse(why);
        return false;
    }

    const PixarReader& r_;
    const PixarHeader& h_;
    const DecodeContext& ctx_;
    bool raw_ = false; ///< levels are samples, without directories
};

} // namespace

static std::optional<Image> decodePixar(Bytes b, const DecodeContext& ctx) {
    if (b.size() < headerBytes) return ctx.refuse("it is truncated");
    const PixarReader r{b, b[0] == 0xfa};
    std::string why;
    const PixarHeader h = headerOf(r, why);
    if (!why.empty()) return ctx.refuse(why, why.find("native") != std::string::npos ? Rie::Unimplement : Rie::BadFile);
    return Decoder(r, h, ctx).picture();
}

PictureFormat pixarFormat() {
    return {"Pixar's native textures", [](Bytes b) { return starts(b, {0xfa, 0xce}) || starts(b, {0xce, 0xfa}); }, decodePixar};
}

} // namespace alpenglow::display
