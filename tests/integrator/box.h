// The Muttenzer box for tests: its RIB with or without spheres, tiles of its frame, and how two sets of tiles are compared.
#pragma once
#include "integrator/harness.h"
#include "oracle/box_oracle.h"
#include <random>

namespace alpenglow::integrator::testing {

inline std::string boxRib(bool spheres) {
    std::string s = readText(ALPENGLOW_SOURCE_DIR "/examples/muttenzer_box.rib");
    size_t at = s.find("    AttributeBegin # mirror sphere"), end = s.find("WorldEnd");
    EXPECT_NE(at, std::string::npos);
    if (!spheres) s = s.substr(0, at) + s.substr(end);
    return s;
}

/// Camera space of the box's own camera, from the world space of docs/design/muttenzer-box.md.
inline Vec3 boxCamera(double x, double y, double z) { return {float(x), float(y), float(7.2 - z)}; }

/// 64 tiles of the frame; a nightly tile holds 16 x 16 pixels of 256 samples.
struct Tiles {
    static constexpr int kX = 8, kY = 8, kCount = kX * kY;
    std::vector<Moments> tile = std::vector<Moments>(kCount);
    Moments all() const {
        Moments m;
        for (const Moments& t : tile) m.add(t);
        return m;
    }
};

/// `n` samples at random places of a tile. Streams do not repeat between different seeds.
inline std::vector<CameraRay> tileRays(int tile, int n, uint32_t seed) {
    std::mt19937_64 rng((uint64_t(seed + seedBase()) << 8) + uint64_t(tile));
    std::uniform_real_distribution<double> u01(0, 1);
    std::vector<CameraRay> rays(static_cast<size_t>(n));
    double t = std::tan(13.5 * kPi / 180);
    for (int k = 0; k < n; ++k) {
        double x = (tile % Tiles::kX + u01(rng)) / Tiles::kX, y = (tile / Tiles::kX + u01(rng)) / Tiles::kY;
        CameraRay& r = rays[size_t(k)];
        r.direction = normalize(Vec3(float((2 * x - 1) * t * 4 / 3), float((1 - 2 * y) * t), 1));
        r.cosine = r.direction.z;
        r.px = tile;
        r.py = k;
    }
    return rays;
}
inline std::vector<CameraRay> boxRays(int n, uint32_t seed) {
    std::vector<CameraRay> all;
    for (int i = 0; i < Tiles::kCount; ++i) {
        auto rays = tileRays(i, n, seed);
        all.insert(all.end(), rays.begin(), rays.end());
    }
    return all;
}

inline Tiles boxTiles(const std::string& rib, Settings s, int n, uint32_t seed, Counters* counters = nullptr) {
    s.hider = Hider::Path;
    s.seed = seed;
    Scene scene(rib, s);
    Tiles t;
    if (!scene.world) return t;
    for (int i = 0; i < Tiles::kCount; ++i)
        for (const SampleResult& r : scene.trace(tileRays(i, n, seed), counters)) t.tile[size_t(i)].add(r.color);
    return t;
}

inline Tiles oracleTiles(bool spheres, int n, uint32_t seed) {
    oracle::Box box;
    box.spheres = spheres;
    std::mt19937_64 rng(seed + seedBase());
    Tiles t;
    for (int i = 0; i < Tiles::kCount; ++i)
        for (int k = 0; k < n; ++k) {
            oracle::V o, d;
            oracle::Box::camera(640 * (i % Tiles::kX + oracle::Box::u01(rng)) / Tiles::kX,
                                480 * (i / Tiles::kX + oracle::Box::u01(rng)) / Tiles::kY, o, d);
            oracle::V v = box.radiance(o, d, rng);
            t.tile[size_t(i)].add(Color(float(v.x), float(v.y), float(v.z)));
        }
    return t;
}

/// A way of making the tiles: with `n` samples a tile and a seed of its own.
using Technique = std::function<Tiles(int n, uint32_t seed)>;

/// The four statistics of T6 on each channel. `declared`: the relative bias of the whole image that must be found in 99 of 100
/// runs; nightly a quarter of it. Nightly, with fresh seeds, a rejection is repeated once with new seeds and four times the
/// samples and counts only when repeated.
inline void expectSame(const Technique& a, const Technique& b, int n, double declared, const std::string& what, uint32_t seed) {
    for (int stage = 0;; ++stage) {
        int count = n * (stage ? 4 : 1);
        Tiles ta = a(count, seed + 1000u * uint32_t(stage)), tb = b(count, seed + 500u + 1000u * uint32_t(stage));
        bool again = false;
        for (int k = 0; k < 3; ++k) {
            std::vector<teststat::TileMean> ma, mb;
            for (int i = 0; i < Tiles::kCount; ++i) {
                ma.push_back({ta.tile[size_t(i)].mean(k), ta.tile[size_t(i)].se(k), ta.tile[size_t(i)].effective(k)});
                mb.push_back({tb.tile[size_t(i)].mean(k), tb.tile[size_t(i)].se(k), tb.tile[size_t(i)].effective(k)});
            }
            teststat::Agreement r = teststat::compareTiles(ma, mb);
            if (k == 0) std::printf("%s: %s\n", what.c_str(), r.text().c_str());
            if (!stage && k == 0) teststat::keepP(what, r.imageP);
            ASSERT_GT(r.used, 20) << what;
            if (!r.ok(3)) {
                again |= nightly() && !stage;
                EXPECT_TRUE(again) << what << " channel " << k << ": " << r.text();
            }
            EXPECT_GE(r.effective, 1000) << what << ": not enough samples to decide";
            EXPECT_LE(r.finds, nightly() ? declared / 4 : declared) << what << ": not precise enough";
        }
        if (!again) return;
        std::printf("%s: repeated with four times the samples\n", what.c_str());
    }
}

} // namespace alpenglow::integrator::testing
