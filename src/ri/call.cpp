#include "ri/call.h"
#include <algorithm>
#include <cmath>
#include <limits>

namespace alpenglow::ri {

float toFloat(double d) {
    constexpr double kMax = std::numeric_limits<float>::max();
    if (!std::isfinite(d)) return float(d); // the caller checks that the value is finite
    return d > kMax ? float(kMax) : d < -kMax ? float(-kMax) : float(d);
}

float Call::real(size_t i, size_t k) const { return toFloat(arguments[i].numbers[k]); }

std::vector<float> toFloats(const std::vector<double>& from) {
    constexpr double kMax = std::numeric_limits<float>::max();
    std::vector<float> to(from.size());
    bool large = false; // or infinite
    for (size_t i = 0; i < from.size(); ++i) {
        large |= std::fabs(from[i]) > kMax;
        to[i] = float(std::min(std::max(from[i], -kMax), kMax));
    }
    for (size_t i = 0; large && i < from.size(); ++i) to[i] = toFloat(from[i]);
    return to;
}

std::vector<float> Call::reals(size_t i) const { return toFloats(arguments[i].numbers); }

std::vector<int> Call::ints(size_t i) const {
    const std::vector<double>& from = arguments[i].numbers;
    std::vector<int> to(from.size());
    for (size_t k = 0; k < from.size(); ++k) to[k] = int(from[k]);
    return to;
}

} // namespace alpenglow::ri
