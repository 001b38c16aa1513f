#include "ptex/filter.h"
#include "base/exact.h"
#include <algorithm>
#include <cmath>
#include <deque>
#include <vector>

namespace alpenglow::ptex {

namespace {

constexpr float kLeastSpread = .6f; ///< of the Gaussian, pixels: below, it would show them
constexpr float kMostPixels = 8;    ///< that a footprint is wide in the level that is read
constexpr int kMostSteps = 8;       ///< from face to face

/// A position on some face. `black`: beyond a black border.
struct Place {
    uint32_t face;
    float u, v;
    bool black = false;
};

/// A function of the distance in pixels, for a footprint of this width in pixels.
struct Shape {
    Kernel kernel;
    float half; ///< of the Gaussian its spread
    Shape(Kernel k, float wide) : kernel(k) {
        if (k == Kernel::Gaussian) half = std::max(kLeastSpread, wide / 2);
        else if (k == Kernel::Triangle) half = std::max(1.f, wide);
        else half = std::max(.5f, wide / 2);
    }
    float reach() const { return kernel == Kernel::Gaussian ? 3.5f * half : kernel == Kernel::Box ? half + .5f : half; }
    float at(float x) const {
        const float a = std::fabs(x);
        if (kernel == Kernel::Gaussian) return float(exact::exp(-.5 * double(x / half) * double(x / half)));
        if (kernel == Kernel::Triangle) return std::max(0.f, 1 - a / half);
        return std::clamp(half + .5f - a, 0.f, 1.f); // overlap of the pixel with the box
    }
};

/// A level of a face, complete or in tiles.
struct Level {
    uint64_t key;
    std::shared_ptr<const Image> image; ///< or the latest tile
    std::shared_ptr<const Tiles> tiles;
    uint32_t tile = 0; ///< the latest
    int u, v;
};

class Filter {
public:
    Filter(const Texture& t, const Query& q) : texture_(t), head_(t.head()), q_(q), sums_(size_t(head_.channels)) {}
    void run();
    void give(float* out) const;

private:
    void overQuad();
    void overTriangle();
    Level& level(uint32_t face, int halvings);
    Level& levelLike(uint32_t face);
    bool cross(Place&, int edge) const;
    bool crossTriangle(Place&, int edge) const;
    bool border(Place&, bool u) const;
    Place walk(Place, bool uFirst) const;
    void add(const Place&, float weight);
    void addTriangle(Place, float weight);
    void addPixel(Level&, int i, int j, float weight);
    int levelFor(const Face&) const;

    const Texture& texture_;
    const Head& head_;
    const Query& q_;
    std::vector<double> sums_;
    double weight_ = 0;
    int ulog_ = 0, vlog_ = 0; ///< of the level that is read
    std::deque<Level> levels_;
};

/// Halvings, so that the footprint is not much wider than a pixel on its narrow side.
int Filter::levelFor(const Face& f) const {
    const float a = std::max(q_.wu, 0.f) * float(1 << f.ulog), b = std::max(q_.wv, 0.f) * float(1 << f.vlog);
    float least = std::min(a, b), most = std::max(a, b);
    int k = 0;
    while (k < 16 && (least >= 2 || most > kMostPixels)) least /= 2, most /= 2, ++k;
    return k;
}

Level& Filter::level(uint32_t face, int k) {
    const uint64_t key = uint64_t(face) << 8 | uint64_t(k);
    for (Level& known : levels_)
        if (known.key == key) return known;
    Level l{key, nullptr, texture_.tiles(face, k), 0, 1, 1};
    if (!l.tiles) l.image = texture_.image(face, k);
    const Image& sides = l.tiles ? *l.tiles : *l.image;
    l.u = sides.u, l.v = sides.v;
    return levels_.emplace_back(std::move(l));
}

/// Another face, its longer side of as many pixels as that of the level that is read: which of its sides is along u is its own
/// affair.
Level& Filter::levelLike(uint32_t face) {
    const Face& f = head_.faces[face];
    return level(face, std::max(0, int(std::max(f.ulog, f.vlog)) - std::max(ulog_, vlog_)));
}

/// Position relative to an edge: t from its first to its last corner, d beyond it.
void alongEdge(int edge, float u, float v, float& t, float& d) {
    t = edge == 0 ? u : edge == 1 ? v : edge == 2 ? 1 - u : 1 - v;
    d = edge == 0 ? -v : edge == 1 ? u - 1 : edge == 2 ? v - 1 : -u;
}

/// Crosses an edge onto the neighbour. Returns false if there is none.
bool Filter::cross(Place& p, int edge) const {
    const Face& f = head_.faces[p.face];
    if (f.adjacent[size_t(edge)] < 0) return false;
    float t, d;
    alongEdge(edge, p.u, p.v, t, d);
    uint32_t to = uint32_t(f.adjacent[size_t(edge)]);
    int at = f.edge[size_t(edge)];
    t = 1 - t;                                   // neighbours go along their common edge in opposite directions
    if (head_.faces[to].subface && !f.subface) { // two parts share the edge: the first of them, as we go, is the last as they do
        d *= 2;
        if (t >= .5f) t = 2 * t - 1;
        else {
            const int before = (at + 3) & 3;
            const int32_t second = head_.faces[to].adjacent[size_t(before)];
            if (second >= 0) {
                at = (head_.faces[to].edge[size_t(before)] + 3) & 3;
                to = uint32_t(second);
                t = 2 * t;
            } else t = 0;
        }
    } else if (f.subface && !head_.faces[to].subface) {
        const bool first = head_.faces[to].adjacent[size_t(at)] == int32_t(p.face);
        t = first ? t / 2 : .5f + t / 2;
        d /= 2;
    }
    p.face = to;
    p.u = at == 0 ? t : at == 1 ? 1 - d : at == 2 ? 1 - t : d;
    p.v = at == 0 ? d : at == 1 ? t : at == 2 ? 1 - d : 1 - t;
    return true;
}

/// Applies the border mode across u, or v. Returns false if it is black there.
bool Filter::border(Place& p, bool u) const {
    float& x = u ? p.u : p.v;
    switch (u ? head_.uBorder : head_.vBorder) {
    case Border::Black:
        return false;
    case Border::Periodic:
        x -= std::floor(x);
        return true;
    default:
        x = std::clamp(x, 0.f, 1.f);
        return true;
    }
}

Place Filter::walk(Place p, bool uFirst) const {
    for (int n = 0; n < kMostSteps; ++n) {
        const bool overU = p.u < 0 || p.u > 1, overV = p.v < 0 || p.v > 1;
        if (!overU && !overV) return p;
        const bool u = overU && (uFirst || !overV);
        const int edge = u ? (p.u > 1 ? 1 : 3) : (p.v > 1 ? 2 : 0);
        if (!cross(p, edge) && !border(p, u)) {
            p.black = true;
            return p;
        }
    }
    p.u = std::clamp(p.u, 0.f, 1.f);
    p.v = std::clamp(p.v, 0.f, 1.f);
    return p;
}

void Filter::addPixel(Level& m, int i, int j, float weight) {
    size_t at = size_t(j) * size_t(m.u) + size_t(i);
    if (m.tiles) {
        at = m.tiles->within(i, j);
        if (const uint32_t n = m.tiles->numberOf(i, j); n != m.tile || !m.image)
            m.image = texture_.tile(uint32_t(m.key >> 8), int(m.key & 255), *m.tiles, m.tile = n);
    }
    const float* from = &m.image->values[at * sums_.size()];
    for (size_t c = 0; c < sums_.size(); ++c) sums_[c] += double(weight * from[c]);
}

/// Adds the value of another face, interpolated if it has fewer pixels.
void Filter::add(const Place& p, float weight) {
    weight_ += double(weight);
    if (p.black) return;
    Level& m = levelLike(p.face);
    const float x = p.u * float(m.u) - .5f, y = p.v * float(m.v) - .5f;
    const int i = int(std::floor(x)), j = int(std::floor(y));
    const float a = x - float(i), b = y - float(j);
    const auto pixel = [&](int di, int dj, float w) {
        if (w > 0) addPixel(m, std::clamp(i + di, 0, m.u - 1), std::clamp(j + dj, 0, m.v - 1), weight * w);
    };
    pixel(0, 0, (1 - a) * (1 - b));
    pixel(1, 0, a * (1 - b));
    pixel(0, 1, (1 - a) * b);
    pixel(1, 1, a * b);
}

void Filter::overQuad() {
    const Face& f = head_.faces[q_.face];
    const int k = levelFor(f);
    ulog_ = std::max(0, f.ulog - k), vlog_ = std::max(0, f.vlog - k);
    Level& m = level(q_.face, k);
    const float nu = float(1 << ulog_), nv = float(1 << vlog_), x = q_.u * nu - .5f, y = q_.v * nv - .5f;
    const bool flat = m.u == 1 && m.v == 1 && (ulog_ > 0 || vlog_ > 0); // of one colour
    const Shape su(q_.kernel, q_.wu * nu), sv(q_.kernel, q_.wv * nv);
    for (int j = int(std::ceil(y - sv.reach())); float(j) <= y + sv.reach(); ++j)
        for (int i = int(std::ceil(x - su.reach())); float(i) <= x + su.reach(); ++i) {
            const float w = su.at(float(i) - x) * sv.at(float(j) - y);
            if (!(w > 0)) continue;
            const bool insideU = i >= 0 && float(i) < nu, insideV = j >= 0 && float(j) < nv;
            if (insideU && insideV) {
                weight_ += double(w);
                addPixel(m, flat ? 0 : i, flat ? 0 : j, w);
                continue;
            }
            const Place p{q_.face, (float(i) + .5f) / nu, (float(j) + .5f) / nv};
            if (insideU || insideV) add(walk(p, true), w);
            else {
                add(walk(p, true), w / 2);
                add(walk(p, false), w / 2);
            }
        }
}

/// Adjacent triangles are treated as halves of a parallelogram.
bool Filter::crossTriangle(Place& p, int edge) const {
    const Face& f = head_.faces[p.face];
    if (f.adjacent[size_t(edge)] < 0) return false;
    const float b[3] = {1 - p.u - p.v, p.u, p.v};
    const float first = b[edge], second = b[(edge + 1) % 3], beyond = -b[(edge + 2) % 3];
    const int at = f.edge[size_t(edge)] % 3;
    float to[3];
    to[at] = second - beyond;
    to[(at + 1) % 3] = first - beyond;
    to[(at + 2) % 3] = beyond;
    p = {uint32_t(f.adjacent[size_t(edge)]), to[1], to[2], false};
    return true;
}

void Filter::addTriangle(Place p, float weight) {
    for (int n = 0; n < kMostSteps; ++n) {
        const int edge = p.v < 0 ? 0 : p.u + p.v > 1 ? 1 : p.u < 0 ? 2 : -1;
        if (edge < 0) break;
        if (crossTriangle(p, edge)) continue;
        if (head_.uBorder == Border::Black) {
            weight_ += double(weight);
            return;
        }
        p.u = std::clamp(p.u, 0.f, 1.f);
        p.v = std::clamp(p.v, 0.f, 1.f);
        if (const float over = p.u + p.v; over > 1) p.u /= over, p.v /= over;
        break;
    }
    weight_ += double(weight);
    Level& m = levelLike(p.face);
    const float n = float(m.u), x = std::clamp(p.u, 0.f, 1.f) * n, y = std::clamp(p.v, 0.f, 1.f) * n;
    const int i = std::clamp(int(x), 0, m.u - 1), j = std::clamp(int(y), 0, m.u - 1);
    if (i + j + 1 >= m.u || x - float(i) + y - float(j) <= 1) { // upright
        const int over = std::max(0, i + j + 1 - m.u);
        addPixel(m, std::max(0, i - over), j - std::max(0, over - i), weight);
    } else addPixel(m, m.u - 1 - i, m.u - 1 - j, weight);
}

void Filter::overTriangle() {
    const Face& f = head_.faces[q_.face];
    ulog_ = vlog_ = std::max(0, f.ulog - levelFor(f));
    const float n = float(1 << ulog_), x = q_.u * n, y = q_.v * n;
    const Shape s(q_.kernel == Kernel::Point ? Kernel::Box : Kernel::Gaussian, std::max(q_.wu, q_.wv) * n);
    const float reach = s.reach() * 1.1547f;
    for (int j = int(std::floor(y - reach)); float(j) <= y + reach; ++j)
        for (int i = int(std::floor(x - reach)); float(i) <= x + reach; ++i)
            for (const float third : {1 / 3.f, 2 / 3.f}) {
                const float dx = float(i) + third - x, dy = float(j) + third - y;
                const float w = s.at(std::sqrt(dx * dx + dy * dy + dx * dy)); // of triangles with equal sides
                if (w > 1e-6f) addTriangle({q_.face, (float(i) + third) / n, (float(j) + third) / n}, w);
            }
}

void Filter::run() {
    if (q_.kernel == Kernel::Point) {
        ulog_ = head_.faces[q_.face].ulog, vlog_ = head_.faces[q_.face].vlog;
        if (head_.mesh == Mesh::Triangle) return addTriangle({q_.face, q_.u, q_.v}, 1);
        Level& m = level(q_.face, 0);
        weight_ = 1;
        return addPixel(m, std::clamp(int(q_.u * float(m.u)), 0, m.u - 1), std::clamp(int(q_.v * float(m.v)), 0, m.v - 1), 1);
    }
    head_.mesh == Mesh::Triangle ? overTriangle() : overQuad();
}

void Filter::give(float* out) const {
    for (int c = 0; c < q_.count; ++c) {
        const int from = q_.channel + c;
        const bool there = from >= 0 && from < head_.channels && weight_ > 0;
        out[c] = there ? float(sums_[size_t(from)] / weight_) : q_.fill;
    }
}

} // namespace

bool lookup(const Texture& t, const Query& asked, float* out) {
    for (int c = 0; c < asked.count; ++c) out[c] = 0;
    if (asked.face >= t.head().faces.size()) return false;
    Query q = asked;
    q.u = std::clamp(q.u, 0.f, 1.f); // not a number: 0
    q.v = std::clamp(q.v, 0.f, 1.f);
    if (!(q.u >= 0)) q.u = 0;
    if (!(q.v >= 0)) q.v = 0;
    q.wu = q.wu > 0 ? std::min(q.wu, 1.f) : 0;
    q.wv = q.wv > 0 ? std::min(q.wv, 1.f) : 0;
    Filter f(t, q);
    f.run();
    f.give(out);
    return true;
}

} // namespace alpenglow::ptex
