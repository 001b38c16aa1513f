#include "ri/motion.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::ri {

Matrix at(const scene::Transform& m, double t) {
    if (!m.moves() || t <= m.times.front()) return m.keys.front();
    if (t >= m.times.back()) return m.keys.back();
    size_t i = 1;
    while (m.times[i] < t) ++i;
    double a = m.times[i - 1], b = m.times[i], w = (t - a) / (b - a);
    Matrix r;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) r.m[y][x] = (1 - w) * m.keys[i - 1].m[y][x] + w * m.keys[i].m[y][x];
    return r;
}

scene::Transform compose(const scene::Transform& a, const scene::Transform& b) {
    if (!a.moves() && !b.moves()) return scene::Transform(a.first() * b.first());
    scene::Transform r;
    r.times.clear();
    r.keys.clear();
    if (a.moves()) r.times = a.times;
    if (b.moves()) r.times.insert(r.times.end(), b.times.begin(), b.times.end());
    std::sort(r.times.begin(), r.times.end());
    r.times.erase(std::unique(r.times.begin(), r.times.end()), r.times.end());
    for (float t : r.times) r.keys.push_back(at(a, double(t)) * at(b, double(t)));
    return r;
}

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
