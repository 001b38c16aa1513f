#include "render/stats.h"
#include "integrator/integrator.h"
#include "render/progress.h"
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

namespace alpenglow::render {
namespace {

constexpr const char* kRayTypes[] = {"camera", "diffuse", "specular", "transmission", "shadow"};

double finite(double v) { return std::isfinite(v) ? v : 0; }

std::string bytesText(uint64_t b) {
    if (b >= 1ull << 30) return fmt::format("{:.2f} GiB", double(b) / double(1ull << 30));
    return fmt::format("{:.1f} MiB", double(b) / double(1ull << 20));
}

std::string grouped(uint64_t n) {
    std::string s = std::to_string(n);
    for (int i = int(s.size()) - 3; i > 0; i -= 3) s.insert(size_t(i), ",");
    return s;
}

/// Mean luminance that rays of the caustic guide brought, over the camera rays.
double guidedLight(const RenderStats& s) {
    const auto camera = s.rays.find("camera");
    if (camera == s.rays.end() || !camera->second) return 0;
    return double(s.guide.light) * integrator::Counters::kLightUnit / double(camera->second);
}

} // namespace

std::string toJson(const RenderStats& s) {
    nlohmann::ordered_json j;
    j["width"] = s.width;
    j["height"] = s.height;
    j["spp"] = s.spp;
    j["sppLeast"] = s.sppLeast;
    j["sppMost"] = s.sppMost;
    j["renderSec"] = finite(s.renderSec);
    j["cpuSec"] = finite(s.cpuSec);
    j["raysPerMS"] = finite(raysPerMS(s.totalRays, s.renderSec));
    j["noise"] = finite(s.noise.noise);
    j["noiseAtMost"] = finite(s.noise.noiseAtMost);
    j["coverage"] = finite(s.noise.coverage);
    j["noiseRSE"] = finite(s.noise.noiseRSE);
    j["noiseRSE999"] = finite(s.noise.noiseRSE999);
    j["efficiency"] = finite(efficiency(s.noise.noiseRSE, s.renderSec));
    j["noiseQMC"] = finite(s.noise.noiseQMC);
    j["imageError"] = finite(s.noise.imageError);
    j["curve"] = s.curve;
    j["threads"] = s.threads;
    j["peakMemoryBytes"] = s.peakMemoryBytes;
    j["threadBytes"] = s.threadBytes;
    j["parseSec"] = finite(s.parseSec);
    j["compileSec"] = finite(s.compileSec);
    j["buildSec"] = finite(s.buildSec);
    j["nonFinite"] = s.nonFinite;
    j["saturated"] = s.saturated;
    j["totalRays"] = s.totalRays;
    auto& rays = j["rays"] = nlohmann::ordered_json::object();
    for (const char* t : kRayTypes) rays[t] = 0;
    for (const auto& [type, n] : s.rays) rays[type] = n;
    j["classic"] = {{"primary", s.classic.primary},
                    {"reflected", s.classic.reflected},
                    {"refracted", s.classic.refracted},
                    {"totalReflected", s.classic.totalReflected},
                    {"ignored", s.classic.ignored},
                    {"subsampledPixels", s.classic.subsampledPixels},
                    {"subsampledRays", s.classic.subsampledRays},
                    {"tests", s.classic.tests},
                    {"hits", s.classic.hits}};
    j["shading"] = {{"points", s.shading.points},
                    {"batches", s.shading.batches},
                    {"laneOccupancy", finite(s.shading.laneOccupancy)},
                    {"affineKernels", s.shading.affineKernels},
                    {"suspendingKernels", s.shading.suspendingKernels},
                    {"kernels", s.shading.kernels},
                    {"cacheHits", s.shading.cacheHits}};
    j["guide"] = {{"photons", s.guide.photons}, {"cells", s.guide.cells}, {"lobes", s.guide.lobes},
                  {"rays", s.guide.rays},       {"lit", s.guide.lit},     {"light", guidedLight(s)}};
    j["specularLights"] = {{"seeds", s.specular.seeds},
                           {"searches", s.specular.searches},
                           {"found", s.specular.found},
                           {"probes", s.specular.probes}};
    const RenderStats::LightGuide& l = s.lightGuide;
    j["lightGuide"] = {{"samples", l.samples}, {"lights", l.lights}, {"cells", l.cells}, {"used", l.used}};
    j["depth"] = {{"maximum", s.depth.maximum}, {"average", finite(s.depth.average)}};
    j["errors"] = s.errors;
    j["warnings"] = s.warnings;
    // Ray types come from the renderer; other bytes must not throw here either.
    return j.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string toTable(const RenderStats& s) {
    std::string t;
    auto row = [&](const char* name, const std::string& value) { t += fmt::format("  {:<12} {}\n", name, value); };
    const std::string range = s.sppLeast < s.sppMost ? fmt::format(" ({} to {})", s.sppLeast, s.sppMost) : "";
    row("picture", fmt::format("{} x {}, {} samples per pixel{}", s.width, s.height, s.spp, range));
    row("time", fmt::format("{:.2f} s ({:.2f} s of processor, {} threads)", s.renderSec, s.cpuSec, s.threads));
    row("before", fmt::format("parse {:.2f} s, compile {:.2f} s, build {:.2f} s", s.parseSec, s.compileSec, s.buildSec));
    std::string types;
    for (const auto& [type, n] : s.rays)
        if (n) types += fmt::format("{}{} {}", types.empty() ? "" : ", ", type, grouped(n));
    row("rays", fmt::format("{}, {:.0f} per ms{}", grouped(s.totalRays), raysPerMS(s.totalRays, s.renderSec),
                            types.empty() ? "" : " (" + types + ")"));
    const auto part = [](uint64_t n, const char* what) { return n ? fmt::format(", {} {}", grouped(n), what) : ""; };
    if (s.classic.reflected || s.classic.refracted || s.classic.totalReflected || s.classic.ignored)
        row("specular", fmt::format("{} reflected, {} refracted{}{}", grouped(s.classic.reflected), grouped(s.classic.refracted),
                                    part(s.classic.totalReflected, "totally reflected"), part(s.classic.ignored, "ignored")));
    if (s.classic.tests)
        row("tests", fmt::format("{}, of which {:.1f} % met a surface", grouped(s.classic.tests),
                                 100 * double(s.classic.hits) / double(s.classic.tests)));
    if (s.classic.subsampledPixels)
        row("refined",
            fmt::format("{} pixels, by {} rays", grouped(s.classic.subsampledPixels), grouped(s.classic.subsampledRays)));
    if (s.depth.maximum) row("depth", fmt::format("{} at most, {:.2f} on average", s.depth.maximum, s.depth.average));
    if (s.shading.points)
        row("shading", fmt::format("{} points in {} batches, {:.1f} % of lanes busy; {} kernels ({} affine, {} suspending), "
                                   "{} from the cache",
                                   grouped(s.shading.points), grouped(s.shading.batches), 100 * s.shading.laneOccupancy,
                                   s.shading.kernels, s.shading.affineKernels, s.shading.suspendingKernels, s.shading.cacheHits));
    if (s.guide.cells)
        row("guide", fmt::format("{} photons of mirrors and glass, {} cells, {} lobes; {} rays aimed, {:.1f} % of all, of which "
                                 "{:.1f} % found light: {:.3g} of luminance a camera ray",
                                 grouped(s.guide.photons), grouped(s.guide.cells), grouped(s.guide.lobes), grouped(s.guide.rays),
                                 100 * double(s.guide.rays) / double(std::max<uint64_t>(s.totalRays, 1)),
                                 100 * double(s.guide.lit) / double(std::max<uint64_t>(s.guide.rays, 1)), guidedLight(s)));
    if (s.specular.seeds)
        row("mirrored",
            fmt::format(
                "{} searches for light of point and distant lights by mirrors and glass, {:.1f} % found some, by "
                "{:.1f} probes each; from {} photons",
                grouped(s.specular.searches), 100 * double(s.specular.found) / double(std::max<uint64_t>(s.specular.searches, 1)),
                double(s.specular.probes) / double(std::max<uint64_t>(s.specular.searches, 1)), grouped(s.specular.seeds)));
    if (s.lightGuide.used)
        row("lights",
            fmt::format("{} sampled where they are visible, by {} samples, in {} of {} cells", grouped(s.lightGuide.lights),
                        grouped(s.lightGuide.samples), grouped(s.lightGuide.used), grouped(s.lightGuide.cells)));
    if (s.noise.known)
        row("noise", fmt::format("{:.5f}: the mean relative error of the light on surfaces (docs/noise.md)", s.noise.noise));
    if (!s.curve.empty()) row("curve", s.curve);
    row("memory", bytesText(s.peakMemoryBytes) + " at most" +
                      (s.threadBytes ? "; of each thread's rays and points " + bytesText(s.threadBytes) : std::string()));
    if (s.nonFinite) row("dropped", fmt::format("{} samples that were not finite", grouped(s.nonFinite)));
    if (s.saturated) row("saturated", fmt::format("{} values beyond 2^60", grouped(s.saturated)));
    if (s.errors || s.warnings) row("messages", fmt::format("{} errors, {} warnings", s.errors, s.warnings));
    return t;
}

uint64_t peakMemoryBytes() {
    rusage u{};
    return getrusage(RUSAGE_SELF, &u) == 0 ? uint64_t(u.ru_maxrss) * 1024 : 0; // Linux counts in KiB
}

double processCpuSeconds() {
    rusage u{};
    if (getrusage(RUSAGE_SELF, &u) != 0) return 0;
    return double(u.ru_utime.tv_sec + u.ru_stime.tv_sec) + 1e-6 * double(u.ru_utime.tv_usec + u.ru_stime.tv_usec);
}

} // namespace alpenglow::render
