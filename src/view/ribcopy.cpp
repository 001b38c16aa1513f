#include "view/ribcopy.h"
#include "ri/declare.h"
#include "scene/scene.h"
#include <algorithm>
#include <fmt/format.h>

namespace alpenglow::view {
namespace {

std::string quotedText(const std::string& s) {
    std::string out = "\"";
    for (const char c : s) {
        if (c == '"' || c == '\\') out += '\\';
        out += c;
    }
    return out + '"';
}

std::string parameterText(const scene::Param& p) {
    std::string name;
    if (p.cls != scene::Class::Uniform) name += ri::toString(p.cls) + std::string(" ");
    name += ri::toString(p.type);
    if (p.arrayLength > 0) name += fmt::format("[{}]", p.arrayLength);
    std::string values;
    for (const std::string& s : p.strings) values += (values.empty() ? "" : " ") + quotedText(s);
    for (const float x : p.numbers) values += (values.empty() ? "" : " ") + fmt::format("{}", x);
    return fmt::format(" \"{} {}\" [{}]", name, p.name, values);
}

scene::ParamList withChanges(const ShaderUse& u, const scene::ParamList& changes) {
    scene::ParamList all = u.call->params;
    for (const scene::Param& c : changes) {
        const auto same = std::find_if(all.begin(), all.end(), [&](const scene::Param& p) { return p.name == c.name; });
        if (same == all.end()) all.push_back(c);
        else *same = c;
    }
    return all;
}

std::string callText(const ShaderUse& u, const scene::ParamList& params) {
    const std::string request = u.role == "light"          ? u.area ? "AreaLightSource" : "LightSource"
                                : u.role == "displacement" ? "Displacement"
                                : u.role == "atmosphere"   ? "Atmosphere"
                                : u.role == "interior"     ? "Interior"
                                : u.role == "exterior"     ? "Exterior"
                                : u.role == "imager"       ? "Imager"
                                : u.role == "coshader"     ? "Shader"
                                                           : "Surface";
    std::string text = request + " " + quotedText(u.call->name);
    if (!u.handle.empty()) text += " " + quotedText(u.handle);
    for (const scene::Param& p : params) text += parameterText(p);
    return text + "\n";
}

} // namespace

std::string ribOfShader(const ShaderUse& u, const scene::ParamList& changes) { return callText(u, withChanges(u, changes)); }

std::string ribOfDimmedLight(const ShaderUse& u, const scene::ParamList& changes, double factor,
                             std::optional<double> byDefault) {
    scene::ParamList params = withChanges(u, changes);
    const auto is = [](const scene::Param& p) { return p.name == "intensity" && p.numbers.size() == 1; };
    auto intensity = std::find_if(params.begin(), params.end(), is);
    if (intensity == params.end()) {
        if (!byDefault)
            return fmt::format("# light {}: times {:.4g}; its shader has no \"intensity\"\n", quotedText(u.handle), factor);
        scene::Param p;
        p.name = "intensity";
        p.numbers = {float(*byDefault)};
        intensity = params.insert(params.end(), std::move(p));
    }
    intensity->numbers[0] = float(double(intensity->numbers[0]) * factor);
    return callText(u, params);
}

std::string ribOfCamera(const scene::Options& o) {
    std::string text;
    if (o.screenWindow && o.screenWindow->size() == 4) {
        const auto& w = *o.screenWindow;
        text += fmt::format("ScreenWindow {} {} {} {}\n", w[0], w[1], w[2], w[3]);
    }
    text += "Transform [";
    const Matrix& m = o.worldToCamera.first();
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) text += fmt::format("{}{:.9g}", x + y > 0 ? " " : "", m.m[y][x] == 0 ? 0. : m.m[y][x]);
    return text + "]\n";
}

} // namespace alpenglow::view
