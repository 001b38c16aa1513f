// Photons of one pass, found within a fixed distance: what progressive passes gather (Knaus and Zwicker, "Progressive Photon
// Mapping: A Probabilistic Approach", 2011). Cells in a hash table; photons of a cell lie in the order of emission.
#pragma once
#include "photons/photon.h"
#include <array>
#include <span>
#include <vector>

namespace alpenglow::photons {

class PhotonGrid {
public:
    PhotonGrid() = default;
    /// radius: above 0.
    PhotonGrid(std::vector<Photon> photons, float radius);
    /// Where things move: `times` says by photon, as part of the time that the shutter is open, when it was there. Photons count
    /// that are at most half of `window` away from when somebody asks.
    PhotonGrid(std::vector<Photon> photons, float radius, std::span<const float> times, float window);
    float radius() const { return radius_; }
    size_t size() const { return photons_.size(); }
    /// How long the photons were there that count at a time: part of the time that the shutter is open, 1 where nothing moves.
    float lasts(float time) const {
        return times_.empty() ? 1 : std::min(time + halfWindow_, 1.f) - std::max(time - halfWindow_, 0.f);
    }

    /// Calls take(photon) for all within the radius of a point that count at a time (0 to 1), in an order that depends on nothing
    /// but photons, point and time.
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
    /// The buckets of the cells that the ball about a point may reach, ascending, each once.
    int bucketsAbout(const Vec3& at, std::array<uint32_t, 8>& out) const;
    uint32_t bucketOf(int64_t x, int64_t y, int64_t z) const;
    std::vector<Photon> photons_;
    std::vector<float> times_; ///< by photon; empty: all count at all times
    float halfWindow_ = 1;
    std::vector<uint32_t> first_; ///< by bucket; one more at the end
    float radius_ = 0;
    double cell_ = 1;
    uint32_t mask_ = 0;
};

/// The radius of pass k = 0, 1, 2 ... of a progressive estimate that begins with `first`: its square shrinks by (k + a) / (k + 1)
/// from pass to pass with a = 2/3, so that bias and variance of the mean over all passes both vanish.
float radiusOfPass(float first, uint32_t pass);

/// How a progressive estimate of what moves begins: `radius` and `window` in the place of `radius`, about which as many photons
/// are found. travel: how far things move while the shutter is open. What is smeared over the window is about as wide as the
/// radius where that is so for a window of kLeastWindow or more.
struct MovingStart {
    float radius, window;
};
MovingStart movingStart(float radius, float travel);
inline constexpr float kLeastWindow = .125f;

} // namespace alpenglow::photons
