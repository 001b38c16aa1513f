#include "texture/pyramid.h"
#include "base/exact.h"
#include "base/vec.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace alpenglow::texture {
namespace {

/// The two texels around a coordinate along one axis, and the weight of the second. -1: outside a black border.
struct Pair {
    int i0, i1;
    float f;
};

/// In texels, 0 at the centre of the first.
float position(float coordinate, int n, Wrap wrap) {
    if (!std::isfinite(coordinate)) coordinate = 0;
    if (wrap == Wrap::Periodic) coordinate -= std::floor(coordinate);
    if (wrap == Wrap::Mirror) coordinate -= 2 * std::floor(coordinate * 0.5f);
    float x = coordinate * float(n) - 0.5f;
    return wrap == Wrap::Periodic || wrap == Wrap::Mirror ? x : std::clamp(x, -2.0f, float(n) + 1.0f); // constant beyond
}

/// The texel that texel i of an endless row shows; -1: none, black.
int placed(int i, int n, Wrap wrap) {
    switch (wrap) {
    case Wrap::Periodic:
        return (i % n + n) % n;
    case Wrap::Clamp:
        return std::clamp(i, 0, n - 1);
    case Wrap::Mirror: {
        const int k = (i % (2 * n) + 2 * n) % (2 * n);
        return k < n ? k : 2 * n - 1 - k;
    }
    case Wrap::Black:
        break;
    }
    return i < 0 || i >= n ? -1 : i;
}

Pair texelsAt(float coordinate, int n, Wrap wrap) {
    float x = position(coordinate, n, wrap);
    float fl = std::floor(x);
    int i0 = int(fl), i1 = i0 + 1;
    return {placed(i0, n, wrap), placed(i1, n, wrap), x - fl};
}

/// The three texels that a central difference over one texel needs: the slope is that from the first to the second, blended by f
/// into that from the second to the third.
struct Neighbours {
    int i[3];
    float f;
};

Neighbours neighboursAt(float coordinate, int n, Wrap wrap) {
    float x = position(coordinate, n, wrap) + 0.5f, fl = std::floor(x);
    Neighbours r{{}, x - fl};
    for (int k = 0; k < 3; ++k) r.i[k] = placed(int(fl) - 1 + k, n, wrap);
    return r;
}

/// Kernel over [-1/2, 1/2] scaled to its full width.
struct Kernel {
    enum Kind { Box, Triangle, Gaussian, CatmullRom, Mitchell, Lanczos } kind;
    float width; ///< own full width, in destination texels
};
Kernel kernelOf(std::string_view f) {
    if (f == "triangle") return {Kernel::Triangle, 2};
    if (f == "catmull-rom" || f == "separable-catmull-rom") return {Kernel::CatmullRom, 4};
    if (f == "mitchell") return {Kernel::Mitchell, 4};
    if (f == "lanczos" || f == "sinc") return {Kernel::Lanczos, 4};
    if (f == "box" || f == "disk" || f == "point") return {Kernel::Box, 1};
    return {Kernel::Gaussian, 2};
}

/// Weight at distance x for full width w (RISpec 3.2, appendix E, one-dimensional forms).
double weightAt(Kernel::Kind kind, double x, double w) {
    x = std::fabs(x);
    if (x > w / 2) return 0;
    double t = 4 * x / w; // support 2 on the half width
    switch (kind) {
    case Kernel::Box:
        return 1;
    case Kernel::Triangle:
        return 1 - x / (w / 2);
    case Kernel::Gaussian:
        return exact::exp(-8 * x * x / (w * w));
    case Kernel::CatmullRom:
        return t < 1 ? (3 * t * t * t - 5 * t * t + 2) / 2 : (-t * t * t + 5 * t * t - 8 * t + 4) / 2;
    case Kernel::Mitchell: {
        constexpr double B = 1.0 / 3, C = 1.0 / 3;
        return t < 1 ? ((12 - 9 * B - 6 * C) * t * t * t + (-18 + 12 * B + 6 * C) * t * t + (6 - 2 * B)) / 6
                     : ((-B - 6 * C) * t * t * t + (6 * B + 30 * C) * t * t + (-12 * B - 48 * C) * t + (8 * B + 24 * C)) / 6;
    }
    case Kernel::Lanczos: {
        auto sinc = [](double v) { return v == 0 ? 1.0 : exact::sin(kPi * v) / (kPi * v); };
        return sinc(t) * sinc(t / 2);
    }
    }
    return 0;
}

/// For each destination texel: source texels (wrapped; -1 = black) and weights that sum to 1.
struct Taps {
    std::vector<size_t> begin; ///< destination n+1 offsets
    std::vector<int> source;
    std::vector<float> weight;
};

Taps tapsFor(int from, int to, const Kernel& k, float width, Wrap wrap) {
    Taps taps;
    double scale = double(from) / double(to), full = double(k.width) * double(width);
    if (!(full > 0)) full = double(k.width);
    full = std::min(full, 64.0); // a wider reduction would only blur, at quadratic cost
    for (int i = 0; i < to; ++i) {
        taps.begin.push_back(taps.source.size());
        double centre = (i + 0.5) * scale, radius = full / 2 * scale;
        int lo = int(std::floor(centre - radius)), hi = int(std::ceil(centre + radius));
        std::vector<double> w;
        double sum = 0;
        for (int j = lo; j < hi; ++j) {
            double v;
            if (k.kind == Kernel::Box)
                v = std::max(0.0, std::min(j + 1.0, centre + radius) - std::max(double(j), centre - radius));
            else v = weightAt(k.kind, (j + 0.5 - centre) / scale, full);
            w.push_back(v);
            sum += v;
        }
        if (!(std::fabs(sum) > 1e-12)) { // narrower than a texel and between centres: the nearest
            lo = int(std::floor(centre));
            w = {1};
            sum = 1;
        }
        for (size_t j = 0; j < w.size(); ++j) {
            if (w[j] == 0) continue;
            int s = lo + int(j);
            s = placed(s, from, wrap);
            if (s < 0) continue; // black: its weight counts, its value is 0
            taps.source.push_back(s);
            taps.weight.push_back(float(w[j] / sum));
        }
    }
    taps.begin.push_back(taps.source.size());
    return taps;
}

} // namespace

std::optional<Wrap> wrapByName(std::string_view n) {
    if (n == "black") return Wrap::Black;
    if (n == "clamp") return Wrap::Clamp;
    if (n == "periodic") return Wrap::Periodic;
    if (n == "mirror") return Wrap::Mirror;
    return {};
}

const char* nameOf(Wrap w) {
    constexpr const char* names[] = {"black", "clamp", "periodic", "mirror"};
    return names[int(w)];
}

bool isReductionFilter(std::string_view n) {
    for (const char* k : {"box", "triangle", "gaussian", "catmull-rom", "separable-catmull-rom", "mitchell", "lanczos", "sinc",
                          "disk", "bessel", "b-spline", "blackman-harris", "point"})
        if (n == k) return true;
    return false;
}

void Level::addBilinear(float s, float t, Wrap swrap, Wrap twrap, int first, int count, float weight, float* sum,
                        bool asLight) const {
    Pair x = texelsAt(s, width, swrap), y = texelsAt(t, height, twrap);
    const float w[4] = {(1 - x.f) * (1 - y.f), x.f * (1 - y.f), (1 - x.f) * y.f, x.f * y.f};
    const int xs[4] = {x.i0, x.i1, x.i0, x.i1}, ys[4] = {y.i0, y.i0, y.i1, y.i1};
    size_t at[4];
    float k[4];
    for (int i = 0; i < 4; ++i) {
        bool outside = xs[i] < 0 || ys[i] < 0;
        at[i] = outside ? 0 : (size_t(ys[i]) * size_t(width) + size_t(xs[i])) * size_t(channels) + size_t(first);
        k[i] = outside ? 0 : w[i];
    }
    // The positions of the values are equal for all texels of a channel.
    const float* numbers = codes.empty() ? (asLight && !light.empty() ? light : values).data() : nullptr;
    for (int c = 0; c < count; ++c) {
        const CodeTable& ofCode = codes.empty() ? kCodeValues : tableOf(first + c, asLight);
        float r = 0;
        for (int i = 0; i < 4; ++i) {
            if (k[i] == 0) continue; // 0 * infinity would spoil a neighbour
            const size_t from = at[i] + size_t(c);
            r += k[i] * (numbers ? numbers[from] : ofCode[codes[from]]);
        }
        sum[c] += weight * r;
    }
}

void Level::addTexel(int x, int y, Wrap swrap, Wrap twrap, int first, int count, float weight, float* sum, bool asLight) const {
    const int i = placed(x, width, swrap), j = placed(y, height, twrap);
    if (i < 0 || j < 0) return;
    const size_t at = (size_t(j) * size_t(width) + size_t(i)) * size_t(channels) + size_t(first);
    for (int c = 0; c < count; ++c) sum[c] += weight * texel(at + size_t(c), first + c, asLight);
}

void Level::addSlopes(float s, float t, Wrap swrap, Wrap twrap, int first, int count, float weight, float* ds, float* dt,
                      bool asLight) const {
    const auto valueAt = [&](int x, int y, int c) {
        if (x < 0 || y < 0) return 0.0f;
        return texel((size_t(y) * size_t(width) + size_t(x)) * size_t(channels) + size_t(first + c), first + c, asLight);
    };
    const Pair px = texelsAt(s, width, swrap), py = texelsAt(t, height, twrap);
    const Neighbours nx = neighboursAt(s, width, swrap), ny = neighboursAt(t, height, twrap);
    for (int c = 0; c < count; ++c) {
        const auto alongS = [&](int y) {
            const float v[3] = {valueAt(nx.i[0], y, c), valueAt(nx.i[1], y, c), valueAt(nx.i[2], y, c)};
            return (1 - nx.f) * (v[1] - v[0]) + nx.f * (v[2] - v[1]);
        };
        const auto alongT = [&](int x) {
            const float v[3] = {valueAt(x, ny.i[0], c), valueAt(x, ny.i[1], c), valueAt(x, ny.i[2], c)};
            return (1 - ny.f) * (v[1] - v[0]) + ny.f * (v[2] - v[1]);
        };
        ds[c] += weight * float(width) * ((1 - py.f) * alongS(py.i0) + py.f * alongS(py.i1));
        dt[c] += weight * float(height) * ((1 - px.f) * alongT(px.i0) + px.f * alongT(px.i1));
    }
}

void Level::addCurves(float s, float t, Wrap swrap, Wrap twrap, int first, int count, float weight, float* ss, float* st,
                      float* tt, bool asLight) const {
    const float w = float(width), h = float(height), x = 0.5f / w, y = 0.5f / h;
    for (int c = 0; c < count; ++c) {
        float alongS = 0, across = 0, alongT = 0, other = 0;
        addSlopes(s + x, t, swrap, twrap, first + c, 1, 1, &alongS, &other, asLight);
        addSlopes(s - x, t, swrap, twrap, first + c, 1, -1, &alongS, &other, asLight);
        addSlopes(s, t + y, swrap, twrap, first + c, 1, 1, &across, &alongT, asLight);
        addSlopes(s, t - y, swrap, twrap, first + c, 1, -1, &across, &alongT, asLight);
        ss[c] += weight * w * alongS;
        st[c] += weight * h * across;
        tt[c] += weight * h * alongT;
    }
}

namespace {
/// Rows of a picture, reduced horizontally; caches the last ones. In double, so that the mean is preserved over many levels.
class ReducedRows {
public:
    ReducedRows(const PictureRows& m, int width, const Taps& taps, size_t kept)
        : m_(m), taps_(taps), channels_(m.channels.size()), rows_(kept), which_(kept, -1),
          whole_(size_t(m.width) * m.channels.size()) {
        for (std::vector<double>& r : rows_) r.resize(size_t(width) * channels_);
    }
    const std::vector<double>& row(int y) {
        const size_t slot = size_t(y) % rows_.size();
        std::vector<double>& to = rows_[slot];
        if (std::exchange(which_[slot], y) == y) return to;
        m_.read(y, whole_.data());
        std::fill(to.begin(), to.end(), 0.0);
        for (size_t x = 0; x + 1 < taps_.begin.size(); ++x)
            for (size_t i = taps_.begin[x]; i < taps_.begin[x + 1]; ++i)
                for (size_t c = 0; c < channels_; ++c)
                    to[x * channels_ + c] += double(taps_.weight[i]) * double(whole_[size_t(taps_.source[i]) * channels_ + c]);
        return to;
    }

private:
    const PictureRows& m_;
    const Taps& taps_;
    size_t channels_;
    std::vector<std::vector<double>> rows_;
    std::vector<int> which_;
    std::vector<float> whole_;
};
} // namespace

display::Image reduced(const PictureRows& m, const Reduction& how, Wrap swrap, Wrap twrap) {
    const int w = std::max(1, m.width / 2), h = std::max(1, m.height / 2);
    const Kernel k = kernelOf(how.filter);
    const Taps tx = tapsFor(m.width, w, k, how.swidth, swrap), ty = tapsFor(m.height, h, k, how.twidth, twrap);
    size_t most = 1;
    for (size_t y = 0; y + 1 < ty.begin.size(); ++y) most = std::max(most, ty.begin[y + 1] - ty.begin[y]);
    ReducedRows rows(m, w, tx, most);
    display::Image out = display::makeImage(w, h, m.channels);
    std::vector<double> row(size_t(w) * m.channels.size());
    for (int y = 0; y < h; ++y) {
        std::fill(row.begin(), row.end(), 0.0);
        for (size_t i = ty.begin[size_t(y)]; i < ty.begin[size_t(y) + 1]; ++i) {
            const std::vector<double>& from = rows.row(ty.source[i]);
            for (size_t j = 0; j < row.size(); ++j) row[j] += double(ty.weight[i]) * from[j];
        }
        for (size_t j = 0; j < row.size(); ++j) out.pixel(0, y)[j] = float(row[j]);
    }
    return out;
}

display::Image reduced(const display::Image& m, const Reduction& how, Wrap swrap, Wrap twrap) {
    const size_t n = size_t(m.width) * m.channels.size();
    return reduced({m.width, m.height, m.channels, [&](int y, float* to) { std::copy_n(m.pixel(0, y), n, to); }}, how, swrap,
                   twrap);
}

std::vector<display::Image> reducedLevels(const display::Image& m, const Reduction& how, Wrap swrap, Wrap twrap) {
    std::vector<display::Image> levels;
    const display::Image* last = &m;
    while (last->width > 1 || last->height > 1) {
        display::Image next = reduced(*last, how, swrap, twrap);
        levels.push_back(std::move(next));
        last = &levels.back();
    }
    return levels;
}

std::vector<display::Image> reducedLevels(const PictureRows& m, const Reduction& how, Wrap swrap, Wrap twrap) {
    std::vector<display::Image> levels;
    if (m.width <= 1 && m.height <= 1) return levels;
    levels.push_back(reduced(m, how, swrap, twrap));
    for (display::Image& below : reducedLevels(levels[0], how, swrap, twrap)) levels.push_back(std::move(below));
    return levels;
}

size_t storedLevels(const display::Image& m) {
    int w = m.width, h = m.height;
    size_t n = 0;
    for (const display::Image& l : m.levels) {
        if (w == 1 && h == 1) break;
        w = std::max(1, w / 2);
        h = std::max(1, h / 2);
        if (l.width != w || l.height != h || l.channels.size() != m.channels.size()) break;
        ++n;
    }
    return n;
}

} // namespace alpenglow::texture
