// The scheduler on a fake ray service: "shaders" here are little state machines whose results have closed forms.
#include "shading/scheduler.h"
#include <functional>
#include <gtest/gtest.h>
#include <random>

namespace scheduler_test {

using namespace alpenglow;
using namespace alpenglow::shading;

namespace {

struct Payload {
    float value = 0;
    int fan = 0;
    int levels = 0;
    bool suspends = false;
    enum { Ray, Light, Shadow } kind = Ray;
};
using S = Scheduler<Payload>;

// A strip of `lanes` rays that hit a shader which sends `fan` rays one level down, one after the other (a suspension each), and
// returns value + sum of what came back. Masks: lane i only takes part while i % (step + 1) == 0 or step == 0.
class FakeStrip : public S::Strip {
public:
    FakeStrip(std::vector<S::Task> tasks) : tasks_(std::move(tasks)), sums_(tasks_.size(), 0.f) {}
    int depth() const override { return tasks_[0].depth; }
    size_t frameBytes() const override { return 1000; }
    bool resume(S& s, std::span<const TargetValue> results) override {
        for (size_t k = 0; k < results.size(); ++k) sums_[lanes_[k]] += results[k].radiance.x;
        return advance(s, s.takeResuming());
    }
    static void start(S& s, std::vector<S::Task> tasks) {
        auto strip = std::make_unique<FakeStrip>(std::move(tasks));
        for (auto& t : strip->tasks_) s.hold(t.target);
        auto* p = strip.get();
        p->advance(s, std::move(strip));
    }

private:
    bool advance(S& s, std::unique_ptr<S::Strip> self) {
        while (step_ < tasks_[0].payload.fan) {
            int step = step_++;
            lanes_.clear();
            for (size_t i = 0; i < tasks_.size(); ++i)
                if (step == 0 || i % (step + 1) == 0) lanes_.push_back(int(i));
            if (lanes_.empty()) continue;
            std::vector<S::Task> children;
            for (int lane : lanes_) {
                S::Task c = tasks_[lane];
                c.depth++;
                c.payload.levels--;
                c.payload.value = c.payload.value * 0.5f;
                children.push_back(c);
            }
            s.wait(std::move(self), int(lanes_.size()), [&](int i, AccumulatorId id) {
                children[i].target = id;
                s.spawn(children[i]);
            });
            return false;
        }
        for (size_t i = 0; i < tasks_.size(); ++i) {
            s.add(tasks_[i].target, Color(tasks_[i].payload.value + sums_[i]));
            s.release(tasks_[i].target);
        }
        return true;
    }
    std::vector<S::Task> tasks_;
    std::vector<float> sums_;
    std::vector<int> lanes_;
    int step_ = 0;
};

class FakeService : public S::RayService {
public:
    int strip = 16;
    std::vector<size_t> slices;
    int deepest = 0;
    std::function<void()> onSlice;
    void follow(std::span<const S::Task> slice, S& s) override {
        slices.push_back(slice.size());
        if (onSlice) onSlice();
        std::vector<S::Task> group;
        auto flush = [&] {
            if (!group.empty()) FakeStrip::start(s, std::move(group));
            group.clear();
        };
        for (const auto& t : slice) {
            deepest = std::max(deepest, t.depth);
            if (t.payload.levels == 0) {
                s.add(t.target, Color(t.payload.value));
            } else if (t.payload.suspends) {
                group.push_back(t);
                if (int(group.size()) == strip) flush();
            } else { // affine: pairs, no wait
                s.add(t.target, Color(t.payload.value));
                for (int f = 0; f < t.payload.fan; ++f) {
                    S::Task c = t;
                    c.depth++;
                    c.payload.levels--;
                    c.payload.value *= 0.5f;
                    s.spawn(c);
                }
            }
        }
        flush();
    }
};

// A light loop: the surface's strip waits for a light batch, whose own kernel waits for a shadow ray a lane. Lane i of the light
// is blocked when i is odd; the surface adds its own value.
class LightStrip : public S::Strip {
public:
    explicit LightStrip(std::vector<S::Task> t) : tasks_(std::move(t)) {}
    int depth() const override { return tasks_[0].depth; }
    size_t frameBytes() const override { return 500; }
    static void start(S& s, std::vector<S::Task> tasks) {
        auto strip = std::make_unique<LightStrip>(std::move(tasks));
        auto* p = strip.get();
        for (auto& t : p->tasks_) s.hold(t.target);
        std::vector<S::Task> rays = p->tasks_;
        s.wait(std::move(strip), int(rays.size()), [&](int i, AccumulatorId id) {
            rays[i].target = id;
            rays[i].depth++;
            rays[i].payload.kind = Payload::Shadow;
            s.spawn(rays[i]);
        });
    }
    bool resume(S& s, std::span<const TargetValue> shadow) override {
        for (size_t i = 0; i < tasks_.size(); ++i) {
            s.add(tasks_[i].target, Color(tasks_[i].payload.value) * shadow[i].radiance);
            s.release(tasks_[i].target);
        }
        return true;
    }

private:
    std::vector<S::Task> tasks_;
};

class LitSurface : public S::Strip {
public:
    explicit LitSurface(std::vector<S::Task> t) : tasks_(std::move(t)) {}
    int depth() const override { return tasks_[0].depth; }
    size_t frameBytes() const override { return 500; }
    static void start(S& s, std::vector<S::Task> tasks) {
        auto strip = std::make_unique<LitSurface>(std::move(tasks));
        auto* p = strip.get();
        for (auto& t : p->tasks_) s.hold(t.target);
        p->next(s, std::move(strip));
    }
    bool resume(S& s, std::span<const TargetValue> light) override {
        for (size_t i = 0; i < tasks_.size(); ++i) s.add(tasks_[i].target, light[i].radiance);
        if (light_ < 3) { // the next light of the loop, in lockstep for all lanes
            next(s, s.takeResuming());
            return false;
        }
        for (auto& t : tasks_) {
            s.add(t.target, Color(t.payload.value));
            s.release(t.target);
        }
        return true;
    }

private:
    void next(S& s, std::unique_ptr<S::Strip> self) {
        ++light_;
        std::vector<S::Task> lights = tasks_;
        float intensity = float(light_) * 0.25f;
        s.wait(std::move(self), int(lights.size()), [&](int i, AccumulatorId id) {
            lights[i].target = id;
            lights[i].depth++;
            lights[i].payload.kind = Payload::Light;
            lights[i].payload.value = intensity;
            lights[i].payload.levels = i;
            s.spawn(lights[i]);
        });
    }
    std::vector<S::Task> tasks_;
    int light_ = 0;
};

class LightService : public S::RayService {
public:
    std::vector<size_t> lightBatches;
    void follow(std::span<const S::Task> slice, S& s) override {
        std::vector<S::Task> surfaces, lights;
        for (const auto& t : slice) {
            if (t.payload.kind == Payload::Ray) surfaces.push_back(t);
            else if (t.payload.kind == Payload::Light) lights.push_back(t);
            else if (t.payload.levels % 2 == 0) s.add(t.target, Color(1));
        }
        if (!lights.empty()) {
            lightBatches.push_back(lights.size());
            LightStrip::start(s, lights);
        }
        for (size_t i = 0; i < surfaces.size(); i += 16)
            LitSurface::start(s, {surfaces.begin() + long(i), surfaces.begin() + long(std::min(i + 16, surfaces.size()))});
    }
};

TEST(Scheduler, LightBatchesInsideASurfaceBatch) {
    LightService service;
    S s(service);
    std::vector<AccumulatorId> roots;
    for (int i = 0; i < 40; ++i) {
        roots.push_back(s.newRoot());
        s.spawn({0, roots.back(), {2, 0, 0, true, Payload::Ray}});
    }
    EXPECT_TRUE(s.run());
    for (int i = 0; i < 40; ++i) // lights of .25, .5, .75 reach the even lanes of each strip of 16
        EXPECT_EQ(s.value(roots[i]).radiance.x, 2 + ((i % 16) % 2 == 0 ? 1.5f : 0.f)) << i;
    // Strips that wait for the same light are lit as one batch.
    EXPECT_EQ(service.lightBatches.size(), 3u);
    EXPECT_EQ(service.lightBatches[0], 40u);
}

// The value of one root without masks: v + fan * value(v/2, levels-1).
float expected(float v, int fan, int levels) {
    float sum = 0, factor = 1;
    for (int l = 0; l <= levels; ++l, factor *= fan * 0.5f) sum += v * factor;
    return sum;
}

TEST(Scheduler, AffineTreesSumUp) {
    FakeService service;
    S s(service);
    auto root = s.newRoot();
    s.spawn({0, root, {1, 3, 4, false}});
    EXPECT_TRUE(s.run());
    EXPECT_EQ(s.value(root).radiance.x, expected(1, 3, 4));
    EXPECT_EQ(s.suspensions(), 0u);
}

TEST(Scheduler, NestedSuspension) {
    FakeService service;
    service.strip = 1; // one lane a strip: no masks, the closed form holds
    S s(service);
    auto root = s.newRoot();
    s.spawn({0, root, {1, 2, 6, true}});
    EXPECT_TRUE(s.run());
    EXPECT_EQ(s.value(root).radiance.x, expected(1, 2, 6));
    EXPECT_EQ(service.deepest, 6);
    EXPECT_GT(s.suspensions(), 60u); // 1 + 2 + ... + 32 strips, each waiting twice
}

TEST(Scheduler, MasksAcrossSuspensions) {
    // 16 lanes, one level: lane i gets v/2 for each step in which it takes part.
    FakeService service;
    S s(service);
    std::vector<AccumulatorId> roots;
    for (int i = 0; i < 16; ++i) {
        roots.push_back(s.newRoot());
        s.spawn({0, roots.back(), {1, 4, 1, true}});
    }
    EXPECT_TRUE(s.run());
    for (int i = 0; i < 16; ++i) {
        float want = 1;
        for (int step = 0; step < 4; ++step)
            if (step == 0 || i % (step + 1) == 0) want += 0.5f;
        EXPECT_EQ(s.value(roots[i]).radiance.x, want) << i;
    }
}

TEST(Scheduler, SameBitsForAnySliceAndStrip) {
    std::vector<float> first;
    for (int slice : {1, 7, 64, 4096}) {
        FakeService service;
        service.strip = 1;
        S s(service, nullptr, limits::kFrameBytesPerThread, slice);
        std::mt19937 rng(7);
        std::vector<AccumulatorId> roots;
        for (int i = 0; i < 40; ++i) {
            roots.push_back(s.newRoot());
            s.spawn({0, roots.back(), {std::uniform_real_distribution<float>(0, 1e3f)(rng), 3, 4, i % 2 == 0}});
        }
        EXPECT_TRUE(s.run());
        std::vector<float> values;
        for (auto r : roots) values.push_back(s.value(r).radiance.x);
        if (first.empty()) first = values;
        EXPECT_EQ(first, values) << "slice " << slice;
        EXPECT_LE(s.largestSlice(), size_t(slice));
    }
}

TEST(Scheduler, DeepestFirstBoundsTheFrames) {
    // 4,096 camera rays, each a tree of depth 8: breadth-first would hold 4096 * 2^7 strips.
    FakeService service;
    S s(service, nullptr, 600'000);
    for (int i = 0; i < 4096; ++i) s.spawn({0, s.newRoot(), {1, 2, 8, true}});
    EXPECT_TRUE(s.run());
    EXPECT_EQ(s.overLimit(), 0u);
    EXPECT_LE(s.peakFrameBytes(), 600'000u);
}

TEST(Scheduler, OverTheLimitIsCountedNotHung) {
    FakeService service;
    service.strip = 1;
    S s(service, nullptr, 2'500); // room for two strips, the tree needs five at a time
    auto root = s.newRoot();
    s.spawn({0, root, {1, 1, 5, true}});
    EXPECT_TRUE(s.run());
    EXPECT_GT(s.overLimit(), 0u);
}

TEST(Scheduler, Cancellation) {
    StopFlag stop{0};
    FakeService service;
    int slices = 0;
    service.onSlice = [&] {
        if (++slices == 5) stop = 1;
    };
    S s(service, &stop, limits::kFrameBytesPerThread, 8);
    for (int i = 0; i < 100; ++i) s.spawn({0, s.newRoot(), {1, 3, 5, true}});
    EXPECT_FALSE(s.run());
    EXPECT_EQ(slices, 5);
}

TEST(Scheduler, SlicesAreBounded) {
    FakeService service;
    S s(service);
    auto root = s.newRoot();
    const int rays = 3 * limits::kSliceRays + 1;
    for (int i = 0; i < rays; ++i) s.spawn({0, root, {1, 0, 0, false}});
    EXPECT_TRUE(s.run());
    EXPECT_EQ(s.largestSlice(), size_t(limits::kSliceRays));
    EXPECT_EQ(s.value(root).radiance, Color(float(rays)));
}

TEST(Scheduler, NonFiniteIsCountedAndDropped) {
    FakeService service;
    S s(service);
    auto root = s.newRoot();
    s.add(root, Color(NAN, 0, 0));
    s.add(root, Color(1, 2, 3));
    EXPECT_EQ(s.value(root).radiance, Color(1, 2, 3));
    EXPECT_EQ(s.nonFinite(), 1u);
}

TEST(ExactSum, OrderDoesNotMatter) {
    std::mt19937 rng(3);
    std::vector<float> v(10000);
    for (auto& x : v) x = std::ldexp(std::uniform_real_distribution<float>(-1, 1)(rng), int(rng() % 60) - 35);
    ExactSum a;
    for (float x : v) a.add(x);
    std::shuffle(v.begin(), v.end(), rng);
    ExactSum b, c;
    for (size_t i = 0; i < v.size(); ++i) (i % 2 ? b : c).add(v[i]);
    b.merge(c);
    EXPECT_EQ(a.toDouble(), b.toDouble());
    ExactSum d;
    for (int i = 0; i < 1000; ++i) d.add(0.1f);
    EXPECT_EQ(d.toDouble(), 1000.0 * double(0.1f));
}

TEST(ExactSum, RoundsEachTermToTheUnit) {
    ExactSum s;
    s.add(0x1p-65); // half a unit: to even, which is 0
    EXPECT_EQ(s.toDouble(), 0.0);
    s.add(0x1.8p-64); // a unit and a half: 2
    s.add(-0x1p-64);
    EXPECT_EQ(s.toDouble(), 0x1p-64);
    s.add(0x1p59);
    s.add(-0x1p59);
    EXPECT_EQ(s.toDouble(), 0x1p-64);
    EXPECT_FALSE(s.saturated());
}

TEST(ExactSum, HugeTermsAreClampedAndNeverOverflow) {
    ExactSum a, b;
    for (int i = 0; i < 1000; ++i) {
        a.add(3e38f);
        b.add(-3e38f);
    }
    EXPECT_TRUE(a.saturated());
    EXPECT_EQ(a.toDouble(), 1000 * 0x1p60);
    EXPECT_EQ(b.toDouble(), -1000 * 0x1p60);
    a.merge(b);
    EXPECT_EQ(a.toDouble(), 0.0);
}

} // namespace

namespace {

// Follows rays in twos: one that is alone is held back until nothing else is left.
class PairingService : public S::RayService {
public:
    int lone = 0;
    void follow(std::span<const S::Task> slice, S& s) override {
        for (const S::Task& t : slice) {
            s.hold(t.target);
            held_.push_back(t);
            if (held_.size() == 2) shade(s);
        }
    }
    bool shadeQueued(S& s) override {
        if (held_.empty()) return false;
        ++lone;
        shade(s);
        return true;
    }

private:
    void shade(S& s) {
        std::vector<S::Task> now;
        now.swap(held_);
        for (const S::Task& t : now) {
            s.add(t.target, Color(t.payload.value));
            if (t.payload.levels > 0) {
                S::Task child = t;
                ++child.depth;
                --child.payload.levels;
                s.spawn(child);
            }
            s.release(t.target);
        }
    }
    std::vector<S::Task> held_;
};

} // namespace

TEST(Scheduler, WhatIsHeldBackIsFollowedInTheEnd) {
    for (int slice : {1, 3, 8, 4096}) {
        PairingService service;
        S s(service, nullptr, limits::kFrameBytesPerThread, slice);
        std::vector<AccumulatorId> roots;
        for (int i = 0; i < 101; ++i) { // ray i: 1 + i % 4 values of i
            roots.push_back(s.newRoot());
            S::Task t;
            t.target = roots.back();
            t.payload.value = float(i);
            t.payload.levels = i % 4;
            s.spawn(t);
        }
        ASSERT_TRUE(s.run());
        EXPECT_GE(service.lone, 1);
        for (int i = 0; i < 101; ++i)
            EXPECT_EQ(s.value(roots[size_t(i)]).radiance.x, float(i * (1 + i % 4))) << slice << " " << i;
    }
}

TEST(Scheduler, TasksWrittenInOneGoAreFollowedLikeThoseThatAreSpawned) {
    FakeService service;
    S s(service);
    std::vector<AccumulatorId> roots;
    for (int k = 0; k < 40; ++k) roots.push_back(s.newRoot());
    ASSERT_TRUE(s.plain());
    for (int k = 0; k < 40; k += 4) {
        S::Task* to = s.room(4, 1);
        const int count = k % 3 == 0 ? 4 : 2; // of the others one is written, and overwritten or forgotten
        for (int i = 0; i < count; ++i) to[i] = {0, roots[size_t(k + i)], {float(k + i), 1, i % 2, false}};
        to[count] = {0, roots[0], {1000, 0, 0, false}};
        s.spawned(size_t(count));
        for (int i = count; i < 4; ++i) s.spawn({0, roots[size_t(k + i)], {float(k + i), 1, i % 2, false}});
    }
    EXPECT_TRUE(s.run());
    for (int k = 0; k < 40; ++k) EXPECT_EQ(s.value(roots[size_t(k)]).radiance.x, float(k) * (k % 2 ? 1.5f : 1)) << k;
}

TEST(TaskList, GrowsAndHandsOver) {
    TaskList<S::Task> a, b;
    for (int k = 0; k < 1000; ++k) a.push({k, k, {float(k)}});
    b.push({-1, -1, {}});
    b.takeLast(a, 300);
    EXPECT_EQ(a.size(), 700u);
    EXPECT_EQ(b.size(), 301u);
    for (int k = 0; k < 1000; ++k) EXPECT_EQ((k < 700 ? a.data()[k] : b.data()[k - 699]).payload.value, float(k));
    EXPECT_EQ(reinterpret_cast<uintptr_t>(a.data()) % 64, 0u);
    a.swap(b);
    EXPECT_EQ(a.back().depth, 999);
    a.clear();
    EXPECT_TRUE(a.empty());
}

} // namespace scheduler_test
