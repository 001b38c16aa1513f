// The stage between hit and shader: events on the way of rays, as media with distance sampling and walks inside of surfaces have
// them.
#include "integrator/floorscene.h"
#include "integrator/pipeline.h"
#include "integrator/raystore.h"
#include "integrator/segmentevents.h"

namespace segmentevents_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

struct Event : SegmentEvent {
    SegmentEvents* events = nullptr; ///< that it happens in
};

/// The mean of n samples of a ray, traced where `event` may happen.
Moments estimate(Scene& s, Event& event, CameraRay ray, int n) {
    Pipeline pipeline(std::static_pointer_cast<const WorldImpl>(s.world), s.diagnostics);
    event.events = &pipeline.stages().segmentEvents;
    event.events->happens(event);
    std::vector<CameraRay> rays;
    for (int i = 0; i < n; ++i) {
        ray.px = i;
        rays.push_back(ray);
    }
    std::vector<SampleResult> out(rays.size());
    EXPECT_TRUE(pipeline.trace(rays, out, nullptr));
    Moments m;
    for (const SampleResult& r : out) m.add(r.color);
    return m;
}

/// Fills all of space and absorbs: whether a ray comes as far as its hit is drawn, for shadow rays the chance is taken.
class Absorbs final : public Event {
public:
    void happen(std::span<RaySegment> some, Sched&) override {
        for (RaySegment& f : some)
            f.over |= Random(f.ray->sample->numbers).one(f.ray->vertex, kSegmentEvent, 0) >= std::exp(-kSigma * f.length);
    }
    void dim(std::span<const ShadowRay> rays, std::span<Color> out) override {
        for (size_t i = 0; i < rays.size(); ++i) out[i] *= std::exp(-kSigma * rays[i].distance);
    }
    static constexpr float kSigma = .7f;
};

const double kWay = std::sqrt(.3 * .3 + .8 * .8 + .4 * .4); // of kView

TEST(RaySegment, WhatIsAbsorbedOnTheWayDoesNotArrive) {
    Absorbs absorbs;
    for (const Hider h : {Hider::Hidden, Hider::Path}) {
        Scene s(inWorld("Surface \"constant\" Color .25 .5 .75 " + std::string(kFloor)), withShaders(h));
        const Moments m = estimate(s, absorbs, kView, 1 << 14);
        for (int k = 0; k < 3; ++k) {
            const double want = .25 * (k + 1) * std::exp(-Absorbs::kSigma * kWay);
            EXPECT_NEAR(m.mean(k), want, kZ * m.se(k)) << "hider " << int(h);
            EXPECT_LT(m.se(k), .02 * want);
        }
    }
}

TEST(RaySegment, ShadowRaysAreDimmedLikewise) {
    // A point light two above the floor, of irradiance pi there; both ways are through the medium.
    Absorbs absorbs;
    Scene s(
        inWorld("LightSource \"pointlight\" 1 \"intensity\" 4 \"point from\" [0 2 0] Surface \"matte\" \"Ka\" 0 \"Kd\" 1 Color "
                ".5 .5 .5 " +
                std::string(kFloor)),
        withShaders(Hider::Path));
    const Moments m = estimate(s, absorbs, kView, 1 << 14);
    const double want = .5 * std::exp(-Absorbs::kSigma * (kWay + 2));
    EXPECT_NEAR(m.mean(), want, kZ * m.se());
    EXPECT_LT(m.se(), .03 * want);
}

/// Rays that leave the scene for good are over.
class NoSky final : public Event {
public:
    void happen(std::span<RaySegment> some, Sched&) override {
        for (RaySegment& f : some) f.over |= f.point == nullptr;
    }
    void dim(std::span<const ShadowRay>, std::span<Color>) override {}
};

TEST(RaySegment, RaysThatMeetNothingPassThroughItToo) {
    Scene s(inWorld("LightSource \"envlight\" 1 Surface \"constant\" " + std::string(kFloor)), withShaders(Hider::Path));
    const CameraRay up = rayTo({0, 1, 0}, {0, 2, 0});
    EXPECT_GT(s.one(up).x, .5f);
    NoSky none;
    EXPECT_EQ(estimate(s, none, up, 4).mean(), 0);
    EXPECT_NEAR(estimate(s, none, kView, 4).mean(), 1, 1e-6); // what meets the floor is shaded as ever
}

/// What meets the floor comes out elsewhere, in another direction: as a walk inside of a surface does.
class ComesOutElsewhere final : public Event {
public:
    void happen(std::span<RaySegment> some, Sched& sched) override {
        for (RaySegment& f : some) {
            if (f.over || !f.point || f.ray->layers > 0) continue;
            PathRay next = *f.ray;
            next.origin = {0, 5, 0};
            next.dir = {0, 1, 0};
            next.weight = f.ray->weight * Color(.5f, 1, 1);
            next.vertex = childVertex(f.ray->vertex, kSegmentEvent, 0);
            ++next.layers;
            events->spawn(f, next, sched);
        }
    }
    void dim(std::span<const ShadowRay>, std::span<Color>) override {}
};

TEST(RaySegment, ARayCanGoOnElsewhere) {
    ComesOutElsewhere walk;
    const std::string ceiling = "Polygon \"P\" [-60 9 -60  -60 9 60  60 9 60  60 9 -60]\n";
    for (const Hider h : {Hider::Hidden, Hider::Raytrace, Hider::Path}) {
        Scene s(inWorld("Surface \"constant\" Color 1 0 0 " + std::string(kFloor) + "Color .25 .5 .75 " + ceiling),
                withShaders(h));
        EXPECT_EQ(s.one(kView), Color(1, 0, 0));
        const Moments m = estimate(s, walk, kView, 300);
        EXPECT_NEAR(m.mean(0), .125, 1e-6) << "hider " << int(h);
        EXPECT_NEAR(m.mean(1), .5, 1e-6);
        EXPECT_NEAR(m.mean(2), .75, 1e-6);
        EXPECT_EQ(m.se(1), 0);
    }
}

} // namespace

} // namespace segmentevents_test
