// Repelling planes of Blobbies: bounds against samples of the field, crossings against a march along the ray, and their cost.
#include "geometry/blob_field.h"
#include <cmath>
#include <ctime>
#include <gtest/gtest.h>
#include <random>

namespace repelling_test {

using namespace alpenglow;
using namespace alpenglow::geometry;

namespace {

std::mt19937 rng(11);
double between(double lo, double hi) { return lo + (hi - lo) * double(rng()) / 4294967296.0; }

/// Hills of depths 4.5 to 5.5, seen along z over -4 to 4, with a gap of no depth.
std::shared_ptr<BlobGround> hills(int width, int height) {
    auto g = std::make_shared<BlobGround>();
    g->width = width, g->height = height;
    g->toScreen = scaleMatrix(.25, .25, 1);
    for (int j = 0; j < height; ++j)
        for (int i = 0; i < width; ++i) {
            const bool gap = i < width / 8 && j < height / 8;
            g->depth.push_back(
                gap ? 1e30f : 5 + .5f * std::sin(9.f * float(i) / float(width)) * std::cos(7.f * float(j) / float(height)));
        }
    g->sumUp();
    g->a = 1.5, g->b = .25, g->c = .5, g->d = .6;
    return g;
}

/// The hills and a ball of radius 1.4 at z = 4.
BlobField field(const std::shared_ptr<const BlobGround>& g) {
    BlobLeaf ball, ground;
    double m[16] = {1.4, 0, 0, 0, 0, 1.4, 0, 0, 0, 0, 1.4, 0, 0, 0, 4, 1};
    EXPECT_TRUE(shapeBlobLeaf(m, nullptr, ball));
    ground.kind = BlobLeaf::Kind::Ground;
    ground.ground = g;
    return BlobField({ball, ground});
}

const BlobTape kSum = {{BlobOp::Kind::Leaf, 0, 0, 0}, {BlobOp::Kind::Leaf, 1, 0, 0}, {BlobOp::Kind::Add, 0, 1, 0}};

} // namespace

TEST(RepellingPlane, BoundsHoldTheFieldAndShrinkWithTheBox) {
    const auto g = hills(33, 20);
    for (int k = 0; k < 4000; ++k) {
        const double size = std::pow(10., between(-5, .5));
        const Vec3d lo(between(-4.5, 4.5), between(-4.5, 4.5), between(2.5, 5.6)), hi = lo + Vec3d(size, size, size);
        const Interval all = blobGroundBounds(*g, lo, hi);
        for (int i = 0; i < 20; ++i) {
            const double f = blobGroundField(*g, {between(lo.x, hi.x), between(lo.y, hi.y), between(lo.z, hi.z)});
            ASSERT_GE(f, all.lo - 1e-9);
            ASSERT_LE(f, all.hi + 1e-9);
        }
        // Where the height is above .2 and the slope at most 12 texels' .1, the field changes by less than 20 a unit.
        if (size < .01 && lo.z < 4.2 && lo.x > -2.5 && hi.x < 3.9 && lo.y > -3.9 && hi.y < 2.5)
            EXPECT_LT(all.hi - all.lo, 40 * size);
    }
}

TEST(RepellingPlane, CrossingsAreThoseOfAMarchAndTakeLittleTime) {
    const auto g = hills(128, 128);
    const BlobField f = field(g);
    const std::clock_t begin = std::clock();
    std::vector<std::pair<Vec3d, Vec3d>> rays;
    std::vector<std::vector<double>> found;
    for (int k = 0; k < 1000; ++k) {
        const Vec3d from(between(-2, 2), between(-2, 2), between(1, 3)),
            to(between(-1.2, 1.2), between(-1.2, 1.2), between(4, 5.5));
        rays.push_back({from, to - from});
        double t[16];
        const int n = f.crossings(kSum, from, to - from, 0, 1.5, 16, t);
        found.emplace_back(t, t + n);
    }
    EXPECT_LT(double(std::clock() - begin) / CLOCKS_PER_SEC, 5); // by the depths of the whole map it took 60 ms a ray
    size_t crossed = 0;
    for (size_t k = 0; k < 60; ++k) {
        const auto& [o, d] = rays[k];
        std::vector<double> want;
        constexpr int kSteps = 20000;
        double before = f.value(kSum, o) - kBlobThreshold;
        for (int i = 1; i <= kSteps; ++i) {
            const double now = f.value(kSum, o + d * (1.5 * i / kSteps)) - kBlobThreshold;
            if ((now < 0) != (before < 0)) want.push_back(1.5 * i / kSteps);
            before = now;
        }
        ASSERT_EQ(found[k].size(), want.size()) << k;
        for (size_t i = 0; i < want.size(); ++i) EXPECT_NEAR(found[k][i], want[i], 1.5 / kSteps);
        crossed += want.size();
    }
    EXPECT_GT(crossed, 40u);
}

} // namespace repelling_test
