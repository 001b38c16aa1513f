// Parts of a surface over a square that no ray can reach.
#include "geometry/parametric_dicing.h"

namespace alpenglow::geometry {

/// Patches that need no probing: no ray reaches them or their neighbours, whose sides depend on them. Empty: none known.
std::vector<uint8_t> Parametric::Dicing::unseenPatches(const std::vector<double>& u, const std::vector<double>& v) const {
    std::vector<uint8_t> away, out;
    Bounds b;
    if (!leavesOut() || !s.hull(u[0], v[0], u[1], v[1], b)) return out;
    const size_t nu = u.size() / 2, nv = v.size() / 2;
    for (size_t j = 0; j < nv; ++j)
        for (size_t i = 0; i < nu; ++i) {
            b = {};
            away.push_back(s.hull(u[2 * i], v[2 * j], u[2 * i + 1], v[2 * j + 1], b) && (*unseen)(b));
        }
    out.resize(away.size());
    for (size_t j = 0; j < nv; ++j)
        for (size_t i = 0; i < nu; ++i) {
            bool all = true;
            for (size_t b2 = 0; b2 < 3; ++b2) // around the seam of a closed surface, too
                for (size_t a = 0; a < 3; ++a) all &= away[(j + nv + b2 - 1) % nv * nu + (i + nu + a - 1) % nu] != 0;
            out[j * nu + i] = all;
        }
    return out;
}

void Parametric::Dicing::findUsed() {
    if (!leavesOut() || std::all_of(blocks.begin(), blocks.end(), [](const Block& k) { return k.seen; })) return;
    used.assign(param.size(), 0);
    for (const Block& k : blocks) {
        if (!k.seen) continue;
        for (const auto& points :
             {side(0, k.v0, k.u0, k.u1), side(0, k.v1, k.u0, k.u1), side(1, k.u0, k.v0, k.v1), side(1, k.u1, k.v0, k.v1)})
            for (const Point& p : points) used[p.vertex] = 1;
        if (k.first) std::fill_n(used.begin() + k.first, (k.cutU - 1) * (k.cutV - 1), uint8_t(1));
    }
}

/// Of all that is listed by vertex.
void Parametric::Dicing::dropUnused(std::vector<Vec3>& P, std::vector<uint32_t>& border) {
    if (used.empty()) return;
    std::vector<uint32_t> at(param.size());
    uint32_t n = 0;
    for (size_t i = 0; i < param.size(); ++i) {
        if (!used[i]) continue;
        param[n] = param[i], P[n] = P[i], step[n] = step[i];
        at[i] = n++;
    }
    param.resize(n), P.resize(n), step.resize(n);
    for (uint32_t& i : index) i = at[i];
    std::erase_if(border, [&](uint32_t i) { return !used[i]; });
    for (uint32_t& i : border) i = at[i];
}

} // namespace alpenglow::geometry
