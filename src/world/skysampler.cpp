#include "world/skysampler.h"
#include "base/exact.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::world {

namespace {
/// Bright directions are a stratum if they have this share of the light, and no larger part of all directions: then few lobe rays
/// find them, and samples outside of them are not wasted.
constexpr double kLeastBright = .1, kMostBright = .97, kMostArea = .02;

/// The multiple of 1/4 nearest to a share, or 7/8: multiples of powers of 1/2 keep a net's number of points in a stratum exact.
float chanceOf(double share) { return share > .8125 ? .875f : float(std::clamp(std::round(share * 4), 1., 3.) / 4); }
} // namespace

SkySampler::SkySampler(int width, int height, std::vector<float> weights, std::vector<SkyTable::Refined> refined)
    : rest_(std::make_unique<SkyTable>(width, height, weights, refined)) {
    integral_ = rest_->integral();
    concentration_ = rest_->concentration();
    if (!(integral_ > 0)) return;
    const float limit = float(kBright * integral_ / (4 * kPi));
    std::vector<float> bright(weights.size(), 0);
    std::vector<SkyTable::Refined> brightParts, restParts;
    const auto take = [&](size_t cell) { std::swap(bright[cell], weights[cell]); };
    std::vector<char> divided(weights.size(), 0);
    for (SkyTable::Refined& r : refined) {
        const size_t cell = size_t(r.row) * size_t(width) + size_t(r.column);
        const bool is = std::any_of(r.weights.begin(), r.weights.end(), [&](float v) { return v > limit; });
        divided[cell] = 1;
        if (is) take(cell);
        (is ? brightParts : restParts).push_back(std::move(r));
    }
    for (size_t i = 0; i < weights.size(); ++i)
        if (!divided[i] && weights[i] > limit && std::isfinite(weights[i])) take(i);
    double area = 0;
    for (int row = 0; row < height; ++row) {
        const float* const first = &bright[size_t(row) * size_t(width)];
        const double cell = (exact::cos(kPi * row / height) - exact::cos(kPi * (row + 1) / height)) / (2. * width);
        area += cell * double(std::count_if(first, first + width, [](float v) { return v != 0; }));
    }
    auto apart = std::make_unique<SkyTable>(width, height, std::move(bright), std::move(brightParts));
    const double share = apart->integral() / integral_;
    if (!(share >= kLeastBright && share <= kMostBright && area <= kMostArea)) return;
    bright_ = std::move(apart);
    rest_ = std::make_unique<SkyTable>(width, height, std::move(weights), std::move(restParts));
    brightChance_ = chanceOf(share);
}

bool SkySampler::sample(Vec2 u, Vec3& w, float& density) const {
    const bool bright = u.y < brightChance_;
    const float whole = bright ? brightChance_ : 1 - brightChance_;
    u.y = std::min((bright ? u.y : u.y - brightChance_) / whole, 0x1.fffffep-1f);
    if (!(bright ? *bright_ : *rest_).sample(u, w, density)) return false;
    if (bright_) density = pdf(w);
    return density > 0;
}

float SkySampler::pdf(const Vec3& w) const {
    const float rest = rest_->pdf(w);
    return bright_ ? brightChance_ * bright_->pdf(w) + (1 - brightChance_) * rest : rest;
}

bool SkySampler::sampleBright(Vec2 u, Vec3& w, float& density) const {
    if (bright_) return bright_->sample(u, w, density);
    return rest_->sample(u, w, density) && density * float(4 * kPi) > kBright;
}

} // namespace alpenglow::world
