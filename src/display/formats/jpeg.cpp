// JPEG by libjpeg: grey and colour, 8 bits. As in png.cpp, errors jump, so the jumping frame holds no objects.
#include "base/limits.h"
#include "display/formats/codecs.h"
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <jpeglib.h>

namespace alpenglow::display {
namespace {

struct JpegReader {
    jpeg_error_mgr errors{};
    jpeg_progress_mgr progress{};
    std::jmp_buf jump;
    jpeg_decompress_struct info{};
    char error[JMSG_LENGTH_MAX] = "", warning[JMSG_LENGTH_MAX] = "";
    const DecodeContext* ctx = nullptr;
    Image image;
    std::vector<uint8_t> row;
    bool refused = false;
};

JpegReader& self(j_common_ptr c) { return *static_cast<JpegReader*>(c->client_data); }

void onError(j_common_ptr c) {
    JpegReader& r = self(c);
    c->err->format_message(c, r.error);
    std::longjmp(r.jump, 1);
}
void onMessage(j_common_ptr c, int level) {
    if (level >= 0) return;
    JpegReader& r = self(c);
    if (!r.warning[0]) c->err->format_message(c, r.warning);
    ++c->err->num_warnings;
}
void onOutput(j_common_ptr) {}
/// Limits passes: a progressive file can request any number of passes over all pixels.
void onProgress(j_common_ptr c) {
    if (c->is_decompressor && reinterpret_cast<j_decompress_ptr>(c)->input_scan_number > limits::kImageScans) {
        JpegReader& r = self(c);
        std::snprintf(r.error, sizeof r.error, "it has more than %d scans", limits::kImageScans);
        std::longjmp(r.jump, 1);
    }
}

bool prepare(JpegReader& r) {
    int n = r.info.output_components;
    if (!r.ctx->sizeAllowed(r.info.output_width, r.info.output_height, uint64_t(n))) {
        r.refused = true;
        return false;
    }
    r.image = makeImage(int(r.info.output_width), int(r.info.output_height), defaultChannels(n));
    r.image.bits = 8;
    r.image.floating = false;
    r.row.resize(size_t(r.info.output_width) * size_t(n));
    return true;
}

bool decode(JpegReader& r, Bytes b) {
    if (setjmp(r.jump)) return false;
    jpeg_create_decompress(&r.info);
    r.info.client_data = &r;
    r.info.progress = &r.progress;
    jpeg_mem_src(&r.info, b.data(), b.size());
    jpeg_read_header(&r.info, TRUE);
    if (r.info.num_components == 4) {
        std::snprintf(r.error, sizeof r.error, "CMYK JPEG is not supported");
        return false;
    }
    r.info.out_color_space = r.info.num_components == 1 ? JCS_GRAYSCALE : JCS_RGB;
    r.info.dct_method = JDCT_ISLOW;
    jpeg_calc_output_dimensions(&r.info);
    if (!prepare(r)) return false;
    jpeg_start_decompress(&r.info);
    while (r.info.output_scanline < r.info.output_height) {
        float* to = r.image.pixel(0, int(r.info.output_scanline));
        JSAMPROW row = r.row.data();
        if (jpeg_read_scanlines(&r.info, &row, 1) != 1) break;
        for (size_t i = 0; i < r.row.size(); ++i) to[i] = float(r.row[i]) / 255.0f;
    }
    jpeg_finish_decompress(&r.info);
    return true;
}

struct Encoding {
    jpeg_error_mgr errors{};
    std::jmp_buf jump;
    jpeg_compress_struct info{};
    char error[JMSG_LENGTH_MAX] = "";
    const Image* image = nullptr;
    std::vector<int> index; ///< channels written
    bool quantised = false;
    std::vector<uint8_t> row;
    unsigned char* bytes = nullptr; ///< of the library, by malloc
    unsigned long size = 0;
};

void onEncodingError(j_common_ptr c) {
    Encoding& e = *static_cast<Encoding*>(c->client_data);
    c->err->format_message(c, e.error);
    std::longjmp(e.jump, 1);
}

constexpr int kQuality = 95;

bool encode(Encoding& e) {
    if (setjmp(e.jump)) return false;
    const Image& m = *e.image;
    jpeg_create_compress(&e.info);
    e.info.client_data = &e;
    jpeg_mem_dest(&e.info, &e.bytes, &e.size);
    e.info.image_width = JDIMENSION(m.width);
    e.info.image_height = JDIMENSION(m.height);
    e.info.input_components = int(e.index.size());
    e.info.in_color_space = e.index.size() == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(&e.info);
    jpeg_set_quality(&e.info, kQuality, TRUE);
    e.info.dct_method = JDCT_ISLOW;
    e.info.optimize_coding = TRUE;
    for (int c = 0; c < e.info.num_components; ++c) // colour as sharp as lightness
        e.info.comp_info[c].h_samp_factor = e.info.comp_info[c].v_samp_factor = 1;
    jpeg_start_compress(&e.info, TRUE);
    while (e.info.next_scanline < e.info.image_height) {
        const float* from = m.pixel(0, int(e.info.next_scanline));
        size_t at = 0;
        for (int x = 0; x < m.width; ++x, from += m.channels.size())
            for (size_t c = 0; c < e.index.size(); ++c) e.row[at++] = uint8_t(toCode(from[e.index[c]], 255, e.quantised));
        JSAMPROW row = e.row.data();
        jpeg_write_scanlines(&e.info, &row, 1);
    }
    jpeg_finish_compress(&e.info);
    return true;
}

} // namespace

static bool encodeJpeg(OutputFile& out, const Image& m, const WriteOptions& o, Diagnostics& diags, std::string& why) {
    Encoding e;
    e.image = &m;
    e.index = pictureChannels(m, false);
    e.quantised = o.quantised;
    e.row.resize(size_t(m.width) * e.index.size());
    sayLeftOut("JPEG", m, e.index, out.path(), o, diags);
    e.info.err = jpeg_std_error(&e.errors);
    e.errors.error_exit = onEncodingError;
    e.errors.output_message = onOutput;
    e.info.client_data = &e;
    bool ok = encode(e);
    jpeg_destroy_compress(&e.info);
    if (!ok) why = e.error;
    ok = ok && out.write(e.bytes, e.size);
    std::free(e.bytes);
    return ok;
}

static std::optional<Image> decodeJpeg(Bytes b, const DecodeContext& ctx) {
    JpegReader r;
    r.ctx = &ctx;
    r.info.err = jpeg_std_error(&r.errors);
    r.errors.error_exit = onError;
    r.errors.emit_message = onMessage;
    r.errors.output_message = onOutput;
    r.progress.progress_monitor = onProgress;
    r.info.client_data = &r;
    bool ok = false;
    try {
        ok = decode(r, b);
    } catch (...) {
        jpeg_destroy_decompress(&r.info);
        throw;
    }
    jpeg_destroy_decompress(&r.info);
    if (r.refused) return {};
    if (!ok) return ctx.refuse(r.error);
    if (r.warning[0]) ctx.warn(std::string(r.warning) + "; the readable part is used");
    return std::move(r.image);
}

PictureFormat jpegFormat() {
    static const WrittenFormat kWritten{
        .name = "JPEG",
        .extensions = {"jpg", "jpeg"},
        .floats = false,
        .bits = 8,
        .displays = {"jpeg", "jpg"},
        .doc = "JPEG. 8 bits, quality 95, colour as sharp as lightness, no alpha: r g b, or one channel. 0 to "
               "1 is written as 0 to 255 where "
               "Quantize has no codes of 8 bits."};
    return {kWritten.name, [](Bytes b) { return starts(b, {0xff, 0xd8, 0xff}); }, decodeJpeg, encodeJpeg, &kWritten};
}

} // namespace alpenglow::display
