#include "render/stats.h"
#include <gtest/gtest.h>
#include <limits>
#include <nlohmann/json.hpp>

namespace stats_test {

using namespace alpenglow::render;

namespace {
RenderStats example() {
    RenderStats s;
    s.width = 640;
    s.height = 360;
    s.spp = 100;
    s.renderSec = 2;
    s.cpuSec = 3.5;
    s.totalRays = 5'000'000;
    s.noise = {0.1, 0.4, 0.05, 0.02, 0.03, 0.031, true, 0.5};
    s.threads = 2;
    s.peakMemoryBytes = 3u << 20;
    s.nonFinite = 1234;
    s.rays = {{"camera", 23'040'000}, {"volume", 5}};
    s.shading.points = 10;
    s.depth = {32, 3.25};
    s.errors = 1;
    return s;
}
} // namespace

TEST(Stats, JsonHasEveryPromisedKey) {
    auto j = nlohmann::json::parse(toJson(example()));
    for (const char* k :
         {"width", "height", "spp", "renderSec", "cpuSec", "raysPerMS", "noiseRSE", "noiseRSE999", "efficiency", "noiseQMC",
          "threads", "peakMemoryBytes", "parseSec", "compileSec", "buildSec", "nonFinite", "errors", "warnings"})
        EXPECT_TRUE(j.at(k).is_number()) << k;
    for (const char* k : {"camera", "diffuse", "specular", "transmission", "shadow", "volume"})
        EXPECT_TRUE(j.at("rays").at(k).is_number()) << k;
    for (const char* k : {"points", "batches", "laneOccupancy", "affineKernels", "suspendingKernels", "kernels", "cacheHits"})
        EXPECT_TRUE(j.at("shading").at(k).is_number()) << k;
    EXPECT_EQ(j["depth"]["maximum"], 32);
    EXPECT_EQ(j["depth"]["average"], 3.25);
    EXPECT_EQ(j["raysPerMS"], 2500);                // 5e6 / 2 s / 1000
    EXPECT_NEAR(double(j["efficiency"]), 50, 1e-9); // 1 / (0.01 * 2)
    EXPECT_EQ(j["rays"]["camera"], 23'040'000);
}

TEST(Stats, NoInfinityReachesTheFile) {
    RenderStats s;
    s.noise.noiseQMC = std::numeric_limits<double>::infinity();
    s.depth.average = std::numeric_limits<double>::quiet_NaN();
    s.rays["\xff\xfe"] = 1;
    auto j = nlohmann::json::parse(toJson(s));
    EXPECT_EQ(j["noiseQMC"], 0);
    EXPECT_EQ(j["depth"]["average"], 0);
    EXPECT_EQ(j["efficiency"], 0);
}

TEST(Stats, Table) {
    std::string t = toTable(example());
    EXPECT_NE(t.find("640 x 360, 100 samples per pixel"), std::string::npos) << t;
    EXPECT_NE(t.find("5,000,000, 2500 per ms (camera 23,040,000, volume 5)"), std::string::npos) << t;
    EXPECT_NE(t.find("noise        0.03000: "), std::string::npos) << t; // one figure; the others are in the JSON
    for (const char* other : {"noiseRSE", "noiseQMC", "efficiency"}) EXPECT_EQ(t.find(other), std::string::npos) << t;
    EXPECT_NE(t.find("1,234 samples that were not finite"), std::string::npos) << t;
    EXPECT_EQ(t.back(), '\n');
}

TEST(Stats, AFigureThatIsNotKnownHasNoLine) { // hidden and raytrace, or one sample a pixel
    RenderStats s = example();
    s.noise = {};
    EXPECT_EQ(toTable(s).find("noise"), std::string::npos);
}

TEST(Stats, TheProcessHasMemoryAndTime) {
    EXPECT_GT(peakMemoryBytes(), 1u << 20);
    EXPECT_GE(processCpuSeconds(), 0);
}

} // namespace stats_test
