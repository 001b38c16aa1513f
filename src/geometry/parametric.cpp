#include "geometry/parametric.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {

void normalDerivatives(LocalPoint& p) {
    Vec3d c = cross(p.Pu, p.Pv);
    double l = length(c);
    if (!(l > 0)) return;
    Vec3d cu = cross(p.Puu, p.Pv) + cross(p.Pu, p.Puv), cv = cross(p.Puv, p.Pv) + cross(p.Pu, p.Pvv);
    p.nu = (cu - p.n * dot(p.n, cu)) / l;
    p.nv = (cv - p.n * dot(p.n, cv)) / l;
}

SurfacePoint Parametric::evaluateLocal(uint32_t, double u, double v) const {
    LocalPoint c = cameraPoint(u, v);
    SurfacePoint p;
    double o = orientation_;
    p.P = Vec3(c.P);
    p.dPdu = Vec3(c.Pu);
    p.dPdv = Vec3(c.Pv);
    p.Puu = Vec3(c.Puu);
    p.Puv = Vec3(c.Puv);
    p.Pvv = Vec3(c.Pvv);
    p.n = Vec3(c.n * o);
    p.dNdu = Vec3(c.nu * o);
    p.dNdv = Vec3(c.nv * o);
    Vec3d g = cross(c.Pu, c.Pv) * o;
    p.Ng = dot(g, g) > 0 ? Vec3(g) : p.n;
    p.u = float(u);
    p.v = float(v);
    p.orientation = orientation_;
    p.b1 = u;
    p.b2 = v;
    p.pError = roundingError(p.P) + float(4e-15 * pointScale_);
    p.face = faceAt(u, v);
    finishPoint(p, true);
    return p;
}

int Parametric::faceAt(double u, double v) const {
    const int pu = patchesU(), pv = patchesV();
    if (pu * pv <= 1) return 0;
    return std::clamp(int(v * pv), 0, pv - 1) * pu + std::clamp(int(u * pu), 0, pu - 1);
}

std::vector<double> Parametric::borders(int direction) const {
    const int n = direction == 0 ? patchesU() : patchesV();
    std::vector<double> b;
    for (int i = 0; i <= n; ++i) b.push_back(double(i) / n);
    return b;
}

double Parametric::sampleDensity(const SurfacePoint& p) const {
    double l = length(cross(Vec3d(p.dPdu), Vec3d(p.dPdv)));
    return l > 0 ? 1 / l : 0;
}

double Parametric::area() const {
    // Gauss-Legendre, 8 points a cell: the integrand is analytic inside a patch; 4 cells a patch tame poles.
    static constexpr double x[4] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
    static constexpr double w[4] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
    const std::vector<double> bu = borders(0), bv = borders(1);
    const int nu = int(bu.size()) - 1, nv = int(bv.size()) - 1, su = nu > 64 ? 1 : 4, sv = nv > 64 ? 1 : 4;
    double sum = 0;
    for (int j = 0; j < nv * sv; ++j)
        for (int i = 0; i < nu * su; ++i) {
            const double hu = (bu[size_t(i / su) + 1] - bu[size_t(i / su)]) / su,
                         hv = (bv[size_t(j / sv) + 1] - bv[size_t(j / sv)]) / sv;
            const double u0 = bu[size_t(i / su)] + hu * (i % su), v0 = bv[size_t(j / sv)] + hv * (j % sv);
            double cell = 0;
            for (int b = 0; b < 8; ++b)
                for (int a = 0; a < 8; ++a) {
                    LocalPoint p = cameraPoint(u0 + hu * (0.5 + 0.5 * (a < 4 ? x[a] : -x[a - 4])),
                                               v0 + hv * (0.5 + 0.5 * (b < 4 ? x[b] : -x[b - 4])));
                    cell += w[a & 3] * w[b & 3] * length(cross(p.Pu, p.Pv));
                }
            sum += cell * hu * hv;
        }
    return sum * 0.25;
}

int Parametric::bilinearWeights(double u, double v, int nu, int nv, bool wrapU, bool wrapV, Weight w[16]) {
    auto cell = [](double x, int n, bool wrap, int& i0, int& i1, double& f) {
        int cells = wrap ? n : n - 1;
        if (cells < 1) {
            i0 = i1 = 0;
            f = 0;
            return 0;
        }
        double s = x * cells;
        i0 = std::clamp(int(std::floor(s)), 0, cells - 1);
        f = s - i0;
        i1 = i0 + 1 == n ? 0 : i0 + 1;
        return cells;
    };
    int i0, i1, j0, j1;
    double a, b;
    int cu = cell(u, nu, wrapU, i0, i1, a), cv = cell(v, nv, wrapV, j0, j1, b);
    auto at = [&](int i, int j) { return size_t(j) * size_t(nu) + size_t(i); };
    w[0] = {at(i0, j0), (1 - a) * (1 - b), -cu * (1 - b), -cv * (1 - a)};
    w[1] = {at(i1, j0), a * (1 - b), cu * (1 - b), -cv * a};
    w[2] = {at(i0, j1), (1 - a) * b, -cu * b, cv * (1 - a)};
    w[3] = {at(i1, j1), a * b, cu * b, cv * a};
    return 4;
}

} // namespace alpenglow::geometry
