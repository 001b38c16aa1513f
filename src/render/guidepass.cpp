#include "render/guidepass.h"
#include "integrator/integrator.h"
#include "photonmap/limits.h"
#include "render/filtersampler.h"
#include "render/photonpass.h"
#include "scene/scene.h"
#include "world/photonmaps.h"
#include "world/photonstore.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::render {

namespace {

constexpr uint32_t kGuidePilot = 0xfffffffeu, kLearned = 0xfffffffdu, kSeedPilot = 0xfffffff8u,
                   kSeeds = 0xfffffff7u; ///< numbers of photon passes, distinct from others
constexpr uint32_t kMostTurns = 4;
constexpr uint64_t kOtherSeed = 0x6775696465ull; ///< makes the guide independent of the picture's own samples

bool refused(const scene::Options& o) {
    const scene::Param* p = scene::find(o.hiderParams, "guide");
    return p && !p->numbers.empty() && p->numbers[0] == 0;
}

/// `each` rays through each of side x side parts of the complete picture; they are not samples of the picture.
std::vector<integrator::CameraRay> pilotRays(Job& job, int side, uint32_t each = 1) {
    const scene::Options& o = job.world->frame().options;
    const FilterSampler filter(job.plan.basis.filter);
    std::vector<PixelSample> samples;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            for (uint32_t k = 0; k < each; ++k)
                samples.push_back(
                    {x * std::max(o.xres, 1) / side, y * std::max(o.yres, 1) / side, uint32_t(y * side + x) * each + k});
    NumberRows numbers;
    std::vector<integrator::CameraRay> rays;
    std::vector<float> weights;
    pathRays(job.camera, filter, job.settings.seed ^ kOtherSeed, samples, numbers, rays, weights);
    for (integrator::CameraRay& r : rays) r.sample += 0x40000000u; // larger than any sample number of a picture
    return rays;
}

/// Luminances of `each` samples in each of side x side places of the complete picture; empty if stopped.
std::vector<double> luminancesOf(Job& job, int side, uint32_t each) {
    const std::vector<integrator::CameraRay> rays = pilotRays(job, side, each);
    std::vector<integrator::SampleResult> results(rays.size());
    Diagnostics silent;
    const auto tracer = job.engine.tracer(job.world, silent);
    if (!tracer->trace(rays, results, &job.halt) || job.halt) return {};
    std::vector<double> light;
    for (const integrator::SampleResult& r : results) {
        const float l = luminance(r.color);
        light.push_back(l >= 0 ? l : 0);
    }
    return light;
}

/// Mean luminance of the complete picture without its brightest 2 %, because a caustic hit by chance is not representative.
float brightnessOf(Job& job) {
    std::vector<double> light = luminancesOf(job, 32, 1);
    std::sort(light.begin(), light.end());
    double sum = 0;
    for (size_t i = 0; i < light.size() * 49 / 50; ++i) sum += light[i];
    return float(sum / double(std::max<size_t>(light.size(), 1)));
}

} // namespace

void forgetLearned(Job& job) {
    world::PhotonStore* const store = job.world->photons();
    if (!store) return;
    store->guide.reset();
    store->seeds.reset();
    store->lightGuides.clear();
    store->leastLight = 0;
}

bool learnCaustics(Job& job) {
    const scene::Options& o = job.world->frame().options;
    if (refused(o) || !job.world->photons() || !world::mayHaveCaustics(*job.world)) return true;
    Diagnostics silent;
    PhotonPasses passes(job, job.world, {.all = true, .sky = true, .caustics = true, .width = 0, .learns = true}, silent);
    if (!passes.emission().lights()) return true;
    std::vector<world::StoredPhoton> found;
    const auto take = [&](uint32_t, std::vector<world::StoredPhoton> stored) { found = std::move(stored); };
    // Few enough to cost nothing in small pictures. For the complete picture, so that a crop equals that part of the picture.
    const double pixels = double(std::max(o.xres, 1)) * double(std::max(o.yres, 1));
    const auto pilot = uint32_t(std::clamp(pixels / 4, double(1u << 12), double(1u << 14)));
    if (!passes.emit(kGuidePilot, 1, pilot, limits::kPhotonsAtRest, take)) return false;
    if (found.empty()) return true;
    passes.emission().learn(found, kGuidePilot, pilot);
    const auto photons = uint32_t(std::clamp(pixels, double(1u << 13), double(1u << 17)));
    // For emitters that are not flat, emission is inefficient: sends more.
    std::vector<world::StoredPhoton> all;
    uint32_t turns = 0;
    do {
        if (!passes.emit(kLearned - turns, 1, photons, limits::kPhotonsAtRest, take)) return false;
        all.insert(all.end(), found.begin(), found.end());
    } while (++turns < kMostTurns && double(all.size()) < pixels / 8);
    for (world::StoredPhoton& s : all) s.photon.power /= float(turns);
    const float brightness = brightnessOf(job);
    job.guide = world::guideCaustics(*job.world, all, passes.emission().power(), brightness);
    job.world->flushPrints(false);
    return !job.pollStop();
}

bool learnSeeds(Job& job) {
    constexpr size_t kFewest = 32, kEnough = 512, kMost = 1u << 15;
    constexpr double kLeast = 1e-5; ///< fraction of all light
    const scene::Options& o = job.world->frame().options;
    world::PhotonStore* const store = job.world->photons();
    if (refused(o) || !store || !world::mayHaveCaustics(*job.world)) return true;
    Diagnostics silent;
    const integrator::PhotonUse use{.all = true, .sky = false, .caustics = true, .width = 0, .learns = true, .unmet = true};
    PhotonPasses passes(job, job.world, use, silent);
    if (!passes.emission().lights()) return true;
    std::vector<world::StoredPhoton> found;
    const auto take = [&](uint32_t, std::vector<world::StoredPhoton> stored) { found = std::move(stored); };
    const double pixels = double(std::max(o.xres, 1)) * double(std::max(o.yres, 1));
    auto pilot = uint32_t(std::clamp(pixels / 4, double(1u << 12), double(1u << 14)));
    if (!passes.emit(kSeedPilot, 1, pilot, limits::kPhotonsAtRest, take)) return false;
    uint32_t pass = kSeedPilot;
    if (found.size() < kEnough) { // small mirrors, or small surfaces that they light
        pilot *= 8, --pass;
        if (!passes.emit(pass, 1, pilot, limits::kPhotonsAtRest, take)) return false;
    }
    if (found.empty()) return true;
    std::vector<world::CausticSeed> seeds;
    passes.emission().addSeeds(found, pass, seeds, silent);
    passes.emission().learn(found, pass, pilot);
    const auto photons = uint32_t(std::clamp(pixels / 2, double(1u << 13), double(1u << 16)));
    if (!passes.emit(kSeeds, 1, photons, kMost, take)) return false;
    const size_t before = seeds.size();
    passes.emission().addSeeds(found, kSeeds, seeds, silent);
    double power = 0;
    for (size_t i = before; i < seeds.size(); ++i) power += seeds[i].power;
    for (size_t i = 0; i < seeds.size(); ++i) seeds[i].power *= i < before ? 0 : 1; // both emissions bring all of the light
    if (!(power > kLeast * passes.emission().power())) return true;
    const float brightness = seeds.size() < kFewest ? 0 : brightnessOf(job);
    if (brightness > 0) {
        // Squared error times time: 2 is best for mirrors and a ball of glass, .5 for a glass of water, whose searches cost 400.
        constexpr double kGain = 2, kCost = 60;
        const world::CausticSeeds made(seeds, brightness, float(kGain));
        const double cost = integrator::costOfSearches(job.world, made, silent);
        const auto gain = float(kGain * std::min(1., kCost / std::max(cost, 1.)));
        store->seeds = std::make_shared<const world::CausticSeeds>(std::move(seeds), brightness, gain);
    }
    job.world->flushPrints(false);
    return !job.pollStop();
}

bool learnLights(Job& job) {
    if (refused(job.world->frame().options) || !integrator::mayGuideLights(*job.world)) return true;
    const scene::Options& o = job.world->frame().options;
    Diagnostics silent;
    const auto learn = [&](int side) {
        return integrator::learnLights(job.world, pilotRays(job, side), silent, &job.halt, job.lightGuide);
    };
    // Few paths tell whether a guide pays; more tell what it should know. For the complete picture, so that a crop equals that
    // part of the picture.
    const double pixels = double(std::max(o.xres, 1)) * double(std::max(o.yres, 1));
    if (!learn(int(std::sqrt(std::clamp(pixels / 4, 256., 4096.))))) return false;
    if (job.lightGuide.used > 0) {
        integrator::forgetLights(*job.world);
        if (!learn(int(std::sqrt(std::clamp(pixels, 4096., 32768.))))) return false;
    }
    job.world->flushPrints(false);
    return !job.pollStop();
}

bool learnBrightness(Job& job) {
    constexpr double kMost = .12; // of the median of places that are not black
    const scene::Options& o = job.world->frame().options;
    world::PhotonStore* const store = job.world->photons();
    if (refused(o) || !store || !integrator::mayTraceBefore(*job.world)) return true;
    const double pixels = double(std::max(o.xres, 1)) * double(std::max(o.yres, 1));
    const std::vector<double> light = luminancesOf(job, int(std::sqrt(std::clamp(pixels / 128, 32., 1024.))), 2);
    std::vector<double> means;
    double squares = 0;
    for (size_t i = 0; i + 1 < light.size(); i += 2) {
        const double sum = light[i] + light[i + 1];
        if (!(sum > 0)) continue;
        means.push_back(sum / 2);
        const double difference = (light[i] - light[i + 1]) / sum;
        squares += difference * difference;
    }
    if (means.empty()) return !job.pollStop();
    const auto middle = means.begin() + std::ptrdiff_t(means.size() / 2);
    std::nth_element(means.begin(), middle, means.end());
    // The roulette adds a variance of at most leastLight times the light of a sample, so it shall not be more than a part of the
    // variance that is there: relative to the square of the light, twice the mean square of (a - b) / (a + b), if that is small.
    store->leastLight = float(kMost * *middle * std::min(1., 2 * squares / double(means.size())));
    job.world->flushPrints(false);
    return !job.pollStop();
}

} // namespace alpenglow::render
