// Outputs that are not shader outputs: light by path, first visible surface, pixel statistics.
#include "render/outputs.h"
#include "scene/scene.h"
#include <algorithm>
#include <string_view>

namespace alpenglow::render {

namespace {

using Source = OutputVariable::Source;

/// Variance of the pixel's mean luminance, from two independently scrambled replicas: unbiased.
float varianceOf(const Film& film, int x, int y) {
    double sum[2];
    uint32_t n[2];
    for (uint32_t r = 0; r < 2; ++r) film.replica(x, y, r, &sum[r], &n[r]);
    const double all = n[0] + n[1], away = n[0] && n[1] ? sum[0] / n[0] - sum[1] / n[1] : 0;
    return float(all > 0 ? away * away * (n[0] / all) * (n[1] / all) : 0);
}
float samplesOf(const Film& film, int x, int y) { return float(film.count(x, y)); }

/// An output that the renderer computes: the mean of a color over the samples, or a number of the film's pixel.
struct Computed {
    const char* name;
    Color integrator::SampleResult::* ofSample; ///< null: `ofPixel`
    float (*ofPixel)(const Film&, int x, int y);
    size_t width() const { return ofSample ? 3 : 1; }
};
// Part files store the index: add at the end.
constexpr Computed kComputed[] = {{"albedo", &integrator::SampleResult::albedo, nullptr},
                                  {"normal", &integrator::SampleResult::normal, nullptr},
                                  {"variance", nullptr, varianceOf},
                                  {"samples", nullptr, samplesOf}};

constexpr const char* kPathWords[] = {"direct", "indirect", "other"}; ///< light paths with a name
constexpr const char* kRgb[] = {".r", ".g", ".b"};

Source sourceOf(size_t computed) { return Source(int(Source::Computed) + int(computed)); }
/// Null: of another source.
const Computed* computedOf(Source s) {
    return s >= Source::Computed ? &kComputed[size_t(s) - size_t(Source::Computed)] : nullptr;
}

size_t widthOf(Source s) { return computedOf(s) ? computedOf(s)->width() : 3; }

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

std::string namesForMessages() {
    std::string all;
    const std::vector<std::string> names = computedOutputs();
    for (size_t i = 0; i < names.size(); ++i) all += (i + 1 < names.size() ? ", " : " and ") + names[i];
    return all;
}

} // namespace

void sayNeedsPath(const std::string& output, const SourcePlace& place, Diagnostics& diags) {
    diags.report(Severity::Error, Rie::Incapable, place,
                 "\"" + output + "\": outputs by light path" + namesForMessages() + " need Hider \"path\"; it is 0");
}

std::optional<Source> computedOutput(std::string_view name) {
    for (size_t i = 0; i < std::size(kComputed); ++i)
        if (name == kComputed[i].name) return sourceOf(i);
    return {};
}

std::vector<std::string> computedOutputs() {
    std::vector<std::string> names;
    for (const Computed& c : kComputed) names.push_back(c.name);
    return names;
}

void setSource(OutputVariable& v, const scene::Options& o, OutputPlan& plan, const SourcePlace& display, Diagnostics& diags) {
    v.source = Source::Engine;
    const auto params = o.displayChannelParams.find(v.name);
    const scene::Param* given = params == o.displayChannelParams.end() ? nullptr : scene::find(params->second, "source");
    const std::string source = given && !given->strings.empty() ? given->strings[0] : "";
    const SourcePlace& place = given ? given->place : display;
    const auto fix = [&](Source s) { // its width
        if (v.channels.size() == widthOf(s)) return;
        if (v.typed)
            diags.report(Severity::Error, Rie::Consistency, place,
                         "\"" + v.name + "\" has " + std::to_string(v.channels.size()) + " numbers; its source has " +
                             std::to_string(widthOf(s)),
                         widthOf(s) == 3 ? "DisplayChannel \"color " + v.name + "\"" : "DisplayChannel \"float " + v.name + "\"");
        v.channels = {v.name};
        if (widthOf(s) == 3) v.channels = {v.name + ".r", v.name + ".g", v.name + ".b"};
    };
    const auto only = [&](Source s) {
        if (!plan.basis.path) sayNeedsPath(v.name, place, diags);
        fix(s);
    };
    if (const auto expression = scene::lightPathIn(source.empty() ? v.name : source)) {
        v.source = Source::Light;
        const auto word = scene::lightPathOfWord(*expression);
        v.light = lightOf(plan, word.value_or(*expression), place);
        only(v.source);
        return;
    }
    const std::string name = source.empty() ? v.name : withoutType(source);
    const bool path = std::find(std::begin(kPathWords), std::end(kPathWords), name) != std::end(kPathWords);
    const std::optional<Source> named = path ? Source::Light : computedOutput(name);
    if (!named) {
        v.asked = name == v.name ? "" : name;
        return;
    }
    if (path) v.light = lightOf(plan, *scene::lightPathOfWord(name), place);
    if (!source.empty()) {
        v.source = *named;
        only(v.source);
    } else { // a shader may have an output of that name: OutputPlan::resolve()
        v.instead = *named;
        if (!v.typed) {
            v.color = widthOf(v.instead) == 3;
            fix(v.instead);
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
            const Computed* c = computedOf(std::max(v.source, v.instead));
            return c && c->ofSample;
        });
    });
}

void addLightChannels(const OutputPlan& plan, std::vector<Channel>& c) {
    for (size_t i = 0; i < std::size(kComputed); ++i)
        for (int k = 0; kComputed[i].ofSample && plan.needs(sourceOf(i)) && k < 3; ++k)
            c.push_back({std::string(kComputed[i].name) + kRgb[k], ChannelRule::Average});
    for (int part = 0; part < plan.parts; ++part)
        for (int k = 0; k < 3; ++k)
            c.push_back({"part." + std::to_string(part) + kRgb[k], ChannelRule(int(ChannelRule::PartOfRed) + k)});
}

void addLightValues(const OutputPlan& plan, const integrator::SampleResult& s, std::vector<float>* out) {
    for (size_t i = 0; i < std::size(kComputed); ++i)
        if (kComputed[i].ofSample && plan.needs(sourceOf(i))) {
            const Color& c = s.*kComputed[i].ofSample;
            out->insert(out->end(), {c.x, c.y, c.z});
        }
    for (size_t part = 0; part < size_t(plan.parts); ++part) {
        const Color c = part < s.parts.size() ? s.parts[part] : Color(0);
        out->insert(out->end(), {c.x, c.y, c.z});
    }
}

size_t lightFloats(const OutputPlan& plan) {
    size_t n = plan.lightParts.size() * 3;
    for (const Computed& c : kComputed) n += c.width();
    return n;
}

size_t lightFloat(const OutputPlan& plan, const OutputVariable& v) {
    if (v.source == Source::Light) return size_t(v.light) * 3;
    size_t at = plan.lightParts.size() * 3;
    for (size_t i = 0; i < std::size(kComputed) && sourceOf(i) < v.source; ++i) at += kComputed[i].width();
    return at;
}

void addLightPixels(const OutputPlan& plan, const Film& film, int x, int y, float* to) {
    const auto& channels = film.description().channels;
    const auto find = [&](const char* name) {
        for (size_t i = 0; i < channels.size(); ++i)
            if (channels[i].name == name) return int(i);
        return -1;
    };
    const int first = find("part.0.r");
    std::vector<int> of;
    for (const std::vector<int>& parts : plan.lightParts)
        for (int k = 0; k < 3; ++k) {
            of.clear();
            for (int part : parts)
                if (first >= 0) of.push_back(first + 3 * part + k);
            *to++ = film.aov(x, y, of);
        }
    for (const Computed& c : kComputed) {
        if (!c.ofSample) {
            *to++ = c.ofPixel(film, x, y);
            continue;
        }
        const int at = find((c.name + std::string(kRgb[0])).c_str());
        for (int k = 0; k < 3; ++k) *to++ = at >= 0 ? film.aov(x, y, at + k) : 0;
    }
}

} // namespace alpenglow::render
