#include "ri/motion.h"
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

bool finite(const Matrix& m) {
    for (auto& row : m.m)
        for (double v : row)
            if (!std::isfinite(v)) return false;
    return true;
}

void addRotationKeys(scene::Transform& out, double t0, double angle0, double t1, double angle1, double x, double y, double z) {
    int n = int(std::clamp(std::ceil(std::fabs(angle1 - angle0) / 7.5), 1.0, 96.0));
    for (int i = out.keys.empty() ? 0 : 1; i <= n; ++i) {
        double w = double(i) / n;
        float t = float(i == n ? t1 : t0 + w * (t1 - t0));
        if (!out.times.empty() && t <= out.times.back()) continue; // times too close for float
        out.times.push_back(t);
        out.keys.push_back(rotateMatrix(angle0 + w * (angle1 - angle0), x, y, z));
    }
}

} // namespace alpenglow::ri
