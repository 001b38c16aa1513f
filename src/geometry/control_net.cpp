#include "geometry/control_net.h"
#include "base/limits.h"
#include "geometry/edge_curve.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {

using scene::Class;

NetDirection NetDirection::linear(int n, bool wrap) {
    NetDirection d;
    d.n_ = n;
    d.wrap_ = wrap;
    d.patches_ = wrap ? n : n - 1;
    d.width_ = 2;
    return d;
}

NetDirection NetDirection::cubic(int n, bool wrap, const scene::Basis& b) {
    NetDirection d;
    d.n_ = n;
    d.wrap_ = wrap;
    d.step_ = std::max(1, b.step);
    d.width_ = 4;
    d.patches_ = wrap ? n / d.step_ : (n - 4) / d.step_ + 1;
    for (size_t i = 0; i < 4; ++i)
        for (size_t j = 0; j < 4; ++j) d.m_[i][j] = b.m[i][j];
    return d;
}

NetDirection NetDirection::nurbs(int n, int order, std::vector<double> knots, double lo, double hi) {
    NetDirection d;
    d.n_ = n;
    d.order_ = order;
    d.patches_ = n - order + 1;
    d.knots_ = std::move(knots);
    d.lo_ = lo;
    d.hi_ = hi;
    return d;
}

int NetDirection::spanOf(double t) const {
    const auto first = knots_.begin() + order_ - 1, last = knots_.begin() + n_;
    int span = int(std::upper_bound(first + 1, last, t) - knots_.begin()) - 1;
    while (span > order_ - 1 && knots_[size_t(span)] == knots_[size_t(span) + 1]) --span; // the end of the last real interval
    return span;
}

std::vector<double> NetDirection::borders() const {
    std::vector<double> b{0};
    if (order_ == 0) {
        for (int i = 1; i < patches_; ++i) b.push_back(double(i) / patches_);
    } else {
        for (int i = order_; i < n_; ++i) {
            const double x = (knots_[size_t(i)] - lo_) / (hi_ - lo_);
            if (x > b.back() && x < 1) b.push_back(x);
        }
    }
    b.push_back(1);
    return b;
}

bool NetDirection::torn(double border) const {
    if (order_ == 0) return false;
    int times = 0;
    for (int i = order_; i < n_; ++i) times += (knots_[size_t(i)] - lo_) / (hi_ - lo_) == border;
    return times >= order_;
}

NetDirection::Cell NetDirection::cell(double x) const {
    x = std::clamp(x, 0.0, 1.0);
    if (order_ == 0) {
        const int i = std::clamp(int(x * patches_), 0, patches_ - 1);
        return {i, x * patches_ - i, double(patches_)};
    }
    const double t = lo_ + x * (hi_ - lo_);
    const int span = spanOf(t);
    const double first = knots_[size_t(span)], length = knots_[size_t(span) + 1] - first;
    return {span - (order_ - 1), length > 0 ? std::clamp((t - first) / length, 0.0, 1.0) : 0,
            length > 0 ? (hi_ - lo_) / length : 0};
}

bool NetDirection::convex() const {
    if (order_ > 0) return true;
    if (width_ < 4) return true;
    for (size_t p = 0; p < 4; ++p) // powers 3..0 of the sum of all weights, which is 1
        if (!(std::fabs(m_[p][0] + m_[p][1] + m_[p][2] + m_[p][3] - (p == 3)) < 1e-6)) return false;
    // A cubic that is below 0 somewhere between 0 and 1 has a Bezier coefficient below 0.
    for (size_t k = 0; k < 4; ++k) {
        const double a = m_[0][k], b = m_[1][k], c = m_[2][k], d = m_[3][k];
        for (const double bezier : {d, d + c / 3, d + 2 * c / 3 + b / 3, a + b + c + d})
            if (bezier < -1e-9) return false;
    }
    return true;
}

BasisSpan NetDirection::at(double x) const {
    BasisSpan s;
    x = std::clamp(x, 0.0, 1.0);
    if (order_ > 0) {
        double t = lo_ + x * (hi_ - lo_);
        const int k = order_ - 1, span = spanOf(t);
        // Cox-de Boor, degree by degree; derivatives by the difference rule from one and two degrees lower.
        auto K = [&](int i) { return knots_[size_t(i)]; };
        auto basis = [&](int degree, double* b) { // b[0..degree]: functions span-degree .. span
            b[0] = 1;
            for (int p = 1; p <= degree; ++p) {
                double saved = 0;
                for (int r = 0; r < p; ++r) {
                    double right = K(span + r + 1), left = K(span + 1 - p + r), den = right - left;
                    double q = den > 0 ? b[r] / den : 0;
                    b[r] = saved + (right - t) * q;
                    saved = (t - left) * q;
                }
                b[p] = saved;
            }
        };
        auto derive = [&](int degree, const double* lower, double* out) { // lower: degree - 1 functions or their derivatives
            for (int r = 0; r <= degree; ++r) {
                int i = span - degree + r;
                double a = 0, c = 0;
                if (r > 0 && K(i + degree) > K(i)) a = lower[r - 1] / (K(i + degree) - K(i));
                if (r < degree && K(i + degree + 1) > K(i + 1)) c = lower[r] / (K(i + degree + 1) - K(i + 1));
                out[r] = degree * (a - c);
            }
        };
        constexpr int kMost = limits::kNurbsOrder;
        double b[kMost], b1[kMost], b2[kMost], d1[kMost], e[kMost], dd[kMost];
        basis(k, b);
        std::fill(d1, d1 + order_, 0.0);
        std::fill(dd, dd + order_, 0.0);
        if (k >= 1) basis(k - 1, b1), derive(k, b1, d1);
        if (k >= 2) basis(k - 2, b2), derive(k - 1, b2, e), derive(k, e, dd);
        double scale = hi_ - lo_;
        s.count = order_;
        for (int r = 0; r <= k; ++r) {
            s.index[r] = span - k + r;
            s.w[r] = b[r];
            s.d[r] = d1[r] * scale;
            s.dd[r] = dd[r] * scale * scale;
        }
        return s;
    }
    int cell = std::clamp(int(x * patches_), 0, patches_ - 1);
    double t = x * patches_ - cell, k = patches_;
    s.count = width_;
    for (int i = 0; i < width_; ++i) {
        int at = cell * step_ + i;
        s.index[i] = wrap_ ? at % n_ : at;
        if (width_ == 2) {
            s.w[i] = i ? t : 1 - t;
            s.d[i] = i ? k : -k;
            s.dd[i] = 0;
        } else {
            size_t c = size_t(i);
            s.w[i] = ((m_[0][c] * t + m_[1][c]) * t + m_[2][c]) * t + m_[3][c];
            s.d[i] = ((3 * m_[0][c] * t + 2 * m_[1][c]) * t + m_[2][c]) * k;
            s.dd[i] = (6 * m_[0][c] * t + 2 * m_[1][c]) * k * k;
        }
    }
    return s;
}

template <class Points>
std::vector<std::array<double, 4>> NetDirection::bezier(int patch, double from, double to, const Points& points) const {
    using Point = std::array<double, 4>;
    std::vector<Point> out;
    if (order_ > 0) { // blossoms: de Boor's scheme with `from` and `to` replacing the parameter
        const double a = lo_ + from * (hi_ - lo_), b = lo_ + to * (hi_ - lo_);
        const int k = order_ - 1, span = spanOf(0.5 * (a + b));
        for (int r = 0; r <= k; ++r) {
            std::vector<Point> d;
            for (int i = 0; i <= k; ++i) d.push_back(points(span - k + i));
            for (int p = 1; p <= k; ++p) {
                const double t = p <= r ? b : a;
                for (int i = k; i >= p; --i) {
                    const double lower = knots_[size_t(span - k + i)], upper = knots_[size_t(span + 1 + i - p)];
                    const double w = upper > lower ? (t - lower) / (upper - lower) : 0;
                    for (size_t c = 0; c < 4; ++c) d[size_t(i)][c] = d[size_t(i) - 1][c] * (1 - w) + d[size_t(i)][c] * w;
                }
            }
            out.push_back(d.back());
        }
        return out;
    }
    for (int i = 0; i < width_; ++i) {
        const int at = patch * step_ + i;
        out.push_back(points(wrap_ ? at % n_ : at));
    }
    constexpr std::array<std::array<double, 4>, 4> own{{{-1, 3, -3, 1}, {3, -6, 3, 0}, {-3, 3, 0, 0}, {1, 0, 0, 0}}};
    if (width_ == 2 || m_ == own) return out;
    for (size_t c = 0; c < 4; ++c) {
        double k[4] = {}; // by power 3..0
        for (size_t r = 0; r < 4; ++r)
            for (size_t i = 0; i < 4; ++i) k[r] += m_[r][i] * out[i][c];
        const double b[4] = {k[3], k[3] + k[2] / 3, k[3] + k[2] * 2 / 3 + k[1] / 3, k[3] + k[2] + k[1] + k[0]};
        for (size_t i = 0; i < 4; ++i) out[i][c] = b[i];
    }
    return out;
}

bool ControlNet::edgeCurve(int side, int cell, double from, double to, EdgeCurve& out) const {
    const bool alongU = side == 0 || side == 2;
    const NetDirection &along = alongU ? u_ : v_, &across = alongU ? v_ : u_;
    const BasisSpan b = across.at(side == 1 || side == 2 ? 1 : 0);
    const auto point = [&](int i) {
        std::array<double, 4> sum{};
        for (int j = 0; j < b.count; ++j) {
            const size_t k = alongU ? size_t(b.index[j]) * size_t(u_.points()) + size_t(i)
                                    : size_t(i) * size_t(u_.points()) + size_t(b.index[j]);
            for (size_t c = 0; c < 4; ++c) sum[c] += b.w[j] * points_[k][c];
        }
        return sum;
    };
    const auto bezier = along.bezier(cell, from, to, point);
    for (const auto& p : bezier)
        if (!(std::fabs(p[3]) > 1e-30)) return false; // a weight that vanishes
    out = EdgeCurve::bezier(bezier);
    return true;
}

ControlNet::ControlNet(ShapeSource s, NetDirection u, NetDirection v, std::vector<std::array<double, 4>> points,
                       Diagnostics& diag, std::shared_ptr<const TrimRegion> trim)
    : Parametric(std::move(s)), u_(std::move(u)), v_(std::move(v)), points_(std::move(points)), trim_(std::move(trim)) {
    mostWeights_ = std::max(mostWeights_, u_.width() * v_.width());
    for (auto& p : points_) {
        if (p[3] != 1) rational_ = true;
        if (p[3] == 0) continue; // a direction
        for (size_t k = 0; k < 3; ++k) pointScale_ = std::max(pointScale_, std::fabs(p[k] / p[3]));
    }
    closedU_ = u_.wrap() || sameEdge(true);
    closedV_ = v_.wrap() || sameEdge(false);
    convex_ = u_.convex() && v_.convex();
    for (const auto& p : points_) convex_ &= p[3] > 0;
    takePrimvars(diag);
}

bool ControlNet::hull(double u0, double v0, double u1, double v1, Bounds& out) const {
    if (!convex_) return false;
    const auto add = [&](size_t i) {
        const auto& p = points_[i];
        out.add(Vec3(Vec3d(p[0] / p[3], p[1] / p[3], p[2] / p[3])));
    };
    if (u0 == 0 && v0 == 0 && u1 == 1 && v1 == 1) {
        for (size_t i = 0; i < points_.size(); ++i) add(i);
        return true;
    }
    const BasisSpan a = u_.at(0.5 * (u0 + u1)), b = v_.at(0.5 * (v0 + v1));
    for (int j = 0; j < b.count; ++j)
        for (int i = 0; i < a.count; ++i) add(size_t(b.index[j]) * size_t(u_.points()) + size_t(a.index[i]));
    return true;
}

// Whether the edges u = 0 and u = 1 (alongV) are one curve: many old models close a patch by repeating its points.
bool ControlNet::sameEdge(bool alongV) const {
    constexpr int kProbe = 9;
    for (int i = 0; i < kProbe; ++i) {
        double x = double(i) / (kProbe - 1);
        Vec3 a(alongV ? cameraPosition(0, x) : cameraPosition(x, 0)), b(alongV ? cameraPosition(1, x) : cameraPosition(x, 1));
        if (length(a - b) > 4 * roundingError(a)) return false;
    }
    return true;
}

Vec3d ControlNet::cameraPosition(double u, double v) const {
    BasisSpan a = u_.at(u), b = v_.at(v);
    double x = 0, y = 0, z = 0, w = 0;
    for (int j = 0; j < b.count; ++j)
        for (int i = 0; i < a.count; ++i) {
            const auto& p = points_[size_t(b.index[j]) * size_t(u_.points()) + size_t(a.index[i])];
            double k = a.w[i] * b.w[j];
            x += k * p[0];
            y += k * p[1];
            z += k * p[2];
            w += k * p[3];
        }
    return rational_ && w != 0 ? Vec3d(x / w, y / w, z / w) : Vec3d(x, y, z);
}

void ControlNet::differentiate(double u, double v, LocalPoint& r) const {
    BasisSpan a = u_.at(u), b = v_.at(v);
    double f[6][4] = {};
    for (int j = 0; j < b.count; ++j)
        for (int i = 0; i < a.count; ++i) {
            const auto& p = points_[size_t(b.index[j]) * size_t(u_.points()) + size_t(a.index[i])];
            double k[6] = {a.w[i] * b.w[j],  a.d[i] * b.w[j], a.w[i] * b.d[j],
                           a.dd[i] * b.w[j], a.d[i] * b.d[j], a.w[i] * b.dd[j]};
            for (int q = 0; q < 6; ++q)
                for (size_t c = 0; c < 4; ++c) f[q][c] += k[q] * p[c];
        }
    auto v3 = [&](int q) { return Vec3d(f[q][0], f[q][1], f[q][2]); };
    if (!rational_ || f[0][3] == 0) {
        r.P = v3(0);
        r.Pu = v3(1);
        r.Pv = v3(2);
        r.Puu = v3(3);
        r.Puv = v3(4);
        r.Pvv = v3(5);
        return;
    }
    double w = f[0][3], wu = f[1][3], wv = f[2][3], wuu = f[3][3], wuv = f[4][3], wvv = f[5][3];
    r.P = v3(0) / w;
    r.Pu = (v3(1) - r.P * wu) / w;
    r.Pv = (v3(2) - r.P * wv) / w;
    r.Puu = (v3(3) - r.Pu * (2 * wu) - r.P * wuu) / w;
    r.Puv = (v3(4) - r.Pu * wv - r.Pv * wu - r.P * wuv) / w;
    r.Pvv = (v3(5) - r.Pv * (2 * wv) - r.P * wvv) / w;
}

LocalPoint ControlNet::cameraPoint(double u, double v) const {
    LocalPoint r;
    differentiate(u, v, r);
    auto normalOf = [](const LocalPoint& p, Vec3d& n) {
        Vec3d c = cross(p.Pu, p.Pv);
        double l = length(c);
        if (!(l > 1e-12 * (dot(p.Pu, p.Pu) + dot(p.Pv, p.Pv)))) return false;
        n = c / l;
        return true;
    };
    if (normalOf(r, r.n)) {
        normalDerivatives(r);
        return r;
    }
    // An edge collapsed to a point, or a cusp: the normal of a point a little inside.
    for (double step : {1e-4, 1e-3, 1e-2}) {
        LocalPoint q;
        differentiate(u + (u < 0.5 ? step : -step), v + (v < 0.5 ? step : -step), q);
        if (normalOf(q, r.n)) return r;
    }
    r.n = Vec3d(0, 0, -1);
    return r;
}

int ControlNet::faceAt(double u, double v) const { return v_.cell(v).patch * u_.patches() + u_.cell(u).patch; }

void ControlNet::trim(TriMesh& m) {
    if (!trim_) return;
    std::vector<uint32_t> kept;
    edge_.clear();
    for (size_t t = 0; t + 3 <= m.made.size(); t += 3) {
        const Vec2 a = meshParam_[m.made[t]], b = meshParam_[m.made[t + 1]], c = meshParam_[m.made[t + 2]];
        const auto cover = trim_->cover(std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::max({a.x, b.x, c.x}),
                                        std::max({a.y, b.y, c.y}));
        if (cover == TrimRegion::Cover::None) continue;
        kept.insert(kept.end(), {m.made[t], m.made[t + 1], m.made[t + 2]});
        edge_.push_back(cover == TrimRegion::Cover::Some);
    }
    m.made = std::move(kept);
    trimmed_ = true;
}

bool ControlNet::keepsHit(uint32_t prim, double b1, double b2) const {
    if (prim >= edge_.size() || !edge_[prim]) return true;
    const uint32_t* i = &mesh_.index[3 * size_t(prim)];
    const Vec2 p0 = meshParam_[i[0]], p1 = meshParam_[i[1]], p2 = meshParam_[i[2]];
    const double b0 = 1 - b1 - b2;
    return trim_->keeps(b0 * p0.x + b1 * p1.x + b2 * p2.x, b0 * p0.y + b1 * p1.y + b2 * p2.y);
}

double ControlNet::area() const {
    if (!trim_) return Parametric::area();
    double sum = 0;
    for (const TrimRegion::Node& n : trim_->nodes()) {
        const LocalPoint p = cameraPoint(n.u, n.v);
        sum += n.weight * length(cross(p.Pu, p.Pv));
    }
    return sum;
}

SurfacePoint ControlNet::sampleArea(double xi1, double xi2) const {
    double u = xi1, v = xi2;
    if (trim_) trim_->sample(xi1, xi2, u, v); // if there is none the density is 0
    return evaluateLocal(0, u, v);
}

double ControlNet::sampleDensity(const SurfacePoint& p) const {
    return trim_ ? Parametric::sampleDensity(p) * trim_->density(p.b2) : Parametric::sampleDensity(p);
}

size_t ControlNet::classCount(Class c) const {
    switch (c) {
    case Class::Constant:
        return 1;
    case Class::Uniform:
        return size_t(faces());
    case Class::Vertex:
        return points_.size();
    default:
        return size_t(u_.varyings()) * size_t(v_.varyings());
    }
}

int ControlNet::weights(Class c, const SurfacePoint& p, Weight w[16]) const {
    if (c == Class::Constant || c == Class::Uniform) {
        w[0] = {c == Class::Uniform ? size_t(p.face) : 0, 1, 0, 0};
        return 1;
    }
    if (c != Class::Vertex) {
        const NetDirection::Cell i = u_.cell(p.b1), j = v_.cell(p.b2);
        const int nu = u_.varyings(), i1 = (i.patch + 1) % nu, j1 = (j.patch + 1) % v_.varyings();
        auto at = [&](int a, int b) { return size_t(b) * size_t(nu) + size_t(a); };
        w[0] = {at(i.patch, j.patch), (1 - i.at) * (1 - j.at), -i.slope * (1 - j.at), -j.slope * (1 - i.at)};
        w[1] = {at(i1, j.patch), i.at * (1 - j.at), i.slope * (1 - j.at), -j.slope * i.at};
        w[2] = {at(i.patch, j1), (1 - i.at) * j.at, -i.slope * j.at, j.slope * (1 - i.at)};
        w[3] = {at(i1, j1), i.at * j.at, i.slope * j.at, j.slope * i.at};
        return 4;
    }
    BasisSpan a = u_.at(p.b1), b = v_.at(p.b2);
    int n = 0;
    for (int j = 0; j < b.count; ++j)
        for (int i = 0; i < a.count; ++i)
            w[n++] = {size_t(b.index[j]) * size_t(u_.points()) + size_t(a.index[i]), a.w[i] * b.w[j], a.d[i] * b.w[j],
                      a.w[i] * b.d[j]};
    return n;
}

namespace {

/// For a net with control points of weight 0: whether the weight vanishes at ends of patches, or between.
bool atInfinity(const NetDirection& u, const NetDirection& v, const std::vector<std::array<double, 4>>& points) {
    const auto zero = [](const std::array<double, 4>& p) { return p[3] == 0; };
    if (std::none_of(points.begin(), points.end(), zero)) return false;
    double most = 0;
    for (const auto& p : points) most = std::max(most, std::fabs(p[3]));
    const auto places = [](const NetDirection& d) {
        const std::vector<double> borders = d.borders();
        std::vector<BasisSpan> at{d.at(0)};
        for (size_t i = 0; i + 1 < borders.size(); ++i)
            for (const double way : {.5, 1.}) at.push_back(d.at(borders[i] + way * (borders[i + 1] - borders[i])));
        return at;
    };
    const std::vector<BasisSpan> along = places(u), across = places(v);
    for (const BasisSpan& b : across)
        for (const BasisSpan& a : along) {
            double w = 0;
            for (int j = 0; j < b.count; ++j)
                for (int i = 0; i < a.count; ++i)
                    w += a.w[i] * b.w[j] * points[size_t(b.index[j]) * size_t(u.points()) + size_t(a.index[i])][3];
            if (!(std::fabs(w) > 1e-12 * most)) return true;
        }
    return false;
}

} // namespace

ShapeRef makeNet(ShapeSource s, NetDirection u, NetDirection v, std::vector<std::array<double, 4>> points, Diagnostics& diag,
                 std::shared_ptr<const TrimRegion> trim) {
    if (atInfinity(u, v, points)) {
        diag.report(Severity::Error, Rie::Range, s.primitive->place,
                    s.primitive->kind + ": the weights of \"Pw\" vanish, so it reaches infinity; it is not drawn");
        return nullptr;
    }
    return std::make_shared<ControlNet>(std::move(s), std::move(u), std::move(v), std::move(points), diag, std::move(trim));
}

bool readControlPoints(const ShapeSource& s, int nu, int nv, bool wrapU, bool wrapV, Diagnostics& diag,
                       std::vector<std::array<double, 4>>& out) {
    const scene::Primitive& p = *s.primitive;
    const Matrix& m = s.toCamera;
    size_t n = size_t(nu) * size_t(nv);
    auto fail = [&](Rie code, const std::string& why) {
        diag.report(Severity::Error, code, p.place, p.kind + ": " + why + "; it is not drawn");
        return false;
    };
    int width = 3;
    const scene::Param* q = lastParam(p.params, "P");
    if (!q) q = lastParam(p.params, "Pw"), width = 4;
    if (!q) q = lastParam(p.params, "Pz"), width = 1;
    if (!q) return fail(Rie::MissingData, "\"P\", \"Pw\" or \"Pz\" is missing");
    if (q->name == "P" && q->type == scene::Type::HPoint) width = 4;
    if (n > limits::kControlPoints) return fail(Rie::Limit, "too many control points");
    if (q->numbers.size() < n * size_t(width))
        return fail(Rie::MissingData, "\"" + q->name + "\" has " + std::to_string(q->numbers.size()) + " numbers, " +
                                          std::to_string(n * size_t(width)) + " needed");
    out.resize(n);
    for (size_t k = 0; k < n; ++k) {
        const float* f = &q->numbers[k * size_t(width)];
        double h[4] = {0, 0, 0, 1};
        if (width == 1) {
            // A height field over the unit square.
            int du = wrapU ? nu : nu - 1, dv = wrapV ? nv : nv - 1;
            const size_t row = k / size_t(nu);
            h[0] = double(k % size_t(nu)) / du;
            h[1] = double(row) / dv;
            h[2] = f[0];
        } else {
            for (int c = 0; c < width; ++c) h[c] = f[c];
        }
        for (double x : h)
            if (!std::isfinite(x)) return fail(Rie::Range, "\"" + q->name + "\" holds a number that is not finite");
        if (width == 4 && !(std::fabs(h[3]) > 1e-30)) h[3] = 0;
        for (size_t c = 0; c < 4; ++c) out[k][c] = h[0] * m.m[0][c] + h[1] * m.m[1][c] + h[2] * m.m[2][c] + h[3] * m.m[3][c];
    }
    return true;
}

} // namespace alpenglow::geometry
