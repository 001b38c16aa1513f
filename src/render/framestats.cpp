#include "render/framestats.h"
#include "render/provenance.h"
#include <nlohmann/json.hpp>

namespace alpenglow::render {
namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson frameJson(const FrameStats& f) {
    OrderedJson j{{"frame", f.frame}, {"scene", f.scene}, {"sceneHash", f.sceneHash}, {"hider", f.hider}, {"seed", f.seed}};
    j["pictures"] = OrderedJson::array();
    for (const FrameStats::Picture& p : f.pictures)
        j["pictures"].push_back({{"file", p.file}, {"type", p.type}, {"channels", p.channels}});
    j["textures"] = OrderedJson::array();
    for (const FrameStats::Texture& t : f.textures)
        j["textures"].push_back(
            {{"file", t.file}, {"fileBytes", t.fileBytes}, {"memoryBytes", t.memoryBytes}, {"scratchBytes", t.scratchBytes}});
    j.update(OrderedJson::parse(toJson(f.figures)));
    return j;
}

} // namespace

void accumulate(RenderStats& all, const RenderStats& f) {
    const RenderStats before = all;
    all = f;
    for (auto member :
         {&RenderStats::renderSec, &RenderStats::cpuSec, &RenderStats::parseSec, &RenderStats::compileSec, &RenderStats::buildSec,
          &RenderStats::lanesUsed, &RenderStats::lanesRun, &RenderStats::depthSum, &RenderStats::paths})
        all.*member += before.*member;
    for (auto member : {&RenderStats::totalRays, &RenderStats::nonFinite, &RenderStats::saturated}) all.*member += before.*member;
    for (const auto& [type, n] : before.rays) all.rays[type] += n;
    for (auto member :
         {&RenderStats::Classic::primary, &RenderStats::Classic::reflected, &RenderStats::Classic::refracted,
          &RenderStats::Classic::totalReflected, &RenderStats::Classic::ignored, &RenderStats::Classic::subsampledPixels,
          &RenderStats::Classic::subsampledRays, &RenderStats::Classic::tests, &RenderStats::Classic::hits})
        all.classic.*member += before.classic.*member;
    all.shading.points += before.shading.points;
    all.shading.batches += before.shading.batches;
    for (auto member : {&RenderStats::Guide::photons, &RenderStats::Guide::cells, &RenderStats::Guide::lobes,
                        &RenderStats::Guide::rays, &RenderStats::Guide::lit, &RenderStats::Guide::light})
        all.guide.*member += before.guide.*member;
    for (auto member : {&RenderStats::LightGuide::samples, &RenderStats::LightGuide::lights, &RenderStats::LightGuide::cells,
                        &RenderStats::LightGuide::used})
        all.lightGuide.*member += before.lightGuide.*member;
    all.depth.maximum = std::max(all.depth.maximum, before.depth.maximum);
    all.threadBytes = std::max(all.threadBytes, before.threadBytes);
    all.errors += before.errors;
    all.warnings += before.warnings;
}

std::string statsJson(const RenderStats& all, const std::vector<FrameStats>& frames, const RenderSettings& s) {
    OrderedJson j = OrderedJson::parse(toJson(all));
    j["software"] = s.software;
    j["command"] = s.command;
    j["options"] = pixelOptions(s);
    std::string environment;
    for (const auto& [name, value] : s.environment) environment += (environment.empty() ? "" : " ") + name + "=" + value;
    j["environment"] = environment;
    j["host"] = hostName();
    j["date"] = dateText();
    j["frames"] = OrderedJson::array();
    for (const FrameStats& f : frames) j["frames"].push_back(frameJson(f));
    return j.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

} // namespace alpenglow::render
