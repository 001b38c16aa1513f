// KTX and KTX2 pictures and cube maps, read only: uncompressed and BC1 to BC7, with levels; KTX2 also with zlib. Source: Khronos,
// KTX File Format Specification 1.0 and 2.0. Without "KTXorientation" the first row is the top one.
#include "base/half.h"
#include "display/formats/blocks.h"
#include "display/formats/codecs.h"
#include <algorithm>
#include <cstring>
#include <zlib.h>

namespace alpenglow::display {
namespace {

/// Format of the texels.
struct TexelFormat {
    enum Number { Unorm, Snorm, Half, Float };
    uint32_t code;
    int channels, bytes; ///< of a number
    Number number;
    bool srgb = false, turned = false; ///< turned: b g r
    std::optional<Block> block{};
    size_t texel() const { return size_t(channels) * size_t(bytes); }
};

constexpr TexelFormat blocksOf(uint32_t code, Block b, bool srgb = false) {
    return {code, 0, 0, TexelFormat::Unorm, srgb, false, b};
}

using N = TexelFormat;
/// VkFormat of KTX2.
constexpr TexelFormat kVulkan[] = {
    {9, 1, 1, N::Unorm},
    {10, 1, 1, N::Snorm},
    {15, 1, 1, N::Unorm, true},
    {16, 2, 1, N::Unorm},
    {17, 2, 1, N::Snorm},
    {22, 2, 1, N::Unorm, true},
    {23, 3, 1, N::Unorm},
    {24, 3, 1, N::Snorm},
    {29, 3, 1, N::Unorm, true},
    {30, 3, 1, N::Unorm, false, true},
    {36, 3, 1, N::Unorm, true, true},
    {37, 4, 1, N::Unorm},
    {38, 4, 1, N::Snorm},
    {43, 4, 1, N::Unorm, true},
    {44, 4, 1, N::Unorm, false, true},
    {50, 4, 1, N::Unorm, true, true},
    {70, 1, 2, N::Unorm},
    {71, 1, 2, N::Snorm},
    {76, 1, 2, N::Half},
    {77, 2, 2, N::Unorm},
    {78, 2, 2, N::Snorm},
    {83, 2, 2, N::Half},
    {84, 3, 2, N::Unorm},
    {85, 3, 2, N::Snorm},
    {90, 3, 2, N::Half},
    {91, 4, 2, N::Unorm},
    {92, 4, 2, N::Snorm},
    {97, 4, 2, N::Half},
    {100, 1, 4, N::Float},
    {103, 2, 4, N::Float},
    {106, 3, 4, N::Float},
    {109, 4, 4, N::Float},
    blocksOf(131, Block::Bc1),
    blocksOf(132, Block::Bc1, true),
    blocksOf(133, Block::Bc1Alpha),
    blocksOf(134, Block::Bc1Alpha, true),
    blocksOf(135, Block::Bc2),
    blocksOf(136, Block::Bc2, true),
    blocksOf(137, Block::Bc3),
    blocksOf(138, Block::Bc3, true),
    blocksOf(139, Block::Bc4),
    blocksOf(140, Block::Bc4Signed),
    blocksOf(141, Block::Bc5),
    blocksOf(142, Block::Bc5Signed),
    blocksOf(143, Block::Bc6),
    blocksOf(144, Block::Bc6Signed),
    blocksOf(145, Block::Bc7),
    blocksOf(146, Block::Bc7, true),
};
/// glInternalFormat of KTX, where blocks are compressed.
constexpr TexelFormat kOpenGl[] = {
    blocksOf(0x83f0, Block::Bc1),       blocksOf(0x83f1, Block::Bc1Alpha),  blocksOf(0x83f2, Block::Bc2),
    blocksOf(0x83f3, Block::Bc3),       blocksOf(0x8c4c, Block::Bc1, true), blocksOf(0x8c4d, Block::Bc1Alpha, true),
    blocksOf(0x8c4e, Block::Bc2, true), blocksOf(0x8c4f, Block::Bc3, true), blocksOf(0x8dbb, Block::Bc4),
    blocksOf(0x8dbc, Block::Bc4Signed), blocksOf(0x8dbd, Block::Bc5),       blocksOf(0x8dbe, Block::Bc5Signed),
    blocksOf(0x8e8c, Block::Bc7),       blocksOf(0x8e8d, Block::Bc7, true), blocksOf(0x8e8e, Block::Bc6Signed),
    blocksOf(0x8e8f, Block::Bc6),
};

/// Uncompressed numbers by glType and glFormat.
std::optional<TexelFormat> glNumbers(uint32_t type, uint32_t format, uint32_t internal) {
    struct Word {
        uint32_t code;
        int value;
    };
    constexpr Word kFormats[] = {{0x1903, 1}, {0x1906, 1}, {0x1909, 1}, {0x190a, 2}, {0x8227, 2},
                                 {0x1907, 3}, {0x80e0, 3}, {0x1908, 4}, {0x80e1, 4}};
    TexelFormat f{};
    for (const Word& w : kFormats)
        if (w.code == format) f.channels = w.value;
    f.turned = format == 0x80e0 || format == 0x80e1;
    switch (type) {
    case 0x1400:
    case 0x1401:
        f.bytes = 1;
        break;
    case 0x1402:
    case 0x1403:
    case 0x140b:
        f.bytes = 2;
        break;
    case 0x1406:
        f.bytes = 4;
        break;
    default:
        break;
    }
    f.number = type == 0x1400 || type == 0x1402 ? N::Snorm : type == 0x140b ? N::Half : type == 0x1406 ? N::Float : N::Unorm;
    f.srgb = internal == 0x8c41 || internal == 0x8c43 || internal == 0x8fbd || internal == 0x8fbe;
    if (!f.channels || !f.bytes) return {};
    return f;
}

template <size_t n> const TexelFormat* formatIn(const TexelFormat (&list)[n], uint32_t code) {
    for (const TexelFormat& f : list)
        if (f.code == code) return &f;
    return nullptr;
}

/// Common contents of both headers.
struct KtxHeader {
    TexelFormat format{};
    uint32_t width = 0, height = 0, faces = 1, levels = 1;
    bool big = false;    ///< numbers have their high byte first
    bool upward = false; ///< the first row is the bottom one
    size_t rowUnit = 1;  ///< rows are padded to a multiple of this
    int channels() const { return format.block ? channelsOf(*format.block) : format.channels; }
    uint64_t widthOf(uint32_t l) const { return std::max<uint32_t>(1, width >> l); }
    uint64_t heightOf(uint32_t l) const { return std::max<uint32_t>(1, height >> l); }
    /// Bytes of a face of a level.
    uint64_t bytesOfFace(uint32_t level) const {
        const uint64_t w = widthOf(level), h = heightOf(level);
        if (format.block) return (w + 3) / 4 * ((h + 3) / 4) * bytesOf(*format.block);
        return bytesOfRow(w) * h;
    }
    uint64_t bytesOfRow(uint64_t w) const { return (w * format.texel() + rowUnit - 1) / rowUnit * rowUnit; }
};

/// Numbers of a file; call has() first.
struct KtxBytes {
    Bytes b;
    bool big = false;
    uint64_t number(uint64_t at, size_t bytes) const {
        uint64_t v = 0;
        for (size_t i = 0; i < bytes; ++i) v |= uint64_t(b[size_t(at) + i]) << (8 * (big ? bytes - 1 - i : i));
        return v;
    }
    uint32_t u32(uint64_t at) const { return uint32_t(number(at, 4)); }
    uint64_t u64(uint64_t at) const { return number(at, 8); }
    bool has(uint64_t at, uint64_t n) const { return at <= b.size() && n <= b.size() - at; }
};

float numberAt(const uint8_t* p, const TexelFormat& f, bool big) {
    uint32_t v = 0;
    for (int i = 0; i < f.bytes; ++i) v |= uint32_t(p[i]) << (8 * (big ? f.bytes - 1 - i : i));
    switch (f.number) {
    case N::Half:
        return ofHalf(uint16_t(v));
    case N::Float: {
        float x;
        std::memcpy(&x, &v, sizeof x);
        return x;
    }
    case N::Snorm:
        return f.bytes == 1 ? float(std::max<int>(int8_t(v), -127)) / 127 : float(std::max<int>(int16_t(v), -32767)) / 32767;
    case N::Unorm:
        break;
    }
    return float(v) / (f.bytes == 1 ? 255.f : 65535.f);
}

/// The texels of one face into rows `top`, top + 1, ... of a picture.
void decodeFace(const uint8_t* from, const KtxHeader& h, uint32_t level, Image& to, int top) {
    const int w = int(h.widthOf(level)), rows = int(h.heightOf(level)), n = to.channelCount();
    const auto row = [&](int y) { return top + (h.upward ? rows - 1 - y : y); };
    if (h.format.block) {
        const size_t size = bytesOf(*h.format.block);
        float texels[16][4];
        for (int y = 0; y < rows; y += 4)
            for (int x = 0; x < w; x += 4, from += size) {
                decodeBlock(*h.format.block, from, texels);
                for (int i = 0; i < 16; ++i)
                    if (x + i % 4 < w && y + i / 4 < rows) std::copy_n(texels[i], n, to.pixel(x + i % 4, row(y + i / 4)));
            }
        return;
    }
    for (int y = 0; y < rows; ++y) {
        const uint8_t* p = from + size_t(y) * h.bytesOfRow(uint64_t(w));
        for (int x = 0; x < w; ++x)
            for (int c = 0; c < n; ++c, p += h.format.bytes)
                to.pixel(x, row(y))[h.format.turned && c < 3 ? 2 - c : c] = numberAt(p, h.format, h.big);
    }
}

/// An empty picture of a level: of a cube map its six faces from top to bottom.
Image pictureFor(const KtxHeader& h, uint32_t level) {
    const int n = h.channels();
    Image m = makeImage(int(h.widthOf(level)), int(h.heightOf(level) * h.faces),
                        n == 2 && !h.format.block && h.format.code == 0x190a ? defaultChannels(2)
                        : n == 2                                             ? std::vector<std::string>{"r", "g"}
                                                                             : defaultChannels(n));
    const bool wide = h.format.block == Block::Bc4 || h.format.block == Block::Bc5;
    const bool floats = h.format.number != N::Unorm || h.format.block == Block::Bc4Signed || h.format.block == Block::Bc5Signed ||
                        h.format.block == Block::Bc6 || h.format.block == Block::Bc6Signed;
    m.floating = floats;
    m.bits = h.format.block ? wide || floats ? 16 : 8 : 8 * h.format.bytes;
    if (h.format.srgb) m.metadata["colorspace"] = "sRGB";
    if (h.faces == 6) {
        m.metadata["textureformat"] = "CubeFace Environment";
        m.metadata["fovcot"] = "1";
    }
    return m;
}

/// Checks limits and unsupported features; returns false after an error.
bool acceptable(const KtxHeader& h, uint32_t depth, uint32_t layers, const DecodeContext& ctx) {
    if (depth > 1 || layers > 0 || (h.faces != 1 && h.faces != 6)) {
        ctx.refuse(depth > 1 ? "it is a volume; only pictures and cube maps are read"
                             : "it is an array of pictures; only single ones and cube maps are read");
        return false;
    }
    if (h.faces == 6 && h.width != h.height) {
        ctx.refuse("the faces of its cube are not square");
        return false;
    }
    return ctx.sizeAllowed(h.width, uint64_t(h.height) * h.faces, uint64_t(h.channels()));
}

/// Number of levels to read: those of a picture, if requested.
uint32_t levelsOf(const KtxHeader& h, const DecodeContext& ctx) {
    if (h.faces > 1 || !ctx.options.levels) return 1;
    uint32_t most = 1;
    while ((std::max(h.width, h.height) >> most) > 0) ++most;
    return std::min(std::max(h.levels, 1u), most);
}

void addLevel(Image& all, Image&& m, uint32_t level) {
    if (level == 0) all = std::move(m);
    else all.levels.push_back(std::move(m));
}

/// Finds "KTXorientation" among the keys: whether the first row is the bottom one.
bool rowsUpward(const KtxBytes& f, uint64_t at, uint64_t size) {
    constexpr char kKey[] = "KTXorientation";
    const uint64_t end = at + size;
    while (end - at > 4) {
        const uint64_t n = f.u32(at);
        at += 4;
        if (n > end - at) return false;
        if (n > sizeof kKey && std::memcmp(f.b.data() + at, kKey, sizeof kKey) == 0) {
            const std::string value(f.b.begin() + std::ptrdiff_t(at + sizeof kKey), f.b.begin() + std::ptrdiff_t(at + n));
            return value.starts_with("S=") ? value.find("T=u") != std::string::npos : value.size() > 1 && value[1] == 'u';
        }
        at += std::min(end - at, (n + 3) / 4 * 4);
    }
    return false;
}

} // namespace

static bool looksLikeKtx(Bytes b) {
    constexpr uint8_t one[12] = {0xab, 'K', 'T', 'X', ' ', '1', '1', 0xbb, '\r', '\n', 0x1a, '\n'};
    constexpr uint8_t two[12] = {0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb, '\r', '\n', 0x1a, '\n'};
    return b.size() >= 12 && (std::equal(one, one + 12, b.begin()) || std::equal(two, two + 12, b.begin()));
}

static std::optional<Image> decodeKtx1(Bytes b, const DecodeContext& ctx) {
    KtxBytes f{b};
    if (!f.has(0, 64)) return ctx.refuse("it is truncated");
    f.big = f.u32(12) == 0x01020304;
    if (!f.big && f.u32(12) != 0x04030201) return ctx.refuse("its byte order is unknown");
    KtxHeader h;
    const uint32_t type = f.u32(16), format = f.u32(24), internal = f.u32(28);
    if (type == 0) {
        const TexelFormat* found = formatIn(kOpenGl, internal);
        if (!found) return ctx.refuse("glInternalFormat " + std::to_string(internal) + " is not read; BC1 to BC7 are");
        h.format = *found;
    } else {
        const auto found = glNumbers(type, format, internal);
        if (!found)
            return ctx.refuse("glType " + std::to_string(type) + " with glFormat " + std::to_string(format) +
                              " is not read; numbers of 8 and 16 bits, half and float are");
        h.format = *found;
        h.format.code = format;
    }
    h.big = f.big;
    h.rowUnit = 4;
    h.width = f.u32(36), h.height = std::max(1u, f.u32(40)), h.faces = f.u32(52), h.levels = f.u32(56);
    if (!acceptable(h, f.u32(44), f.u32(48), ctx)) return {};
    const uint64_t keys = f.u32(60);
    if (!f.has(64, keys)) return ctx.refuse("it is truncated");
    h.upward = rowsUpward(f, 64, keys);
    uint64_t at = 64 + keys;
    Image all;
    for (uint32_t level = 0, n = levelsOf(h, ctx); level < n; ++level) {
        const uint64_t size = h.bytesOfFace(level), step = (size + 3) / 4 * 4;
        if (!f.has(at, 4) || !f.has(at + 4, step * (h.faces - 1) + size)) return ctx.refuse("it is truncated");
        if (f.u32(at) != size) return ctx.refuse("the size of a level does not match its pixels");
        Image m = pictureFor(h, level);
        for (uint32_t face = 0; face < h.faces; ++face)
            decodeFace(b.data() + at + 4 + face * step, h, level, m, int(face * h.heightOf(level)));
        addLevel(all, std::move(m), level);
        at += 4 + step * h.faces;
    }
    return all;
}

/// Bytes of a level of a KTX2 file, decompressed into `room` if needed; null after an error.
static const uint8_t* levelBytes(const KtxBytes& f, uint32_t level, bool packed, uint64_t size, std::vector<uint8_t>& room,
                                 const DecodeContext& ctx) {
    const uint64_t entry = 80 + 24 * uint64_t(level);
    if (!f.has(entry, 24) || !f.has(f.u64(entry), f.u64(entry + 8))) {
        ctx.refuse("it is truncated");
        return nullptr;
    }
    const uint8_t* from = f.b.data() + f.u64(entry);
    if (f.u64(entry + (packed ? 16 : 8)) != size) {
        ctx.refuse("the size of a level does not match its pixels");
        return nullptr;
    }
    if (!packed) return from;
    room.resize(size_t(size));
    uLongf got = uLongf(size);
    if (uncompress(room.data(), &got, from, uLong(f.u64(entry + 8))) != Z_OK || got != size) {
        ctx.refuse("the zlib bytes of a level are damaged");
        return nullptr;
    }
    return room.data();
}

static std::optional<Image> decodeKtx2(Bytes b, const DecodeContext& ctx) {
    const KtxBytes f{b};
    if (!f.has(0, 80)) return ctx.refuse("it is truncated");
    KtxHeader h;
    const uint32_t code = f.u32(12), packing = f.u32(44);
    constexpr const char* kPackings[] = {"", "Basis Universal (BasisLZ)", "Zstandard"};
    if (packing == 1 || packing == 2)
        return ctx.refuse(std::string("its levels are packed by ") + kPackings[packing] + ", which is not read; zlib is");
    if (packing > 3) return ctx.refuse("supercompression " + std::to_string(packing) + " is unknown");
    const TexelFormat* found = formatIn(kVulkan, code);
    if (!found)
        return ctx.refuse(code == 0 ? std::string("it has no Vulkan format (as Basis Universal has none)")
                                    : "Vulkan format " + std::to_string(code) +
                                          " is not read; numbers of 8 and 16 bits, half, float, and BC1 to BC7 are");
    h.format = *found;
    h.width = f.u32(20), h.height = std::max(1u, f.u32(24)), h.faces = f.u32(36), h.levels = f.u32(40);
    if (!acceptable(h, f.u32(28), f.u32(32), ctx)) return {};
    const uint64_t about = f.u32(48), keys = f.u32(56), size = f.u32(60);
    if (!f.has(keys, size)) return ctx.refuse("it is truncated");
    h.upward = rowsUpward(f, keys, size);
    const bool linear = f.has(about, 28) && f.b[size_t(about) + 14] == 1; // transfer function of the first data format descriptor
    Image all;
    std::vector<uint8_t> room;
    for (uint32_t level = 0, n = levelsOf(h, ctx); level < n; ++level) {
        const uint64_t bytes = h.bytesOfFace(level);
        const uint8_t* from = levelBytes(f, level, packing == 3, bytes * h.faces, room, ctx);
        if (!from) return {};
        Image m = pictureFor(h, level);
        if (linear && !h.format.srgb) m.metadata["colorspace"] = "linear";
        for (uint32_t face = 0; face < h.faces; ++face)
            decodeFace(from + face * bytes, h, level, m, int(face * h.heightOf(level)));
        addLevel(all, std::move(m), level);
    }
    return all;
}

static std::optional<Image> decodeKtx(Bytes b, const DecodeContext& ctx) {
    return b[5] == '1' ? decodeKtx1(b, ctx) : decodeKtx2(b, ctx);
}

PictureFormat ktxFormat() {
    return {"KTX", [](Bytes b) { return looksLikeKtx(b); }, decodeKtx};
}

} // namespace alpenglow::display
