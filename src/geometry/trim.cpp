#include "geometry/trim.h"
#include "base/limits.h"
#include "geometry/primvars.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {
namespace {

// Four points of Gauss and Legendre on [0, 1].
constexpr double kNode[4] = {0.0694318442029737, 0.3300094782075719, 0.6699905217924281, 0.9305681557970263};
constexpr double kWeight[4] = {0.1739274225687269, 0.3260725774312731, 0.3260725774312731, 0.1739274225687269};

struct Quadrature {
    double at, weight;
};
// On [0, 1], adapted to square roots at both ends: curves have horizontal tangents at ends of strips.
Quadrature smoothed(int panel, int panels, int k) {
    const double s = (panel + kNode[k]) / panels;
    return {s * s * (3 - 2 * s), kWeight[k] / panels * 6 * s * (1 - s)};
}
constexpr int kPanels = 4;

double along(const std::vector<double>& c, double t) { // de Casteljau
    double b[limits::kNurbsOrder];
    std::copy(c.begin(), c.end(), b);
    for (size_t n = c.size() - 1; n > 0; --n)
        for (size_t i = 0; i < n; ++i) b[i] += (b[i + 1] - b[i]) * t;
    return b[0];
}

/// The part from t0 to t1 of a Bezier curve.
std::vector<double> part(std::vector<double> c, double t0, double t1) {
    const size_t n = c.size();
    for (size_t k = 1; k < n; ++k) // right of t0
        for (size_t i = 0; i + k < n; ++i) c[i] += (c[i + 1] - c[i]) * t0;
    // c[i] now holds the points of [t0, 1]; its left part up to t1:
    const double t = t0 < 1 ? (t1 - t0) / (1 - t0) : 0;
    for (size_t k = 1; k < n; ++k)
        for (size_t i = n - 1; i >= k; --i) c[i] = c[i - 1] + (c[i] - c[i - 1]) * t;
    return c;
}

} // namespace

double TrimRegion::Piece::crossing(double v) const {
    // y(t) - v w(t) changes sign once: regula falsi (Illinois) safeguarded by bisection.
    double lo = 0, hi = 1;
    double flo = v0 - v, fhi = v1 - v;
    if (flo == 0) return u0;
    if (fhi == 0) return u1;
    double t = 0.5;
    if (x.size() == 2) {
        const double a = y[0] - v * w[0], b = y[1] - v * w[1];
        t = a != b ? std::clamp(a / (a - b), 0.0, 1.0) : 0.5;
    } else {
        int side = 0;
        for (int i = 0; i < 100 && hi - lo > 1e-16; ++i) {
            t = i % 4 == 3 ? 0.5 * (lo + hi) : lo + (hi - lo) * flo / (flo - fhi);
            if (!(t > lo && t < hi)) t = 0.5 * (lo + hi);
            if (t == lo || t == hi) break;
            const double f = along(y, t) / along(w, t) - v;
            if (f == 0) break;
            if ((f < 0) == (flo < 0)) {
                lo = t, flo = f;
                if (side == 1) fhi *= 0.5;
                side = 1;
            } else {
                hi = t, fhi = f;
                if (side == 2) flo *= 0.5;
                side = 2;
            }
        }
    }
    return along(x, t) / along(w, t);
}

// ---- from the request to pieces
// -------------------------------------------------------------------------------------------------

class TrimRegion::Maker {
public:
    Maker(TrimRegion& region, const Domain& d) : region_(region), domain_(d) {}
    double widestGap = 0;

    bool curve(int order, const float* knot, double min, double max, int n, const float* u, const float* v, const float* w,
               std::string& why);
    void closeLoop();
    bool tooMany() const { return region_.pieces_.size() > limits::kTrimPieces; }

private:
    struct Point {
        double u, v;
    };
    void bezier(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& w);
    static void extremes(const std::vector<double>& y, const std::vector<double>& w, double t0, double t1,
                         std::vector<double>& out);
    void add(std::vector<double> x, std::vector<double> y, std::vector<double> w);
    void lineTo(Point);

    TrimRegion& region_;
    const Domain& domain_;
    bool open_ = false;
    Point start_{}, at_{};
};

/// One point of the Bezier form over [a, b] within knot span `i`: the blossom at `zeros` times a, the rest b.
static double blossom(const std::vector<double>& c, const std::vector<double>& t, int i, double a, double b, int zeros) {
    double d[limits::kNurbsOrder];
    const int p = int(c.size()) - 1; // c: the control values that act on the span
    for (int j = 0; j <= p; ++j) d[j] = c[size_t(j)];
    for (int r = 1; r <= p; ++r) {
        const double x = r <= zeros ? a : b;
        for (int j = p; j >= r; --j) {
            const double lo = t[size_t(i - p + j)], hi = t[size_t(j + 1 + i - r)];
            d[j] = d[j - 1] + (d[j] - d[j - 1]) * ((x - lo) / (hi - lo));
        }
    }
    return d[p];
}

bool TrimRegion::Maker::curve(int order, const float* knot, double min, double max, int n, const float* u, const float* v,
                              const float* w, std::string& why) {
    std::vector<double> t(knot, knot + n + order);
    for (size_t i = 0; i < t.size(); ++i)
        if (!std::isfinite(t[i]) || (i && t[i] < t[i - 1])) return why = "its knots must be finite and must not decrease", false;
    int sign = 0;
    for (int i = 0; i < n; ++i) {
        if (!std::isfinite(u[i]) || !std::isfinite(v[i]) || !std::isfinite(w[i]))
            return why = "it holds a number that is not finite", false;
        const int s = w[i] > 0 ? 1 : -1;
        if (w[i] == 0 || (sign && s != sign)) return why = "its weights must have one sign", false;
        sign = s;
    }
    min = std::max(min, t[size_t(order) - 1]);
    max = std::min(max, t[size_t(n)]);
    if (!(min < max)) return why = "its range of parameters is empty", false;
    const int p = order - 1;
    for (int i = p; i < n; ++i) {
        const double a = std::max(min, t[size_t(i)]), b = std::min(max, t[size_t(i) + 1]);
        if (!(a < b)) continue;
        std::vector<double> c[3], out[3];
        for (int j = i - p; j <= i; ++j) {
            const double weight = sign * double(w[j]);
            c[0].push_back((sign * double(u[j]) - domain_.lo[0] * weight) / (domain_.hi[0] - domain_.lo[0]));
            c[1].push_back((sign * double(v[j]) - domain_.lo[1] * weight) / (domain_.hi[1] - domain_.lo[1]));
            c[2].push_back(weight);
        }
        for (int k = 0; k < 3; ++k)
            for (int j = 0; j <= p; ++j) out[k].push_back(blossom(c[k], t, i, a, b, p - j));
        bezier(out[0], out[1], out[2]);
        if (tooMany()) return why = "there are more than " + std::to_string(limits::kTrimPieces) + " pieces", false;
    }
    return true;
}

/// Extremes of v = y / w: the quotients of the control points rise or fall only if the curve does (variation diminishing).
void TrimRegion::Maker::extremes(const std::vector<double>& y, const std::vector<double>& w, double t0, double t1,
                                 std::vector<double>& out) {
    bool up = false, down = false;
    double least = y[0] / w[0], most = least, before = least;
    for (size_t i = 1; i < y.size(); ++i) {
        const double v = y[i] / w[i];
        up |= v > before;
        down |= v < before;
        least = std::min(least, v);
        most = std::max(most, v);
        before = v;
    }
    if (!(up && down)) return;
    const double middle = 0.5 * (t0 + t1);
    // Level to the last bit, or so short that it is: v is off by the square of such a step.
    if (t1 - t0 < 1e-8 || most - least <= 4e-16 * std::max(std::fabs(least), std::fabs(most))) {
        if (middle - out.back() > 1e-7) out.push_back(middle);
        return;
    }
    const size_t found = out.size();
    extremes(part(y, 0, 0.5), part(w, 0, 0.5), t0, middle, out);
    extremes(part(y, 0.5, 1), part(w, 0.5, 1), middle, t1, out);
    // It turns at the joint of the halves, or not at all
    if (out.size() == found && middle - out.back() > 1e-7) out.push_back(middle);
}

void TrimRegion::Maker::bezier(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& w) {
    std::vector<double> cuts{0};
    extremes(y, w, 0, 1, cuts);
    cuts.push_back(1);
    for (size_t i = 0; i + 1 < cuts.size(); ++i)
        add(part(x, cuts[i], cuts[i + 1]), part(y, cuts[i], cuts[i + 1]), part(w, cuts[i], cuts[i + 1]));
}

void TrimRegion::Maker::add(std::vector<double> x, std::vector<double> y, std::vector<double> w) {
    const Point from{x[0] / w[0], y[0] / w[0]}, to{x.back() / w.back(), y.back() / w.back()};
    if (open_) {
        const double gap = std::max(std::fabs(from.u - at_.u), std::fabs(from.v - at_.v));
        widestGap = std::max(widestGap, gap);
        constexpr double kSame = 1e-9; // ends that rounding parted are one point
        if (gap > kSame) lineTo(from);
    } else {
        start_ = from;
        at_ = from;
        open_ = true;
    }
    Piece p{std::move(x), std::move(y), std::move(w), at_.u, at_.v, to.u, to.v, 0, 0};
    p.left = std::min(p.u0, p.u1);
    p.right = std::max(p.u0, p.u1);
    for (size_t i = 0; i < p.x.size(); ++i) {
        p.left = std::min(p.left, p.x[i] / p.w[i]);
        p.right = std::max(p.right, p.x[i] / p.w[i]);
    }
    at_ = to;
    region_.pieces_.push_back(std::move(p));
}

void TrimRegion::Maker::lineTo(Point to) {
    region_.pieces_.push_back(
        {{at_.u, to.u}, {at_.v, to.v}, {1, 1}, at_.u, at_.v, to.u, to.v, std::min(at_.u, to.u), std::max(at_.u, to.u)});
    at_ = to;
}

void TrimRegion::Maker::closeLoop() {
    if (!open_) return;
    widestGap = std::max({widestGap, std::fabs(start_.u - at_.u), std::fabs(start_.v - at_.v)});
    if (at_.u != start_.u || at_.v != start_.v) lineTo(start_);
    open_ = false;
}

std::shared_ptr<const TrimRegion> TrimRegion::make(const scene::ParamList& curves, const Domain& domain, bool keepInside,
                                                   std::string& why, double& widestGap) {
    static const std::vector<float> none;
    auto list = [&](const char* name) -> const std::vector<float>& {
        const scene::Param* p = lastParam(curves, name);
        return p ? p->numbers : none;
    };
    const auto &ncurves = list("ncurves"), &order = list("order"), &knot = list("knot"), &min = list("min"), &max = list("max"),
               &n = list("n"), &u = list("u"), &v = list("v"), &w = list("w");
    std::shared_ptr<TrimRegion> region(new TrimRegion);
    region->keepInside_ = keepInside;
    Maker maker(*region, domain);
    size_t c = 0, points = 0, knots = 0;
    for (float loop : ncurves) {
        for (int k = 0; k < int(loop); ++k, ++c) {
            if (c >= order.size() || c >= n.size() || c >= min.size() || c >= max.size())
                return why = "arrays are too short", nullptr;
            const int o = int(order[c]), count = int(n[c]);
            if (o < 2 || o > limits::kNurbsOrder || count < o)
                return why = "orders are 2 to " + std::to_string(limits::kNurbsOrder) + ", with as many points at least", nullptr;
            if (knots + size_t(o) + size_t(count) > knot.size() ||
                points + size_t(count) > std::min({u.size(), v.size(), w.size()}))
                return why = "arrays are too short", nullptr;
            std::string fault;
            if (!maker.curve(o, &knot[knots], min[c], max[c], count, &u[points], &v[points], &w[points], fault))
                return why = "curve " + std::to_string(c + 1) + ": " + fault, nullptr;
            knots += size_t(o) + size_t(count);
            points += size_t(count);
        }
        maker.closeLoop();
    }
    widestGap = maker.widestGap;
    // Pieces outside of the square, or horizontal in v, are never crossed there.
    std::erase_if(region->pieces_,
                  [](const Piece& p) { return p.v0 == p.v1 || std::max(p.v0, p.v1) < 0 || std::min(p.v0, p.v1) > 1; });
    region->makeStrips();
    region->weighStrips();
    return region;
}

// ---- strips of v
// ----------------------------------------------------------------------------------------------------------------

void TrimRegion::makeStrips() {
    constexpr size_t kEvenly = 32, kMost = 1u << 15, kEntries = 1u << 23;
    std::vector<double> ends;
    for (size_t i = 0; i <= kEvenly; ++i) ends.push_back(double(i) / kEvenly);
    for (const Piece& p : pieces_)
        for (double v : {p.v0, p.v1})
            if (v > 0 && v < 1) ends.push_back(v);
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    for (;;) {
        if (ends.size() > kMost) { // then uniform: the ends are only an index
            ends.clear();
            for (size_t i = 0; i <= kMost / 2; ++i) ends.push_back(double(i) / (kMost / 2));
        }
        strips_.assign(ends.size() - 1, {});
        for (size_t i = 0; i + 1 < ends.size(); ++i) strips_[i].lo = ends[i], strips_[i].hi = ends[i + 1];
        auto each = [&](auto&& f) {
            for (uint32_t k = 0; k < pieces_.size(); ++k) {
                const double lo = std::min(pieces_[k].v0, pieces_[k].v1), hi = std::max(pieces_[k].v0, pieces_[k].v1);
                for (size_t s = size_t(&stripOf(std::clamp(lo, 0.0, 1.0)) - strips_.data());
                     s < strips_.size() && strips_[s].lo <= hi; ++s)
                    f(strips_[s], k);
            }
        };
        size_t entries = 0;
        each([&](Strip& s, uint32_t) { ++s.count, ++entries; });
        if (entries > kEntries && ends.size() > 3) {
            std::vector<double> half;
            for (size_t i = 0; i < ends.size(); i += 2) half.push_back(ends[i]);
            if (half.back() != 1) half.push_back(1);
            ends = std::move(half);
            continue;
        }
        active_.resize(entries);
        uint32_t first = 0;
        for (Strip& s : strips_) s.first = first, first += s.count, s.count = 0;
        each([&](Strip& s, uint32_t k) { active_[s.first + s.count++] = k; });
        return;
    }
}

const TrimRegion::Strip& TrimRegion::stripOf(double v) const {
    auto i = std::upper_bound(strips_.begin(), strips_.end(), v, [](double x, const Strip& s) { return x < s.lo; });
    return i == strips_.begin() ? *i : *(i - 1);
}

void TrimRegion::intervals(double v, std::vector<double>& ends) const {
    ends.clear();
    const Strip& s = stripOf(v);
    int before = 0;
    for (uint32_t k = s.first; k < s.first + s.count; ++k) {
        const Piece& p = pieces_[active_[k]];
        if ((p.v0 <= v) == (p.v1 <= v)) continue;
        const double u = p.crossing(v);
        if (u <= 0) ++before;
        else if (u < 1) ends.push_back(u);
    }
    std::sort(ends.begin(), ends.end());
    if (bool(before & 1) == keepInside_) ends.insert(ends.begin(), 0.0);
    if (ends.size() & 1) ends.push_back(1.0);
}

double TrimRegion::keptLength(double v) const {
    thread_local std::vector<double> ends;
    intervals(v, ends);
    double sum = 0;
    for (size_t i = 0; i + 1 < ends.size(); i += 2) sum += ends[i + 1] - ends[i];
    return sum;
}

void TrimRegion::weighStrips() {
    double all = 0;
    for (Strip& s : strips_) {
        const double h = s.hi - s.lo;
        double sum = 0;
        for (int p = 0; p < kPanels; ++p)
            for (int k = 0; k < 4; ++k) {
                const Quadrature q = smoothed(p, kPanels, k);
                sum += q.weight * keptLength(s.lo + h * q.at);
            }
        s.share = sum * h;
        area_ += s.share;
        // The nodes may miss a kept part: every kept point needs a nonzero probability.
        if (s.count) s.share += 1e-4 * h;
        all += s.share;
    }
    double cumulative = 0;
    for (Strip& s : strips_) s.cumulative = cumulative += s.share = all > 0 ? s.share / all : 0;
}

bool TrimRegion::keeps(double u, double v) const {
    const Strip& s = stripOf(v);
    bool inside = false;
    for (uint32_t k = s.first; k < s.first + s.count; ++k) {
        const Piece& p = pieces_[active_[k]];
        if ((p.v0 <= v) == (p.v1 <= v) || u < p.left) continue;
        if (u > p.right || p.crossing(v) <= u) inside = !inside;
    }
    return inside == keepInside_;
}

TrimRegion::Cover TrimRegion::cover(double u0, double v0, double u1, double v1) const {
    for (const Strip* s = &stripOf(v0); s != strips_.data() + strips_.size() && s->lo <= v1; ++s)
        for (uint32_t k = s->first; k < s->first + s->count; ++k) {
            const Piece& p = pieces_[active_[k]];
            if (p.right >= u0 && p.left <= u1 && std::max(p.v0, p.v1) >= v0 && std::min(p.v0, p.v1) <= v1) return Cover::Some;
        }
    return keeps(0.5 * (u0 + u1), 0.5 * (v0 + v1)) ? Cover::All : Cover::None;
}

bool TrimRegion::sample(double xi1, double xi2, double& u, double& v) const {
    auto i = std::upper_bound(strips_.begin(), strips_.end(), xi1, [](double x, const Strip& s) { return x < s.cumulative; });
    while (i != strips_.begin() && (i == strips_.end() || !(i->share > 0))) --i;
    const double within = i->share > 0 ? std::clamp((xi1 - (i->cumulative - i->share)) / i->share, 0.0, 1.0) : 0.5;
    v = i->lo + (i->hi - i->lo) * within;
    u = 0.5;
    thread_local std::vector<double> ends;
    intervals(v, ends);
    double length = 0;
    for (size_t k = 0; k + 1 < ends.size(); k += 2) length += ends[k + 1] - ends[k];
    if (!(length > 0)) return false;
    double at = xi2 * length;
    for (size_t k = 0; k + 1 < ends.size(); k += 2) {
        u = std::min(ends[k] + at, ends[k + 1]);
        if ((at -= ends[k + 1] - ends[k]) <= 0) break;
    }
    return true;
}

double TrimRegion::density(double v) const {
    const Strip& s = stripOf(v);
    const double length = keptLength(v);
    return length > 0 && s.hi > s.lo ? s.share / ((s.hi - s.lo) * length) : 0;
}

std::vector<TrimRegion::Node> TrimRegion::nodes() const {
    std::vector<Node> out;
    std::vector<double> ends;
    const int panels = strips_.size() > 4096 ? 1 : kPanels;
    for (const Strip& s : strips_)
        for (int p = 0; p < panels; ++p)
            for (int k = 0; k < 4; ++k) {
                const Quadrature q = smoothed(p, panels, k);
                const double v = s.lo + (s.hi - s.lo) * q.at, weight = q.weight * (s.hi - s.lo);
                intervals(v, ends);
                for (size_t e = 0; e + 1 < ends.size(); e += 2)
                    for (int a = 0; a < 2 * kPanels; ++a)
                        for (int b = 0; b < 4; ++b) {
                            const double h = (ends[e + 1] - ends[e]) / (2 * kPanels);
                            out.push_back({ends[e] + h * (a + kNode[b]), v, weight * h * kWeight[b]});
                        }
            }
    return out;
}

} // namespace alpenglow::geometry
