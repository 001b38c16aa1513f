#include "render/samplebuffer.h"
#include <cmath>
#include <gtest/gtest.h>

namespace samplebuffer_test {

using namespace alpenglow;
using namespace alpenglow::render;

namespace {

template <class F> void fill(SampleBuffer& b, F shade) {
    const Window& w = b.sampled();
    for (int y = w.y0; y < w.y1; ++y)
        for (int x = w.x0; x < w.x1; ++x)
            for (int k = 0; k < b.samplesPerPixel(); ++k) b.set(x, y, k, shade(b.position(x, y, k), x, y, k));
}

ImageSample grey(float v) {
    ImageSample s;
    s.color = Color(v);
    s.opacity = Color(1.0f);
    return s;
}

} // namespace

TEST(SampleBuffer, PositionsAreStratified) {
    for (Jitter j : {Jitter::Grid, Jitter::Jittered})
        for (int y = -2; y < 3; ++y)
            for (int k = 0; k < 12; ++k) {
                Vec2 o = stratifiedOffset(3, 5, y, k, 4, 3, j);
                EXPECT_EQ(int(o.x * 4), k % 4);
                EXPECT_EQ(int(o.y * 3), k / 4);
                if (j == Jitter::Grid) { EXPECT_NEAR(o.x, (k % 4 + 0.5) / 4, 1e-6); }
            }
    EXPECT_NE(stratifiedOffset(3, 5, 0, 0, 4, 3, Jitter::Jittered).x, stratifiedOffset(3, 6, 0, 0, 4, 3, Jitter::Jittered).x);
}

TEST(SampleBuffer, ConstantStaysConstantUnderEveryFilter) {
    for (int k = 0; k < kFilterKinds; ++k) {
        PixelFilter f{FilterKind(k), 3, 2.5};
        SampleBuffer b({2, 1, 6, 4}, f.xw, f.yw, 2, 2, {{"aov"}}, 1, Jitter::Jittered);
        const float aov[1] = {-4};
        fill(b, [&](Vec2, int, int, int) {
            ImageSample s;
            s.color = {0.25f, 3, 0};
            s.opacity = {0.5f, 0.5f, 0.5f};
            s.aovs = aov;
            return s;
        });
        Image i = b.reconstruct(f, DepthFilter::Min, {2, 1, 6, 4});
        ASSERT_EQ(i.channels.size(), 9u);
        for (int y = 1; y < 4; ++y)
            for (int x = 2; x < 6; ++x) {
                EXPECT_NEAR(i.at(x, y, 0), 0.25, 1e-6) << filterName(f.kind);
                EXPECT_NEAR(i.at(x, y, 1), 3, 1e-5);
                EXPECT_NEAR(i.at(x, y, 3), 0.5, 1e-6);
                EXPECT_NEAR(i.at(x, y, 8), -4, 1e-5);
                EXPECT_TRUE(std::isinf(i.at(x, y, 7)));
            }
    }
}

TEST(SampleBuffer, BoxOfOnePixelIsThePlainMean) {
    SampleBuffer b({0, 0, 3, 3}, 4, 4, 4, 2, {}, 5, Jitter::Jittered);
    fill(b, [](Vec2, int x, int y, int k) { return grey(float(x * 100 + y * 10 + k)); });
    Image i = b.reconstruct({FilterKind::Box, 1, 1}, DepthFilter::Min, {0, 0, 3, 3});
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 3; ++x) EXPECT_FLOAT_EQ(i.at(x, y, 0), float(x * 100 + y * 10) + 3.5f); // mean of 0..7
}

TEST(SampleBuffer, WeightsByHand) {
    // One sample a pixel, in the middle; triangle of width 4: 1, 1/2 and 0 at distances 0, 1, 2 on each axis.
    SampleBuffer b({0, 0, 1, 1}, 4, 4, 1, 1, {}, 0, Jitter::Grid);
    EXPECT_EQ(b.sampled(), (Window{-2, -2, 3, 3}));
    fill(b, [](Vec2, int x, int y, int) { return grey(x == 1 && y == 0 ? 1.0f : x == -1 && y == -1 ? 8.0f : 0.0f); });
    Image i = b.reconstruct({FilterKind::Triangle, 4, 4}, DepthFilter::Min, {0, 0, 1, 1});
    EXPECT_FLOAT_EQ(i.at(0, 0, 0), (0.5f + 8 * 0.25f) / 4); // weights: (1/2 + 1 + 1/2)^2 = 4
}

TEST(SampleBuffer, EdgeResponseIsTheFiltersDistribution) {
    // A vertical edge, 32 x 32 samples: pixel x sees the step at distance t = edge - (x + 1/2).
    const double edge = 4.3;
    PixelFilter f{FilterKind::Gaussian, 3, 3};
    SampleBuffer b({0, 0, 9, 1}, 3, 3, 32, 32, {}, 3, Jitter::Jittered);
    fill(b, [&](Vec2 p, int, int, int) { return grey(p.x < edge ? 1.0f : 0.0f); });
    Image i = b.reconstruct(f, DepthFilter::Min, {0, 0, 9, 1});
    for (int x = 0; x < 9; ++x) {
        double t = std::clamp((edge - (x + 0.5)) / 1.5, -1.0, 1.0), r = std::sqrt(2.0);
        EXPECT_NEAR(i.at(x, 0, 0), 0.5 + 0.5 * std::erf(r * t) / std::erf(r), 2e-3) << x;
    }
}

TEST(SampleBuffer, PartsOfTheRasterGiveTheSameBits) {
    auto shade = [](Vec2 p, int, int, int) { return grey(std::sin(p.x) * p.y); };
    const std::vector<PixelFilter> displays = {
        {FilterKind::Gaussian, 2, 2}, {FilterKind::Mitchell, 4, 4}, {FilterKind::Sinc, 3, 5}};
    SampleBuffer whole({0, 0, 20, 11}, 4, 5, 2, 3, {}, 9, Jitter::Jittered);
    fill(whole, shade);
    for (const PixelFilter& f : displays) {
        Image all = whole.reconstruct(f, DepthFilter::Min, {0, 0, 20, 11});
        for (Window w : {Window{0, 0, 7, 11}, Window{7, 3, 20, 4}, Window{19, 10, 20, 11}}) {
            SampleBuffer part(w, f.xw, f.yw, 2, 3, {}, 9, Jitter::Jittered);
            fill(part, shade);
            Image some = part.reconstruct(f, DepthFilter::Min, w), cut = whole.reconstruct(f, DepthFilter::Min, w);
            EXPECT_EQ(some.data, cut.data);
            for (int y = w.y0; y < w.y1; ++y)
                for (int x = w.x0; x < w.x1; ++x) EXPECT_EQ(some.at(x, y, 0), all.at(x, y, 0));
        }
    }
}

TEST(SampleBuffer, BlocksOfPixelsGiveTheSameBits) {
    // More columns and rows than a block has: 16 samples make them 64 x 16.
    const Window all{0, 0, 70, 19}, one{63, 15, 66, 18};
    const std::vector<Channel> aovs{{"a"}};
    const auto shade = [](Vec2 p, int x, int, int k) {
        static thread_local float aov[1];
        aov[0] = float(x * k);
        ImageSample s = grey(std::sin(p.x) * p.y);
        s.aovs = aov;
        return s;
    };
    for (FilterKind kind : {FilterKind::Gaussian, FilterKind::Bessel}) {
        SampleBuffer whole(all, 3, 3, 4, 4, aovs, 9, Jitter::Jittered), part(one, 3, 3, 4, 4, aovs, 9, Jitter::Jittered);
        fill(whole, shade);
        fill(part, shade);
        const Image a = whole.reconstruct({kind, 3, 3}, DepthFilter::Min, all),
                    b = part.reconstruct({kind, 3, 3}, DepthFilter::Min, one);
        for (int y = one.y0; y < one.y1; ++y)
            for (int x = one.x0; x < one.x1; ++x)
                for (int c = 0; c < 9; ++c) EXPECT_EQ(a.at(x, y, c), b.at(x, y, c));
    }
}

TEST(SampleBuffer, PlacesDrawnTogetherHaveTheSameBits) {
    for (Jitter j : {Jitter::Grid, Jitter::Jittered, Jitter::Scrambled, Jitter::Middle}) {
        PlaceRows rows(77, 3, 5, j);
        for (int again = 0; again < 2; ++again) { // in the memory of the call before
            rows.clear();
            for (int y = -1; y < 3; ++y)
                for (int k = 0; k < 15; ++k) rows.ask(again - y, y, k);
            rows.draw();
            const std::span<const Vec2> places = rows.places();
            ASSERT_EQ(places.size(), 60u);
            for (int y = -1; y < 3; ++y)
                for (int k = 0; k < 15; ++k) {
                    const Vec2 one = stratifiedOffset(77, again - y, y, k, 3, 5, j), p = places[size_t((y + 1) * 15 + k)];
                    EXPECT_TRUE(one.x == p.x && one.y == p.y) << int(j) << ' ' << y << ' ' << k;
                }
        }
    }
}

TEST(SampleBuffer, MemoryOfABufferThatIsGoneServesAgain) {
    const Window all{0, 0, 9, 5};
    SampleBuffer first(all, 2, 2, 2, 2, {{"a"}}, 1, Jitter::Jittered);
    fill(first, [](Vec2 p, int, int, int) { return grey(p.x); });
    std::vector<float> memory = std::move(first).takeMemory();
    std::fill(memory.begin(), memory.end(), std::nanf("")); // whatever it held
    const float* at = memory.data();
    SampleBuffer again(all, 1, 1, 2, 2, {}, 1, Jitter::Jittered, std::move(memory)),
        fresh(all, 1, 1, 2, 2, {}, 1, Jitter::Jittered);
    EXPECT_EQ(again.reconstruct({}, DepthFilter::Average, all).data, fresh.reconstruct({}, DepthFilter::Average, all).data);
    for (SampleBuffer* b : {&again, &fresh}) fill(*b, [](Vec2 p, int, int, int) { return grey(p.y); });
    EXPECT_EQ(again.reconstruct({}, DepthFilter::Min, all).data, fresh.reconstruct({}, DepthFilter::Min, all).data);
    EXPECT_EQ(std::move(again).takeMemory().data(), at);
}

TEST(SampleBuffer, MovedDownItIsTheBufferOfThere) {
    const auto shade = [](Vec2 at, int, int, int k) { return grey(at.x * at.y + float(k)); };
    const PixelFilter f{FilterKind::Gaussian, 3, 4};
    SampleBuffer moving({0, 0, 9, 5}, f.xw, f.yw, 2, 3, {}, 7, Jitter::Jittered);
    fill(moving, shade);
    // The border is of two rows: what both buffers have is kept.
    const std::pair<Window, int> steps[] = {{{0, 5, 9, 12}, 7}, {{0, 12, 9, 13}, 14}, {{0, 13, 9, 30}, 15}, {{0, 60, 9, 64}, 58}};
    for (const auto& [w, fresh] : steps) {
        SampleBuffer there(w, f.xw, f.yw, 2, 3, {}, 7, Jitter::Jittered);
        fill(there, shade);
        const int first = moving.moveDown(w);
        ASSERT_EQ(moving.sampled(), there.sampled());
        EXPECT_EQ(first, fresh);
        for (int y = first; y < moving.sampled().y1; ++y)
            for (int x = moving.sampled().x0; x < moving.sampled().x1; ++x)
                for (int k = 0; k < 6; ++k) moving.set(x, y, k, shade(moving.position(x, y, k), x, y, k));
        EXPECT_EQ(moving.reconstruct(f, DepthFilter::Min, w).data, there.reconstruct(f, DepthFilter::Min, w).data);
    }
}

TEST(SampleBuffer, DepthFilters) {
    const float inf = std::numeric_limits<float>::infinity();
    const float z[4] = {5, 2, inf, 8}, second[4] = {9, inf, inf, 10};
    SampleBuffer b({0, 0, 1, 1}, 1, 1, 2, 2, {{"least", ChannelRule::Min}, {"most", ChannelRule::Max}}, 0, Jitter::Grid);
    float aov[4][2];
    fill(b, [&](Vec2, int, int, int k) {
        ImageSample s = grey(1);
        s.z = z[k];
        s.zSecond = second[k];
        aov[k][0] = aov[k][1] = float(k) - 1;
        s.aovs = aov[k];
        return s;
    });
    auto depth = [&](DepthFilter d) { return b.reconstruct({FilterKind::Box, 1, 1}, d, {0, 0, 1, 1}); };
    EXPECT_EQ(depth(DepthFilter::Min).at(0, 0, 7), 2);
    EXPECT_EQ(depth(DepthFilter::Max).at(0, 0, 7), inf);
    EXPECT_EQ(depth(DepthFilter::Average).at(0, 0, 7), 5);
    EXPECT_EQ(depth(DepthFilter::Midpoint).at(0, 0, 7), 7); // min of (5+9)/2 and (8+10)/2
    EXPECT_EQ(depth(DepthFilter::Min).at(0, 0, 8), -1);
    EXPECT_EQ(depth(DepthFilter::Min).at(0, 0, 9), 2);
    EXPECT_EQ(depthFilterByName("zmax"), DepthFilter::Max);
    EXPECT_EQ(depthFilterByName("midpoint"), DepthFilter::Midpoint);
    EXPECT_FALSE(depthFilterByName("median"));
}

TEST(SampleBuffer, NonFiniteSamplesAreDroppedAndCounted) {
    SampleBuffer b({0, 0, 1, 1}, 1, 1, 2, 1, {}, 0, Jitter::Grid);
    EXPECT_TRUE(b.set(0, 0, 0, grey(3)));
    EXPECT_FALSE(b.set(0, 0, 1, grey(std::nanf(""))));
    EXPECT_EQ(b.nonFinite(), 1u);
    EXPECT_TRUE(b.set(0, 0, 0, grey(3))); // a task that is done again
    EXPECT_FALSE(b.set(0, 0, 1, grey(std::nanf(""))));
    EXPECT_EQ(b.nonFinite(), 1u);
    EXPECT_EQ(b.reconstruct({FilterKind::Box, 1, 1}, DepthFilter::Min, {0, 0, 1, 1}).at(0, 0, 0), 3);
}

TEST(SampleBuffer, AFilterThatMeetsNoSampleFallsBackToThePixel) {
    SampleBuffer b({0, 0, 1, 1}, 1, 1, 2, 2, {}, 0, Jitter::Grid); // samples at 1/4 and 3/4, none near the centre
    fill(b, [](Vec2, int, int, int k) { return grey(float(k)); });
    EXPECT_EQ(b.reconstruct({FilterKind::Box, 0.1, 0.1}, DepthFilter::Min, {0, 0, 1, 1}).at(0, 0, 0), 1.5f);
    // No sample at all: black, transparent, no depth.
    SampleBuffer empty({0, 0, 1, 1}, 1, 1, 1, 1, {}, 0, Jitter::Grid);
    Image i = empty.reconstruct({}, DepthFilter::Max, {0, 0, 1, 1});
    EXPECT_EQ(i.at(0, 0, 3), 0);
    EXPECT_TRUE(std::isinf(i.at(0, 0, 7)) && i.at(0, 0, 7) > 0);
}

} // namespace samplebuffer_test
