// Photons of one pass with lookups within a fixed radius, for progressive passes (Knaus and Zwicker, "Progressive Photon Mapping:
// A Probabilistic Approach", 2011). Hash table of cells; photons of a cell are in order of emission.
#pragma once
#include "photonmap/photon.h"
#include <array>
#include <span>
#include <vector>

namespace alpenglow::photonmap {

/// Photons in the cells of a grid, for a progressive pass whose radii are known before.
class PhotonGrid {
public:
    PhotonGrid() = default;
    /// radius: > 0.
    PhotonGrid(std::vector<Photon> photons, float radius);
    /// For moving scenes: `times` has the time of each photon as a fraction of the open shutter. A lookup uses photons within
    /// half of `window` of its time.
    PhotonGrid(std::vector<Photon> photons, float radius, std::span<const float> times, float window);
    /// As given to the constructor; number of photons.
    float radius() const { return radius_; }
    size_t size() const { return photons_.size(); }
    /// Length of the time interval of photons for a lookup at this time, as a fraction of the open shutter; 1 without motion.
    float lasts(float time) const {
        return times_.empty() ? 1 : std::min(time + halfWindow_, 1.f) - std::max(time - halfWindow_, 0.f);
    }

    /// Calls take(photon) for all photons within the radius of a point for a time (0 to 1), in an order that depends only on
    /// photons, point and time.
    template <class Take> void within(const Vec3& at, float time, Take&& take) const {
        std::array<uint32_t, 8> buckets;
        const int count = bucketsAbout(at, buckets);
        for (int k = 0; k < count; ++k)
            for (uint32_t i = first_[buckets[size_t(k)]]; i < first_[buckets[size_t(k)] + 1]; ++i) {
                const Vec3 away = photons_[i].P - at;
                if (!(dot(away, away) < radius_ * radius_)) continue;
                if (times_.empty() || std::fabs(times_[i] - time) < halfWindow_) take(photons_[i]);
            }
    }

private:
    /// The buckets of the cells that the ball around a point can intersect, ascending and unique.
    int bucketsAbout(const Vec3& at, std::array<uint32_t, 8>& out) const;
    uint32_t bucketOf(int64_t x, int64_t y, int64_t z) const;
    std::vector<Photon> photons_;
    std::vector<float> times_; ///< by photon; empty: no motion
    float halfWindow_ = 1;
    std::vector<uint32_t> first_; ///< by bucket; one more at the end
    float radius_ = 0;
    double cell_ = 1;
    uint32_t mask_ = 0;
};

/// Radius of pass k = 0, 1, 2 ... of a progressive estimate that starts with `first`: its square shrinks by (k + a) / (k + 1)
/// from pass to pass with a = 2/3, so that bias and variance of the mean over all passes vanish.
float radiusOfPass(float first, uint32_t pass);

/// Start of a progressive estimate with motion: `radius` and `window` replace `radius` and include about as many photons. travel:
/// distance of motion while the shutter is open. Blur over the window is about as wide as the radius, if that gives a window of
/// at least kLeastWindow.
struct MovingStart {
    float radius, window;
};
/// Radius: of the estimate without motion, camera space, > 0.
MovingStart movingStart(float radius, float travel);
inline constexpr float kLeastWindow = .125f;

} // namespace alpenglow::photonmap
