// The depth files of the eighties: magic 2F 08 67 AB, two 16-bit sizes, world to screen and world to camera as 16 floats each,
// then the depths, all in the byte order of the machine that wrote them.
#include "display/formats/codecs.h"
#include <bit>
#include <cstring>

namespace alpenglow::display {

static std::optional<Image> decodeZfile(Bytes b, const DecodeContext& ctx) {
    constexpr size_t header = 8 + 2 * 64;
    if (b.size() < header) return ctx.refuse("it is truncated");
    bool big = b[0] == 0x2f;
    auto u16 = [&](size_t i) { return big ? unsigned(b[i]) << 8 | b[i + 1] : unsigned(b[i + 1]) << 8 | b[i]; };
    auto f32 = [&](size_t i) {
        uint32_t v = big ? u16(i) << 16 | u16(i + 2) : u16(i + 2) << 16 | u16(i);
        return std::bit_cast<float>(v);
    };
    unsigned w = u16(4), h = u16(6);
    if (!ctx.sizeAllowed(w, h, 1)) return {};
    if ((b.size() - header) / 4 < size_t(w) * h) return ctx.refuse("it is truncated");
    Image m = makeImage(int(w), int(h), {"z"});
    m.worldToNDC.emplace();
    m.worldToCamera.emplace();
    for (size_t i = 0; i < 16; ++i) {
        m.worldToNDC->m[i / 4][i % 4] = f32(8 + 4 * i);
        m.worldToCamera->m[i / 4][i % 4] = f32(72 + 4 * i);
    }
    m.worldToNDC = *m.worldToNDC * screenToNDC();
    for (size_t i = 0; i < m.data.size(); ++i) m.data[i] = f32(header + 4 * i);
    m.metadata["textureformat"] = "Shadow";
    return m;
}

PictureFormat zfileFormat() {
    return {"zfile", [](Bytes b) { return starts(b, {0x2f, 0x08, 0x67, 0xab}) || starts(b, {0xab, 0x67, 0x08, 0x2f}); },
            decodeZfile};
}

} // namespace alpenglow::display
