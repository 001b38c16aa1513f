#include "scene/motion.h"
#include "scene/scene.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::scene {

Matrix at(const Transform& m, double t) {
    if (!m.moves() || t <= m.times.front()) return m.keys.front();
    if (t >= m.times.back()) return m.keys.back();
    const size_t i = size_t(std::lower_bound(m.times.begin() + 1, m.times.end(), t) - m.times.begin());
    double a = m.times[i - 1], b = m.times[i], w = (t - a) / (b - a);
    Matrix r;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) r.m[y][x] = (1 - w) * m.keys[i - 1].m[y][x] + w * m.keys[i].m[y][x];
    return r;
}

Transform compose(const Transform& a, const Transform& b) {
    if (!a.moves() && !b.moves()) return Transform(a.first() * b.first());
    Transform r;
    r.times.clear();
    r.keys.clear();
    if (a.moves()) r.times = a.times;
    if (b.moves()) r.times.insert(r.times.end(), b.times.begin(), b.times.end());
    std::sort(r.times.begin(), r.times.end());
    r.times.erase(std::unique(r.times.begin(), r.times.end()), r.times.end());
    for (float t : r.times) r.keys.push_back(at(a, double(t)) * at(b, double(t)));
    return r;
}

Shutter::Shutter(const Options& o) {
    double offset = 0;
    if (auto i = o.values.find("shutter:offset"); i != o.values.end() && !i->second.numbers.empty())
        offset = i->second.numbers[0];
    open = o.shutterOpen + offset;
    close = std::max(open, o.shutterClose + offset);
}

Transform overShutter(const Transform& m, const Shutter& s) {
    Transform r(at(m, s.open));
    if (!m.moves() || !s.opens()) return r;
    const auto add = [&](double part, const Matrix& key) {
        if (float(part) <= r.times.back()) return;
        r.times.push_back(float(part));
        r.keys.push_back(key);
    };
    bool moves = false;
    for (size_t i = 0; i < m.keys.size(); ++i) {
        const double part = (m.times[i] - s.open) / (s.close - s.open);
        if (part > 0 && part < 1) add(part, m.keys[i]);
    }
    add(1, at(m, s.close));
    for (const Matrix& k : r.keys) moves |= !(k == r.keys[0]);
    return moves ? r : Transform(r.keys[0]);
}

PrimitiveRef primitiveAt(const PrimitiveRef& p, double time) {
    if (p->motionKeys.empty() || p->motionTimes.size() != p->motionKeys.size() + 1) return p;
    const auto& times = p->motionTimes;
    const auto key = [&](size_t i) -> PrimitiveRef { return i == 0 ? p : p->motionKeys[i - 1]; };
    if (time <= times.front()) return p;
    if (time >= times.back()) return p->motionKeys.back();
    const size_t i = size_t(std::lower_bound(times.begin(), times.end(), time) - times.begin());
    if (double(times[i]) == time) return key(i);
    const PrimitiveRef a = key(i - 1), b = key(i);
    const double w = (time - times[i - 1]) / (double(times[i]) - times[i - 1]);
    auto out = std::make_shared<Primitive>(*a);
    out->motionKeys.clear();
    out->motionTimes.clear();
    const auto blend = [w](std::vector<float>& x, const std::vector<float>& y) {
        for (size_t k = 0; k < x.size() && k < y.size(); ++k) x[k] = float((1 - w) * x[k] + w * y[k]);
    };
    blend(out->numbers, b->numbers);
    for (Param& x : out->params)
        if (const Param* y = find(b->params, x.name); y && x.type != Type::Integer && x.type != Type::String)
            blend(x.numbers, y->numbers);
    return out;
}

std::vector<float> keysOverShutter(const Primitive& p, const Shutter& s) {
    std::vector<float> out{0};
    if (p.motionKeys.empty() || !s.opens() || p.motionTimes.front() >= s.close || p.motionTimes.back() <= s.open) return out;
    for (float t : p.motionTimes)
        if (const float part = float((t - s.open) / (s.close - s.open)); part > out.back() && part < 1) out.push_back(part);
    out.push_back(1);
    return out;
}

} // namespace alpenglow::scene
