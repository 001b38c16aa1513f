// The depth files of the eighties: magic 2F 08 67 AB, two 16-bit sizes, world to screen and world to camera as 16 floats each,
// then the depths, all in the byte order of the machine that wrote them.
#include "display/formats/codecs.h"
#include <algorithm>
#include <bit>
#include <cmath>

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

/// In the byte order of this machine, as all that write it do.
bool writeZfile(const std::string& path, const Image& image, const OutputPolicy& policy, Diagnostics& diags,
                const SourcePlace& place) {
    const auto refuse = [&](const std::string& why) {
        diags.report(Severity::Error, Rie::Limit, place, "cannot write \"" + path + "\": " + why,
                     "OpenEXR holds it: name it .exr");
        return false;
    };
    const int z = image.channel("z"), width = image.fullWidth > 0 ? image.fullWidth : image.width,
              height = image.fullHeight > 0 ? image.fullHeight : image.height;
    if (z < 0) return refuse("it has no depth");
    if (width > 65535 || height > 65535) return refuse("a zfile is not larger than 65535 x 65535");
    auto file = OutputFile::open(path, policy, diags, place);
    if (!file) return false;
    const uint32_t magic = 0x2f0867ab;
    const uint16_t size[2] = {uint16_t(width), uint16_t(height)};
    const Matrix none, toScreen = image.worldToNDC.value_or(none) * inverse(screenToNDC());
    float numbers[32];
    for (size_t i = 0; i < 16; ++i) {
        numbers[i] = float(toScreen.m[i / 4][i % 4]);
        numbers[16 + i] = float(image.worldToCamera.value_or(none).m[i / 4][i % 4]);
    }
    file->write(&magic, sizeof magic);
    file->write(size, sizeof size);
    file->write(numbers, sizeof numbers);
    constexpr float kNothing = 1e30f;
    std::vector<float> row(size_t(width), kNothing);
    for (int y = 0; y < height; ++y) {
        std::fill(row.begin(), row.end(), kNothing);
        const int inside = y - image.originY;
        for (int x = 0; x < image.width && inside >= 0 && inside < image.height; ++x) {
            const float depth = image.pixel(x, inside)[z];
            if (x + image.originX < width && x + image.originX >= 0 && std::fabs(depth) < kNothing)
                row[size_t(x + image.originX)] = depth;
        }
        file->write(row.data(), sizeof(float) * row.size());
    }
    return file->commit(diags);
}

PictureFormat zfileFormat() {
    return {"zfile", [](Bytes b) { return starts(b, {0x2f, 0x08, 0x67, 0xab}) || starts(b, {0xab, 0x67, 0x08, 0x2f}); },
            decodeZfile};
}

} // namespace alpenglow::display
