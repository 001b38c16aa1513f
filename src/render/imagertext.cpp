#include "render/imagertext.h"
#include "base/limits.h"
#include "scene/scene.h"
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

namespace alpenglow::render {
namespace {

using Json = nlohmann::json;
using scene::Attributes;
using scene::Options;
using scene::Param;
using scene::ShaderRef;

// Declared before the templates that call them, because only earlier declarations are found there.
template <class T> Json toJson(const T& v) { return v; }
template <class T> void fromJson(const Json& j, T& v) { v = j.get<T>(); }
Json toJson(const ShaderRef&);
void fromJson(const Json&, ShaderRef&);
template <class T> Json toJson(const std::optional<T>& v) { return v ? Json(*v) : Json(nullptr); }
template <class T> void fromJson(const Json& j, std::optional<T>& v) {
    v.reset();
    if (!j.is_null()) v = j.get<T>();
}

Json toJson(const SourcePlace& p) { return {p.file, p.line, p.column}; }
void fromJson(const Json& j, SourcePlace& p) { p = {j.at(0).get<std::string>(), j.at(1).get<int>(), j.at(2).get<int>()}; }

Json toJson(const Color& c) { return {c.x, c.y, c.z}; }
void fromJson(const Json& j, Color& c) { c = {j.at(0).get<float>(), j.at(1).get<float>(), j.at(2).get<float>()}; }

Json toJson(const Matrix& m) {
    Json j = Json::array();
    for (const auto& row : m.m)
        for (double v : row) j.push_back(v);
    return j;
}
void fromJson(const Json& j, Matrix& m) {
    for (size_t i = 0; i < 16; ++i) m.m[i / 4][i % 4] = j.at(i).get<double>();
}

Json toJson(const scene::Transform& t) {
    Json keys = Json::array();
    for (const Matrix& m : t.keys) keys.push_back(toJson(m));
    return {{"times", t.times}, {"keys", std::move(keys)}};
}
void fromJson(const Json& j, scene::Transform& t) {
    t.times = j.at("times").get<std::vector<float>>();
    t.keys.clear();
    for (const Json& k : j.at("keys")) fromJson(k, t.keys.emplace_back());
    if (t.keys.empty() || t.times.size() != t.keys.size()) t = {};
}

Json toJson(const Param& p) {
    return {{"name", p.name},         {"class", int(p.cls)},  {"type", int(p.type)},  {"array", p.arrayLength},
            {"declared", p.declared}, {"numbers", p.numbers}, {"strings", p.strings}, {"place", toJson(p.place)}};
}
void fromJson(const Json& j, Param& p) {
    p.name = j.at("name").get<std::string>();
    p.cls = scene::Class(std::clamp(j.at("class").get<int>(), 0, int(scene::Class::FaceVertex)));
    p.type = scene::Type(std::clamp(j.at("type").get<int>(), 0, int(scene::Type::Matrix)));
    p.arrayLength = j.at("array").get<int>();
    p.declared = j.at("declared").get<bool>();
    p.numbers = j.at("numbers").get<std::vector<float>>();
    p.strings = j.at("strings").get<std::vector<std::string>>();
    fromJson(j.at("place"), p.place);
}

Json toJson(const scene::ParamList& list) {
    Json j = Json::array();
    for (const Param& p : list) j.push_back(toJson(p));
    return j;
}
void fromJson(const Json& j, scene::ParamList& list) {
    list.clear();
    for (const Json& p : j) fromJson(p, list.emplace_back());
}

template <class V> Json toJson(const std::map<std::string, V>& m) {
    Json j = Json::object();
    for (const auto& [key, v] : m) j[key] = toJson(v);
    return j;
}
template <class V> void fromJson(const Json& j, std::map<std::string, V>& m) {
    m.clear();
    for (const auto& [key, v] : j.items()) fromJson(v, m[key]);
}

Json toJson(const ShaderRef& s) {
    if (!s) return nullptr;
    Json connections = Json::array();
    for (const scene::Connection& c : s->connections)
        connections.push_back({c.parameter, c.element, c.handle, c.output, toJson(c.place)});
    return {{"name", s->name},
            {"params", toJson(s->params)},
            {"connections", connections},
            {"toWorld", toJson(s->toWorld)},
            {"place", toJson(s->place)}};
}
void fromJson(const Json& j, ShaderRef& s) {
    s.reset();
    if (j.is_null()) return;
    auto call = std::make_shared<scene::ShaderCall>();
    call->name = j.at("name").get<std::string>();
    fromJson(j.at("params"), call->params);
    for (const Json& c : j.at("connections")) {
        scene::Connection& to = call->connections.emplace_back();
        to.parameter = c.at(0).get<std::string>();
        to.element = c.at(1).get<int>();
        to.handle = c.at(2).get<std::string>();
        to.output = c.at(3).get<std::string>();
        fromJson(c.at(4), to.place);
    }
    fromJson(j.at("toWorld"), call->toWorld);
    fromJson(j.at("place"), call->place);
    s = std::move(call);
}

/// Writes each field under its name, or reads it: one list of fields for both directions.
struct ImagerWriter {
    Json j = Json::object();
    template <class T> void operator()(const char* name, const T& v) { j[name] = toJson(v); }
    template <size_t N> void operator()(const char* name, const float (&v)[N]) { j[name] = std::vector<float>(v, v + N); }
};
struct ImagerReader {
    const Json& j;
    template <class T> void operator()(const char* name, T& v) { fromJson(j.at(name), v); }
    template <size_t N> void operator()(const char* name, float (&v)[N]) {
        for (size_t k = 0; k < N; ++k) v[k] = j.at(name).at(k).get<float>();
    }
};

/// Fields for attribute(), and the co-shaders.
template <class Field, class A> void attributeFields(Field& field, A& a) {
    field("color", a.color);
    field("opacity", a.opacity);
    field("shadingRate", a.shadingRate);
    field("matte", a.matte);
    field("sides", a.sides);
    field("inside", a.inside);
    field("textureCoordinates", a.textureCoordinates);
    field("detailRange", a.detailRange);
    field("values", a.values);
    field("coshaders", a.coshaders);
}

/// Fields for option() and named spaces, and the imager.
template <class Field, class O> void optionFields(Field& field, O& o) {
    field("xres", o.xres);
    field("yres", o.yres);
    field("pixelAspect", o.pixelAspect);
    field("formatSet", o.formatSet);
    field("frameAspect", o.frameAspect);
    field("screenWindow", o.screenWindow);
    field("crop", o.crop);
    field("projection", o.projection);
    field("projectionParams", o.projectionParams);
    field("fov", o.fov);
    field("clipNear", o.clipNear);
    field("clipFar", o.clipFar);
    field("fstop", o.fstop);
    field("focalLength", o.focalLength);
    field("focalDistance", o.focalDistance);
    field("shutterOpen", o.shutterOpen);
    field("shutterClose", o.shutterClose);
    field("pixelSamplesX", o.pixelSamplesX);
    field("pixelSamplesY", o.pixelSamplesY);
    field("pixelSamplesSet", o.pixelSamplesSet);
    field("pixelVariance", o.pixelVariance);
    field("gain", o.gain);
    field("gamma", o.gamma);
    field("imager", o.imager);
    field("hider", o.hider);
    field("hiderParams", o.hiderParams);
    field("values", o.values);
    field("frameNumber", o.frameNumber);
    field("worldToCamera", o.worldToCamera);
    field("cameraSpaces", o.cameraSpaces);
}

template <class Field, class S> void settingFields(Field& field, S& s) {
    field("seed", s.seed);
    field("lanes", s.lanes);
    field("maxDepth", s.maxDepth);
    field("dialect", s.dialect);
    field("shaderPaths", s.shaderPaths);
    field("texturePaths", s.texturePaths);
    field("pluginPaths", s.pluginPaths);
}

void makeAbsolute(std::vector<std::string>& folders) {
    for (std::string& f : folders) {
        std::error_code failed;
        const auto whole = std::filesystem::absolute(f.empty() ? "." : f, failed);
        if (!failed) f = whole.lexically_normal().string();
    }
}

} // namespace

std::string imagerToText(const scene::Frame& frame, const world::Settings& settings) {
    if (!frame.options.imager) return "";
    world::Settings from = settings;
    for (auto* folders : {&from.shaderPaths, &from.texturePaths, &from.pluginPaths}) makeAbsolute(*folders);
    ImagerWriter options, attributes, how;
    optionFields(options, frame.options);
    settingFields(how, from);
    how("hiderNumber", int(from.hider));
    Json j = {{"options", std::move(options.j)}, {"settings", std::move(how.j)}, {"systems", toJson(frame.coordinateSystems)}};
    if (frame.options.attributes) {
        attributeFields(attributes, *frame.options.attributes);
        j["attributes"] = std::move(attributes.j);
    }
    // option("Display") returns the name of the first display.
    if (!frame.options.displays.empty()) j["display"] = frame.options.displays.front().name;
    const std::string text = j.dump(-1, ' ', false, Json::error_handler_t::replace);
    return text.size() < limits::kPartHeaderBytes / 2 ? text : "";
}

std::optional<ImagerScene> imagerFromText(const std::string& text, const std::string& file, Diagnostics& diags) {
    try {
        const Json j = Json::parse(text);
        ImagerScene scene;
        auto frame = std::make_shared<scene::Frame>();
        ImagerReader options{j.at("options")}, how{j.at("settings")};
        optionFields(options, frame->options);
        settingFields(how, scene.settings);
        int hider = 0;
        how("hiderNumber", hider);
        scene.settings.hider = world::Hider(std::clamp(hider, 0, int(world::Hider::Path)));
        if (scene.settings.lanes != 4 && scene.settings.lanes != 8) scene.settings.lanes = 16;
        fromJson(j.at("systems"), frame->coordinateSystems);
        if (j.contains("attributes")) {
            ImagerReader attributes{j.at("attributes")};
            auto a = std::make_shared<Attributes>();
            attributeFields(attributes, *a);
            frame->options.attributes = std::move(a);
        }
        if (j.contains("display")) frame->options.displays.emplace_back().name = j.at("display").get<std::string>();
        scene.frame = std::move(frame);
        return scene;
    } catch (const Json::exception& e) {
        diags.report(Severity::Error, Rie::BadFile, {file}, std::string("cannot read the part file's imager: ") + e.what());
        return std::nullopt;
    }
}

} // namespace alpenglow::render
