#include "ri/call.h"
#include <cmath>
#include <limits>

namespace alpenglow::ri {

float toFloat(double d) {
    constexpr double kMax = std::numeric_limits<float>::max();
    if (!std::isfinite(d)) return float(d); // the caller checks that the value is finite
    return d > kMax ? float(kMax) : d < -kMax ? float(-kMax) : float(d);
}

float Call::real(size_t i, size_t k) const { return toFloat(arguments[i].numbers[k]); }

std::vector<float> Call::reals(size_t i) const {
    std::vector<float> r;
    r.reserve(arguments[i].numbers.size());
    for (double d : arguments[i].numbers) r.push_back(toFloat(d));
    return r;
}

std::vector<int> Call::ints(size_t i) const {
    std::vector<int> r;
    r.reserve(arguments[i].numbers.size());
    for (double d : arguments[i].numbers) r.push_back(int(d));
    return r;
}

} // namespace alpenglow::ri
