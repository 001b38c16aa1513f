// TIFF by libtiff, with handlers and memory limits for each file rather than global ones. Reads 8, 16, 32 bit integers, 16, 32,
// 64 bit floats, contiguous or separate planes, strips or tiles, any compression of the library; other kinds (palettes, YCbCr,
// CMYK, 1 to 4 bits) through its RGBA conversion. Writes 8, 16 bit and float, contiguous strips.
#include "base/limits.h"
#include "display/formats/codecs.h"
#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstring>
#include <half.h>
#include <memory>
#include <tiffio.h>

namespace alpenglow::display {
namespace {

struct MemoryClient {
    Bytes bytes;
    uint64_t at = 0;
};

/// Messages of the library for one file; stores the first.
struct Messages {
    std::string first;
    static int error(TIFF*, void* self, const char*, const char* format, va_list args) {
        auto& m = *static_cast<Messages*>(self);
        if (m.first.empty()) {
            char text[512];
            std::vsnprintf(text, sizeof text, format, args);
            m.first = text;
        }
        return 1;
    }
    static int warning(TIFF*, void*, const char*, const char*, va_list) { return 1; } // unknown tags and such: no loss of pixels
};

struct OptionsDeleter {
    void operator()(TIFFOpenOptions* o) const { TIFFOpenOptionsFree(o); }
};
struct TiffDeleter {
    void operator()(TIFF* t) const { TIFFClose(t); }
};
using TiffHandle = std::unique_ptr<TIFF, TiffDeleter>;

std::unique_ptr<TIFFOpenOptions, OptionsDeleter> openOptions(Messages& messages) {
    std::unique_ptr<TIFFOpenOptions, OptionsDeleter> o(TIFFOpenOptionsAlloc());
    if (!o) return o;
    TIFFOpenOptionsSetErrorHandlerExtR(o.get(), Messages::error, &messages);
    TIFFOpenOptionsSetWarningHandlerExtR(o.get(), Messages::warning, &messages);
    TIFFOpenOptionsSetMaxSingleMemAlloc(o.get(), tmsize_t(2) << 30);
    return o;
}

tmsize_t memoryRead(thandle_t h, void* to, tmsize_t n) {
    auto& c = *static_cast<MemoryClient*>(h);
    if (n <= 0 || c.at >= c.bytes.size()) return 0;
    size_t k = std::min<size_t>(size_t(n), c.bytes.size() - c.at);
    std::memcpy(to, c.bytes.data() + c.at, k);
    c.at += k;
    return tmsize_t(k);
}
tmsize_t noWrite(thandle_t, void*, tmsize_t) { return 0; }
toff_t memorySeek(thandle_t h, toff_t off, int whence) {
    auto& c = *static_cast<MemoryClient*>(h);
    c.at = whence == SEEK_SET ? off : whence == SEEK_CUR ? c.at + off : c.bytes.size() + off;
    return c.at;
}
int noClose(thandle_t) { return 0; }
toff_t memorySize(thandle_t h) { return static_cast<MemoryClient*>(h)->bytes.size(); }
int memoryMap(thandle_t h, void** base, toff_t* size) {
    auto& c = *static_cast<MemoryClient*>(h);
    *base = const_cast<uint8_t*>(c.bytes.data()); // libtiff only reads a mapped file
    *size = c.bytes.size();
    return 1;
}
void memoryUnmap(thandle_t, void*, toff_t) {}

tmsize_t fileRead(thandle_t h, void* to, tmsize_t n) { return tmsize_t(static_cast<OutputFile*>(h)->read(to, size_t(n))); }
tmsize_t fileWrite(thandle_t h, void* from, tmsize_t n) { return static_cast<OutputFile*>(h)->write(from, size_t(n)) ? n : -1; }
toff_t fileSeek(thandle_t h, toff_t off, int whence) {
    auto& f = *static_cast<OutputFile*>(h);
    uint64_t to = whence == SEEK_SET ? off : whence == SEEK_CUR ? f.tell() + off : f.size() + off;
    return f.seek(to) ? to : toff_t(-1);
}
toff_t fileSize(thandle_t h) { return static_cast<OutputFile*>(h)->size(); }

struct Layout {
    uint32_t width = 0, height = 0;
    uint16_t bits = 1, samples = 1, format = SAMPLEFORMAT_UINT, planar = PLANARCONFIG_CONTIG,
             photometric = PHOTOMETRIC_MINISBLACK;
    uint16_t orientation = ORIENTATION_TOPLEFT;
    bool direct() const {
        bool photo =
            photometric == PHOTOMETRIC_MINISBLACK || photometric == PHOTOMETRIC_MINISWHITE || photometric == PHOTOMETRIC_RGB;
        bool integer = (format == SAMPLEFORMAT_UINT || format == SAMPLEFORMAT_INT || format == SAMPLEFORMAT_VOID) &&
                       (bits == 8 || bits == 16 || bits == 32);
        bool real = format == SAMPLEFORMAT_IEEEFP && (bits == 16 || bits == 32 || bits == 64);
        return photo && (integer || real);
    }
};

Layout layoutOf(TIFF* t) {
    Layout l;
    TIFFGetField(t, TIFFTAG_IMAGEWIDTH, &l.width);
    TIFFGetField(t, TIFFTAG_IMAGELENGTH, &l.height);
    TIFFGetFieldDefaulted(t, TIFFTAG_BITSPERSAMPLE, &l.bits);
    TIFFGetFieldDefaulted(t, TIFFTAG_SAMPLESPERPIXEL, &l.samples);
    TIFFGetFieldDefaulted(t, TIFFTAG_SAMPLEFORMAT, &l.format);
    TIFFGetFieldDefaulted(t, TIFFTAG_PLANARCONFIG, &l.planar);
    TIFFGetFieldDefaulted(t, TIFFTAG_ORIENTATION, &l.orientation);
    if (!TIFFGetField(t, TIFFTAG_PHOTOMETRIC, &l.photometric))
        l.photometric = l.samples >= 3 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK;
    return l;
}

template <class T> T load(const uint8_t* p) {
    T v;
    std::memcpy(&v, p, sizeof v);
    return v;
}

/// `count` samples at `from` to floats spaced `stride` apart; integers scaled so that the largest code is 1.
void convert(const uint8_t* from, size_t count, const Layout& l, float* to, size_t stride) {
    bool sign = l.format == SAMPLEFORMAT_INT;
    if (l.format == SAMPLEFORMAT_IEEEFP) {
        for (size_t i = 0; i < count; ++i, to += stride) {
            if (l.bits == 16) {
                Imath::half h;
                h.setBits(load<uint16_t>(from + 2 * i));
                *to = h;
            } else if (l.bits == 32) *to = load<float>(from + 4 * i);
            else *to = float(load<double>(from + 8 * i));
        }
    } else if (l.bits == 8) {
        for (size_t i = 0; i < count; ++i, to += stride) *to = sign ? float(int8_t(from[i])) / 127.0f : float(from[i]) / 255.0f;
    } else if (l.bits == 16) {
        for (size_t i = 0; i < count; ++i, to += stride)
            *to = sign ? float(load<int16_t>(from + 2 * i)) / 32767.0f : float(load<uint16_t>(from + 2 * i)) / 65535.0f;
    } else {
        for (size_t i = 0; i < count; ++i, to += stride)
            *to = float(sign ? load<int32_t>(from + 4 * i) / 2147483647.0 : load<uint32_t>(from + 4 * i) / 4294967295.0);
    }
}

/// Reads the pixels of the current directory into m.data, which has the right size. Returns false if unreadable.
bool readDirect(TIFF* t, const Layout& l, Image& m) {
    size_t n = l.samples, unit = l.bits / 8;
    bool separate = l.planar == PLANARCONFIG_SEPARATE && n > 1;
    size_t perPixel = separate ? 1 : n;
    if (!TIFFIsTiled(t)) {
        tmsize_t need = TIFFScanlineSize(t);
        if (need <= 0 || size_t(need) < size_t(l.width) * perPixel * unit) return false;
        std::vector<uint8_t> row((size_t(need)));
        for (size_t plane = 0; plane < (separate ? n : 1); ++plane)
            for (uint32_t y = 0; y < l.height; ++y) {
                if (TIFFReadScanline(t, row.data(), y, uint16_t(plane)) < 0) return false;
                if (separate) convert(row.data(), l.width, l, m.pixel(0, int(y)) + plane, n);
                else convert(row.data(), size_t(l.width) * n, l, m.pixel(0, int(y)), 1);
            }
        return true;
    }
    uint32_t tw = 0, th = 0;
    TIFFGetField(t, TIFFTAG_TILEWIDTH, &tw);
    TIFFGetField(t, TIFFTAG_TILELENGTH, &th);
    tmsize_t need = TIFFTileSize(t);
    if (!tw || !th || tw > uint32_t(limits::kImageSide) || th > uint32_t(limits::kImageSide) || need <= 0 ||
        size_t(need) > (size_t(1) << 30) || size_t(need) < size_t(tw) * th * perPixel * unit)
        return false;
    std::vector<uint8_t> tile((size_t(need)));
    for (size_t plane = 0; plane < (separate ? n : 1); ++plane)
        for (uint32_t y = 0; y < l.height; y += th)
            for (uint32_t x = 0; x < l.width; x += tw) {
                if (TIFFReadTile(t, tile.data(), x, y, 0, uint16_t(plane)) < 0) return false;
                uint32_t w = std::min(tw, l.width - x), h = std::min(th, l.height - y);
                for (uint32_t r = 0; r < h; ++r) {
                    const uint8_t* from = tile.data() + size_t(r) * tw * perPixel * unit;
                    if (separate) convert(from, w, l, m.pixel(int(x), int(y + r)) + plane, n);
                    else convert(from, size_t(w) * n, l, m.pixel(int(x), int(y + r)), 1);
                }
            }
    return true;
}

bool readConverted(TIFF* t, const Layout& l, Image& m) {
    std::vector<uint32_t> raster(size_t(l.width) * l.height);
    if (!TIFFReadRGBAImageOriented(t, l.width, l.height, raster.data(), ORIENTATION_TOPLEFT, 1)) return false;
    size_t n = m.channels.size();
    for (size_t i = 0; i < raster.size(); ++i)
        for (size_t c = 0; c < n; ++c) m.data[i * n + c] = float(raster[i] >> (8 * c) & 255) / 255.0f;
    return true;
}

void flip(Image& m, bool horizontally, bool vertically) {
    size_t n = m.channels.size(), row = n * size_t(m.width);
    if (vertically)
        for (int y = 0; y < m.height / 2; ++y) std::swap_ranges(m.pixel(0, y), m.pixel(0, y) + row, m.pixel(0, m.height - 1 - y));
    if (horizontally)
        for (int y = 0; y < m.height; ++y)
            for (int x = 0; x < m.width / 2; ++x) std::swap_ranges(m.pixel(x, y), m.pixel(x, y) + n, m.pixel(m.width - 1 - x, y));
}

const char* channelsKey = "channels=";

/// Names written by encodeTiff into the description, when they fit.
std::optional<std::vector<std::string>> namesIn(const std::string& description, size_t count) {
    if (description.rfind(channelsKey, 0) != 0) return {};
    std::vector<std::string> names{""};
    for (char c : description.substr(std::strlen(channelsKey))) {
        if (c == ',') names.push_back("");
        else names.back() += c;
    }
    if (names.size() != count) return {};
    return names;
}

/// Reads the current directory; returns nothing after an error, which is reported.
std::optional<Image> readDirectory(TIFF* t, const DecodeContext& ctx, const Messages& messages) {
    Layout l = layoutOf(t);
    if (!ctx.sizeAllowed(l.width, l.height, l.direct() ? l.samples : 4)) return {};
    Image m;
    m.width = int(l.width);
    m.height = int(l.height);
    m.bits = l.bits;
    m.floating = l.format == SAMPLEFORMAT_IEEEFP;
    auto text = [&](uint32_t tag) -> std::string {
        const char* s = nullptr;
        return TIFFGetField(t, tag, &s) && s ? s : "";
    };
    std::string description = text(TIFFTAG_IMAGEDESCRIPTION);
    bool ok;
    if (l.direct()) {
        m.channels = namesIn(description, l.samples).value_or(defaultChannels(l.samples));
        if (l.samples == 4 && l.photometric != PHOTOMETRIC_RGB) m.channels = namesIn(description, 4).value_or(m.channels);
        m.data.assign(m.sampleCount(), 0.0f);
        ok = readDirect(t, l, m);
        if (ok && l.photometric == PHOTOMETRIC_MINISWHITE)
            for (float& v : m.data) v = 1 - v;
        if (l.orientation >= ORIENTATION_LEFTTOP && l.orientation <= ORIENTATION_LEFTBOT)
            ctx.warn("its orientation (turned by 90 degrees) is ignored");
        flip(m, l.orientation == ORIENTATION_TOPRIGHT || l.orientation == ORIENTATION_BOTRIGHT,
             l.orientation == ORIENTATION_BOTRIGHT || l.orientation == ORIENTATION_BOTLEFT);
    } else {
        char why[1024] = "";
        if (!TIFFRGBAImageOK(t, why)) return ctx.refuse(why, Rie::Unimplement);
        bool grey = l.samples == 1 && (l.photometric == PHOTOMETRIC_MINISBLACK || l.photometric == PHOTOMETRIC_MINISWHITE);
        uint16_t extra = 0, *kinds = nullptr;
        TIFFGetField(t, TIFFTAG_EXTRASAMPLES, &extra, &kinds);
        m.channels = defaultChannels(grey ? 1 : extra ? 4 : 3);
        m.bits = 8;
        m.floating = false;
        m.data.assign(m.sampleCount(), 0.0f);
        ok = readConverted(t, l, m);
    }
    if (!ok) return ctx.refuse(messages.first.empty() ? "it is truncated or damaged" : messages.first);
    if (std::string s = text(TIFFTAG_SOFTWARE); !s.empty()) m.metadata["Software"] = s;
    if (!description.empty() && description.rfind(channelsKey, 0) != 0) m.metadata["ImageDescription"] = description;
    if (std::string s = text(TIFFTAG_PIXAR_WRAPMODES); !s.empty()) m.metadata["wrapmodes"] = s;
    if (std::string s = text(TIFFTAG_PIXAR_TEXTUREFORMAT); !s.empty()) m.metadata["textureformat"] = s;
    uint32_t full = 0, fullH = 0;
    if (TIFFGetField(t, TIFFTAG_PIXAR_IMAGEFULLWIDTH, &full) && TIFFGetField(t, TIFFTAG_PIXAR_IMAGEFULLLENGTH, &fullH) &&
        full <= uint32_t(limits::kImageSide) && fullH <= uint32_t(limits::kImageSide)) {
        m.fullWidth = int(full);
        m.fullHeight = int(fullH);
        float x = 0, y = 0, rx = 1, ry = 1;
        TIFFGetField(t, TIFFTAG_XPOSITION, &x);
        TIFFGetField(t, TIFFTAG_YPOSITION, &y);
        TIFFGetField(t, TIFFTAG_XRESOLUTION, &rx);
        TIFFGetField(t, TIFFTAG_YRESOLUTION, &ry);
        auto place = [](float v) { return v >= 0 && v < 1e6f ? int(std::lround(v)) : 0; };
        m.originX = place(x * rx);
        m.originY = place(y * ry);
    }
    auto matrix = [&](uint32_t tag, std::optional<Matrix>& to) {
        const float* f = nullptr;
        if (!TIFFGetField(t, tag, &f) || !f) return;
        to.emplace();
        for (int i = 0; i < 16; ++i) to->m[i / 4][i % 4] = f[i];
    };
    matrix(TIFFTAG_PIXAR_MATRIX_WORLDTOSCREEN, m.worldToNDC);
    if (m.worldToNDC) m.worldToNDC = *m.worldToNDC * screenToNDC();
    matrix(TIFFTAG_PIXAR_MATRIX_WORLDTOCAMERA, m.worldToCamera);
    return m;
}

} // namespace

static std::optional<Image> decodeTiff(Bytes b, const DecodeContext& ctx) {
    Messages messages;
    auto options = openOptions(messages);
    MemoryClient client{b};
    TiffHandle t(TIFFClientOpenExt(ctx.name.c_str(), "r", &client, memoryRead, noWrite, memorySeek, noClose, memorySize,
                                   memoryMap, memoryUnmap, options.get()));
    if (!t) return ctx.refuse(messages.first.empty() ? "it is damaged" : messages.first);
    auto m = readDirectory(t.get(), ctx, messages);
    if (!m || !ctx.options.levels) return m;
    // Textures of the time keep their levels as further directories, each half the size.
    int w = m->width, h = m->height;
    for (int l = 0; l < 32 && (w > 1 || h > 1) && TIFFReadDirectory(t.get()); ++l) {
        Layout next = layoutOf(t.get());
        w = std::max(1, w / 2);
        h = std::max(1, h / 2);
        if (next.width != uint32_t(w) || next.height != uint32_t(h)) break;
        auto level = readDirectory(t.get(), ctx, messages);
        if (!level) return {};
        if (level->channels.size() != m->channels.size()) break;
        m->levels.push_back(std::move(*level));
    }
    return m;
}

namespace {

/// Whether the first three belong together: r g b, Cs.r Cs.g Cs.b, N.x N.y N.z. Viewers show those as colours, others as greys.
bool beginWithATriple(const std::vector<std::string>& c) {
    if (c.size() < 3) return false;
    for (const std::string_view letters : {"rgb", "xyz"}) {
        bool all = true;
        for (size_t k = 0; k < 3; ++k)
            all &= !c[k].empty() && c[k].back() == letters[k] && c[k].compare(0, c[k].size() - 1, c[0], 0, c[0].size() - 1) == 0;
        if (all && (c[0].size() > 1 ? c[0][c[0].size() - 2] == '.' : letters == "rgb")) return true;
    }
    return false;
}

void setCompression(TIFF* f, const std::string& name, unsigned bits) {
    // Of 1 to 9: a third of the time of the usual 6 for 2 to 11 % more bytes. Small frames of animations took 5 % of theirs here.
    constexpr int kDeflate = 4;
    if (name == "none") return;
    const int kind = name == "lzw" ? COMPRESSION_LZW : name == "packbits" ? COMPRESSION_PACKBITS : COMPRESSION_ADOBE_DEFLATE;
    TIFFSetField(f, TIFFTAG_COMPRESSION, kind);
    if (kind == COMPRESSION_ADOBE_DEFLATE) TIFFSetField(f, TIFFTAG_ZIPQUALITY, kDeflate);
    if (kind != COMPRESSION_PACKBITS)
        TIFFSetField(f, TIFFTAG_PREDICTOR, bits == 32 ? PREDICTOR_FLOATINGPOINT : PREDICTOR_HORIZONTAL);
}

/// How the samples are stored.
void setForm(TIFF* f, const Image& m, const WriteOptions& o, unsigned bits) {
    const size_t n = m.channels.size(), rowBytes = n * size_t(m.width) * bits / 8;
    bool rgb = beginWithATriple(m.channels);
    TIFFSetField(f, TIFFTAG_IMAGEWIDTH, uint32_t(m.width));
    TIFFSetField(f, TIFFTAG_IMAGELENGTH, uint32_t(m.height));
    TIFFSetField(f, TIFFTAG_BITSPERSAMPLE, int(bits));
    TIFFSetField(f, TIFFTAG_SAMPLESPERPIXEL, int(n));
    TIFFSetField(f, TIFFTAG_SAMPLEFORMAT, bits == 32 ? SAMPLEFORMAT_IEEEFP : SAMPLEFORMAT_UINT);
    TIFFSetField(f, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(f, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    TIFFSetField(f, TIFFTAG_PHOTOMETRIC, rgb ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK);
    std::vector<uint16_t> extra;
    for (size_t c = rgb ? 3 : 1; c < n; ++c)
        extra.push_back(m.channels[c] == "a" ? EXTRASAMPLE_ASSOCALPHA : EXTRASAMPLE_UNSPECIFIED);
    if (!extra.empty()) TIFFSetField(f, TIFFTAG_EXTRASAMPLES, int(extra.size()), extra.data());
    setCompression(f, o.compression, bits);
    TIFFSetField(f, TIFFTAG_ROWSPERSTRIP, uint32_t(std::max<size_t>(1, (size_t(64) << 10) / std::max<size_t>(1, rowBytes))));
}

/// What is known of the picture besides: channels, texts, its place in a larger one, the camera.
void setMetadata(TIFF* f, const Image& m) {
    const size_t n = m.channels.size();
    auto text = [&](const char* key) {
        auto i = m.metadata.find(key);
        return i == m.metadata.end() ? "" : i->second.c_str();
    };
    if (m.channels != defaultChannels(int(n))) {
        std::string names = channelsKey;
        for (size_t c = 0; c < n; ++c) names += (c ? "," : "") + m.channels[c];
        TIFFSetField(f, TIFFTAG_IMAGEDESCRIPTION, names.c_str());
    } else if (*text("ImageDescription")) TIFFSetField(f, TIFFTAG_IMAGEDESCRIPTION, text("ImageDescription"));
    if (*text("Software")) TIFFSetField(f, TIFFTAG_SOFTWARE, text("Software"));
    if (*text("wrapmodes")) TIFFSetField(f, TIFFTAG_PIXAR_WRAPMODES, text("wrapmodes"));
    if (*text("textureformat")) TIFFSetField(f, TIFFTAG_PIXAR_TEXTUREFORMAT, text("textureformat"));
    if (m.fullWidth > 0 && m.fullHeight > 0) {
        TIFFSetField(f, TIFFTAG_PIXAR_IMAGEFULLWIDTH, uint32_t(m.fullWidth));
        TIFFSetField(f, TIFFTAG_PIXAR_IMAGEFULLLENGTH, uint32_t(m.fullHeight));
        TIFFSetField(f, TIFFTAG_RESOLUTIONUNIT, RESUNIT_NONE);
        TIFFSetField(f, TIFFTAG_XRESOLUTION, 1.0);
        TIFFSetField(f, TIFFTAG_YRESOLUTION, 1.0);
        if (m.originX > 0) TIFFSetField(f, TIFFTAG_XPOSITION, double(m.originX)); // the tag has no sign
        if (m.originY > 0) TIFFSetField(f, TIFFTAG_YPOSITION, double(m.originY));
    }
    auto matrix = [&](uint32_t tag, const std::optional<Matrix>& from) {
        float v[16];
        if (!from) return;
        for (int i = 0; i < 16; ++i) v[i] = float(from->m[i / 4][i % 4]);
        TIFFSetField(f, tag, v);
    };
    std::optional<Matrix> screen;
    if (m.worldToNDC) screen = *m.worldToNDC * inverse(screenToNDC());
    matrix(TIFFTAG_PIXAR_MATRIX_WORLDTOSCREEN, screen);
    matrix(TIFFTAG_PIXAR_MATRIX_WORLDTOCAMERA, m.worldToCamera);
}

/// False after an error, which the library has reported.
bool writeRows(TIFF* f, const Image& m, const WriteOptions& o, unsigned bits) {
    const size_t n = m.channels.size();
    std::vector<uint8_t> row(n * size_t(m.width) * bits / 8);
    bool ok = true;
    for (int y = 0; y < m.height && ok; ++y) {
        const float* from = m.pixel(0, y);
        for (size_t i = 0; i < n * size_t(m.width); ++i) {
            if (bits == 8) row[i] = uint8_t(toCode(from[i], 255, o.quantised));
            else if (bits == 16) {
                uint16_t v = uint16_t(toCode(from[i], 65535, o.quantised));
                std::memcpy(&row[2 * i], &v, 2);
            } else std::memcpy(&row[4 * i], &from[i], 4);
        }
        ok = TIFFWriteScanline(f, row.data(), uint32_t(y), 0) >= 0;
    }
    return ok;
}

} // namespace

static bool encodeTiff(OutputFile& out, const Image& m, const WriteOptions& o, Diagnostics&, std::string& why) {
    Messages messages;
    auto options = openOptions(messages);
    unsigned bits = o.sample == Sample::UInt8 ? 8 : o.sample == Sample::UInt16 ? 16 : 32;
    size_t n = m.channels.size(), rowBytes = n * size_t(m.width) * bits / 8;
    bool big = rowBytes * size_t(m.height) > (size_t(3) << 30);
    TiffHandle t(TIFFClientOpenExt(out.path().c_str(), big ? "w8" : "w", &out, fileRead, fileWrite, fileSeek, noClose, fileSize,
                                   nullptr, nullptr, options.get()));
    if (!t) {
        why = messages.first;
        return false;
    }
    TIFF* f = t.get();
    setForm(f, m, o, bits);
    setMetadata(f, m);
    bool ok = writeRows(f, m, o, bits);
    ok = ok && TIFFWriteDirectory(f);
    t.reset();
    if (!ok || !messages.first.empty()) {
        why = messages.first;
        return false;
    }
    return true;
}

PictureFormat tiffFormat() {
    static const WrittenFormat kWritten{.name = "TIFF",
                                        .extensions = {"tif", "tiff"},
                                        .displays = {"tiff", "tif"},
                                        .doc = "TIFF. 8 bits when Quantize's codes end at 255 or below, 16 bits to 65535, floats "
                                               "when it is off (one = 0). Parameter: "
                                               "\"string compression\" none, lzw, packbits, zip (default)."};
    return {kWritten.name,
            [](Bytes b) {
                return starts(b, {'I', 'I', 42, 0}) || starts(b, {'M', 'M', 0, 42}) || starts(b, {'I', 'I', 43, 0}) ||
                       starts(b, {'M', 'M', 0, 43});
            },
            decodeTiff, encodeTiff, &kWritten};
}

} // namespace alpenglow::display
