#include "display/drivers/picture.h"
#include "base/limits.h"
#include <algorithm>
#include <cstring>

namespace alpenglow::display {

bool PictureDriver::open(const DriverSetup& s, Diagnostics& diags) {
    setup_ = s;
    auto refuse = [&](Rie code, const std::string& why) {
        diags.report(Severity::Error, code, s.place, "display \"" + s.name + "\": " + why);
        return false;
    };
    if (s.width <= 0 || s.height <= 0 || s.channels.empty()) return refuse(Rie::Range, "it has no pixels");
    if (s.width > limits::kImageSide || s.height > limits::kImageSide || s.channels.size() > size_t(limits::kImageChannels) ||
        size_t(s.width) * size_t(s.height) * s.channels.size() > limits::kImageBytes / sizeof(float))
        return refuse(Rie::Limit, "it is too large");
    format_ = format(s, diags);
    try {
        image_ = makeImage(s.width, s.height, s.channels);
    } catch (const std::exception&) { return refuse(Rie::NoMem, "out of memory"); }
    image_.originX = s.originX;
    image_.originY = s.originY;
    if (s.fullWidth > 0 && s.fullHeight > 0 && (s.fullWidth != s.width || s.fullHeight != s.height || s.originX || s.originY)) {
        image_.fullWidth = s.fullWidth;
        image_.fullHeight = s.fullHeight;
    }
    image_.pixelAspect = s.pixelAspect;
    image_.metadata = s.metadata;
    image_.worldToCamera = s.worldToCamera;
    image_.worldToNDC = s.worldToNDC;
    image_.deep = s.deep;
    return true;
}

bool PictureDriver::rows(int y, int count, const float* data) {
    if (y < 0 || count < 0 || y > image_.height || count > image_.height - y) return false;
    if (count)
        std::memcpy(image_.pixel(0, y), data, sizeof(float) * size_t(count) * size_t(image_.width) * image_.channels.size());
    return true;
}

WriteOptions PictureDriver::chooseSamples(Diagnostics& diags) {
    WriteOptions o;
    o.format = format_;
    o.policy = setup_.policy;
    o.place = setup_.place;
    auto say = [&](Severity severity, const std::string& what) {
        Diagnostic d;
        d.severity = severity;
        d.place = setup_.place;
        d.message = "display \"" + setup_.name + "\": " + what;
        diags.reportOnce("display:" + setup_.name + ":" + what, d);
    };
    const WrittenFormat& w = written(format_);
    if (!w.codes) {
        o.compression = stringParam(setup_, "exrcompression", {"none", "rle", "zips", "zip", "piz"}, "zip", diags);
        o.sample =
            stringParam(setup_, "exrpixeltype", {"float", "half"}, "float", diags) == "half" ? Sample::Half : Sample::Float;
        if (setup_.quantizeAsked && !setup_.rgba.floating() && !data())
            say(Severity::Info, std::string(w.name) + " holds floating point; quantisation does not apply");
        return o;
    }
    if (w.bits == 8) { // without codes of 8 bits 0 to 1 fills them
        o.quantised = !setup_.rgba.floating() && !data() && setup_.rgba.min >= 0 && setup_.rgba.max <= 255;
        o.sample = Sample::UInt8;
        return o;
    }
    o.compression = stringParam(setup_, "compression", {"none", "lzw", "packbits", "zip", "deflate"}, "zip", diags);
    // Which quantisers are at work: z has its own, and a file has one kind of sample.
    bool hasZ = false, hasOther = false;
    for (const std::string& c : setup_.channels) (c == "z" ? hasZ : hasOther) = true;
    Quantization q = hasOther ? setup_.rgba : setup_.z;
    bool floats = q.floating() || data();
    if (hasOther && hasZ && setup_.z.floating() != q.floating()) {
        floats = true;
        if (w.floats) say(Severity::Info, "depth is floating point, so the whole file is");
    }
    float top = std::max(q.max, hasZ && hasOther && !setup_.z.floating() ? setup_.z.max : q.max);
    if (!floats && (q.min < 0 || top > 65535)) {
        say(Severity::Warning, "no integer format holds its range of codes; floating point is written");
        floats = true;
    }
    o.quantised = !floats;
    o.sample = floats ? Sample::Float : top > 255 ? Sample::UInt16 : Sample::UInt8;
    if (floats && !w.floats) {
        say(Severity::Info, std::string(w.name) + " has no floating point; 0 to 1 is written as 16 bits");
        o.sample = Sample::UInt16;
    }
    return o;
}

void PictureDriver::quantiseInto(Image& m) const {
    size_t n = m.channels.size();
    for (int y = 0; y < m.height; ++y)
        for (int x = 0; x < m.width; ++x) {
            float* p = m.pixel(x, y);
            for (size_t c = 0; c < n; ++c) {
                const Quantization& q = m.channels[c] == "z" ? setup_.z : setup_.rgba;
                float noise = q.dither != 0 ? ditherNoise(m.originX + x, m.originY + y, int(c)) : 0;
                p[c] = quantise(q, p[c], noise);
            }
        }
}

bool PictureDriver::close(Diagnostics& diags) {
    WriteOptions o = chooseSamples(diags);
    if (!o.quantised) return write(setup_.name, image_, o, diags);
    std::vector<float> floats = std::move(image_.data); // they stay, for a later close()
    Image codes = image_;
    image_.data = std::move(floats);
    codes.data = image_.data;
    quantiseInto(codes);
    return write(setup_.name, codes, o, diags);
}

namespace {
class FormatDriver final : public PictureDriver {
public:
    explicit FormatDriver(Format f) : its_(f) {}

private:
    Format format(const DriverSetup&, Diagnostics&) override { return its_; }
    Format its_;
};
} // namespace

DriverDescriptor formatDriver(Format f) {
    return {written(f).displays, written(f).doc, [f] { return std::make_unique<FormatDriver>(f); }, true, f};
}

std::string stringParam(const DriverSetup& s, const std::string& name, const std::vector<std::string>& allowed,
                        const std::string& fallback, Diagnostics& diags) {
    const scene::Param* p = scene::find(s.params, name);
    if (!p) return fallback;
    if (p->strings.size() == 1 && std::find(allowed.begin(), allowed.end(), p->strings[0]) != allowed.end()) return p->strings[0];
    std::string list;
    for (auto& a : allowed) list += (list.empty() ? "" : " ") + a;
    diags.report(Severity::Warning, Rie::Range, p->place.file.empty() ? s.place : p->place,
                 "display parameter \"" + name + "\" is one of: " + list + "; \"" + fallback + "\" is used",
                 p->strings.empty() ? "" : nearestName(p->strings[0], allowed));
    return fallback;
}

} // namespace alpenglow::display
