// Writing Ptex files.
#include "base/file.h"
#include "ptex/limits.h"
#include "ptex/numbers.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::ptex {

namespace {

constexpr size_t kTileBytes = 65536; ///< faces that are larger are cut
constexpr int kLeastReduced = 2;     ///< logarithm of the smaller side, below which faces have no coarser level
constexpr size_t kLargeMeta = 1024;  ///< bytes; larger items have a block of their own
constexpr uint32_t kExtendedBytes = 40;

class Writer {
public:
    Writer(const Head& h, const std::vector<Image>& images) : head_(h), images_(images) {}
    std::vector<uint8_t> all();

private:
    std::vector<uint8_t> packed(const Image&, int u0, int v0, int u, int v, uint32_t* header) const;
    std::vector<uint8_t> face(const Image&, uint32_t* header) const;
    void level(const std::vector<uint32_t>& faces, const std::vector<Image>& images, bool first);
    std::vector<uint8_t> faceInfo() const;
    std::vector<uint8_t> constants() const;
    Image premultiplied(const Image&) const;
    const Head& head_;
    const std::vector<Image>& images_;
    std::vector<uint8_t> levelInfo_, levelData_;
    uint16_t levels_ = 0;
};

bool isConstant(const Image& m, size_t channels) {
    for (size_t i = channels; i < m.values.size(); ++i)
        if (m.values[i] != m.values[i - channels]) return false;
    return true;
}

/// Encodes the channels one after the other, with differences for integers.
std::vector<uint8_t> Writer::packed(const Image& m, int u0, int v0, int u, int v, uint32_t* header) const {
    const size_t channels = size_t(head_.channels);
    std::vector<uint8_t> data;
    for (size_t c = 0; c < channels; ++c)
        for (int j = v0; j < v0 + v; ++j)
            for (int i = u0; i < u0 + u; ++i)
                fromFloat(head_.number, m.values[(size_t(j) * size_t(m.u) + size_t(i)) * channels + c], data);
    const size_t size = sizeOf(head_.number);
    const bool whole = head_.number == Number::Byte || head_.number == Number::Word;
    if (head_.number == Number::Byte)
        for (size_t i = data.size(); i-- > 1;) data[i] = uint8_t(data[i] - data[i - 1]);
    if (head_.number == Number::Word)
        for (size_t i = data.size() / 2; i-- > 1;) {
            const uint16_t d = uint16_t(take<uint16_t>(&data[2 * i]) - take<uint16_t>(&data[2 * i - size]));
            data[2 * i] = uint8_t(d), data[2 * i + 1] = uint8_t(d >> 8);
        }
    std::vector<uint8_t> zip = deflated(data);
    *header = uint32_t(zip.size()) | uint32_t(whole ? kDifferences : kZipped) << 30;
    return zip;
}

std::vector<uint8_t> Writer::face(const Image& m, uint32_t* header) const {
    const size_t pixel = sizeOf(head_.number) * size_t(head_.channels);
    int tu = m.u, tv = m.v;
    while (size_t(tu) * size_t(tv) * pixel > kTileBytes && (tu > 1 || tv > 1)) (tu >= tv ? tu : tv) /= 2;
    if (tu == m.u && tv == m.v) return packed(m, 0, 0, m.u, m.v, header);
    std::vector<uint8_t> headers, tiles, all;
    for (int v = 0; v < m.v; v += tv)
        for (int u = 0; u < m.u; u += tu) {
            uint32_t h;
            const std::vector<uint8_t> tile = packed(m, u, v, tu, tv, &h);
            put(headers, h);
            tiles.insert(tiles.end(), tile.begin(), tile.end());
        }
    const std::vector<uint8_t> zip = deflated(headers);
    all = {uint8_t(std::countr_zero(unsigned(tu))), uint8_t(std::countr_zero(unsigned(tv)))};
    put(all, uint32_t(zip.size()));
    all.insert(all.end(), zip.begin(), zip.end());
    all.insert(all.end(), tiles.begin(), tiles.end());
    *header = uint32_t(all.size()) | uint32_t(kTiled) << 30;
    return all;
}

void Writer::level(const std::vector<uint32_t>& faces, const std::vector<Image>& images, bool first) {
    std::vector<uint8_t> headers, data;
    for (const uint32_t f : faces) {
        uint32_t h = uint32_t(sizeOf(head_.number) * size_t(head_.channels)); // constant
        if (!first || !head_.faces[f].constant) {
            const std::vector<uint8_t> block = face(images[f], &h);
            data.insert(data.end(), block.begin(), block.end());
        }
        put(headers, h);
    }
    const std::vector<uint8_t> zip = deflated(headers);
    put(levelInfo_, uint64_t(zip.size() + data.size()));
    put(levelInfo_, uint32_t(zip.size()));
    put(levelInfo_, uint32_t(faces.size()));
    levelData_.insert(levelData_.end(), zip.begin(), zip.end());
    levelData_.insert(levelData_.end(), data.begin(), data.end());
    ++levels_;
}

std::vector<uint8_t> Writer::faceInfo() const {
    std::vector<uint8_t> b;
    for (size_t i = 0; i < head_.faces.size(); ++i) {
        const Face& f = head_.faces[i];
        const size_t pixel = size_t(head_.channels);
        bool same = f.constant; // and all about it
        for (const int32_t a : f.adjacent)
            if (a >= 0 && same)
                same = head_.faces[size_t(a)].constant &&
                       std::equal(images_[i].values.begin(), images_[i].values.begin() + long(pixel),
                                  images_[size_t(a)].values.begin());
        b.push_back(f.ulog);
        b.push_back(f.vlog);
        b.push_back(uint8_t(f.edge[0] | f.edge[1] << 2 | f.edge[2] << 4 | f.edge[3] << 6));
        b.push_back(uint8_t(int(f.constant) | int(same) << 2 | int(f.subface) << 3));
        for (const int32_t a : f.adjacent) put(b, uint32_t(a));
    }
    return deflated(b);
}

/// Means, by alpha where there is one.
std::vector<uint8_t> Writer::constants() const {
    std::vector<uint8_t> b;
    const size_t channels = size_t(head_.channels), alpha = size_t(head_.alpha);
    for (const Image& m : images_) {
        std::vector<double> sum(channels);
        double weight = 0;
        for (size_t i = 0; i < m.values.size(); i += channels) {
            const double w = head_.alpha < 0 ? 1 : double(m.values[i + alpha]);
            weight += w;
            for (size_t c = 0; c < channels; ++c) sum[c] += double(m.values[i + c]) * (head_.alpha >= 0 && c == alpha ? 1 : w);
        }
        for (size_t c = 0; c < channels; ++c) {
            const double over = head_.alpha >= 0 && c == alpha ? double(m.values.size() / channels) : weight;
            const bool one = isConstant(m, channels);
            fromFloat(head_.number, one ? m.values[c] : over > 0 ? float(sum[c] / over) : 0, b);
        }
    }
    return deflated(b);
}

Image Writer::premultiplied(const Image& from) const {
    Image m = from;
    const size_t channels = size_t(head_.channels), alpha = size_t(head_.alpha);
    for (size_t i = 0; head_.alpha >= 0 && i < m.values.size(); i += channels)
        for (size_t c = 0; c < channels; ++c)
            if (c != alpha) m.values[i + c] *= m.values[i + alpha];
    return m;
}

void putMeta(const Meta& m, std::vector<uint8_t>& to) {
    const std::string key = m.key.substr(0, 254);
    to.push_back(uint8_t(key.size() + 1));
    to.insert(to.end(), key.begin(), key.end());
    to.push_back(0);
    to.push_back(m.type);
    put(to, uint32_t(m.bytes.size()));
}

std::vector<uint8_t> Writer::all() {
    std::vector<uint32_t> every(head_.faces.size()), coarse;
    for (uint32_t f = 0; f < every.size(); ++f) every[f] = f;
    level(every, images_, true);
    for (const uint32_t f : every)
        if (!head_.faces[f].constant) coarse.push_back(f);
    const auto least = [&](uint32_t f) { return int(std::min(head_.faces[f].ulog, head_.faces[f].vlog)); };
    std::stable_sort(coarse.begin(), coarse.end(), [&](uint32_t a, uint32_t b) { return least(a) > least(b); });
    std::vector<Image> reduced(images_.size());
    for (int k = 1;; ++k) {
        while (!coarse.empty() && least(coarse.back()) - k < kLeastReduced) coarse.pop_back();
        if (coarse.empty()) break;
        for (const uint32_t f : coarse)
            reduced[f] = halved(k == 1 ? premultiplied(images_[f]) : reduced[f], head_.channels, head_.mesh);
        level(coarse, reduced, false);
    }
    std::vector<uint8_t> metas, largeHeader, largeData;
    for (const Meta& m : head_.metas) {
        const bool large = m.bytes.size() > kLargeMeta;
        putMeta(m, large ? largeHeader : metas);
        if (!large) metas.insert(metas.end(), m.bytes.begin(), m.bytes.end());
        else {
            const std::vector<uint8_t> zip = deflated(m.bytes);
            put(largeHeader, uint32_t(zip.size()));
            largeData.insert(largeData.end(), zip.begin(), zip.end());
        }
    }
    const auto packedOr0 = [](const std::vector<uint8_t>& b) { return b.empty() ? b : deflated(b); };
    const std::vector<uint8_t> info = faceInfo(), means = constants(), metaZip = packedOr0(metas),
                               largeZip = packedOr0(largeHeader);
    std::vector<uint8_t> b = {'P', 't', 'e', 'x'};
    put(b, uint32_t(1));
    put(b, uint32_t(head_.mesh));
    put(b, uint32_t(head_.number));
    put(b, uint32_t(head_.alpha));
    put(b, uint16_t(head_.channels));
    put(b, levels_);
    for (const size_t n : {head_.faces.size(), size_t(kExtendedBytes), info.size(), means.size(), levelInfo_.size(), size_t(3)})
        put(b, uint32_t(n));
    put(b, uint64_t(levelData_.size()));
    put(b, uint32_t(metaZip.size()));
    put(b, uint32_t(metas.size()));
    put(b, uint32_t(head_.uBorder));
    put(b, uint32_t(head_.vBorder));
    put(b, uint32_t(largeZip.size()));
    put(b, uint32_t(largeHeader.size()));
    put(b, uint64_t(largeData.size()));
    put(b, uint64_t(0)); // no edits
    put(b, uint64_t(0));
    const std::vector<uint8_t> barrier(8);
    for (const std::vector<uint8_t>* part : std::initializer_list<const std::vector<uint8_t>*>{
             &info, &means, &levelInfo_, &levelData_, &metaZip, &barrier, &largeZip, &largeData})
        b.insert(b.end(), part->begin(), part->end());
    return b;
}

/// Averages rectangles of bu x bv pixels.
template <class Pixel> Image halvedBy(const Image& from, int bu, int bv, int channels, Mesh mesh, const Pixel& pixel) {
    const int u = from.u, v = from.v;
    Image to{std::max(1, u / 2), std::max(1, v / 2), {}};
    const size_t n = size_t(channels);
    to.values.resize(size_t(to.u) * size_t(to.v) * n);
    const auto at = [&](int i, int j, size_t c) { return pixel(i, j)[c]; };
    const auto triangle = [&](int i, int j, bool upright, size_t c) {
        return upright ? at(i, j, c) : at(u - 1 - i, u - 1 - j, c);
    };
    const auto mean = [&](int i, int j, size_t c) {
        const int x = u > 1 ? 2 * i : 0, y = v > 1 ? 2 * j : 0, x1 = std::min(x + 1, u - 1), y1 = std::min(y + 1, v - 1);
        if (mesh == Mesh::Quad || u < 2) return (at(x, y, c) + at(x1, y, c) + at(x, y1, c) + at(x1, y1, c)) / 4;
        if (i + j < to.u) // upright: three, and one on its head between them
            return (triangle(x, y, true, c) + triangle(x + 1, y, true, c) + triangle(x, y + 1, true, c) +
                    triangle(x, y, false, c)) /
                   4;
        const int a = 2 * (to.u - 1 - i), b = 2 * (to.u - 1 - j);
        return (triangle(a + 1, b + 1, false, c) + triangle(a, b + 1, false, c) + triangle(a + 1, b, false, c) +
                triangle(a + 1, b + 1, true, c)) /
               4;
    };
    const int du = std::max(1, bu / 2), dv = std::max(1, bv / 2);
    for (int j0 = 0; j0 < to.v; j0 += dv)
        for (int i0 = 0; i0 < to.u; i0 += du)
            for (int j = j0; j < std::min(j0 + dv, to.v); ++j)
                for (int i = i0; i < std::min(i0 + du, to.u); ++i)
                    for (size_t c = 0; c < n; ++c) to.values[(size_t(j) * size_t(to.u) + size_t(i)) * n + c] = mean(i, j, c);
    return to;
}
} // namespace

Image halved(const Image& m, int channels, Mesh mesh) {
    return halvedBy(m, m.u, m.v, channels, mesh,
                    [&](int i, int j) { return &m.values[(size_t(j) * size_t(m.u) + size_t(i)) * size_t(channels)]; });
}

Image halved(const Tiles& t, int channels, Mesh mesh, const std::function<const float*(int, int)>& pixel) {
    return halvedBy(t, 1 << t.tu, 1 << t.tv, channels, mesh, pixel);
}

bool writeTexture(const std::string& name, Head head, const std::vector<Image>& images, const OutputPolicy& policy,
                  Diagnostics& d, const SourcePlace& place) {
    for (size_t i = 0; i < images.size() && i < head.faces.size(); ++i)
        head.faces[i].constant = isConstant(images[i], size_t(head.channels));
    auto file = OutputFile::open(name, policy, d, place);
    if (!file) return false;
    const std::vector<uint8_t> b = Writer(head, images).all();
    file->write(b.data(), b.size());
    return file->commit(d);
}

} // namespace alpenglow::ptex
