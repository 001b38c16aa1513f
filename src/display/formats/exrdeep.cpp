// Deep OpenEXR pictures in scan lines or in tiles, as far as deep shadow maps need them: depths and opacities; colours are passed
// over.
#include "base/exact.h"
#include "base/limits.h"
#include "display/formats/exr.h"
#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineInputPart.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfDeepTiledInputPart.h>
#include <ImfPartType.h>
#include <algorithm>
#include <cmath>

namespace alpenglow::display {
namespace {

/// Names of the file's channels: depth, its end where a sample is a slab, and opacity of red, green and blue (all of them "A"
/// where it has but one).
const char* const kZ = "Z";
const char* const kZBack = "ZBack";
const char* const kColours[3] = {"RA", "GA", "BA"};
const char* const kAlpha = "A";
constexpr int kSlab = 8; ///< steps that a sample with an extent becomes

/// One or more lines: samples by channel, and the start of each pixel's samples.
class Line {
public:
    Line(int width, int left, size_t channels, int height = 1)
        : count(size_t(width) * size_t(height)), values(channels), left_(left), width_(width),
          pointers_(channels, std::vector<char*>(count.size())) {}
    /// Slices whose rows are all this one; or for several lines, starting at `top`.
    Imf::DeepFrameBuffer buffer(const std::vector<const char*>& names, std::optional<int> top = {}) {
        Imf::DeepFrameBuffer fb;
        const size_t row = top ? size_t(width_) : 0;
        const long before = left_ + (top ? long(*top) * width_ : 0);
        fb.insertSampleCountSlice(
            Imf::Slice(Imf::UINT, reinterpret_cast<char*>(count.data() - before), sizeof(unsigned), row * sizeof(unsigned)));
        for (size_t c = 0; c < names.size(); ++c)
            fb.insert(names[c], Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(pointers_[c].data() - before), sizeof(char*),
                                               row * sizeof(char*), sizeof(float)));
        return fb;
    }
    /// Allocates space for the samples in `count`.
    void point() {
        size_t all = 0;
        for (unsigned n : count) all += n;
        for (size_t c = 0; c < values.size(); ++c) {
            values[c].resize(all + 1);
            size_t at = 0;
            for (size_t x = 0; x < count.size(); ++x) {
                pointers_[c][x] = reinterpret_cast<char*>(values[c].data() + at);
                at += count[x];
            }
        }
    }
    std::vector<unsigned> count;            ///< samples of each pixel
    std::vector<std::vector<float>> values; ///< by channel, those of all pixels in order

private:
    long left_; ///< x of the first pixel
    int width_;
    std::vector<std::vector<char*>> pointers_;
};

struct Taken {
    float z, back, opacity[3];
};

/// Samples of a pixel as a staircase.
void addStairs(std::vector<Taken>& samples, std::vector<DeepStep>& out) {
    std::erase_if(samples, [](const Taken& t) { return !std::isfinite(t.z); });
    std::stable_sort(samples.begin(), samples.end(), [](const Taken& a, const Taken& b) { return a.z < b.z; });
    DeepStep s;
    for (const Taken& t : samples) {
        const bool slab = std::isfinite(t.back) && t.back > t.z;
        for (int k = 0; k < (slab ? kSlab : 1); ++k) {
            s.z = slab ? t.z + (t.back - t.z) * (float(k) + 0.5f) / kSlab : t.z;
            for (int c = 0; c < 3; ++c) {
                const float clear = 1 - std::clamp(t.opacity[c], 0.f, 1.f);
                if (!(clear < 1)) continue; // also NaN, which has no opacity
                s.transmittance[c] *= slab ? float(exact::pow(double(clear), 1.0 / kSlab)) : clear;
            }
            out.push_back(s);
        }
    }
    // Slabs may be nested: a late step is moved to its predecessor.
    for (size_t i = 1; i < out.size(); ++i)
        if (out[i].z < out[i - 1].z) out[i].z = out[i - 1].z;
}

/// Layout of a file.
struct Layout {
    std::vector<const char*> names;
    bool coloured, slabs;
    int left, top;
    size_t fileBytes;
};

/// Whether so many samples can be in the file: zip compresses at most by a factor of 1032.
bool fits(uint64_t samples, const Layout& l) {
    return samples <= limits::kDeepSteps && samples * 4 <= uint64_t(l.fileBytes) * 1100;
}
const char* const kTooMany = "it declares more samples than the file can hold";

/// Appends the pixels of a line from a sample on. Returns "" or an error.
std::string addPixels(const Line& line, const Layout& l, size_t from, int width, int y, size_t& at, Image& m, DeepSamples& deep) {
    std::vector<Taken> taken;
    std::vector<DeepStep> stairs;
    for (int x = 0; x < width; ++x) {
        deep.first.push_back(deep.steps.size());
        taken.clear();
        for (unsigned n = 0; n < line.count[from + size_t(x)]; ++n, ++at) {
            const auto value = [&](size_t c) { return line.values[c][at]; };
            taken.push_back({value(0),
                             l.slabs ? value(l.names.size() - 1) : 0,
                             {value(1), value(l.coloured ? 2 : 1), value(l.coloured ? 3 : 1)}});
        }
        stairs.clear();
        addStairs(taken, stairs);
        if (!stairs.empty()) *m.pixel(x, y) = stairs.front().z;
        if (deep.steps.size() + stairs.size() > limits::kDeepSteps)
            return "it has more than " + std::to_string(limits::kDeepSteps) + " samples";
        deep.steps.insert(deep.steps.end(), stairs.begin(), stairs.end());
    }
    return "";
}

std::string readLines(Imf::MultiPartInputFile& file, const Layout& l, Image& m, DeepSamples& deep) {
    Line line(m.width, l.left, l.names.size());
    Imf::DeepScanLineInputPart part(file, 0);
    part.setFrameBuffer(line.buffer(l.names));
    for (int y = 0; y < m.height; ++y) {
        part.readPixelSampleCounts(l.top + y);
        uint64_t all = 0;
        for (unsigned n : line.count) all += n;
        if (!fits(all, l)) return kTooMany;
        line.point();
        part.readPixels(l.top + y);
        size_t at = 0;
        if (std::string fault = addPixels(line, l, 0, m.width, y, at, m, deep); !fault.empty()) return fault;
    }
    return "";
}

/// The finest level, a row of tiles at a time.
std::string readTiles(Imf::MultiPartInputFile& file, const Layout& l, Image& m, DeepSamples& deep) {
    Imf::DeepTiledInputPart part(file, 0);
    const int high = int(std::min<unsigned>(part.tileYSize(), unsigned(m.height)));
    if (uint64_t(high) * uint64_t(m.width) > (uint64_t(l.fileBytes) + 4096) * 1100) return kTooMany; // including the counts
    for (int row = 0; row < part.numYTiles(0); ++row) {
        const int y0 = row * int(part.tileYSize()), lines = std::min(high, m.height - y0);
        Line band(m.width, l.left, l.names.size(), lines);
        part.setFrameBuffer(band.buffer(l.names, l.top + y0));
        part.readPixelSampleCounts(0, part.numXTiles(0) - 1, row, row);
        uint64_t all = 0;
        for (unsigned n : band.count) all += n;
        if (!fits(all, l)) return kTooMany;
        band.point();
        part.readTiles(0, part.numXTiles(0) - 1, row, row);
        size_t at = 0;
        for (int y = 0; y < lines; ++y)
            if (std::string fault = addPixels(band, l, size_t(y) * size_t(m.width), m.width, y0 + y, at, m, deep); !fault.empty())
                return fault;
    }
    return "";
}

} // namespace

std::optional<Image> decodeDeep(Imf::MultiPartInputFile& file, const DecodeContext& ctx) {
    const Imf::Header& h = file.header(0);
    const Imf::ChannelList& channels = h.channels();
    const auto has = [&](const char* name) { return channels.findChannel(name) != nullptr; };
    if (!has(kZ)) return ctx.refuse("it is a deep picture without the channel \"Z\"");
    const bool coloured = has(kColours[0]) && has(kColours[1]) && has(kColours[2]);
    if (!coloured && !has(kAlpha))
        return ctx.refuse("it is a deep picture without opacity (the channel \"A\", or \"RA\", \"GA\" and \"BA\")");
    const Imath::Box2i dw = h.dataWindow();
    Image m = makeImage(0, 0, {"z"});
    m.width = dw.max.x - dw.min.x + 1;
    m.height = dw.max.y - dw.min.y + 1;
    if (!ctx.sizeAllowed(uint64_t(m.width), uint64_t(m.height), 4)) return {};
    readAttributes(h, m);
    m.metadata["textureformat"] = "Shadow";
    m.data.assign(m.sampleCount(), 1e38f);
    std::vector<const char*> names{kZ};
    if (coloured) names.insert(names.end(), std::begin(kColours), std::end(kColours));
    else names.push_back(kAlpha);
    const bool slabs = has(kZBack);
    if (slabs) names.push_back(kZBack);
    auto deep = std::make_shared<DeepSamples>();
    deep->first.reserve(size_t(m.width) * size_t(m.height) + 1);
    const bool tiles = h.hasType() && h.type() == Imf::DEEPTILE;
    const std::string fault =
        (tiles ? readTiles : readLines)(file, Layout{names, coloured, slabs, dw.min.x, dw.min.y, ctx.fileBytes}, m, *deep);
    if (!fault.empty()) return ctx.refuse(fault, fault.find("more than") == std::string::npos ? Rie::BadFile : Rie::Limit);
    deep->first.push_back(deep->steps.size());
    m.deep = std::move(deep);
    return m;
}

bool encodeDeep(OutputFile& out, const Image& m, std::string& why) {
    const DeepSamples& deep = *m.deep;
    if (deep.first.size() != size_t(m.width) * size_t(m.height) + 1) return why = "its depths do not match its size", false;
    if (deep.first.back() > limits::kDeepSteps)
        return why = "it has more than " + std::to_string(limits::kDeepSteps) + " samples", false;
    if (deep.first.back() != deep.steps.size()) return why = "its depths do not match its size", false;
    try {
        Imath::Box2i dw({m.originX, m.originY}, {m.originX + m.width - 1, m.originY + m.height - 1}), full = dw;
        if (m.fullWidth > 0 && m.fullHeight > 0) full = {{0, 0}, {m.fullWidth - 1, m.fullHeight - 1}};
        Imf::Header h(full, dw, m.pixelAspect, {0, 0}, 1, Imf::INCREASING_Y, Imf::ZIPS_COMPRESSION);
        h.setType(Imf::DEEPSCANLINE);
        const std::vector<const char*> names{kZ, kColours[0], kColours[1], kColours[2], kAlpha};
        for (const char* n : names) h.channels().insert(n, Imf::Channel(Imf::FLOAT));
        writeAttributes(m, h);
        FileStream stream(out);
        Imf::DeepScanLineOutputFile file(stream, h, 0);
        Line line(m.width, dw.min.x, names.size());
        file.setFrameBuffer(line.buffer(names));
        for (int y = 0; y < m.height; ++y) {
            const size_t row = size_t(y) * size_t(m.width);
            for (int x = 0; x < m.width; ++x)
                line.count[size_t(x)] = unsigned(deep.first[row + size_t(x) + 1] - deep.first[row + size_t(x)]);
            line.point();
            size_t at = 0;
            for (int x = 0; x < m.width; ++x) {
                float left[3] = {1, 1, 1};
                for (size_t i = deep.first[row + size_t(x)]; i < deep.first[row + size_t(x) + 1]; ++i, ++at) {
                    const DeepStep& s = deep.steps[i];
                    float sum = 0;
                    line.values[0][at] = s.z;
                    for (size_t c = 0; c < 3; ++c) { // opacity of the sample relative to the incoming light
                        const float o = left[c] > 0 ? 1 - s.transmittance[c] / left[c] : 0;
                        line.values[c + 1][at] = o;
                        sum += o;
                        left[c] = s.transmittance[c];
                    }
                    line.values[4][at] = sum / 3;
                }
            }
            file.writePixels(1);
        }
        return true;
    } catch (const std::bad_alloc&) { throw; } catch (const std::exception& e) {
        why = e.what();
        return false;
    }
}

} // namespace alpenglow::display
