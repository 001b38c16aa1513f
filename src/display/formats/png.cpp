// PNG by libpng: 8 and 16 bits, 1 to 4 channels. Errors leave the library by longjmp, so the frames that call it hold no objects
// with destructors; everything lives in a struct one frame up.
#include "base/limits.h"
#include "display/formats/codecs.h"
#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <png.h>

namespace alpenglow::display {
namespace {

struct PngReader {
    Bytes bytes;
    size_t at = 0;
    const DecodeContext* ctx = nullptr;
    std::string error;
    Image image;
    std::vector<uint8_t> raw;
    std::vector<png_bytep> rows;
    bool refused = false; ///< already reported
};

struct PngWriter {
    OutputFile* file = nullptr;
    std::string error;
};

void readBytes(png_structp png, png_bytep to, size_t n) {
    auto& r = *static_cast<PngReader*>(png_get_io_ptr(png));
    if (r.bytes.size() - r.at < n) png_error(png, "it is truncated");
    std::memcpy(to, r.bytes.data() + r.at, n);
    r.at += n;
}
void writeBytes(png_structp png, png_bytep from, size_t n) {
    if (!static_cast<PngWriter*>(png_get_io_ptr(png))->file->write(from, n)) png_error(png, "write failed");
}
void flushBytes(png_structp) {}
template <class T> void onError(png_structp png, png_const_charp text) {
    auto* self = static_cast<T*>(png_get_error_ptr(png));
    if (self->error.empty()) self->error = text;
    png_longjmp(png, 1);
}
void onWarning(png_structp, png_const_charp) {} // damaged side chunks: no pixel is lost

/// Allocates the picture, outside of the setjmp frame because it makes objects. Returns false to stop.
bool prepare(PngReader& r, png_structp png, png_infop info) {
    uint32_t w = png_get_image_width(png, info), h = png_get_image_height(png, info);
    int n = png_get_channels(png, info);
    if (!r.ctx->sizeAllowed(w, h, uint64_t(n))) {
        r.refused = true;
        return false;
    }
    Image& m = r.image;
    m.width = int(w);
    m.height = int(h);
    m.channels = defaultChannels(n);
    m.bits = png_get_bit_depth(png, info);
    m.floating = false;
    m.data.assign(m.sampleCount(), 0.0f);
    size_t rowBytes = png_get_rowbytes(png, info);
    r.raw.assign(rowBytes * h, 0);
    r.rows.resize(h);
    for (uint32_t y = 0; y < h; ++y) r.rows[y] = r.raw.data() + rowBytes * y;
    return true;
}

void finish(PngReader& r, png_structp png, png_infop info) {
    Image& m = r.image;
    size_t count = m.sampleCount();
    if (m.bits == 16)
        for (size_t i = 0; i < count; ++i) m.data[i] = float(r.raw[2 * i] << 8 | r.raw[2 * i + 1]) / 65535.0f;
    else
        for (size_t i = 0; i < count; ++i) m.data[i] = float(r.raw[i]) / 255.0f;
    int intent = 0;
    double gamma = 0;
    if (png_get_sRGB(png, info, &intent)) m.metadata["colorspace"] = "sRGB";
    else if (png_get_gAMA(png, info, &gamma)) m.metadata["gamma"] = std::to_string(gamma);
    png_textp text = nullptr;
    int n = 0;
    png_get_text(png, info, &text, &n);
    for (int i = 0; i < n; ++i)
        if (text[i].key && text[i].text) m.metadata[text[i].key] = text[i].text;
}

bool decode(PngReader& r, png_structp png, png_infop info) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_user_limits(png, limits::kImageSide, limits::kImageSide);
    png_set_chunk_malloc_max(png, 16u << 20);
    png_set_read_fn(png, &r, readBytes);
    png_read_info(png, info);
    png_set_expand(png); // palettes to RGB, 1 to 4 bits to 8, transparent colour to alpha
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
    if (!prepare(r, png, info)) return false;
    png_read_image(png, r.rows.data());
    png_read_end(png, info);
    finish(r, png, info);
    return true;
}

struct Encoding {
    const Image* image;
    std::vector<int> index; ///< channels written
    bool sixteen = false, quantised = false, srgb = false;
    std::vector<uint8_t> row;
    std::vector<png_text> texts;
};

bool encode(Encoding& e, PngWriter& w, png_structp png, png_infop info) {
    if (setjmp(png_jmpbuf(png))) return false;
    const Image& m = *e.image;
    static constexpr int types[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGB_ALPHA};
    png_set_user_limits(png, limits::kImageSide, limits::kImageSide);
    png_set_write_fn(png, &w, writeBytes, flushBytes);
    png_set_IHDR(png, info, png_uint_32(m.width), png_uint_32(m.height), e.sixteen ? 16 : 8, types[e.index.size() - 1],
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (e.srgb) png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    if (!e.texts.empty()) png_set_text(png, info, e.texts.data(), int(e.texts.size()));
    png_write_info(png, info);
    size_t n = e.index.size();
    for (int y = 0; y < m.height; ++y) {
        const float* from = m.pixel(0, y);
        for (size_t x = 0; x < size_t(m.width); ++x, from += m.channels.size())
            for (size_t c = 0; c < n; ++c) {
                unsigned v = toCode(from[e.index[c]], e.sixteen ? 65535 : 255, e.quantised);
                if (e.sixteen) {
                    e.row[2 * (x * n + c)] = uint8_t(v >> 8);
                    e.row[2 * (x * n + c) + 1] = uint8_t(v);
                } else e.row[x * n + c] = uint8_t(v);
            }
        png_write_row(png, e.row.data());
    }
    png_write_end(png, info);
    return true;
}

} // namespace

static std::optional<Image> decodePng(Bytes b, const DecodeContext& ctx) {
    PngReader r;
    r.bytes = b;
    r.ctx = &ctx;
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &r, onError<PngReader>, onWarning);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    bool ok = false;
    try {
        ok = info && decode(r, png, info);
    } catch (...) {
        png_destroy_read_struct(&png, &info, nullptr);
        throw;
    }
    png_destroy_read_struct(&png, &info, nullptr);
    if (ok) return std::move(r.image);
    if (r.refused) return {};
    return ctx.refuse(r.error.empty() ? "out of memory" : r.error);
}

static bool encodePng(OutputFile& out, const Image& m, const WriteOptions& o, Diagnostics& diags, std::string& why) {
    Encoding e;
    e.image = &m;
    e.index = pictureChannels(m, true);
    e.sixteen = o.sample != Sample::UInt8;
    e.quantised = o.quantised;
    const auto space = m.metadata.find("colorspace");
    e.srgb = space != m.metadata.end() && space->second == "sRGB";
    e.row.resize(size_t(m.width) * e.index.size() * (e.sixteen ? 2 : 1));
    sayLeftOut("PNG", m, e.index, out.path(), o, diags);
    for (auto& [key, value] : m.metadata) {
        bool plain =
            !key.empty() && key.size() < 80 && key.front() != ' ' && key.back() != ' ' && key != "gamma" && key != "colorspace";
        for (char c : key) plain = plain && c >= 32 && c < 127;
        if (!plain) continue;
        png_text t{};
        t.compression = PNG_TEXT_COMPRESSION_NONE;
        t.key = const_cast<char*>(key.c_str());
        t.text = const_cast<char*>(value.c_str());
        t.text_length = value.size();
        e.texts.push_back(t);
    }
    PngWriter w;
    w.file = &out;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &w, onError<PngWriter>, onWarning);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    bool ok = info && encode(e, w, png, info);
    png_destroy_write_struct(&png, &info);
    if (!ok) why = w.error.empty() ? "out of memory" : w.error;
    return ok;
}

PictureFormat pngFormat() {
    static const WrittenFormat kWritten{.name = "PNG",
                                        .extensions = {"png"},
                                        .floats = false,
                                        .displays = {"png"},
                                        .doc = "PNG. 8 or 16 bits by Quantize; with Quantize off 0 to 1 is written as 16 bits. "
                                               "One picture: r g b (a), or one channel (a)."};
    return {kWritten.name, [](Bytes b) { return starts(b, {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'}); }, decodePng, encodePng,
            &kWritten};
}

} // namespace alpenglow::display
