// Photon maps: nearest photons against a slow search, density estimates against known densities, files against damage.
#include "base/file.h"
#include "base/hash.h"
#include "photonmap/photonfile.h"
#include "photonmap/photongrid.h"
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <set>
#include <unistd.h>

namespace photonmap_test {

using namespace alpenglow;
using namespace alpenglow::photonmap;

namespace {

float number(uint64_t& state) { return unitFloat(uint32_t(mix64(++state) >> 32)); }

/// `count` photons that carry 1 together, evenly over the square from 0 to 1 of the plane y = 0; from above.
std::vector<Photon> evenly(int count, uint64_t seed) {
    std::vector<Photon> all;
    uint64_t state = seed << 32;
    for (int i = 0; i < count; ++i) {
        Photon p;
        p.P = {number(state), 0, number(state)};
        p.power = Color(1.f / float(count), .5f / float(count), 0);
        p.from = packUnit({0, 1, 0});
        p.normal = packUnit({0, 1, 0});
        p.reflected[0] = p.reflected[1] = 51; // a fifth
        p.bounces = uint8_t(i % 3);
        all.push_back(p);
    }
    return all;
}

TEST(Photons, DirectionsAreKept) {
    uint64_t state = 5;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 v = normalize(Vec3(number(state) - .5f, number(state) - .5f, number(state) - .5f));
        EXPECT_LT(length(unpackUnit(packUnit(v)) - v), 7e-5f);
    }
    for (const Vec3 v : {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)}) EXPECT_EQ(unpackUnit(packUnit(v)), v);
}

TEST(PhotonMap, NearestAreThoseOfASlowSearch) {
    std::vector<Photon> all = evenly(3000, 1);
    for (size_t i = 0; i < all.size(); i += 7) all[i].P.y = .3f; // another floor
    const PhotonMap map(all);
    uint64_t state = 9;
    for (int turn = 0; turn < 200; ++turn) {
        PhotonMap::Lookup l;
        l.P = {number(state), .02f, number(state)};
        l.N = {0, 1, 0};
        l.estimator = 1 + turn % 60;
        l.minBounces = turn % 3;
        std::vector<std::pair<float, Color>> near;
        for (const Photon& p : all)
            if (p.bounces >= l.minBounces) near.push_back({dot(p.P - l.P, p.P - l.P), p.power});
        std::sort(near.begin(), near.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
        double sum = 0;
        for (int k = 0; k < l.estimator; ++k) sum += double(near[size_t(k)].second.x);
        const double want = sum / (kPi * double(near[size_t(l.estimator)].first));
        EXPECT_NEAR(map.irradiance(l).x, want, 2e-5 * want) << turn;
    }
    EXPECT_NEAR(map.power().x, 1, 1e-4);
}

// Far from all photons, or on a side on which none lies, most of them are not looked at; what is found is the same.
TEST(PhotonMap, LooksAtFewPhotonsFromAfar) {
    std::vector<Photon> all = evenly(20000, 2);
    const PhotonMap map(all);
    const Vec3 up(0, 1, 0);
    for (const Vec3 at : {Vec3(.5f, 0, 9), Vec3(-7, 0, .3f), Vec3(.5f, 6, .5f), Vec3(4, 2, -3), Vec3(.2f, 0, .6f)}) {
        uint64_t visited = 0;
        PhotonMap::Lookup l{at, up, 400, 0, &visited};
        const float e = map.irradiance(l).x;
        EXPECT_LT(visited, 3000u) << at.x;
        std::vector<float> far;
        for (const Photon& p : all) far.push_back(dot(p.P - at, p.P - at));
        std::nth_element(far.begin(), far.begin() + 400, far.end());
        const double want = 400. / 20000 / (kPi * double(far[400]));
        EXPECT_NEAR(e, want, 1e-4 * want) << at.x;
    }
    for (const Vec3 n : {-up, Vec3(1, 0, 0), normalize(Vec3(1, .4f, 0))}) {
        uint64_t visited = 0;
        EXPECT_EQ(map.irradiance({{.5f, 0, .5f}, n, 400, 0, &visited}).x, 0);
        EXPECT_LT(visited, 10u);
    }
    // One photon of another side among them is found.
    all[777].normal = packUnit(-up), all[777].from = packUnit(-up);
    all[778] = all[777];
    EXPECT_GT(PhotonMap(all).irradiance({{.5f, 0, .5f}, -up, 400, 0}).x, 0);
}

// The estimate is right in the mean: irradiance 1 within the square. (With the k-th photon's own disc and all k of them it would
// be k / (k - 1) too bright, 25 % at 5.)
TEST(PhotonMap, RightInTheMean) {
    for (const int estimator : {1, 2, 5, 50}) {
        double sum = 0, squares = 0;
        const int turns = 4000;
        for (int turn = 0; turn < turns; ++turn) {
            const PhotonMap map(evenly(400, 100 + uint64_t(turn)));
            const double e = map.irradiance({{.5f, 0, .5f}, {0, 1, 0}, estimator, 0}).x;
            sum += e, squares += e * e;
        }
        const double mean = sum / turns, error = std::sqrt((squares / turns - mean * mean) / turns);
        if (estimator > 2)
            EXPECT_NEAR(mean, 1, 4.5 * error) << estimator; // the variance of 1 / r^2 is infinite for the first two
        else EXPECT_GT(mean, .8) << estimator;
    }
}

TEST(PhotonMap, SidesBouncesAndReflection) {
    std::vector<Photon> all = evenly(20000, 3);
    const PhotonMap map(all);
    const Vec3 at(.5f, 0, .5f), up(0, 1, 0);
    EXPECT_NEAR(map.irradiance({at, up, 500, 0}).x, 1, .15);
    EXPECT_NEAR(map.irradiance({at, up, 500, 0}).y, .5, .08);
    EXPECT_NEAR(map.irradiance({at, up, 500, 1}).x, 2 / 3., .1);
    EXPECT_NEAR(map.irradiance({at, up, 500, 2}).x, 1 / 3., .05);
    EXPECT_EQ(map.irradiance({at, up, 500, 3}).x, 0);
    EXPECT_EQ(map.irradiance({at, -up, 500, 0}).x, 0);
    EXPECT_EQ(map.irradiance({at, Vec3(1, 0, 0), 500, 0}).x, 0);
    EXPECT_NEAR(map.radiance({at, up, 500, 0}).x, .2 / kPi, .03 / kPi);
    EXPECT_EQ(map.radiance({at, up, 500, 0}).z, 0);
    const float none = std::nanf("");
    EXPECT_EQ(map.irradiance({{none, 0, 0}, up, 5, 0}).x, 0);
    EXPECT_EQ(map.irradiance({at, {none, 0, 0}, 5, 0}).x, 0);
    EXPECT_EQ(PhotonMap().irradiance({at, up, 5, 0}).x, 0);
}

TEST(PhotonGrid, FindsAllWithinTheRadiusOnce) {
    const std::vector<Photon> all = evenly(5000, 4);
    for (const float radius : {.003f, .05f, .4f}) {
        const PhotonGrid grid(all, radius);
        uint64_t state = 1;
        for (int turn = 0; turn < 100; ++turn) {
            const Vec3 at(number(state) * 1.2f - .1f, number(state) * .02f - .01f, number(state) * 1.2f - .1f);
            std::multiset<float> found, want;
            grid.within(at, 0, [&](const Photon& p) { found.insert(p.P.x); });
            for (const Photon& p : all)
                if (dot(p.P - at, p.P - at) < radius * radius) want.insert(p.P.x);
            EXPECT_EQ(found, want) << radius;
        }
    }
}

// Of what moves those count that were there at nearly the same time; at both ends of the shutter the window is cut.
TEST(PhotonGrid, FindsThoseOfATime) {
    const std::vector<Photon> all = evenly(5000, 4);
    std::vector<float> times;
    uint64_t state = 7;
    for (size_t i = 0; i < all.size(); ++i) times.push_back(number(state));
    const PhotonGrid grid(all, .3f, times, .2f);
    for (const float time : {0.f, .05f, .5f, 1.f}) {
        const Vec3 at(.5f, 0, .5f);
        std::multiset<float> found, want;
        grid.within(at, time, [&](const Photon& p) { found.insert(p.P.x); });
        for (size_t i = 0; i < all.size(); ++i)
            if (dot(all[i].P - at, all[i].P - at) < .09f && std::fabs(times[i] - time) < .1f) want.insert(all[i].P.x);
        EXPECT_EQ(found, want) << time;
        EXPECT_GT(want.size(), 50u);
    }
    EXPECT_FLOAT_EQ(grid.lasts(0), .1f);
    EXPECT_FLOAT_EQ(grid.lasts(.05f), .15f);
    EXPECT_FLOAT_EQ(grid.lasts(.5f), .2f);
    EXPECT_EQ(PhotonGrid(all, .3f).lasts(.5f), 1);
}

// As many photons as in the circle of a scene that stands still; what is smeared is as wide as the circle, or the window is
// least.
TEST(PhotonGrid, MovingStart) {
    for (const float travel : {0.f, .5f, 2.f, 10.f, 1e6f}) {
        const MovingStart s = movingStart(1, travel);
        EXPECT_NEAR(s.radius * s.radius * s.window, 1, 1e-5f) << travel;
        if (travel <= 1) EXPECT_EQ(s.window, 1);
        else if (s.window > kLeastWindow) EXPECT_NEAR(s.window * travel, s.radius, 1e-4f * s.radius) << travel;
        else EXPECT_GT(kLeastWindow * travel, s.radius);
    }
}

TEST(PhotonGrid, RadiusShrinks) {
    EXPECT_EQ(radiusOfPass(2, 0), 2);
    double square = 1; // the product itself, where the code uses a power
    for (uint32_t k = 1; k <= 100000; ++k) {
        square *= (k + 2.0 / 3) / (k + 1.0);
        if (k == 1 || k == 999 || k == 2000 || k == 100000)
            EXPECT_NEAR(radiusOfPass(1, k), std::sqrt(square), 1e-4 * std::sqrt(square)) << k;
    }
}

struct PhotonFile : ::testing::Test {
    std::string folder = ::testing::TempDir() + "alpenglow_photons_" + std::to_string(::getpid());
    std::string path = folder + "/a.photons";
    OutputPolicy anywhere;
    PhotonFile() {
        std::filesystem::create_directories(folder);
        anywhere.allowWrite = true;
    }
    ~PhotonFile() override { std::filesystem::remove_all(folder); }
    std::vector<char> bytes() {
        std::ifstream f(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(f), {}};
    }
    std::string loadFault(const std::vector<char>& b) {
        std::ofstream(path, std::ios::binary).write(b.data(), long(b.size()));
        Diagnostics d;
        EXPECT_EQ(loadPhotons(path, Matrix(), d), nullptr);
        EXPECT_EQ(d.errors(), 1);
        return d.all().empty() ? "" : toString(d.all()[0]);
    }
};

TEST_F(PhotonFile, ComesBackInAnotherCamera) {
    const std::vector<Photon> all = evenly(1000, 7);
    Diagnostics d;
    const Matrix from = rotateMatrix(30, 1, 2, 3) * translateMatrix(1, 2, 3) * scaleMatrix(1, 1, -1);
    ASSERT_TRUE(savePhotons(path, all, 5000, from, anywhere, d));
    const auto map = loadPhotons(path, inverse(from), d);
    ASSERT_TRUE(map);
    EXPECT_EQ(map->size(), 1000u);
    const PhotonMap before(all);
    const PhotonMap::Lookup l{{.5f, 0, .5f}, {0, 1, 0}, 50, 0};
    EXPECT_NEAR(map->irradiance(l).x, before.irradiance(l).x, 1e-3 * before.irradiance(l).x);
    // A camera that sees everything at half the size sees the same irradiance.
    const auto small = loadPhotons(path, inverse(from) * scaleMatrix(.5, .5, .5), d);
    ASSERT_TRUE(small);
    EXPECT_NEAR(small->irradiance({{.25f, 0, .25f}, {0, 1, 0}, 50, 0}).x, before.irradiance(l).x, 1e-3 * before.irradiance(l).x);
    EXPECT_EQ(d.errors(), 0);
}

TEST_F(PhotonFile, DamageIsAnError) {
    Diagnostics d;
    ASSERT_TRUE(savePhotons(path, evenly(100, 7), 100, Matrix(), anywhere, d));
    const std::vector<char> good = bytes();
    ASSERT_EQ(good.size(), 36u + 36 * 100 + 4);
    std::vector<char> b(good.begin(), good.end() - 1);
    EXPECT_NE(loadFault(b).find("cut short"), std::string::npos);
    b.resize(20);
    EXPECT_NE(loadFault(b).find("cut short"), std::string::npos);
    b.resize(3);
    EXPECT_NE(loadFault(b).find("no photon map"), std::string::npos);
    EXPECT_NE(loadFault({}).find("no photon map"), std::string::npos);
    b = good;
    b.push_back(0);
    EXPECT_NE(loadFault(b).find("follows"), std::string::npos);
    for (size_t at = 0; at < good.size(); at += at < 40 ? 1 : 97) { // any byte
        b = good;
        b[at] = char(b[at] ^ 0x10);
        loadFault(b);
    }
    b = good; // a header that says more than there is
    b[16] = char(200);
    EXPECT_NE(loadFault(b).find("header is damaged"), std::string::npos);
}

} // namespace

} // namespace photonmap_test
