// Hemispheres that are interpolated: gradients of records against closed forms, and pictures that read them against exact ones.
#include "integrator/floorscene.h"
#include "world/records.h"
#include <algorithm>
#include <cmath>

namespace records_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const std::string kSeen = "Attribute \"visibility\" \"integer transmission\" 1 \"integer diffuse\" 1 \"integer specular\" 1\n";
const std::string kWall =
    "AttributeBegin Surface \"constant\" Color 1 1 1 Polygon \"P\" [.5 0 -9000  .5 0 9000  .5 1 9000  .5 1 -9000] AttributeEnd\n";

/// What a wall of that height at distance x takes of the hemisphere over a floor, by the cosine; and how that changes with x.
double ofWall(double x, double h) { return (1 - x / std::sqrt(x * x + h * h)) / 2; }
double slopeOfWall(double x, double h) { return -h * h / (2 * std::pow(x * x + h * h, 1.5)); }

/// A record about +z of what `sees` gives for each direction: light, and the distance that it comes from.
LightRecord recordOf(int rings, int turns, const std::function<std::pair<double, double>(const Vec3d&)>& sees) {
    std::vector<Color> light;
    std::vector<float> way;
    for (int j = 0; j < rings; ++j)
        for (int k = 0; k < turns; ++k) {
            const double s2 = (j + .5) / rings, s = std::sqrt(s2), a = 2 * M_PI * (k + .5) / turns;
            const auto [l, r] = sees({s * std::cos(a), s * std::sin(a), std::sqrt(1 - s2)});
            light.push_back(Color(float(l)));
            way.push_back(float(r));
        }
    LightRecord r;
    r.change = .2f;
    r.N = Vec3(0, 0, 1);
    r.take({Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}, rings, turns, light, way, 1e-6f, 1e9f);
    return r;
}

TEST(Records, TurnedTowardHalfASky) {
    // Half a ball of light about x: a plane whose normal is `a` away from x sees (1 + cos a) / 2 of it.
    const LightRecord r = recordOf(1600, 60, [](const Vec3d& w) { return std::pair(w.x > 0 ? 1. : 0., 1e38); });
    EXPECT_NEAR(r.light.x, .5, 1e-6);
    EXPECT_NEAR(dot(cross(r.N, Vec3(1, 0, 0)), r.turned[0]), .5, .01); // to x; the derivative is sin a / 2
    EXPECT_NEAR(dot(cross(r.N, Vec3(0, 1, 0)), r.turned[0]), 0, .01);
    EXPECT_EQ(length(r.moved[0]), 0);
}

TEST(Records, MovedTowardAWall) {
    for (const double x : {.25, .5, 2.}) {
        const LightRecord r = recordOf(300, 600, [&](const Vec3d& w) {
            const double t = w.x > 0 ? x / w.x : 1e38;
            return t < 1e30 && t * w.z < 1 ? std::pair(1., t) : std::pair(0., 1e38);
        });
        EXPECT_NEAR(r.light.x, ofWall(x, 1), .01) << x;
        EXPECT_NEAR(r.moved[0].x, -slopeOfWall(x, 1), .03 * -slopeOfWall(x, 1)) << x; // nearer by so much
        EXPECT_NEAR(r.moved[0].y, 0, .01) << x;
        EXPECT_LE(r.distance, r.light.x / r.moved[0].x * 1.001) << x;
    }
}

TEST(Records, ReachAsManyPixelsAsTheyMay) {
    const auto of = [](float pixel, float most) {
        LightRecord r;
        r.change = .2f;
        r.take({Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}, 2, 6, std::vector<Color>(12, Color(1)), std::vector<float>(12, 1.f),
               pixel, most);
        return r.distance * r.change;
    };
    EXPECT_NEAR(of(.01f, 1000), .2, 1e-6); // the harmonic mean of the distances, 1, times the change
    EXPECT_NEAR(of(.01f, 10), .1, 1e-6);
    EXPECT_NEAR(of(1, 10), 1.5, 1e-6); // a pixel and a half at least
}

TEST(Records, DoNotDependOnTheirOrder) {
    std::vector<LightRecord> all;
    for (int i = 0; i < 200; ++i) {
        LightRecord r;
        r.P = Vec3(float(i % 20) * .1f, float(i / 20) * .1f, 0);
        r.N = Vec3(0, 0, 1);
        r.light = Color(float(i) * .013f, 1.f / float(i + 1), .3f);
        r.distance = .7f;
        r.change = .5f;
        r.call = 1 + uint64_t(i % 3);
        r.place = {i / 20, i % 20, 0, 0, 0};
        all.push_back(r);
    }
    const auto read = [](const std::vector<LightRecord>& records, uint64_t call, const Vec3& p) {
        LightRecords kept;
        for (const LightRecord& r : records) kept.add(r);
        EXPECT_EQ(kept.keep(), records.size());
        Color c(-1);
        kept.find(call, p, Vec3(0, 0, 1), c);
        return c;
    };
    std::vector<LightRecord> turned(all.rbegin(), all.rend());
    for (const Vec3& p : {Vec3(.3f, .4f, 0), Vec3(1.91f, .03f, .01f), Vec3(-.2f, 0, 0)})
        for (const uint64_t call : {1, 2, 3, 4}) {
            EXPECT_EQ(read(all, call, p), read(turned, call, p));
            EXPECT_EQ(read(all, call, p) == Color(-1), call == 4);
        }
    EXPECT_EQ(read(all, 1, Vec3(5, 5, 5)), Color(-1));
}

/// A floor whose shader gives `value`; passes of camera rays that find records, in `order`.
struct Interpolated {
    Scene scene;
    explicit Interpolated(const std::string& name, const std::string& value, Hider h, bool backwards = false)
        : scene(inWorld((writeShader(name, "surface " + name + "() { vector up = vector \"world\" (0, 1, 0); Ci = " + value +
                                               "; Oi = 1; }\n"),
                         kSeen + "Surface \"" + name + "\"\n" + kFloor + kWall)),
                withShaders(h)) {
        for (int step = 4; step >= 1; step /= 2) {
            std::vector<CameraRay> rays;
            for (int y = 0; y < 16; y += step)
                for (int x = 0; x < 16; x += step) rays.push_back(at(x, y)), rays.back().records = true;
            if (backwards) std::reverse(rays.begin(), rays.end());
            for (size_t i = 0; i < rays.size(); i += 7)
                scene.trace(std::span(rays).subspan(i, std::min<size_t>(7, rays.size() - i)));
            records = scene.world->keepRecords();
        }
    }
    static CameraRay at(double x, double y) {
        CameraRay r = rayTo({0, 1, -.2f}, {float(-.2 + x * .03), 0, float(-.2 + y * .03)});
        r.width = 0;
        r.spread = .01f;
        r.px = int(x * 8);
        r.py = int(y * 8);
        return r;
    }
    size_t records = 0;
};

TEST(Records, GiveWhatExactCallsGive) {
    for (const Hider h : {Hider::Raytrace, Hider::Path})
        for (const char* value :
             {"indirectdiffuse(P, up, 1024, \"maxvariation\", .04)", "color occlusion(P, up, 1024, \"maxvariation\", .04)",
              "color (pow(occlusion(P, up, 1024, \"maxvariation\", .04), 1))"}) {
            Interpolated i("recwall", value, h);
            EXPECT_TRUE(i.scene.world->interpolates());
            EXPECT_GT(i.records, 3u);
            EXPECT_LT(i.records, 256u);
            Counters n;
            double worst = 0, sum = 0;
            for (int k = 0; k < 60; ++k) {
                const CameraRay ray = Interpolated::at(.37 + k * .25, 2.71 + (k * 7 % 11));
                const Vec3 hit = ray.origin + ray.direction * (-ray.origin.y / ray.direction.y);
                const double want = ofWall(.5 - hit.x, 1), got = i.scene.trace({&ray, 1}, &n)[0].color.x;
                worst = std::max(worst, std::fabs(got / want - 1));
                sum += got / want - 1;
            }
            EXPECT_EQ(n.interpolated, 60u) << value;
            EXPECT_EQ(n.diffuse + n.shadow, 0u) << value;
            EXPECT_LT(worst, .1) << value;
            EXPECT_NEAR(sum / 60, 0, .03) << value;
        }
}

TEST(Records, AreTheSameInAnyOrder) {
    for (const Hider h : {Hider::Raytrace, Hider::Path}) {
        const char* value = "indirectdiffuse(P, up, 32, \"maxvariation\", .02) + occlusion(P, up, 32, \"maxvariation\", .02)";
        Interpolated a("recorder", value, h), b("recorder", value, h, true);
        EXPECT_EQ(a.records, b.records);
        for (int k = 0; k < 40; ++k) {
            const CameraRay ray = Interpolated::at(k * .4, 15 - k * .35);
            EXPECT_EQ(a.scene.one(ray), b.scene.one(ray)) << k;
        }
    }
}

TEST(Records, OnlyWhereTheyAreAskedFor) {
    for (const char* value : {"indirectdiffuse(P, up, 16)", "color occlusion(P, up, 16)",
                              "color occlusion(P, up, 16, \"maxerror\", .5, \"maxpixeldist\", 20)"}) {
        Interpolated i("recnone", value, Hider::Raytrace);
        EXPECT_FALSE(i.scene.world->interpolates()) << value;
        EXPECT_EQ(i.records, 0u);
    }
    // Asked for, but not of what records hold, or with 0.
    for (const char* value :
         {"indirectdiffuse(P, up, 16, \"maxvariation\", 0)", "indirectdiffuse(P, up, 16, \"maxvariation\", .1, \"coneangle\", 1)",
          "color occlusion(P, up, 16, \"maxvariation\", .1, \"axis\", up)",
          "color occlusion(P, up, 16, \"maxvariation\", sqrt(-1) * 0 / 0)"}) {
        Interpolated i("recpart", value, Hider::Raytrace);
        EXPECT_EQ(i.records, 0u) << value;
    }
}

// Two halves of a floor, side by side, of one shader: rays of one do not meet the wall. Each keeps records of its own.
TEST(Records, AreOfTheRaysThatTheirSurfacesSend) {
    writeShader("recgroups", "surface recgroups() { vector up = vector \"world\" (0, 1, 0); Oi = 1; Ci = color occlusion(P, up, "
                             "256, \"maxvariation\", .2); }\n");
    const auto half = [](const char* subset, const char* x) {
        return "AttributeBegin Attribute \"grouping\" \"string tracesubset\" \"" + std::string(subset) +
               "\" Surface \"recgroups\" Polygon \"P\" [" + x + "] AttributeEnd\n";
    };
    Scene s(inWorld(kSeen + half("walls", "-60 0 -60  -60 0 0  60 0 0  60 0 -60") +
                    half("others", "-60 0 0  -60 0 60  60 0 60  60 0 0") +
                    "Attribute \"grouping\" \"string membership\" \"walls\"\n" + kWall),
            withShaders(Hider::Raytrace));
    for (int step = 4; step >= 1; step /= 2) {
        for (int y = 0; y < 16; y += step)
            for (int x = 0; x < 16; x += step) {
                CameraRay ray = Interpolated::at(x, y);
                ray.records = true;
                s.trace({&ray, 1});
            }
        s.world->keepRecords();
    }
    for (int k = 0; k < 30; ++k) {
        const CameraRay ray = Interpolated::at(.37 + k * .5, .4 + k % 5 + (k % 2 ? 9 : 0));
        const Vec3 hit = ray.origin + ray.direction * (-ray.origin.y / ray.direction.y);
        EXPECT_NEAR(s.one(ray).x, hit.z < 0 ? ofWall(.5 - hit.x, 1) : 0, .03) << hit.x << " " << hit.z;
    }
}

} // namespace

} // namespace records_test
