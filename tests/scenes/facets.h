// Bicubic patches of a RIB file cut in triangles, as a renderer of the 1990s did before it drew them.
#pragma once
#include "base/vec.h"
#include <algorithm>
#include <cstdio>
#include <sstream>
#include <string>

namespace alpenglow::scenes {

/// How often a patch is cut in u and in v.
struct Cuts {
    int u, v;
};

/// A RIB file's text with every `Patch "bicubic" "P" [...]` (Bezier, object space) replaced by triangles with the patch's own
/// normals at their corners; `cuts` is asked with the text of the last line that began with '#'.
template <class F> std::string cutPatches(const std::string& rib, F cuts) {
    const std::string head = "Patch \"bicubic\" \"P\" [";
    std::string out;
    for (size_t at = 0;;) {
        const size_t patch = rib.find(head, at);
        out += rib.substr(at, patch - at);
        if (patch == std::string::npos) return out;
        const size_t end = rib.find(']', patch), comment = rib.rfind("\n#", patch);
        at = end + 1;
        const Cuts n = cuts(rib.substr(comment + 2, rib.find('\n', comment + 1) - comment - 2));
        std::istringstream numbers(rib.substr(patch + head.size(), end - patch - head.size()));
        Vec3d c[4][4];
        for (auto& row : c)
            for (Vec3d& p : row) numbers >> p.x >> p.y >> p.z;
        auto weights = [](double t, double b[4], double d[4]) {
            const double s = 1 - t;
            b[0] = s * s * s, b[1] = 3 * t * s * s, b[2] = 3 * t * t * s, b[3] = t * t * t;
            d[0] = -3 * s * s, d[1] = 3 * s * s - 6 * t * s, d[2] = 6 * t * s - 3 * t * t, d[3] = 3 * t * t;
        };
        auto sum = [&](const double u[4], const double v[4]) {
            Vec3d p(0, 0, 0);
            for (int j = 0; j < 4; ++j)
                for (int i = 0; i < 4; ++i) p = p + c[j][i] * (u[i] * v[j]);
            return p;
        };
        auto text = [](const Vec3d& p) {
            char s[80];
            std::snprintf(s, sizeof s, "%.9g %.9g %.9g ", p.x, p.y, p.z);
            return std::string(s);
        };
        std::string counts, corners, points, normals;
        for (int j = 0; j <= n.v; ++j)
            for (int i = 0; i <= n.u; ++i) {
                double b[2][4], d[2][4];
                const double u = double(i) / n.u, v = double(j) / n.v;
                weights(u, b[0], d[0]), weights(v, b[1], d[1]);
                points += text(sum(b[0], b[1]));
                // A hair inside, where no edge has shrunk to a point.
                weights(std::clamp(u, 1e-4, 1 - 1e-4), b[0], d[0]), weights(std::clamp(v, 1e-4, 1 - 1e-4), b[1], d[1]);
                const Vec3d normal = cross(sum(d[0], b[1]), sum(b[0], d[1]));
                normals += text(normal / length(normal));
                if (i == n.u || j == n.v) continue;
                const int p = j * (n.u + 1) + i, q = p + n.u + 1;
                counts += "3 3 ";
                for (int k : {p, p + 1, q + 1, p, q + 1, q}) corners += std::to_string(k) + " ";
            }
        out += "PointsPolygons [" + counts + "] [" + corners + "] \"P\" [" + points + "] \"N\" [" + normals + "]";
    }
}

} // namespace alpenglow::scenes
