#include "ri/motion.h"
#include "base/exact.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::ri {

scene::Transform inverse(const scene::Transform& m, bool* singular) {
    scene::Transform r = m;
    if (singular) *singular = false;
    for (Matrix& k : r.keys) {
        bool s = false;
        k = alpenglow::inverse(k, &s);
        if (singular && s) *singular = true;
    }
    return r;
}

namespace {

constexpr double kStep = 2.5; // degrees

Matrix upper(const Matrix& m) {
    Matrix r;
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 3; ++x) r.m[y][x] = m.m[y][x];
    return r;
}
Matrix transposed(const Matrix& m) {
    Matrix r;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) r.m[y][x] = m.m[x][y];
    return r;
}
Matrix mix(const Matrix& a, const Matrix& b, double w) {
    Matrix r;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) r.m[y][x] = (1 - w) * a.m[y][x] + w * b.m[y][x];
    return r;
}

/// The orthogonal factor of the upper 3x3, by Newton's iteration. False: there is none to be trusted.
bool orthogonal(const Matrix& m, Matrix& q) {
    q = upper(m);
    double change = 1;
    for (int i = 0; i < 60 && change > 1e-14; ++i) {
        bool singular = false;
        const Matrix next = mix(q, transposed(inverse(q, &singular)), 0.5);
        if (singular) return false;
        change = 0;
        for (int y = 0; y < 3; ++y)
            for (int x = 0; x < 3; ++x) change = std::max(change, std::fabs(next.m[y][x] - q.m[y][x]));
        q = next;
    }
    return change <= 1e-9;
}

void addKey(scene::Transform& out, double t, const Matrix& m) {
    if (!out.times.empty() && float(t) <= out.times.back()) return; // times too close for float
    out.times.push_back(float(t));
    out.keys.push_back(m);
}

} // namespace

void addMatrixKeys(scene::Transform& out, double t0, const Matrix& m0, double t1, const Matrix& m1) {
    const auto affine = [](const Matrix& m) { return m.m[0][3] == 0 && m.m[1][3] == 0 && m.m[2][3] == 0 && m.m[3][3] == 1; };
    if (out.keys.empty()) addKey(out, t0, m0);
    Matrix q0, q1;
    if (affine(m0) && affine(m1) && finite(m0) && finite(m1) && determinant3(m0) * determinant3(m1) > 0 && orthogonal(m0, q0) &&
        orthogonal(m1, q1)) {
        const Matrix d = transposed(q0) * q1;
        const Vec3d axis(d.m[1][2] - d.m[2][1], d.m[2][0] - d.m[0][2], d.m[0][1] - d.m[1][0]);
        const double sine = length(axis), angle = exact::atan2(sine, d.m[0][0] + d.m[1][1] + d.m[2][2] - 1) * 180 / kPi;
        const int n = angle < 179.9 && sine > 1e-9 ? int(std::ceil(angle / kStep)) : 1;
        const Matrix s0 = upper(m0) * transposed(q0), s1 = upper(m1) * transposed(q1);
        for (int i = 1; i < n; ++i) {
            const double w = double(i) / n;
            Matrix m = mix(s0, s1, w) * q0 * rotateMatrix(angle * w, axis.x, axis.y, axis.z);
            for (int x = 0; x < 3; ++x) m.m[3][x] = (1 - w) * m0.m[3][x] + w * m1.m[3][x];
            addKey(out, t0 + w * (t1 - t0), m);
        }
    }
    addKey(out, t1, m1);
}

bool finite(const Matrix& m) {
    for (auto& row : m.m)
        for (double v : row)
            if (!std::isfinite(v)) return false;
    return true;
}

void addRotationKeys(scene::Transform& out, double t0, double angle0, double t1, double angle1, double x, double y, double z) {
    int n = int(std::clamp(std::ceil(std::fabs(angle1 - angle0) / kStep), 1.0, 360.0));
    for (int i = out.keys.empty() ? 0 : 1; i <= n; ++i) {
        double w = double(i) / n;
        float t = float(i == n ? t1 : t0 + w * (t1 - t0));
        if (!out.times.empty() && t <= out.times.back()) continue; // times too close for float
        out.times.push_back(t);
        out.keys.push_back(rotateMatrix(angle0 + w * (angle1 - angle0), x, y, z));
    }
}

} // namespace alpenglow::ri
