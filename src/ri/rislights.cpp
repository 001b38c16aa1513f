// Lights of RIS: on everywhere but where a subset leaves them out, with filters and profiles (docs/ris.md).
#include "base/file.h"
#include "base/limits.h"
#include "ri/interpreter.h"
#include "ri/ris.h"
#include "scene/filterlink.h"
#include <algorithm>
#include <fmt/format.h>
#include <sstream>

namespace alpenglow::ri {
namespace {

/// The default shape of a light of RIS in its own space: width 1, shining along +z.
struct LightShape {
    std::string_view name, requests;
};
constexpr LightShape kGeometryShapes[] = {
    {"PxrRectLight", "Polygon \"P\" [-.5 -.5 0  .5 -.5 0  .5 .5 0  -.5 .5 0] \"st\" [0 0 1 0 1 1 0 1]"},
    {"PxrPortalLight", "Polygon \"P\" [-.5 -.5 0  .5 -.5 0  .5 .5 0  -.5 .5 0] \"st\" [0 0 1 0 1 1 0 1]"},
    {"PxrDiskLight", "Disk 0 .5 360"},
    {"PxrSphereLight", "Sphere .5 -.5 .5 360"},
    {"PxrCylinderLight", "TransformBegin Rotate 90 0 1 0 Cylinder .5 -.5 .5 360 TransformEnd"},
};
/// Geometry that is a light and draws nothing: "envsphere" and its like.
constexpr std::string_view kNoShapes[] = {"envsphere", "domelight", "distantlight", "envlight", "envdaylight"};
constexpr std::string_view kFar[] = {"PxrDomeLight", "PxrDistantLight", "PxrEnvDayLight", "PxrStdEnvMapLight",
                                     "PxrStdEnvDayLight"};

/// The words of a text, separated by blanks or commas; a + before one does not count.
std::set<std::string> wordsOf(const scene::Param* p) {
    std::set<std::string> all;
    if (!p || p->strings.empty()) return all;
    std::string text = p->strings[0];
    std::replace(text.begin(), text.end(), ',', ' ');
    std::istringstream in(text);
    for (std::string word; in >> word;) all.insert(word.front() == '+' ? word.substr(1) : word);
    return all;
}

/// Whether the subsets of a primitive's attributes let a light of those groups illuminate it.
bool linked(const scene::Attributes& a, const std::set<std::string>& groups) {
    const auto has = [&](const std::set<std::string>& subset) {
        return std::any_of(subset.begin(), subset.end(), [&](const std::string& s) { return groups.count(s) > 0; });
    };
    const std::set<std::string> subset = wordsOf(a.value("lighting:subset"));
    return (subset.empty() || has(subset)) && !has(wordsOf(a.value("lighting:excludesubset")));
}

bool namedAsProfile(const std::string& path) {
    const auto lower = [](char c) { return char(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c); };
    std::string end = path.size() < 4 ? "" : path.substr(path.size() - 4);
    std::transform(end.begin(), end.end(), end.begin(), lower);
    return end == ".ies";
}

RawParam numbersParam(const char* name, const std::vector<float>& numbers) {
    RawParam p;
    p.token = fmt::format("uniform float[{}] {}", numbers.size(), name);
    p.value.kind = Value::Kind::Numbers;
    p.value.array = true;
    p.value.numbers.assign(numbers.begin(), numbers.end());
    return p;
}

RawParam textsParam(const char* name, std::vector<std::string> texts) {
    RawParam p;
    p.token = fmt::format("uniform string[{}] {}", texts.size(), name);
    p.value.kind = Value::Kind::Strings;
    p.value.array = true;
    p.value.strings = std::move(texts);
    return p;
}

constexpr char kFilterLinks[] = "lightFilterLinks"; // shaders/include/rislight.h

} // namespace

std::optional<std::string_view> lightGeometry(std::string_view name) {
    static constexpr std::pair<std::string_view, std::string_view> kShapeNames[] = {{"rectlight", "PxrRectLight"},
                                                                                    {"disklight", "PxrDiskLight"},
                                                                                    {"spherelight", "PxrSphereLight"},
                                                                                    {"cylinderlight", "PxrCylinderLight"}};
    for (const auto& [geometry, light] : kShapeNames)
        if (geometry == name)
            return std::find_if(std::begin(kGeometryShapes), std::end(kGeometryShapes), [&](auto& s) { return s.name == light; })
                ->requests;
    if (std::find(std::begin(kNoShapes), std::end(kNoShapes), name) != std::end(kNoShapes)) return "";
    return {};
}

void Interpreter::lightFilter(const Call& call) {
    ris_ = true;
    const scene::ParamList given = bind(call, Use::Other);
    const std::string& name = call.text(0);
    if (name == "PxrCombinerLightFilter") return; // each filter has its own way to be combined
    scene::Transform space = state.ctm;
    if (const scene::Param* p = scene::find(given, "coordsys"); p && !p->strings.empty() && !p->strings[0].empty()) {
        const auto named = namedSystem(p->strings[0]);
        if (named) space = *named;
        else
            reporter.error(
                Rie::BadToken, p->place,
                fmt::format("LightFilter: there is no coordinate system \"{}\": the filter stands here", p->strings[0]));
    }
    bool singular = false;
    auto filter = ri::lightFilter(name, given, inverse(space.first(), &singular));
    if (!filter || singular || !inWorld())
        return reporter.once("ri:LightFilter:" + name, Severity::Warning, Rie::Incapable, call.place,
                             !filter    ? fmt::format("LightFilter \"{}\" is left out: there is none of that name", name)
                             : singular ? "LightFilter is left out: its space is flat"
                                        : "LightFilter is left out: it stands before WorldBegin",
                             filter ? "" : "IntMult, Barn, Gobo, Cookie, Rod, Blocker and Ramp are known, as PxrRodLightFilter");
    auto all =
        state.filters ? std::make_shared<std::vector<LightFilter>>(*state.filters) : std::make_shared<std::vector<LightFilter>>();
    if (all->size() >= kLightFilters)
        return reporter.once("ri:lightfilters", Severity::Error, Rie::Limit, call.place,
                             fmt::format("a light has more than {} filters", kLightFilters));
    filter->handle = call.text(1);
    linksFilters_ |= !filter->groups.empty();
    all->push_back(std::move(*filter));
    state.filters = std::move(all);
}

/// The filters that are in force, as parameters of the light.
void Interpreter::addFilters(Call& call) const {
    if (!state.filters) return;
    std::vector<float> rows;
    std::vector<std::string> maps, links;
    for (const LightFilter& f : *state.filters) {
        rows.insert(rows.end(), f.row.begin(), f.row.end());
        maps.push_back(f.map);
        links.push_back(scene::FilterLink{call.text(1), f.handle, f.groups}.text());
    }
    call.params.push_back(numbersParam("lightFilters", rows));
    call.params.push_back(textsParam("lightFilterMaps", std::move(maps)));
    call.params.push_back(textsParam(kFilterLinks, std::move(links)));
}

void Interpreter::enableFilter(const Call& call) {
    ris_ = true;
    linksFilters_ = true;
    scene::Param p;
    p.name = scene::enabledFilterKey(call.text(0), call.text(1));
    p.numbers = {call.real(2)};
    p.place = call.place;
    attributes().values[p.name] = std::move(p);
}

/// Where all filters act on everything, lights need not ask what they light.
void Interpreter::dropFilterLinks(scene::Frame& frame) const {
    if (linksFilters_) return;
    for (scene::Light& l : frame.lights) {
        if (!l.shader || !scene::find(l.shader->params, kFilterLinks)) continue;
        auto copy = std::make_shared<scene::ShaderCall>(*l.shader);
        std::erase_if(copy->params, [](const scene::Param& p) { return p.name == kFilterLinks; });
        l.shader = std::move(copy);
    }
}

/// The photometry of "iesProfile", read, as a parameter of the light.
void Interpreter::addProfile(Call& call) {
    const auto named = std::find_if(call.params.begin(), call.params.end(), [](const RawParam& p) {
        return p.token.substr(p.token.find_last_of(" \t") + 1) == "iesProfile" && p.value.kind == Value::Kind::Strings;
    });
    if (named == call.params.end() || named->value.strings.empty() || named->value.strings[0].empty()) return;
    const std::string name = named->value.strings[0];
    const SourcePlace place = call.at(*named);
    const std::string path = locate("light profile", name, place, namedAsProfile);
    if (path.empty()) return; // reported by locate()
    Diagnostics reported;
    const auto bytes = readWholeFile(path, limits::kShaderFileLooked, reported);
    for (const Diagnostic& d : reported.all()) reporter.error(d.code, place, d.message, d.hint);
    if (!bytes) return;
    std::string why;
    const auto profile = lightProfile({bytes->begin(), bytes->end()}, why);
    if (profile) call.params.push_back(numbersParam("lightProfile", *profile));
    else
        reporter.error(Rie::BadFile, place, fmt::format("light profile \"{}\" is not read: {}", name, why),
                       "profiles are files of IES LM-63, type C");
}

/// The light is on for all that there is, if it is not muted.
void Interpreter::turnOn(int light) {
    const scene::Param* muted = attributes().value("lighting:mute");
    if (muted && !muted->numbers.empty() && muted->numbers[0] != 0) attributes().lights.erase(light);
    else globalLights_.insert(light);
}

/// Lights that are on everywhere, with the names by which a primitive's subset may call them.
std::vector<std::pair<int, std::set<std::string>>> Interpreter::groupsOfLights(const scene::Frame& frame) const {
    std::vector<std::pair<int, std::set<std::string>>> all;
    for (const int l : globalLights_) {
        if (size_t(l) >= frame.lights.size()) continue;
        const scene::Light& light = frame.lights[size_t(l)];
        std::set<std::string> names;
        if (light.attributes) names = wordsOf(light.attributes->value("grouping:membership"));
        if (names.empty()) names.insert("default");
        names.insert(light.handle);
        if (const scene::Param* p = light.attributes ? light.attributes->value("identifier:name") : nullptr)
            names.insert(p->strings.begin(), p->strings.end());
        all.emplace_back(l, std::move(names));
    }
    return all;
}

void Interpreter::risLight(const Call& call) {
    ris_ = true;
    const std::string& name = call.text(0);
    if (std::any_of(call.params.begin(), call.params.end(), [](const RawParam& p) { return !connectedName(p.token).empty(); }))
        incapable(call, "connections of lights and light filters are not done by this version: they keep their own values");
    Call plain = call;
    std::erase_if(plain.params, [](const RawParam& p) { return !connectedName(p.token).empty(); });
    addFilters(plain);
    addProfile(plain);
    const auto shape =
        std::find_if(std::begin(kGeometryShapes), std::end(kGeometryShapes), [&](const LightShape& s) { return s.name == name; });
    const bool far = std::find(std::begin(kFar), std::end(kFar), name) != std::end(kFar);
    if (shape == std::end(kGeometryShapes)) { // far away, or the primitives that follow
        light(plain, !far);
        turnOn(int(lights().size()) - 1);
        return;
    }
    if (!inWorld())
        return reporter.once("ri:worldlight", Severity::Warning, Rie::Incapable, call.place,
                             "a light with a shape before WorldBegin is left out", "put it behind WorldBegin");
    if (!begin(BlockKind::Attribute, call)) return;
    light(plain, true);
    scene::Attributes& a = attributes();
    turnOn(a.areaLight);
    // Of black paint that shines: seen by what it lights, hides nothing, and is seen by the camera where the scene says so.
    a.surface = nullptr;
    a.displacement = a.atmosphere = a.interior = a.exterior = nullptr;
    a.coshaders.clear();
    a.color = Color{0};
    a.opacity = Color{1};
    a.sides = name == "PxrSphereLight" || name == "PxrCylinderLight" ? 2 : 1;
    expand("Surface \"constant\"", call);
    if (!a.value("visibility:camera")) expand("Attribute \"visibility\" \"int camera\" 0", call);
    expand("Attribute \"visibility\" \"int transmission\" 0", call);
    expand(std::string(shape->requests), call);
    end(BlockKind::Attribute, call);
}

/// Lights of RIS are on for all that there is, whatever stood before them; an integrator may see one surface everywhere.
void Interpreter::overrideAttributes(scene::Frame& frame) {
    dropFilterLinks(frame);
    if (globalLights_.empty() && !integratorSurface_) return;
    std::map<scene::AttributesRef, scene::AttributesRef> lit;
    const std::vector<std::pair<int, std::set<std::string>>> groups = groupsOfLights(frame);
    const auto light = [&](const scene::AttributesRef& a) {
        scene::AttributesRef& known = lit[a];
        if (known) return known;
        auto copy = std::make_shared<scene::Attributes>(*a);
        for (const auto& [l, names] : groups)
            if (linked(*a, names)) copy->lights.insert(l);
            else copy->lights.erase(l);
        if (integratorSurface_ && !globalLights_.count(a->areaLight)) copy->surface = integratorSurface_;
        return known = copy;
    };
    const auto all = [&](std::vector<scene::PrimitiveRef>& list) {
        for (scene::PrimitiveRef& p : list) {
            if (!p->attributes) continue;
            auto copy = std::make_shared<scene::Primitive>(*p);
            copy->attributes = light(p->attributes);
            if (p->attributesBefore) copy->attributesBefore = light(p->attributesBefore);
            for (auto& k : copy->motionKeys) {
                k = std::make_shared<scene::Primitive>(*k);
                if (k->attributes) k->attributes = light(k->attributes);
            }
            p = std::move(copy);
        }
    };
    all(frame.primitives);
    for (scene::Object& o : frame.objects) all(o.primitives);
    for (scene::Instance& i : frame.instances)
        if (i.attributes) i.attributes = light(i.attributes);
}

} // namespace alpenglow::ri
