#include "photonmap/photongrid.h"
#include "base/exact.h"
#include "base/hash.h"

namespace alpenglow::photonmap {

PhotonGrid::PhotonGrid(std::vector<Photon> photons, float radius) : PhotonGrid(std::move(photons), radius, {}, 1) {}

PhotonGrid::PhotonGrid(std::vector<Photon> photons, float radius, std::span<const float> times, float window)
    : times_(times.size()), halfWindow_(window / 2), radius_(radius), cell_(2.0 * double(radius)) {
    uint32_t buckets = 16;
    while (buckets < photons.size() && buckets < (1u << 30)) buckets *= 2;
    mask_ = buckets - 1;
    first_.assign(size_t(buckets) + 1, 0);
    std::vector<uint32_t> of(photons.size());
    for (size_t i = 0; i < photons.size(); ++i) {
        const Vec3& p = photons[i].P;
        of[i] = bucketOf(int64_t(std::floor(p.x / cell_)), int64_t(std::floor(p.y / cell_)), int64_t(std::floor(p.z / cell_)));
        ++first_[size_t(of[i]) + 1];
    }
    for (size_t b = 1; b < first_.size(); ++b) first_[b] += first_[b - 1];
    std::vector<uint32_t> next(first_.begin(), first_.end() - 1);
    photons_.resize(photons.size());
    for (size_t i = 0; i < photons.size(); ++i) {
        const uint32_t to = next[of[i]]++;
        photons_[to] = photons[i];
        if (!times.empty()) times_[to] = times[i];
    }
}

uint32_t PhotonGrid::bucketOf(int64_t x, int64_t y, int64_t z) const {
    return uint32_t(mix64(uint64_t(x) * 0x9e3779b97f4a7c15ull + uint64_t(y) * 0xc2b2ae3d27d4eb4full +
                          uint64_t(z) * 0x165667b19e3779f9ull)) &
           mask_;
}

int PhotonGrid::bucketsAbout(const Vec3& at, std::array<uint32_t, 8>& out) const {
    if (photons_.empty() || !std::isfinite(dot(at, at))) return 0;
    int64_t low[3], high[3];
    for (int k = 0; k < 3; ++k) { // cells are two radii wide: at most two of them
        low[k] = int64_t(std::floor((double(at[k]) - double(radius_)) / cell_));
        high[k] = std::min(low[k] + 1, int64_t(std::floor((double(at[k]) + double(radius_)) / cell_)));
    }
    int count = 0;
    for (int64_t x = low[0]; x <= high[0]; ++x)
        for (int64_t y = low[1]; y <= high[1]; ++y)
            for (int64_t z = low[2]; z <= high[2]; ++z) out[size_t(count++)] = bucketOf(x, y, z);
    std::sort(out.begin(), out.begin() + count);
    return int(std::unique(out.begin(), out.begin() + count) - out.begin());
}

float radiusOfPass(float first, uint32_t pass) {
    // Product of (j + 2/3) / (j + 1) for j = 1 .. pass: the first thousand factors, then the asymptotic power (error below 1e-4).
    constexpr double kAlpha = 2.0 / 3;
    constexpr uint32_t kExact = 1000;
    double square = 1;
    for (uint32_t j = 1; j <= std::min(pass, kExact); ++j) square *= (j + kAlpha) / (j + 1.0);
    if (pass > kExact) square *= exact::pow((kExact + 1.0) / (pass + 1.0), 1 - kAlpha);
    return float(double(first) * std::sqrt(square));
}

MovingStart movingStart(float radius, float travel) {
    // Radius r and window w with w r^2 = radius^2 and w travel = r, so w = (radius / travel)^(2/3).
    if (!(travel > radius)) return {radius, 1};
    const float window = std::max(float(exact::pow(double(radius) / double(travel), 2.0 / 3)), kLeastWindow);
    return {radius / std::sqrt(window), window};
}

} // namespace alpenglow::photonmap
