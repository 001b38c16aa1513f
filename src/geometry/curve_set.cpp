// The arrays of a Curves request.
#include "geometry/curves.h"
#include "geometry/keyed.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {

using scene::Class;

namespace {

bool finite(const float* v, size_t n) {
    return std::all_of(v, v + n, [](float f) { return std::isfinite(f); });
}

void say(Diagnostics& diag, const scene::Primitive& p, Severity severity, const std::string& what) {
    diag.report(severity, Rie::Range, p.place, p.kind + ": " + what);
}

std::string many(size_t n, const char* what) { return std::to_string(n) + (n == 1 ? " curve " : " curves ") + what; }

} // namespace

Vec3d CurveSet::point(uint32_t vertex) const {
    const float* p = P_ + 3 * size_t(vertex);
    return {p[0], p[1], p[2]};
}

uint32_t CurveSet::vertexOf(const Row& r, uint32_t local, uint32_t k) const {
    const uint32_t i = local * step_ + k;
    return r.vertex + (periodic_ ? i % uint32_t((*counts_)[r.face]) : i);
}

uint32_t CurveSet::cornerOf(const Row& r, uint32_t local, uint32_t k) const {
    const uint32_t i = local + k, n = (&r)[1].segment - r.segment;
    return r.corner + (periodic_ ? i % n : i);
}

size_t CurveSet::classCount(Class c) const {
    switch (c) {
    case Class::Constant:
        return 1;
    case Class::Uniform:
        return counts_->size();
    case Class::Vertex:
        return vertices_;
    default:
        return varying_;
    }
}

void CurveSet::takeWidths(const ShapeSource& s, Diagnostics& diag) {
    const scene::Primitive& p = *s.primitive;
    static constexpr float kOne = 1; // RISpec 3.2, 5.5
    width_ = {&kOne, Class::Constant};
    const scene::Param *width = lastParam(p.params, "width"), *all = lastParam(p.params, "constantwidth");
    for (const scene::Param* w : {all, width}) {
        if (!w) continue;
        const Class cls = w == all ? Class::Constant : w->cls;
        if (w->numbers.size() < classCount(cls) || w->type == scene::Type::String) {
            diag.report(Severity::Error, Rie::MissingData, w->place,
                        p.kind + " \"" + w->name + "\": " + std::to_string(w->numbers.size()) + " values given, " +
                            std::to_string(classCount(cls)) + " needed; curves are 1 wide");
            continue;
        }
        width_ = {w->numbers.data(), cls};
    }
    const size_t n = classCount(width_.cls);
    if (std::any_of(width_.values, width_.values + n, [](float f) { return f < 0; }))
        say(diag, p, Severity::Warning, "negative widths count as 0");
}

bool CurveSet::take(const ShapeSource& s, Diagnostics& diag) {
    const scene::Primitive& p = *s.primitive;
    const auto fail = [&](Rie code, const std::string& why) {
        diag.report(Severity::Error, code, p.place, p.kind + ": " + why + "; it is not drawn");
        return false;
    };
    counts_ = &p.ints;
    linear_ = p.strings.empty() || p.strings[0] != "cubic";
    periodic_ = p.strings.size() > 1 && p.strings[1] == "periodic";
    const scene::Basis& b = s.attributes->vbasis;
    step_ = linear_ ? 1 : uint32_t(std::max(1, b.step));
    static constexpr double kToBezier[4][4] = {
        {0, 0, 0, 1}, {0, 0, 1. / 3, 1}, {0, 1. / 3, 2. / 3, 1}, {1, 1, 1, 1}}; // of a Bezier's inverse
    static constexpr double kBezier[4][4] = {{-1, 3, -3, 1}, {3, -6, 3, 0}, {-3, 3, 0, 0}, {1, 0, 0, 0}};
    bezier_ = true;
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 4; ++k) {
            basis_[i][k] = b.m[i][k];
            bezier_ &= b.m[i][k] == kBezier[i][k];
            if (!std::isfinite(b.m[i][k])) return fail(Rie::Range, "the basis holds a number that is not finite");
        }
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 4; ++k) {
            toBezier_[i][k] = 0;
            for (int j = 0; j < 4; ++j) toBezier_[i][k] += kToBezier[i][j] * basis_[j][k];
        }
    size_t points = 0;
    if (const scene::Param* P = lastParam(p.params, "P")) P_ = P->numbers.data(), points = P->numbers.size() / 3;
    else if (const scene::Param* Pw = lastParam(p.params, "Pw")) {
        points = Pw->numbers.size() / 4;
        bool alike = true;
        for (size_t i = 0; i < points; ++i) {
            const float* w = &Pw->numbers[4 * i];
            alike &= w[3] == Pw->numbers[3];
            for (int k = 0; k < 3; ++k) divided_.push_back(w[k] / w[3]);
        }
        P_ = divided_.data();
        if (!alike && !linear_)
            say(diag, p, Severity::Warning,
                "\"Pw\" with weights that differ: its points are divided by them, the curves are not rational");
    }
    if (!points) return fail(Rie::MissingData, "\"P\" is missing");
    if (p.ints.empty()) return fail(Rie::MissingData, "no number of points of any curve is given");
    for (int n : p.ints) {
        if (n < 0) return fail(Rie::Range, "a curve has " + std::to_string(n) + " points");
        vertices_ += size_t(n);
    }
    if (vertices_ > points)
        return fail(Rie::MissingData, std::to_string(points) + " points given, " + std::to_string(vertices_) + " needed");
    if (points > 0xfffffff0u) return fail(Rie::Limit, "too many points");
    return layOut(s, diag);
}

bool CurveSet::layOut(const ShapeSource& s, Diagnostics& diag) {
    const scene::Primitive& p = *s.primitive;
    const auto segmentsOf = [&](uint32_t n) -> uint32_t {
        if (linear_) return n < 2 ? 0 : periodic_ ? n : n - 1;
        return periodic_ ? n / step_ : n < 4 ? 0 : (n - 4) / step_ + 1;
    };
    for (int n : p.ints)
        if (const uint32_t k = segmentsOf(uint32_t(n))) varying_ += corners(k);
    takeWidths(s, diag);
    for (const scene::Param& q : p.params) {
        if (q.name != "N" || scene::componentCount(q.type) != 3 || q.arrayLength || q.numbers.size() < 3 * classCount(q.cls))
            continue;
        normal_ = q.numbers.data(); // takePrimvars() reports other errors
        normalClass_ = q.cls;
    }
    const bool key = isKey(s);
    size_t few = 0, notFinite = 0, still = 0, thin = 0;
    uint32_t vertex = 0, corner = 0;
    for (size_t face = 0; face < p.ints.size(); ++face) {
        const uint32_t n = uint32_t(p.ints[face]), k = segmentsOf(n);
        const Row row{vertex, corner, uint32_t(curveOf_.size()), uint32_t(face)};
        vertex += n;
        if (!k) {
            ++few;
            continue;
        }
        corner += corners(k);
        // The numbers of a class that belong to this curve.
        const auto own = [&](Class c, int width) -> std::pair<size_t, size_t> {
            if (c == Class::Constant) return {0, size_t(width)};
            if (c == Class::Uniform) return {face * size_t(width), size_t(width)};
            if (c == Class::Vertex) return {row.vertex * size_t(width), n * size_t(width)};
            return {row.corner * size_t(width), corners(k) * size_t(width)};
        };
        const auto [w, ws] = own(width_.cls, 1);
        bool good = finite(P_ + 3 * size_t(row.vertex), 3 * size_t(n)) && finite(width_.values + w, ws);
        if (normal_) {
            const auto [at, size] = own(normalClass_, 3);
            good &= finite(normal_ + at, size);
        }
        if (!good) {
            ++notFinite;
            continue;
        }
        // A key of a moving curve may have width 0 and others not.
        if (!key && std::all_of(width_.values + w, width_.values + w + ws, [](float f) { return !(f > 0); })) {
            ++thin;
            continue;
        }
        const Vec3d first = point(row.vertex);
        bool moves = key;
        for (uint32_t i = 1; i < n && !moves; ++i) moves = !(point(row.vertex + i) == first);
        if (!moves) {
            ++still;
            continue;
        }
        if (curveOf_.size() + k > 0x3fffffffu) {
            diag.report(Severity::Error, Rie::Limit, p.place,
                        p.kind + ": more than a thousand million segments; the rest is not drawn");
            break;
        }
        curveOf_.insert(curveOf_.end(), k, uint32_t(rows_.size()));
        for (uint32_t i = 0; i < k && simple(); ++i) firstOf_.push_back(row.vertex + i * step_);
        rows_.push_back(row);
    }
    rows_.push_back({vertex, corner, uint32_t(curveOf_.size()), 0});
    if (few) say(diag, p, Severity::Error, many(few, "with too few points; not drawn"));
    if (notFinite) say(diag, p, Severity::Error, many(notFinite, "with a number that is not finite; not drawn"));
    if (thin) say(diag, p, Severity::Warning, many(thin, "without a width; not drawn"));
    if (still) say(diag, p, Severity::Warning, many(still, "whose points coincide; not drawn"));
    return !curveOf_.empty();
}

uint32_t CurveSet::segmentAt(int face, double v, double& f) const {
    const auto r = std::lower_bound(rows_.begin(), rows_.end() - 2, uint32_t(std::max(face, 0)),
                                    [](const Row& a, uint32_t b) { return a.face < b; });
    const uint32_t n = (&*r)[1].segment - r->segment;
    const double x = std::clamp(v, 0.0, 1.0) * n;
    const uint32_t i = std::min(uint32_t(x), n - 1);
    f = x - i;
    return r->segment + i;
}

void CurveSet::load(uint32_t segment, CurveSegment& g) const {
    g.linear = linear_;
    // Loads a row only where it is needed: both are misses of the cache, and most segments are missed.
    const auto row = [&]() -> const Row& { return rows_[curveOf_[segment]]; };
    uint32_t vertex[4];
    if (linear_) {
        const Row& r = row();
        const uint32_t i = segment - r.segment, n = (&r)[1].segment - r.segment + !periodic_;
        const auto at = [&](uint32_t k) { return r.vertex + (periodic_ ? (i + n + k - 1) % n : std::clamp(i + k, 1u, n) - 1); };
        for (uint32_t k = 0; k < 4; ++k) g.p[k] = point(vertex[k] = at(k));
    } else {
        for (uint32_t k = 0; k < 4; ++k)
            vertex[k] = simple() ? firstOf_[segment] + k : vertexOf(row(), segment - row().segment, k);
        for (uint32_t k = 0; k < 4; ++k) g.p[k] = point(vertex[k]);
        if (!bezier_) {
            Vec3d q[4];
            for (int a = 0; a < 4; ++a)
                for (int b = 0; b < 4; ++b) q[a] += g.p[b] * toBezier_[a][b];
            std::copy(q, q + 4, g.p);
        }
    }
    // A value of any class in the segment's own form.
    const auto fill = [&](Class c, const auto& value, auto* out) {
        if (c == Class::Vertex && !linear_) {
            for (int a = 0; a < 4; ++a) {
                out[a] = value(vertex[0]) * (bezier_ ? double(a == 0) : toBezier_[a][0]);
                for (int b = 1; b < 4; ++b) out[a] = out[a] + value(vertex[b]) * (bezier_ ? double(a == b) : toBezier_[a][b]);
            }
            return;
        }
        uint32_t from = 0, to = 0;
        if (c == Class::Uniform) from = to = row().face;
        else if (c == Class::Vertex) from = vertex[1], to = vertex[2];
        else if (c != Class::Constant) {
            from = cornerOf(row(), segment - row().segment, 0);
            to = cornerOf(row(), segment - row().segment, 1);
        }
        const auto a = value(from), b = value(to);
        out[0] = a;
        if (linear_) out[1] = b;
        else out[1] = a + (b - a) * (1. / 3), out[2] = a + (b - a) * (2. / 3), out[3] = b;
    };
    fill(width_.cls, [&](uint32_t k) { return 0.5 * std::max(0.f, width_.values[k]); }, g.h);
    if (normal_)
        fill(
            normalClass_,
            [&](uint32_t k) { return Vec3d(normal_[3 * size_t(k)], normal_[3 * size_t(k) + 1], normal_[3 * size_t(k) + 2]); },
            g.n);
}

Vec3d CurveSet::axis(uint32_t segment) const {
    const Row& r = rows_[curveOf_[segment]];
    const uint32_t count = (&r)[1].segment - r.segment;
    const Vec3d chord = point(vertexOf(r, count - 1, linear_ ? 1 : 3)) - point(r.vertex);
    const double x = std::fabs(chord.x), y = std::fabs(chord.y), z = std::fabs(chord.z);
    return x <= y && x <= z ? Vec3d(1, 0, 0) : y <= z ? Vec3d(0, 1, 0) : Vec3d(0, 0, 1);
}

void CurveSet::fetch(uint32_t segment) const {
    const auto points = [&](uint32_t vertex) {
        __builtin_prefetch(P_ + 3 * size_t(vertex));
        __builtin_prefetch(P_ + 3 * size_t(vertex) + 11);
        if (width_.cls == Class::Vertex) __builtin_prefetch(width_.values + vertex);
    };
    const bool corners = width_.cls == Class::Varying || width_.cls == Class::FaceVarying;
    if (simple() && !corners) return points(firstOf_[segment]);
    const Row& r = rows_[curveOf_[segment]];
    points(vertexOf(r, segment - r.segment, 0));
    if (corners) __builtin_prefetch(width_.values + cornerOf(r, segment - r.segment, 0));
}

int CurveSet::weights(Class c, uint32_t segment, double f, Weight w[16]) const {
    const Row& r = rows_[curveOf_[segment]];
    const uint32_t i = segment - r.segment;
    const double n = (&r)[1].segment - r.segment;
    if (c == Class::Constant || c == Class::Uniform) {
        w[0] = {c == Class::Uniform ? r.face : 0u, 1, 0, 0};
        return 1;
    }
    if (c == Class::Vertex && !linear_) {
        const double p[4] = {f * f * f, f * f, f, 1}, d[4] = {3 * f * f, 2 * f, 1, 0};
        for (uint32_t k = 0; k < 4; ++k) {
            w[k] = {vertexOf(r, i, k), 0, 0, 0};
            for (int j = 0; j < 4; ++j) w[k].w += p[j] * basis_[j][k], w[k].dv += n * d[j] * basis_[j][k];
        }
        return 4;
    }
    for (uint32_t k = 0; k < 2; ++k) w[k].index = c == Class::Vertex ? vertexOf(r, i, k) : cornerOf(r, i, k);
    w[0].w = 1 - f, w[0].du = 0, w[0].dv = -n;
    w[1].w = f, w[1].du = 0, w[1].dv = n;
    return 2;
}

} // namespace alpenglow::geometry
