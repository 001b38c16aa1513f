#include "base/matrix.h"
#include "base/exact.h"
#include <cstring>

namespace alpenglow {

bool operator==(const Matrix& a, const Matrix& b) {
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            if (a.m[i][j] != b.m[i][j]) return false;
    return true;
}

Matrix operator*(const Matrix& a, const Matrix& b) {
    Matrix r;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
            double s = 0;
            for (int k = 0; k < 4; ++k) s += a.m[i][k] * b.m[k][j];
            r.m[i][j] = s;
        }
    return r;
}

namespace {
// Gauss-Jordan with partial pivoting; returns the determinant, 0 when singular.
double invert(const Matrix& a, Matrix& out) {
    double w[4][8];
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
            w[i][j] = a.m[i][j];
            w[i][j + 4] = i == j;
        }
    double det = 1;
    for (int c = 0; c < 4; ++c) {
        int p = c;
        for (int r = c + 1; r < 4; ++r)
            if (std::fabs(w[r][c]) > std::fabs(w[p][c])) p = r;
        if (!(std::fabs(w[p][c]) > 0) || !std::isfinite(w[p][c])) return 0;
        if (p != c) {
            for (int j = 0; j < 8; ++j) std::swap(w[p][j], w[c][j]);
            det = -det;
        }
        det *= w[c][c];
        double inv = 1 / w[c][c];
        for (int j = 0; j < 8; ++j) w[c][j] *= inv;
        for (int r = 0; r < 4; ++r) {
            if (r == c) continue;
            double f = w[r][c];
            if (f != 0)
                for (int j = 0; j < 8; ++j) w[r][j] -= f * w[c][j];
        }
    }
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) out.m[i][j] = w[i][j + 4];
    return det;
}
} // namespace

Matrix inverse(const Matrix& a, bool* singular) {
    Matrix r;
    double d = invert(a, r);
    bool bad = d == 0 || !std::isfinite(d);
    if (singular) *singular = bad;
    return bad ? Matrix{} : r;
}

double determinant(const Matrix& a) {
    Matrix r;
    return invert(a, r);
}

double determinant3(const Matrix& a) {
    auto& m = a.m;
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

Matrix translateMatrix(double x, double y, double z) {
    Matrix r;
    r.m[3][0] = x;
    r.m[3][1] = y;
    r.m[3][2] = z;
    return r;
}

Matrix scaleMatrix(double x, double y, double z) {
    Matrix r;
    r.m[0][0] = x;
    r.m[1][1] = y;
    r.m[2][2] = z;
    return r;
}

Matrix rotateMatrix(double degrees, double x, double y, double z) {
    Vec3d a = normalize(Vec3d(x, y, z));
    const auto [s, c] = exact::sinCos(degrees * kPi / 180);
    Matrix r;
    double k = 1 - c;
    double rows[3][3] = {{a.x * a.x * k + c, a.x * a.y * k + a.z * s, a.x * a.z * k - a.y * s},
                         {a.x * a.y * k - a.z * s, a.y * a.y * k + c, a.y * a.z * k + a.x * s},
                         {a.x * a.z * k + a.y * s, a.y * a.z * k - a.x * s, a.z * a.z * k + c}};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) r.m[i][j] = rows[i][j];
    return r;
}

Matrix skewMatrix(double degrees, Vec3d d1, Vec3d d2) {
    d1 = normalize(d1);
    d2 = normalize(d2);
    double c = dot(d1, d2);
    Vec3d w = d1 - d2 * c;
    double s = length(w);
    if (!(s > 0)) return {};
    w = w / s;
    double th = exact::atan2(s, c), de = degrees * kPi / 180;
    double f = 1 / exact::tan(th - de) - 1 / exact::tan(th);
    Matrix r;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) r.m[i][j] += w[i] * f * d2[j];
    return r;
}

Matrix perspectiveMatrix(double fovDegrees) {
    double t = exact::tan(fovDegrees * kPi / 360);
    Matrix r;
    r.m[2][2] = t;
    r.m[2][3] = t;
    r.m[3][2] = -t;
    r.m[3][3] = 0;
    return r;
}

Vec3d transformPoint(const Matrix& a, Vec3d p) {
    auto& m = a.m;
    double x = p.x * m[0][0] + p.y * m[1][0] + p.z * m[2][0] + m[3][0];
    double y = p.x * m[0][1] + p.y * m[1][1] + p.z * m[2][1] + m[3][1];
    double z = p.x * m[0][2] + p.y * m[1][2] + p.z * m[2][2] + m[3][2];
    double w = p.x * m[0][3] + p.y * m[1][3] + p.z * m[2][3] + m[3][3];
    return w == 1 || w == 0 ? Vec3d(x, y, z) : Vec3d(x / w, y / w, z / w);
}

Vec3d transformVector(const Matrix& a, Vec3d v) {
    auto& m = a.m;
    return {v.x * m[0][0] + v.y * m[1][0] + v.z * m[2][0], v.x * m[0][1] + v.y * m[1][1] + v.z * m[2][1],
            v.x * m[0][2] + v.y * m[1][2] + v.z * m[2][2]};
}

Vec3d transformNormal(const Matrix& a, Vec3d n) {
    Matrix i = inverse(a);
    auto& m = i.m;
    return {n.x * m[0][0] + n.y * m[0][1] + n.z * m[0][2], n.x * m[1][0] + n.y * m[1][1] + n.z * m[1][2],
            n.x * m[2][0] + n.y * m[2][1] + n.z * m[2][2]};
}

} // namespace alpenglow
