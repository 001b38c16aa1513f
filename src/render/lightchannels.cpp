// Outputs that are not shader outputs: light by path, first visible surface, pixel statistics.
#include "render/outputs.h"
#include "scene/scene.h"
#include <algorithm>
#include <tuple>

namespace alpenglow::render {

namespace {

using Source = OutputVariable::Source;

constexpr std::pair<const char*, Source> kWords[] = {
    {"direct", Source::Light},  {"indirect", Source::Light},    {"other", Source::Light},    {"albedo", Source::Albedo},
    {"normal", Source::Normal}, {"variance", Source::Variance}, {"samples", Source::Samples}};

size_t widthOf(Source s) { return s == Source::Variance || s == Source::Samples ? 1 : 3; }

/// Index of an expression in the plan.
int lightOf(OutputPlan& plan, const std::string& expression, const SourcePlace& place) {
    for (size_t i = 0; i < plan.lights.size(); ++i)
        if (plan.lights[i].expression == expression) return int(i);
    plan.lights.push_back({expression, place});
    return int(plan.lights.size()) - 1;
}

/// The text after a type ("color direct").
std::string withoutType(const std::string& s) {
    const size_t space = s.find_last_of(" \t");
    return space == std::string::npos ? s : s.substr(space + 1);
}

} // namespace

void setSource(OutputVariable& v, const scene::Options& o, OutputPlan& plan, const SourcePlace& display, Diagnostics& diags) {
    v.source = Source::Engine;
    const auto params = o.displayChannelParams.find(v.name);
    const scene::Param* given = params == o.displayChannelParams.end() ? nullptr : scene::find(params->second, "source");
    const std::string source = given && !given->strings.empty() ? given->strings[0] : "";
    const SourcePlace& place = given ? given->place : display;
    const auto only = [&](Source s) { // under path only, with a fixed width
        if (!plan.basis.path)
            diags.report(Severity::Error, Rie::Incapable, place,
                         "\"" + v.name +
                             "\": outputs by light path, albedo, normal, variance and samples need Hider \"path\"; "
                             "it is 0");
        if (v.channels.size() == widthOf(s)) return true;
        if (v.typed)
            diags.report(Severity::Error, Rie::Consistency, place,
                         "\"" + v.name + "\" has " + std::to_string(v.channels.size()) + " numbers; its source has " +
                             std::to_string(widthOf(s)),
                         widthOf(s) == 3 ? "DisplayChannel \"color " + v.name + "\"" : "DisplayChannel \"float " + v.name + "\"");
        v.channels = {v.name};
        if (widthOf(s) == 3) v.channels = {v.name + ".r", v.name + ".g", v.name + ".b"};
        return true;
    };
    if (const auto expression = scene::lightPathIn(source.empty() ? v.name : source)) {
        v.source = Source::Light;
        const auto word = scene::lightPathOfWord(*expression);
        v.light = lightOf(plan, word.value_or(*expression), place);
        only(v.source);
        return;
    }
    const std::string name = source.empty() ? v.name : withoutType(source);
    const auto word = std::find_if(std::begin(kWords), std::end(kWords), [&](const auto& w) { return name == w.first; });
    if (word == std::end(kWords)) {
        v.asked = name == v.name ? "" : name;
        return;
    }
    if (word->second == Source::Light) v.light = lightOf(plan, *scene::lightPathOfWord(name), place);
    if (!source.empty()) {
        v.source = word->second;
        only(v.source);
    } else { // a shader may have an output of that name
        v.instead = word->second;
        if (!v.typed) {
            v.color = widthOf(v.instead) == 3;
            only(v.instead);
        }
    }
}

void joinLightPaths(OutputPlan& plan, Diagnostics& diags) {
    if (plan.lights.empty()) return;
    auto joined = std::make_shared<scene::LightPaths>(plan.lights, diags);
    plan.parts = joined->parts();
    for (size_t i = 0; i < plan.lights.size(); ++i) plan.lightParts.push_back(joined->partsOf(i));
    plan.lightPaths = std::move(joined);
}

bool OutputPlan::needsFirstSeen() const {
    return std::any_of(pictures.begin(), pictures.end(), [](const OutputSpec& p) {
        return std::any_of(p.variables.begin(), p.variables.end(), [](const OutputVariable& v) {
            return std::max(v.source, v.instead) == Source::Albedo || std::max(v.source, v.instead) == Source::Normal;
        });
    });
}

void addLightChannels(const OutputPlan& plan, std::vector<Channel>& c) {
    constexpr const char* kNames[] = {".r", ".g", ".b"};
    for (auto [source, name] : {std::pair(Source::Albedo, "albedo"), std::pair(Source::Normal, "normal")})
        for (int k = 0; plan.needs(source) && k < 3; ++k) c.push_back({std::string(name) + kNames[k], ChannelRule::Average});
    for (int part = 0; part < plan.parts; ++part)
        for (int k = 0; k < 3; ++k)
            c.push_back({"part." + std::to_string(part) + kNames[k], ChannelRule(int(ChannelRule::PartOfRed) + k)});
}

void addLightValues(const OutputPlan& plan, const integrator::SampleResult& s, std::vector<float>* out) {
    if (plan.needs(Source::Albedo)) out->insert(out->end(), {s.albedo.x, s.albedo.y, s.albedo.z});
    if (plan.needs(Source::Normal)) out->insert(out->end(), {s.normal.x, s.normal.y, s.normal.z});
    for (size_t part = 0; part < size_t(plan.parts); ++part) {
        const Color c = part < s.parts.size() ? s.parts[part] : Color(0);
        out->insert(out->end(), {c.x, c.y, c.z});
    }
}

size_t lightFloats(const OutputPlan& plan) { return plan.lightParts.size() * 3 + 8; }

size_t lightFloat(const OutputPlan& plan, const OutputVariable& v) {
    const size_t behind = plan.lightParts.size() * 3;
    switch (v.source) {
    case Source::Light:
        return size_t(v.light) * 3;
    case Source::Albedo:
        return behind;
    case Source::Normal:
        return behind + 3;
    case Source::Variance:
        return behind + 6;
    default:
        return behind + 7;
    }
}

void addLightPixels(const OutputPlan& plan, const Film& film, int x, int y, float* to) {
    const auto& channels = film.description().channels;
    const auto find = [&](const char* name) {
        for (size_t i = 0; i < channels.size(); ++i)
            if (channels[i].name == name) return int(i);
        return -1;
    };
    const int first = find("part.0.r"), albedo = find("albedo.r"), normal = find("normal.r");
    std::vector<int> of;
    for (const std::vector<int>& parts : plan.lightParts)
        for (int k = 0; k < 3; ++k) {
            of.clear();
            for (int part : parts)
                if (first >= 0) of.push_back(first + 3 * part + k);
            *to++ = film.aov(x, y, of);
        }
    for (int at : {albedo, normal})
        for (int k = 0; k < 3; ++k) *to++ = at >= 0 ? film.aov(x, y, at + k) : 0;
    // Variance of the pixel's mean luminance, from two independently scrambled replicas: unbiased.
    double sum[2];
    uint32_t n[2];
    for (uint32_t r = 0; r < 2; ++r) film.replica(x, y, r, &sum[r], &n[r]);
    const double all = n[0] + n[1], away = n[0] && n[1] ? sum[0] / n[0] - sum[1] / n[1] : 0;
    *to++ = float(all > 0 ? away * away * (n[0] / all) * (n[1] / all) : 0);
    *to++ = float(film.count(x, y));
}

} // namespace alpenglow::render
