#include "render/shutter.h"
#include "scene/scene.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::render {

ShutterOpening::ShutterOpening(const scene::Options& o, Diagnostics& diag) {
    const auto given = o.values.find("shutter:shutteropening");
    if (given == o.values.end()) return;
    const auto& n = given->second.numbers;
    if (n.size() == 2 && n[0] >= 0 && n[1] >= n[0] && n[1] <= 1) {
        wide = n[0];
        closing = n[1];
        return;
    }
    diag.report(Severity::Error, Rie::Range, given->second.place,
                "Option \"shutter\" \"shutteropening\" needs two numbers, 0 <= a <= b <= 1; the shutter opens and closes at "
                "once");
}

double ShutterOpening::at(double u) const {
    if (wide == 0 && closing == 1) return u;
    // Inverse of the area under a trapezoid.
    const double flat = closing - wide, all = flat + 0.5 * (1 - flat), area = u * all;
    if (area < 0.5 * wide) return std::sqrt(2 * wide * area);
    if (area < 0.5 * wide + flat) return wide + area - 0.5 * wide;
    return std::min(1.0, 1 - std::sqrt(2 * (1 - closing) * std::max(0.0, all - area)));
}

} // namespace alpenglow::render
