#include "pointcloud/shear.h"
#include "base/exact.h"
#include "pointcloud/area.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::pointcloud {

namespace {
constexpr double kShearUnit = 0x1p-14;
constexpr double kSameAngles = 1e-3; ///< tolerance for the entries of a metric with determinant 1
constexpr double kMostShear = 0x1p20;
} // namespace

Matrix Shear::matrix() const {
    Matrix m;
    size_t at = 0;
    for (size_t i = 0; i < 3; ++i)
        for (size_t j = 0; j <= i; ++j) m.m[i][j] = double(entries[at++]) * kShearUnit;
    return m;
}

std::optional<Shear> shearOf(const Matrix& toCloud) {
    bool singular = false;
    const Matrix back = inverse(toCloud, &singular);
    const double scale = exact::pow(std::fabs(determinant3(back)), -1.0 / 3);
    if (singular || !(scale > 0) || !std::isfinite(scale)) return {};
    // The metric of the scene in the cloud's space, and its Cholesky factor.
    double g[3][3], l[3][3] = {}, off = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            g[i][j] = 0;
            for (int k = 0; k < 3; ++k) g[i][j] += back.m[i][k] * scale * (back.m[j][k] * scale);
            off = std::max(off, std::fabs(g[i][j] - (i == j)));
        }
    if (!(off > kSameAngles)) return {};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j <= i; ++j) {
            double sum = g[i][j];
            for (int k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
            l[i][j] = i == j ? std::sqrt(sum) : sum / l[j][j];
        }
    Shear s;
    size_t at = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j <= i; ++j, ++at) {
            if (!(std::fabs(l[i][j]) < kMostShear) || (i == j && !(l[i][j] > kShearUnit))) return {};
            s.entries[at] = std::llround(l[i][j] / kShearUnit);
        }
    return s;
}

float areaGrowth(const Matrix& m, const Vec3& n) {
    return float(std::fabs(determinant3(m)) * length(transformNormal(m, Vec3d(n))));
}

void transform(PointCloud& c, const Matrix& m) {
    const int area = areaChannel(c);
    const double mean = exact::pow(std::fabs(determinant3(m)), 2.0 / 3);
    for (size_t i = 0; i < c.size(); ++i) {
        const bool ball = !(dot(c.N[i], c.N[i]) > 0);
        const double grows = ball ? mean : double(areaGrowth(m, c.N[i] / length(c.N[i])));
        c.P[i] = Vec3(transformPoint(m, Vec3d(c.P[i])));
        if (const Vec3 n(transformNormal(m, Vec3d(c.N[i]))); !ball && length(n) > 0) c.N[i] = n / length(n);
        c.radius[i] = float(double(c.radius[i]) * std::sqrt(grows));
        if (area < 0) continue;
        float& a = c.values[i * size_t(c.width()) + size_t(area)];
        a = float(double(a) * grows);
    }
}

} // namespace alpenglow::pointcloud
