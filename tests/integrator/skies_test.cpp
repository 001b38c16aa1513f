// Skies that are bright in places: maps of every form and arithmetic, sampled where they are bright, met by rays, or both; in
// shadow; in loops and trace(); among many lights; switched off. Closed forms and quadratures on a large white floor.
#include "base/limits.h"
#include "integrator/floorscene.h"
#include "integrator/maps.h"
#include "texture/texture.h"

namespace skies_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

constexpr double kSun = .3; // half angle of the sun; 0.955336489125606 is its cosine
constexpr double kRadiance = 50, kDim = .1;
/// The floor's diffuse() under a sun straight above and a dim sky.
const double kLit = kDim + (kRadiance - kDim) * std::sin(kSun) * std::sin(kSun);

const char* const kLambert = "Surface \"matte\" \"float Ka\" 0 \"float Kd\" 1\n";

void writeLooks() {
    writeShader("sunny", R"(light sunny(float sun = 50, dim = .1, __importancesample = 1; vector up = vector "world" (0, 1, 0);) {
    solar() Cl = (normalize(-L) . up > 0.955336489125606) ? sun : dim;
}
)");
    writeShader("sunloop", R"(surface sunloop(float angle = PI / 2;) {
    normal Nf = faceforward(normalize(N), I);
    color sum = 0;
    illuminance(P, Nf, angle) { sum += Cl * (normalize(L) . Nf); }
    Oi = 1;
    Ci = sum;
}
)");
    writeShader("suntrace", R"(surface suntrace(float maxdist = 1e30;) {
    normal Nf = faceforward(normalize(N), I);
    Oi = 1;
    Ci = trace(P, vector(Nf), "distribution", "cosine", "samplecone", PI / 2, "samplearealights", 1, "type", "diffuse",
               "maxdist", maxdist);
}
)");
}
Settings of(int mode) {
    Settings s = under(Hider::Path);
    s.bsdfOnly = mode == 1;
    s.lightOnly = mode == 2;
    return s;
}
std::string lit(const std::string& lights, const std::string& floor = kLambert, const std::string& more = "") {
    return inWorld(lights + more + floor + kFloor);
}
const char* const kSunny = "LightSource \"sunny\" 1\n";

} // namespace

TEST(Skies, ASunByArithmetic) {
    writeLooks();
    for (const int mode : {0, 1, 2}) {
        Scene s(lit(kSunny), of(mode));
        ASSERT_EQ(s.messages(), "");
        // Rays alone find 8.7 % of what they are sent for: 50 of variance for 4.5 of mean.
        expectMean(s.estimate(kView, samples(mode == 1 ? 200'000 : 20'000)), kLit, .02, "mode " + std::to_string(mode));
    }
    // What the table is for: the same light with a fraction of the noise of rays alone.
    Scene both(lit(kSunny), of(0)), rays(lit(kSunny), of(1));
    const Moments a = both.estimate(kView, 20'000), b = rays.estimate(kView, 20'000);
    EXPECT_LT(a.se(), b.se() / 5);
}

// A sun as wide as the real one, .265 degrees of half angle, in a sky by arithmetic whose cells are .7 degrees wide: radiance L
// over a cap of half angle a lights a floor under it with L sin^2 a. A light sample is uniform over the cells that the sun
// touches, so its relative standard deviation is sqrt(1 / f - 1) if the sun fills the fraction f of them: 2.3 for two cells, each
// way, and below 1 where parts of cells, .02 degrees wide, follow its edge.
TEST(Skies, ASunBelowTheSizeOfCells) {
    writeShader("smallsun", R"(light smallsun(vector up = vector "world" (0, 1, 0);) {
    solar() Cl = normalize(-L) . up > 0.99998930399 ? 60000 : 0.1;
}
)");
    const double half = .004625, want = .1 + 60000 * std::sin(half) * std::sin(half);
    Scene s(lit("LightSource \"smallsun\" 1\n"), of(0));
    const int n = samples(20000);
    const Moments m = s.estimate(kView, n);
    expectMean(m, want, .01, "a small sun");
    EXPECT_LT(m.se() * std::sqrt(n), want);
}

TEST(Skies, EvenOnesAreLeftToRays) {
    Scene s(lit("LightSource \"envlight\" 1 \"float intensity\" 3\n"), withShaders(Hider::Path));
    Counters c;
    const Moments m = s.estimate(kView, 2000, &c);
    EXPECT_NEAR(m.mean(), 3, 1e-5); // every ray brings the same
    EXPECT_EQ(c.shadow, 0u);
}

TEST(Skies, ShadowsAndPanes) {
    writeLooks();
    // A half plane through the axis takes half of the sun and of the sky; a pane over all leaves what it lets through.
    const std::string dark = "AttributeBegin\nSurface \"constant\"\nColor 0 0 0\n",
                      wall = "Polygon \"P\" [0 .5 -60 0 .5 60 60 .5 60 60 .5 -60]\n";
    const std::string pane = "Opacity .25 .25 .25\nPolygon \"P\" [-60 .5 -60 -60 .5 60 60 .5 60 60 .5 -60]\n";
    const CameraRay low = rayTo({-.3f, .2f, -.4f}, {0, 0, 0}); // under the pane
    for (const int mode : {0, 1, 2}) {
        const int n = samples(mode == 1 ? 400'000 : 40'000);
        Scene half(lit(kSunny, kLambert, dark + wall + "AttributeEnd\n"), of(mode));
        expectMean(half.estimate(low, n), kLit / 2, .02, "half, mode " + std::to_string(mode));
        Scene through(lit(kSunny, kLambert, dark + pane + "AttributeEnd\n"), of(mode));
        expectMean(through.estimate(low, n), kLit * .75, .02, "pane, mode " + std::to_string(mode));
    }
}

TEST(Skies, LoopsTracesAndSets) {
    writeLooks();
    Scene loop(lit(kSunny, "Surface \"sunloop\"\n"), of(0));
    expectMean(loop.estimate(kView, samples(40'000)), kLit, .02, "loop");
    Scene cone(lit(kSunny, "Surface \"sunloop\" \"float angle\" .2\n"), of(0)); // within the sun
    expectMean(cone.estimate(kView, samples(40'000)), kRadiance * std::pow(std::sin(.2), 2), .02, "cone");
    for (const int mode : {0, 1, 2}) {
        const int n = samples(mode == 1 ? 200'000 : 20'000);
        Scene trace(lit(kSunny, "Surface \"suntrace\"\n"), of(mode));
        expectMean(trace.estimate(kView, n), kLit, .02, "trace, mode " + std::to_string(mode));
        // Behind a distance the sky is seen again.
        const std::string roof = "AttributeBegin\nSurface \"constant\"\nColor 0 0 0\nPolygon \"P\" [-60 2 -60 -60 2 60 60 2 60 "
                                 "60 2 -60]\nAttributeEnd\n";
        Scene under(lit(kSunny, "Surface \"suntrace\" \"float maxdist\" 1.5\n", roof), of(mode));
        const Moments m = under.estimate(kView, n);
        // Rays steeper than acos(1.5 / 2) to the floor go 1.5 and meet nothing: all of the sun is among them... and those that
        // meet the roof within it do not exist: 2 is further than 1.5.
        expectMean(m, kLit, .02, "maxdist, mode " + std::to_string(mode));
    }
    // samplingstrategy: a loop's sky is not a trace's, and the other way round.
    const std::string loops = "Attribute \"light\" \"samplingstrategy\" \"illuminance\"\n",
                      traces = "Attribute \"light\" \"samplingstrategy\" \"trace\"\n";
    EXPECT_EQ(Scene(lit(loops + kSunny, "Surface \"suntrace\"\n"), of(0)).estimate(kView, 2000).mean(), 0);
    EXPECT_EQ(Scene(lit(traces + kSunny, "Surface \"sunloop\"\n"), of(0)).estimate(kView, 2000).mean(), 0);
    for (const std::string& which : {loops, traces})
        expectMean(Scene(lit(which + kSunny), of(0)).estimate(kView, samples(20'000)), kLit, .02, which);
}

TEST(Skies, WithoutImportance) {
    writeLooks();
    Scene s(lit("LightSource \"sunny\" 1 \"float __importancesample\" 0\n"), of(0));
    Counters c;
    expectMean(s.estimate(kView, samples(200'000), &c), kLit, .02, "rays alone");
    EXPECT_EQ(c.shadow, 0u);
    // An emitter, too.
    const std::string lamp = "AttributeBegin\nSurface \"constant\"\nColor 0 0 0\nAreaLightSource \"unsampled\" 1\nTranslate 0 2 "
                             "0\nRotate 90 1 0 0\nDisk 0 .7 360\nAttributeEnd\nIlluminate 1 1\n";
    writeShader("unsampled", "light unsampled(float __importancesample = 0;) { illuminate(P, N, PI / 2) Cl = 5; }\n");
    Scene area(lit(lamp), of(0));
    Counters none;
    expectMean(area.estimate(kView, samples(100'000), &none), 5 * .49 / 4.49, .02, "a disk that rays find");
    EXPECT_EQ(none.shadow, 0u);
}

TEST(Skies, OffForASurface) {
    writeLooks();
    Scene off(lit(kSunny, "Illuminate 1 0\n" + std::string(kLambert)), of(0));
    EXPECT_EQ(off.estimate(kView, 2000).mean(), 0);
    Scene even(lit("LightSource \"envlight\" 1\nLightSource \"ambientlight\" 2\n",
                   "Illuminate 1 0\nIlluminate 2 0\n" + std::string(kLambert)),
               withShaders(Hider::Path));
    EXPECT_EQ(even.estimate(kView, 2000).mean(), 0);
}

TEST(Skies, AmongManyLights) {
    writeLooks();
    std::string lights;
    double want = kLit;
    for (int i = 0; i < 40; ++i) {
        const double x = std::sin(i * 1.7) * (1 + i % 7), z = std::cos(i * 2.3) * (1 + i % 5), y = .6 + .31 * (i % 4),
                     power = .05 + .02 * (i % 3);
        const double d2 = x * x + y * y + z * z;
        lights += "LightSource \"pointlight\" " + std::to_string(i + 2) + " \"float intensity\" " + std::to_string(power) +
                  " \"point from\" [" + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "]\n";
        want += power * y / std::sqrt(d2) / d2;
    }
    // Light samples alone are no test: at the rim of the sun cells whose points all miss it are drawn too seldom, which rays make
    // up for.
    Scene many(lit(kSunny + lights), withShaders(Hider::Path));
    Counters c;
    const int n = samples(40'000);
    expectMean(many.estimate(kView, n, &c), want, .02, "sum of all");
    EXPECT_LE(double(c.shadow) / n, limits::kLightsSampled + 1.5);
}

// envlight with maps: a picture over latitude and longitude, a cube of six, and a plain picture; the irradiance by quadrature
// over the lookups themselves.
TEST(Skies, Maps) {
    writeLooks();
    const auto value = [](int x, int y, int c) {
        return x >= 20 && x < 24 && y >= 3 && y < 6 ? 40.f + 10 * float(c) : .05f * float(c + 1);
    };
    const std::string latlong = writeMap("skylatlong.exr", 64, 32, value);
    Diagnostics said;
    texture::TextureSystem textures(said);
    const texture::Handle map = textures.open(latlong.substr(1, latlong.size() - 2));
    ASSERT_TRUE(map);
    // The shader space of the light is the world turned so that the map's pole, z, is up.
    const std::string light =
        "TransformBegin\nRotate -90 1 0 0\nLightSource \"envlight\" 1 \"string mapname\" " + latlong + "\nTransformEnd\n";
    double want = 0;
    constexpr int kSteps = 1500;
    for (int i = 0; i < kSteps; ++i)
        for (int k = 0; k < kSteps; ++k) { // directions whose squared cosine is even over the hemisphere: a cosine lobe's
            const double up = std::sqrt((i + .5) / kSteps), away = std::sqrt(1 - up * up), turn = 2 * kPi * (k + .5) / kSteps;
            float v[3];
            texture::environment(map, textures.latLong(), 0, 3,
                                 Vec3(float(away * std::cos(turn)), float(away * std::sin(turn)), float(up)), {}, {}, {}, v);
            want += v[0] / double(kSteps) / kSteps;
        }
    for (const int mode : {0, 1, 2}) {
        Settings s = withShaders(Hider::Path);
        s.bsdfOnly = mode == 1, s.lightOnly = mode == 2;
        Scene seen(lit(light), s);
        EXPECT_EQ(seen.messages(), "");
        // 0.5 %: the quadrature's steps at the edges of texels; its halves of steps agree to .1 %.
        const Moments m = seen.estimate(kView, samples(mode == 1 ? 400'000 : 40'000));
        EXPECT_LE(std::fabs(m.mean() - want), kZ * m.se() + .002 * want)
            << "mode " << mode << ": " << m.mean() << " +- " << m.se() << ", " << want;
        EXPECT_LE(m.se(), .02 * want);
    }
}

} // namespace skies_test
