#include "geometry/parametric.h"
#include "base/limits.h"
#include "geometry/dice.h"
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
            const double hu = (bu[size_t(i / su) + 1] - bu[size_t(i / su)]) / su, hv = (bv[size_t(j / sv) + 1] - bv[size_t(j / sv)]) / sv;
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
        if (cells < 1) { i0 = i1 = 0; f = 0; return 0; }
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

DiceLines Parametric::diceLines(const DiceOptions& opt, bool displaced, Diagnostics& diag) const {
    // Facets may stray from the surface by this many pixels; displacement needs whole micropolygons instead.
    constexpr double kDeviation = 0.05;
    double edge = diceEdge(*source_.attributes);
    const std::vector<double> borderU = borders(0), borderV = borders(1);
    const int pu = int(borderU.size()) - 1, pv = int(borderV.size()) - 1;
    std::vector<double> need[2] = {std::vector<double>(size_t(pu), 1.0), std::vector<double>(size_t(pv), 1.0)};
    constexpr int kProbe = 5;
    const auto probe = [&](const Parametric& shape, int i, int j) {
        const double wu = borderU[size_t(i) + 1] - borderU[size_t(i)], wv = borderV[size_t(j) + 1] - borderV[size_t(j)];
        for (int b = 0; b < kProbe; ++b)
            for (int a = 0; a < kProbe; ++a) {
                // Strictly inside the patch, so that knots do not mix neighbours' second derivatives.
                const double u = borderU[size_t(i)] + wu * (a + 0.5) / kProbe, v = borderV[size_t(j)] + wv * (b + 0.5) / kProbe;
                LocalPoint p = shape.cameraPoint(u, v);
                double lu = opt.camera.pixels(p.P, p.Pu) * wu / edge, lv = opt.camera.pixels(p.P, p.Pv) * wv / edge;
                if (!displaced) {
                    double tol = kDeviation * edge;
                    double cu = std::sqrt(opt.camera.pixels(p.P, p.Puu) / (8 * tol)) * wu;
                    double cv = std::sqrt(opt.camera.pixels(p.P, p.Pvv) / (8 * tol)) * wv;
                    double twist = std::sqrt(opt.camera.pixels(p.P, p.Puv) / (4 * tol)) * std::sqrt(wu * wv);
                    // 1.5: the probes miss the peak of what they sample.
                    lu = std::min(lu, 1.5 * std::max(cu, twist));
                    lv = std::min(lv, 1.5 * std::max(cv, twist));
                }
                need[0][size_t(i)] = std::max(need[0][size_t(i)], lu);
                need[1][size_t(j)] = std::max(need[1][size_t(j)], lv);
            }
    };
    for (int j = 0; j < pv; ++j)
        for (int i = 0; i < pu; ++i) {
            if (opt.keys.empty()) probe(*this, i, j);
            for (const ShapeRef& key : opt.keys)
                if (const auto* k = dynamic_cast<const Parametric*>(key.get()); k && k->patchesU() == pu && k->patchesV() == pv) probe(*k, i, j);
        }
    auto total = [](const std::vector<double>& n, double scale) {
        double s = 0;
        for (double x : n) s += std::clamp(std::ceil(x * scale), 1.0, double(limits::kDiceEdge));
        return s;
    };
    double scale = 1;
    while (total(need[0], scale) * total(need[1], scale) > double(limits::kDiceQuads) && scale > 1e-9) scale *= 0.7;
    if (scale < 1) {
        diag.report(Severity::Info, Rie::Limit, place(),
                    kind() + " would need more than " + std::to_string(limits::kDiceQuads) +
                        " micropolygons; it is diced more coarsely");
    }
    DiceLines lines;
    for (int k = 0; k < 2; ++k) {
        std::vector<float>& out = k == 0 ? lines.u : lines.v;
        std::vector<bool>& gap = k == 0 ? lines.gapU : lines.gapV;
        const std::vector<double>& at = k == 0 ? borderU : borderV;
        size_t n = need[k].size();
        for (size_t i = 0; i < n; ++i) {
            if (i && torn(k, at[i])) { // both sides have a line of their own
                out.push_back(std::nextafter(float(at[i]), 0.f));
                gap.resize(out.size());
                gap.back() = true;
            }
            int m = int(std::clamp(std::ceil(need[k][i] * scale), 1.0, double(limits::kDiceEdge)));
            for (int q = 0; q < m; ++q) out.push_back(float(at[i] + (at[i + 1] - at[i]) * q / m));
        }
        out.push_back(1.f);
        gap.resize(out.size());
    }
    auto isClosed = [](bool closed, std::vector<float>& l, std::vector<bool>& gap) {
        // A closed line needs three distinct points, or its two facets would coincide.
        if (closed && l.size() < 4) {
            l = {0.f, 0.33333334f, 0.6666667f, 1.f};
            gap.assign(l.size(), false);
        }
        return closed;
    };
    lines.closedU = isClosed(closedU(), lines.u, lines.gapU);
    lines.closedV = isClosed(closedV(), lines.v, lines.gapV);
    return lines;
}

void Parametric::dice(const DiceOptions& opt, Diagnostics& diag) {
    displaced_ = isDisplaced(*this, opt);
    if (!displaced_ && !needsDicing() && opt.keys.empty()) return;
    DiceLines lines = diceLines(opt, displaced_, diag);
    uint32_t nu = uint32_t(lines.u.size()), nv = uint32_t(lines.v.size());
    TriMesh m;
    m.P.resize(size_t(nu) * nv);
    std::vector<Vec2> param(size_t(nu) * nv);
    for (uint32_t j = 0; j < nv; ++j)
        for (uint32_t i = 0; i < nu; ++i) {
            size_t at = size_t(j) * nu + i;
            param[at] = {lines.u[i], lines.v[j]};
            // A closed surface meets itself to the bit, or rays would leak through the seam.
            if (lines.closedU && i + 1 == nu) m.P[at] = m.P[size_t(j) * nu];
            else if (lines.closedV && j + 1 == nv) m.P[at] = m.P[i];
            else m.P[at] = Vec3(cameraPosition(lines.u[i], lines.v[j]));
        }
    m.made.reserve(6 * size_t(nu - 1) * (nv - 1));
    auto length2 = [&](uint32_t a, uint32_t b) { Vec3 d = m.P[a] - m.P[b]; return dot(d, d); };
    for (uint32_t j = 0; j + 1 < nv; ++j)
        for (uint32_t i = 0; i + 1 < nu; ++i) {
            if (lines.gapU[i] || lines.gapV[j]) continue;
            uint32_t a = j * nu + i, b = a + 1, c = a + nu, d = c + 1;
            if (!opt.keys.empty() || length2(a, d) <= length2(b, c)) m.made.insert(m.made.end(), {a, b, d, a, d, c});
            else m.made.insert(m.made.end(), {a, b, c, b, d, c});
        }
    meshParam_ = std::move(param);
    trim(m);
    if (displaced_)
        displaceMesh(
            *this, opt, diag, [&](uint32_t i) { return evaluateLocal(0, meshParam_[i].x, meshParam_[i].y); },
            [&](uint32_t i) {
                auto step = [](const std::vector<float>& l, uint32_t k) {
                    return k + 1 < l.size() ? l[k + 1] - l[k] : l[k] - l[k - 1];
                };
                return Vec2{step(lines.u, i % nu), step(lines.v, i / nu)};
            },
            m);
    m.finish();
    mesh_ = std::move(m);
}

} // namespace alpenglow::geometry
