#include "display/imageio.h"
#include "base/limits.h"
#include "display/foreign.h"
#include "display/formats/codecs.h"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

namespace alpenglow::display {

std::nullopt_t DecodeContext::refuse(const std::string& why, Rie code) const {
    diags.report(Severity::Error, code, options.place, "cannot read \"" + name + "\": " + why);
    return std::nullopt;
}

void DecodeContext::warn(const std::string& why) const {
    diags.report(Severity::Warning, Rie::BadFile, options.place, "\"" + name + "\": " + why);
}

bool DecodeContext::sizeAllowed(uint64_t width, uint64_t height, uint64_t channels) const {
    if (width == 0 || height == 0 || channels == 0) {
        refuse("it has no pixels");
        return false;
    }
    if (width > uint64_t(limits::kImageSide) || height > uint64_t(limits::kImageSide)) {
        refuse("a side is longer than " + std::to_string(limits::kImageSide) + " pixels", Rie::Limit);
        return false;
    }
    if (channels > uint64_t(limits::kImageChannels)) {
        refuse("it has more than " + std::to_string(limits::kImageChannels) + " channels", Rie::Limit);
        return false;
    }
    uint64_t bytes = width * height * channels * sizeof(float);
    if (bytes > limits::kImageBytes) {
        refuse("its pixels would take more than " + std::to_string(limits::kImageBytes >> 30) + " GiB", Rie::Limit);
        return false;
    }
    if (bytes > limits::kImageSmallBytes && bytes / limits::kImageExpansion > fileBytes) {
        refuse("it is too short for its stated size", Rie::BadFile);
        return false;
    }
    return true;
}

std::vector<int> pictureChannels(const Image& m, bool alpha) {
    int r = m.channel("r"), g = m.channel("g"), b = m.channel("b"), a = m.channel("a");
    std::vector<int> index;
    if (r >= 0 && g >= 0 && b >= 0) index = {r, g, b};
    else if (m.channelCount() == 3 || (m.channelCount() == 4 && a == 3)) index = {0, 1, 2};
    else if (m.channelCount() == 1 || (m.channelCount() == 2 && a == 1)) index = {0};
    else index = m.channelCount() >= 3 ? std::vector<int>{0, 1, 2} : std::vector<int>{0};
    if (alpha && a >= 0 && std::find(index.begin(), index.end(), a) == index.end()) index.push_back(a);
    return index;
}

void sayLeftOut(const char* format, const Image& m, const std::vector<int>& written, const std::string& path,
                const WriteOptions& o, Diagnostics& diags) {
    std::string left;
    for (int c = 0; c < m.channelCount(); ++c)
        if (std::find(written.begin(), written.end(), c) == written.end())
            left += (left.empty() ? "" : ", ") + m.channels[size_t(c)];
    if (left.empty()) return;
    diags.report(left == "a" ? Severity::Info : Severity::Warning, Rie::Incapable, o.place,
                 std::string(format) + " holds a single picture only" + (left == "a" ? " without alpha" : "") +
                     "; left out of \"" + path + "\": " + left,
                 left == "a" ? "PNG, TIFF and OpenEXR hold alpha" : "OpenEXR holds any channels");
}

unsigned toCode(float value, unsigned maximum, bool quantised) {
    float v = quantised ? value : value * float(maximum);
    if (!(v > 0)) return 0; // also NaN
    if (v >= float(maximum)) return maximum;
    return unsigned(std::floor(v + 0.5f));
}

// Described in the files of formats/.
PictureFormat exrFormat(), tiffFormat(), pngFormat(), jpegFormat();
PictureFormat zfileFormat(), radianceFormat(), pixarFormat(), ktxFormat(), targaFormat();

/// All formats: first those of enum Format, in its order. Targa is last, because it has no magic number.
static std::span<const PictureFormat> formats() {
    static const PictureFormat kList[] = {exrFormat(),      tiffFormat(),  pngFormat(), jpegFormat(), zfileFormat(),
                                          radianceFormat(), pixarFormat(), ktxFormat(), targaFormat()};
    return kList;
}

const WrittenFormat& written(Format f) { return *formats()[size_t(f)].written; }

std::span<const Format> writtenFormats() {
    static const std::vector<Format> kList = [] {
        std::vector<Format> list;
        while (formats()[list.size()].written) list.push_back(Format(list.size()));
        return list;
    }();
    return kList;
}

std::string readFormats() {
    std::string all;
    for (const PictureFormat& f : formats()) all += (all.empty() ? "" : ", ") + std::string(f.name);
    return all;
}

static std::optional<Image> decodeAs(Bytes b, const DecodeContext& ctx) {
    if (b.empty()) return ctx.refuse("the file is empty");
    try {
        for (const PictureFormat& f : formats())
            if (f.recognise(b)) return f.decode(b, ctx);
        if (ctx.file) return readForeign(pictureModule(), ctx.name, ctx);
    } catch (const std::bad_alloc&) { return ctx.refuse("out of memory", Rie::NoMem); } catch (const std::length_error&) {
        return ctx.refuse("out of memory", Rie::NoMem);
    }
    return ctx.refuse("it is not a picture in a known format (" + readFormats() + ")");
}

std::optional<Image> decodeImage(std::span<const uint8_t> bytes, const std::string& name, Diagnostics& diags,
                                 const ReadOptions& options) {
    return decodeAs(bytes, {name, diags, options, bytes.size()});
}

std::optional<Image> readImage(const std::string& path, Diagnostics& diags, const ReadOptions& options) {
    auto bytes = readWholeFile(path, limits::kImageBytes, diags, options.place);
    if (!bytes) return {};
    return decodeAs(*bytes, {path, diags, options, bytes->size(), true});
}

bool writeImage(const std::string& path, const Image& image, const WriteOptions& options, Diagnostics& diags) {
    auto refuse = [&](Rie code, const std::string& why) {
        diags.report(Severity::Error, code, options.place, "cannot write \"" + path + "\": " + why);
        return false;
    };
    if (image.width <= 0 || image.height <= 0 || image.channels.empty()) return refuse(Rie::Range, "it has no pixels");
    if (image.width > limits::kImageSide || image.height > limits::kImageSide || image.channelCount() > limits::kImageChannels ||
        image.sampleCount() > limits::kImageBytes / sizeof(float))
        return refuse(Rie::Limit, "it is too large");
    if (image.data.size() != image.sampleCount()) return refuse(Rie::Consistency, "its pixels do not match its size");
    if (std::set<std::string>(image.channels.begin(), image.channels.end()).size() != image.channels.size())
        return refuse(Rie::Consistency, "two channels have the same name");
    auto file = OutputFile::open(path, options.policy, diags, options.place);
    if (!file) return false;
    std::string why;
    bool ok = false;
    try {
        ok = formats()[size_t(options.format)].encode(*file, image, options, diags, why);
    } catch (const std::bad_alloc&) { return refuse(Rie::NoMem, "out of memory"); }
    if (!ok && file->ok()) return refuse(Rie::System, why.empty() ? "the encoder failed" : why);
    return file->commit(diags) && ok;
}

std::optional<Format> formatOfExtension(const std::string& path) {
    size_t dot = path.find_last_of('.');
    if (dot == std::string::npos) return {};
    std::string e = path.substr(dot + 1);
    for (char& c : e) c = char(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    for (Format f : writtenFormats())
        for (const std::string& known : written(f).extensions)
            if (e == known) return f;
    return {};
}

std::string pictureExtensions() {
    std::string all;
    for (Format f : writtenFormats())
        for (const std::string& e : written(f).extensions) all += (all.empty() ? "." : " .") + e;
    return all;
}

} // namespace alpenglow::display
