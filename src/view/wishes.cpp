#include "view/wishes.h"
#include "base/limits.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::view {
namespace {

using Json = nlohmann::json;

/// A number within its range.
bool number(const Json& j, double least, double most, double* to) {
    if (!j.is_number()) return false;
    const double d = j.get<double>();
    if (!(d >= least && d <= most)) return false;
    *to = d;
    return true;
}

bool whole(const Json& j, double least, double most, double* to) { return number(j, least, most, to) && *to == std::floor(*to); }

bool cropOf(const Json& j, std::optional<std::array<double, 4>>* to) {
    if (j.is_null()) {
        to->reset();
        return true;
    }
    std::array<double, 4> v{};
    if (!j.is_array() || j.size() != 4) return false;
    for (size_t i = 0; i < 4; ++i)
        if (!number(j[i], 0, 1, &v[i])) return false;
    if (v[0] >= v[1] || v[2] >= v[3]) return false;
    *to = v;
    return true;
}

/// A name as a display's mode has it, or a light path expression ("lpe:C<RD>L").
bool isChannelName(const std::string& s) {
    if (s.starts_with("lpe:"))
        return s.size() > 4 && s.size() <= 200 &&
               std::all_of(s.begin(), s.end(), [](unsigned char c) { return c > ' ' && c < 127 && c != '"'; });
    return !s.empty() && s.size() <= 200 && std::all_of(s.begin(), s.end(), [](unsigned char c) {
        return std::isalnum(c) || c == '_' || c == ':' || c == '.' || c == '[' || c == ']';
    });
}

bool channelsOf(const Json& j, std::vector<std::string>* to) {
    if (!j.is_array() || j.size() > kMostChannels) return false;
    to->clear();
    for (const Json& one : j) {
        if (!one.is_string() || !isChannelName(one.get<std::string>())) return false;
        if (std::find(to->begin(), to->end(), one.get<std::string>()) == to->end()) to->push_back(one.get<std::string>());
    }
    return true;
}

bool dimOf(const Json& j, std::map<std::string, double>* to) {
    if (!j.is_object() || j.size() > limits::kLights) return false;
    for (const auto& [handle, value] : j.items()) {
        double d = 1;
        if (!number(value, 0, 1000, &d)) return false;
        if (to->size() < 1000 || to->contains(handle)) (*to)[handle] = d;
    }
    return true;
}

} // namespace

std::string Wishes::take(const Json& j) {
    Wishes w = *this;
    double d = 0;
    for (const auto& [name, value] : j.items()) {
        bool fine = true;
        if (name == "continuous" || name == "paused" || name == "direct" || name == "indirect" || name == "lights") {
            if ((fine = value.is_boolean()))
                (name == "continuous" ? w.continuous
                 : name == "paused"   ? w.paused
                 : name == "direct"   ? w.direct
                 : name == "indirect" ? w.indirect
                                      : w.lights) = value.get<bool>();
        } else if (name == "spp") {
            if ((fine = whole(value, 1, limits::kSamplesPerPixel, &d))) w.spp = uint32_t(d);
        } else if (name == "depth") {
            if ((fine = whole(value, -1, limits::kPathDepth, &d))) w.depth = int(d);
        } else if (name == "factor") fine = number(value, 0.01, 8, &w.factor);
        else if (name == "clamp") fine = number(value, 0, 1e30, &w.clamp);
        else if (name == "hider") {
            fine = value.is_string() && (value == "" || value == "path" || value == "hidden" || value == "raytrace");
            if (fine) w.hider = value.get<std::string>();
        } else if (name == "crop") fine = cropOf(value, &w.crop);
        else if (name == "channels") fine = channelsOf(value, &w.channels);
        else if (name == "dim") fine = dimOf(value, &w.dim);
        else return "there is no setting \"" + name + "\"";
        if (!fine) return "\"" + name + "\" cannot be that";
    }
    *this = std::move(w);
    return "";
}

Json Wishes::json() const {
    Json j{{"continuous", continuous}, {"paused", paused},     {"spp", spp},       {"depth", depth},
           {"direct", direct},         {"indirect", indirect}, {"factor", factor}, {"clamp", clamp},
           {"hider", hider},           {"channels", channels}, {"lights", lights}, {"dim", dim}};
    j["crop"] = crop ? Json(*crop) : Json();
    return j;
}

std::string Wishes::worldKey() const {
    Json j{depth, direct, indirect, factor, clamp, hider, channels, lights};
    for (const auto& [shader, params] : parameters)
        for (const scene::Param& p : params) j.push_back({shader, p.name, p.numbers, p.strings});
    return j.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string takeParameter(const Json& j, const std::vector<ShaderUse>& uses, ParameterChanges& changes) {
    if (!j.is_object() || !j.contains("shader") || !j["shader"].is_number_integer() || j["shader"].get<int64_t>() < 0 ||
        j["shader"].get<size_t>() >= uses.size())
        return "there is no such shader";
    if (!j.contains("name") || !j["name"].is_string() || !j.contains("value") || !j["value"].is_array() || j["value"].empty() ||
        j["value"].size() > 64)
        return "a parameter needs a name and a list of values";
    const size_t number = j["shader"].get<size_t>();
    scene::Param p;
    p.name = j["name"].get<std::string>();
    if (p.name.empty() || p.name.size() > 200) return "a parameter has a name";
    p.place = uses[number].call->place;
    const std::string type = j.value("type", "float");
    p.type = type == "color"    ? scene::Type::Color
             : type == "point"  ? scene::Type::Point
             : type == "vector" ? scene::Type::Vector
             : type == "normal" ? scene::Type::Normal
             : type == "string" ? scene::Type::String
                                : scene::Type::Float;
    if (const scene::Param* given = scene::find(uses[number].call->params, p.name)) p = *given;
    p.numbers.clear();
    p.strings.clear();
    for (const Json& v : j["value"]) {
        if (p.type == scene::Type::String && v.is_string() && v.get<std::string>().size() <= 4096)
            p.strings.push_back(v.get<std::string>());
        else if (p.type != scene::Type::String && v.is_number() && std::isfinite(v.get<double>()))
            p.numbers.push_back(float(v.get<double>()));
        else return "\"" + p.name + "\" cannot be that";
    }
    const size_t n = p.type == scene::Type::String ? 1 : size_t(scene::componentCount(p.type));
    const size_t have = p.numbers.size() + p.strings.size();
    if (have != n * size_t(std::max(1, p.arrayLength))) return "\"" + p.name + "\" has another number of values";
    scene::ParamList& list = changes[number];
    const auto same = std::find_if(list.begin(), list.end(), [&](const scene::Param& q) { return q.name == p.name; });
    if (same == list.end()) list.push_back(std::move(p));
    else *same = std::move(p);
    return "";
}

} // namespace alpenglow::view
