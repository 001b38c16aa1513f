// The Muttenzer box for tests: its RIB with or without spheres, tiles of its frame, and how two sets of tiles are compared (T6).
#pragma once
#include "oracle/box_oracle.h"
#include "transport/harness.h"
#include <random>

namespace alpenglow::transport::testing {

inline std::string boxRib(bool spheres) {
    std::string s = readText(ALPENGLOW_SOURCE_DIR "/examples/muttenzer_box.rib");
    size_t at = s.find("    AttributeBegin # mirror sphere"), end = s.find("WorldEnd");
    EXPECT_NE(at, std::string::npos);
    if (!spheres) s = s.substr(0, at) + s.substr(end);
    return s;
}

/// Camera space of the box's own camera, from the world space of the reference.
inline Vec3 boxCamera(double x, double y, double z) { return {float(x), float(y), float(7.2 - z)}; }

struct Tiles {
    static constexpr int kX = 8, kY = 6;
    Moments tile[kX * kY];
    Moments all() const {
        Moments m;
        for (const Moments& t : tile) m.add(t);
        return m;
    }
};

/// `n` samples a tile at random places of it. Streams do not repeat between different seeds.
inline std::vector<CameraRay> boxRays(int n, uint32_t seed) {
    std::mt19937_64 rng(seed + seedBase());
    std::uniform_real_distribution<double> u01(0, 1);
    std::vector<CameraRay> rays;
    double t = std::tan(13.5 * kPi / 180);
    for (int i = 0; i < Tiles::kX * Tiles::kY; ++i)
        for (int k = 0; k < n; ++k) {
            double x = (i % Tiles::kX + u01(rng)) / Tiles::kX, y = (i / Tiles::kX + u01(rng)) / Tiles::kY;
            CameraRay r;
            r.direction = normalize(Vec3(float((2 * x - 1) * t * 4 / 3), float((1 - 2 * y) * t), 1));
            r.cosine = r.direction.z;
            r.px = i;
            r.py = k;
            rays.push_back(r);
        }
    return rays;
}

inline Tiles boxTiles(const std::string& rib, Settings s, int n, uint32_t seed, Counters* counters = nullptr) {
    s.hider = Hider::Path;
    s.seed = seed;
    Scene scene(rib, s);
    Tiles t;
    if (!scene.world) return t;
    auto rays = boxRays(n, seed);
    auto out = scene.trace(rays, counters);
    for (size_t i = 0; i < rays.size(); ++i) t.tile[rays[i].px].add(out[i].color);
    return t;
}

inline Tiles oracleTiles(bool spheres, int n, uint32_t seed) {
    oracle::Box box;
    box.spheres = spheres;
    std::mt19937_64 rng(seed + seedBase());
    Tiles t;
    for (int i = 0; i < Tiles::kX * Tiles::kY; ++i)
        for (int k = 0; k < n; ++k) {
            oracle::V o, d;
            oracle::Box::camera(640 * (i % Tiles::kX + oracle::Box::u01(rng)) / Tiles::kX, 480 * (i / Tiles::kX + oracle::Box::u01(rng)) / Tiles::kY, o, d);
            oracle::V v = box.radiance(o, d, rng);
            t.tile[i].add(Color(float(v.x), float(v.y), float(v.z)));
        }
    return t;
}

/// Welch's t of every tile, then: the image's mean, the sum of z^2 against chi^2, the largest |z| with Sidak's correction.
inline void expectSame(const Tiles& a, const Tiles& b, const std::string& what) {
    for (int k = 0; k < 3; ++k) {
        Moments ma = a.all(), mb = b.all();
        // The image's mean is a stratified sum: its variance is that of the tiles.
        double va = 0, vb = 0, sum = 0, most = 0;
        int used = 0;
        for (int i = 0; i < Tiles::kX * Tiles::kY; ++i) {
            double ea = a.tile[i].se(k), eb = b.tile[i].se(k);
            va += ea * ea;
            vb += eb * eb;
            double v = ea * ea + eb * eb, d = a.tile[i].mean(k) - b.tile[i].mean(k);
            if (!(v > 1e-16)) {
                EXPECT_NEAR(d, 0, 1e-6) << what << " tile " << i;
                continue;
            }
            double z = d / std::sqrt(v);
            sum += z * z;
            most = std::max(most, std::fabs(z));
            ++used;
        }
        double count = Tiles::kX * Tiles::kY, se = std::sqrt(va + vb) / count;
        EXPECT_LE(std::fabs(ma.mean(k) - mb.mean(k)), kZ * se)
            << what << " channel " << k << ": " << ma.mean(k) << " and " << mb.mean(k) << " +- " << se;
        ASSERT_GT(used, 20) << what;
        EXPECT_GT(teststat::gammaQ(used / 2.0, sum / 2), teststat::kAlpha) << what << " channel " << k << ": sum of z^2 " << sum << " over " << used;
        double sidak = 1 - std::pow(1 - teststat::kAlpha, 1.0 / used);
        EXPECT_GT(std::erfc(most / std::sqrt(2.0)), sidak) << what << " channel " << k << ": largest z " << most;
        EXPECT_GE(std::min(ma.effective(k), mb.effective(k)), 1000) << what << ": not enough samples to decide";
    }
}

} // namespace alpenglow::transport::testing
