#include "display/deep.h"
#include <algorithm>
#include <array>
#include <cmath>

namespace alpenglow::display {

void DeepSamples::transmittanceAt(size_t pixel, double z, double out[3]) const {
    const auto begin = steps.begin() + long(first[pixel]), end = steps.begin() + long(first[pixel + 1]);
    const auto at = std::lower_bound(begin, end, z, [](const DeepStep& s, double depth) { return double(s.z) < depth; });
    for (int k = 0; k < 3; ++k) out[k] = at == begin ? 1 : double(std::prev(at)->transmittance[k]);
}

void meanStairs(std::vector<DeepChange>& all, size_t count, float tolerance, std::vector<DeepStep>& out) {
    const auto key = [](const DeepChange& c) {
        return std::array{c.z, c.before[0], c.before[1], c.before[2], c.after[0], c.after[1], c.after[2]};
    };
    std::sort(all.begin(), all.end(), [&](const DeepChange& a, const DeepChange& b) { return key(a) < key(b); });
    const size_t begin = out.size();
    double sum[3] = {double(count), double(count), double(count)};
    for (size_t i = 0, j; i < all.size(); i = j) {
        for (j = i; j < all.size() && all[j].z == all[i].z; ++j)
            for (int k = 0; k < 3; ++k) sum[k] += double(all[j].after[k]) - double(all[j].before[k]);
        DeepStep s{all[i].z, {}};
        for (int k = 0; k < 3; ++k) s.transmittance[k] = float(std::clamp(sum[k] / double(count), 0.0, 1.0));
        // A step closer than the tolerance to the previous one is merged with the next.
        const DeepStep before = out.size() > begin ? out.back() : DeepStep{};
        float most = 0;
        for (int k = 0; k < 3; ++k) most = std::max(most, std::fabs(s.transmittance[k] - before.transmittance[k]));
        if (j == all.size() || most > tolerance) out.push_back(s);
    }
}

} // namespace alpenglow::display
