// Converts the plan of a frame's pictures to JSON for part files.
#include "render/outputs.h"
#include <nlohmann/json.hpp>

namespace alpenglow::render {
namespace {

using Json = nlohmann::json;

Json matrix(const Matrix& m) {
    Json j = Json::array();
    for (const auto& row : m.m)
        for (double v : row) j.push_back(v);
    return j;
}
Matrix matrix(const Json& j) {
    Matrix m;
    for (size_t i = 0; i < 16; ++i) m.m[i / 4][i % 4] = j.at(i).get<double>();
    return m;
}
Json quantize(const scene::Quantize& q) { return {q.one, q.min, q.max, q.dither, q.set}; }
scene::Quantize quantize(const Json& j) {
    return {j.at(0).get<float>(), j.at(1).get<float>(), j.at(2).get<float>(), j.at(3).get<float>(), j.at(4).get<bool>()};
}
Json quantization(const display::Quantization& q) { return {q.zero, q.one, q.min, q.max, q.dither}; }
display::Quantization quantization(const Json& j) {
    return {j.at(0).get<float>(), j.at(1).get<float>(), j.at(2).get<float>(), j.at(3).get<float>(), j.at(4).get<float>()};
}
Json filter(const PixelFilter& f) { return {int(f.kind), f.xw, f.yw}; }
PixelFilter filter(const Json& j) {
    int kind = j.at(0).get<int>();
    PixelFilter f;
    if (kind >= 0 && kind < kFilterKinds) f.kind = FilterKind(kind);
    f.xw = j.at(1).get<double>();
    f.yw = j.at(2).get<double>();
    return f;
}
DepthFilter depth(const Json& j) {
    int d = j.get<int>();
    return d >= 0 && d <= int(DepthFilter::Midpoint) ? DepthFilter(d) : DepthFilter::Min;
}
Json place(const SourcePlace& p) { return {p.file, p.line, p.column}; }
SourcePlace place(const Json& j) { return {j.at(0).get<std::string>(), j.at(1).get<int>(), j.at(2).get<int>()}; }

bool soundLight(const OutputVariable& v, const OutputPlan& plan) {
    return v.source != OutputVariable::Source::Light || (v.light >= 0 && size_t(v.light) < plan.lightParts.size());
}

void takeWidths(const Json& j, OutputPlan& plan) {
    plan.engineWidths.resize(plan.engineOutputs.size(), 1);
    for (int& w : plan.engineWidths) w = std::clamp(w, 1, 16);
    plan.parts = std::clamp(j.at("parts").get<int>(), 0, int(scene::LightPaths::kMostParts));
    plan.lightParts = j.at("lightParts").get<std::vector<std::vector<int>>>();
    for (std::vector<int>& parts : plan.lightParts) std::erase_if(parts, [&](int p) { return p < 0 || p >= plan.parts; });
}

} // namespace

std::string planToText(const OutputPlan& plan, const PictureFacts& facts) {
    const OutputBasis& b = plan.basis;
    Json j;
    j["basis"] = {{"gain", b.gain},
                  {"gamma", b.gamma},
                  {"gammaGiven", b.gammaGiven},
                  {"srgbAsked", b.srgbAsked},
                  {"exposureGiven", b.exposureGiven},
                  {"path", b.path},
                  {"rgba", quantize(b.rgba)},
                  {"z", quantize(b.z)},
                  {"filter", filter(b.filter)},
                  {"depth", int(b.depth)}};
    j["outputs"] = plan.engineOutputs;
    j["widths"] = plan.engineWidths;
    j["lightParts"] = plan.lightParts;
    j["parts"] = plan.parts;
    j["pictures"] = Json::array();
    for (const OutputSpec& s : plan.pictures) {
        Json p = {{"name", s.name},
                  {"type", s.type},
                  {"place", place(s.place)},
                  {"gain", s.gain},
                  {"gamma", s.gamma},
                  {"ownExposure", s.ownExposure},
                  {"srgb", s.srgb},
                  {"curve", s.curve},
                  {"filter", filter(s.filter)},
                  {"depth", int(s.depth)},
                  {"rgba", quantization(s.rgba)},
                  {"z", quantization(s.z)},
                  {"quantizeAsked", s.quantizeAsked},
                  {"userFile", s.userFile}};
        p["variables"] = Json::array();
        for (const OutputVariable& v : s.variables)
            p["variables"].push_back({{"source", int(v.source)},
                                      {"name", v.name},
                                      {"engine", v.engine},
                                      {"light", v.light},
                                      {"typed", v.typed},
                                      {"color", v.color},
                                      {"channels", v.channels}});
        p["params"] = Json::array();
        for (const scene::Param& a : s.params)
            p["params"].push_back({{"name", a.name},
                                   {"class", int(a.cls)},
                                   {"type", int(a.type)},
                                   {"array", a.arrayLength},
                                   {"declared", a.declared},
                                   {"numbers", a.numbers},
                                   {"strings", a.strings},
                                   {"place", place(a.place)}});
        j["pictures"].push_back(std::move(p));
    }
    j["facts"] = {{"pixelAspect", facts.pixelAspect},
                  {"worldToCamera", matrix(facts.worldToCamera)},
                  {"worldToNDC", matrix(facts.worldToNDC)},
                  {"metadata", facts.metadata},
                  {"imager", facts.imager}};
    return j.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::optional<std::pair<OutputPlan, PictureFacts>> planFromText(const std::string& text, const std::string& file,
                                                                Diagnostics& diags) {
    try {
        Json j = Json::parse(text);
        std::pair<OutputPlan, PictureFacts> result;
        auto& [plan, facts] = result;
        const Json& b = j.at("basis");
        plan.basis.gain = b.at("gain").get<float>();
        plan.basis.gamma = b.at("gamma").get<float>();
        plan.basis.gammaGiven = b.at("gammaGiven").get<bool>();
        plan.basis.srgbAsked = b.at("srgbAsked").get<bool>();
        plan.basis.exposureGiven = b.at("exposureGiven").get<bool>();
        plan.basis.path = b.at("path").get<bool>();
        plan.basis.rgba = quantize(b.at("rgba"));
        plan.basis.z = quantize(b.at("z"));
        plan.basis.filter = filter(b.at("filter"));
        plan.basis.depth = depth(b.at("depth"));
        plan.engineOutputs = j.at("outputs").get<std::vector<std::string>>();
        plan.engineWidths = j.at("widths").get<std::vector<int>>();
        takeWidths(j, plan);
        for (const Json& p : j.at("pictures")) {
            OutputSpec s;
            s.name = p.at("name").get<std::string>();
            s.type = p.at("type").get<std::string>();
            s.place = place(p.at("place"));
            s.gain = p.at("gain").get<float>();
            s.gamma = p.at("gamma").get<float>();
            s.ownExposure = p.at("ownExposure").get<bool>();
            s.srgb = p.at("srgb").get<bool>();
            s.curve = p.at("curve").get<std::string>();
            s.filter = filter(p.at("filter"));
            s.depth = depth(p.at("depth"));
            s.rgba = quantization(p.at("rgba"));
            s.z = quantization(p.at("z"));
            s.quantizeAsked = p.at("quantizeAsked").get<bool>();
            for (const Json& q : p.at("variables")) {
                OutputVariable v;
                const int last = int(OutputVariable::Source::Computed) + int(computedOutputs().size()) - 1;
                v.source = OutputVariable::Source(std::clamp(q.at("source").get<int>(), 0, last));
                v.name = q.at("name").get<std::string>();
                v.engine = q.at("engine").get<int>();
                v.light = q.at("light").get<int>();
                v.typed = q.at("typed").get<bool>();
                v.color = q.at("color").get<bool>();
                v.channels = q.at("channels").get<std::vector<std::string>>();
                size_t most = 3;
                if (v.source == OutputVariable::Source::Engine) {
                    if (v.engine < 0 || size_t(v.engine) >= plan.engineOutputs.size()) continue;
                    most = size_t(plan.engineWidths[size_t(v.engine)]);
                } else if (v.source == OutputVariable::Source::Alpha || v.source == OutputVariable::Source::Z) most = 1;
                if (!soundLight(v, plan) || v.channels.empty() || v.channels.size() > most) continue;
                s.variables.push_back(std::move(v));
            }
            for (const Json& q : p.at("params")) {
                scene::Param a;
                a.name = q.at("name").get<std::string>();
                a.cls = scene::Class(std::clamp(q.at("class").get<int>(), 0, int(scene::Class::FaceVertex)));
                a.type = scene::Type(std::clamp(q.at("type").get<int>(), 0, int(scene::Type::Matrix)));
                a.arrayLength = q.at("array").get<int>();
                a.declared = q.at("declared").get<bool>();
                a.numbers = q.at("numbers").get<std::vector<float>>();
                a.strings = q.at("strings").get<std::vector<std::string>>();
                a.place = place(q.at("place"));
                s.params.push_back(std::move(a));
            }
            if (!s.variables.empty()) plan.pictures.push_back(std::move(s));
        }
        const Json& f = j.at("facts");
        facts.pixelAspect = f.at("pixelAspect").get<float>();
        facts.worldToCamera = matrix(f.at("worldToCamera"));
        facts.worldToNDC = matrix(f.at("worldToNDC"));
        facts.metadata = f.at("metadata").get<std::map<std::string, std::string>>();
        facts.imager = f.at("imager").get<bool>();
        return result;
    } catch (const std::exception& e) {
        diags.report(Severity::Error, Rie::BadFile, {file},
                     std::string("part file: the description of its pictures is damaged: ") + e.what());
        return std::nullopt;
    }
}

} // namespace alpenglow::render
