// Networks of patterns as kernels know them: which co-shaders the connections of a shader reach.
#include "scene/network.h"
#include "rsl/front/seexpr.h"
#include "world/mutableworld.h"
#include "world/patterns.h"
#include <algorithm>

namespace alpenglow::world {

bool takesOutputs(const ShaderInstance& i) { return !i.connections.empty(); }

void connect(ShaderInstance& i, const scene::Connection& c, Diagnostics& d) {
    bool found = false;
    std::vector<std::string> names;
    const auto put = [&](const std::string& parameter, int element, const rsl::Connected& to) {
        i.connections[{parameter, element}] = to;
        found = true;
    };
    for (const auto& p : i.program->parameters()) {
        names.push_back(p.name);
        if (p.name == c.parameter || p.name == c.parameter + "_") put(p.name, c.element, {c.handle, c.output, false});
    }
    const std::string prefix = c.parameter + "_";
    if (!found)
        for (const std::string& name : names)
            if (name.starts_with(prefix)) put(name, -1, {c.handle, c.output + "_" + name.substr(prefix.size()), true});
    if (!found && c.output == "pxrMaterialOut") // a layer: all that a PxrSurface is made of, under its own names
        for (const std::string& name : names) put(name, -1, {c.handle, c.output + "_" + name, true});
    if (found) return;
    const std::string near = nearestName(c.parameter, names);
    d.reportOnce("parameter:" + i.name + ":" + c.parameter,
                 {Severity::Warning,
                  Rie::BadToken,
                  c.place,
                  "shader \"" + i.name + "\" has no parameter \"" + c.parameter + "\"; its connection is ignored",
                  near.empty() ? "" : "did you mean \"" + near + "\"?",
                  {}});
}

/// A pattern that is an expression: its shader is made of it and of the values that come with it.
static InstanceRef expression(MutableWorld& world, const scene::ShaderCall& call, Diagnostics& d) {
    scene::ShaderCall rest = call;
    std::string text;
    std::vector<rsl::front::SeExprVariable> variables;
    const auto add = [&](const std::string& name, bool color) {
        const auto same = [&](const auto& v) { return v.name == name; };
        if (std::none_of(variables.begin(), variables.end(), same)) variables.push_back({name, color});
    };
    std::erase_if(rest.params, [&](const scene::Param& p) {
        if (p.name == "expression" && !p.strings.empty()) text = p.strings[0];
        return p.type == scene::Type::String;
    });
    for (const scene::Param& p : rest.params) add(p.name, p.numbers.size() == 3);
    for (const scene::Connection& c : rest.connections) add(c.parameter, true);
    const auto rsl = rsl::front::rslFromSeExpr(text, variables, call.place, d);
    Diagnostics reported;
    auto program = rsl ? world.compiler_->loadText(*rsl, "SeExpr", reported) : nullptr;
    for (Diagnostic m : reported.all())
        if (m.severity >= Severity::Error) m.place = call.place, d.report(std::move(m));
    if (!program) return nullptr;
    auto i = std::make_shared<ShaderInstance>();
    i->name = call.name;
    i->program = std::move(program);
    i->place = call.place;
    i->toCurrent = scene::at(call.toWorld, world.shutter_.open) * world.worldToCamera_;
    world.setParameters(*i, rest, d);
    return i;
}

/// The instance of a pattern; null, reported once, if there is no shader of that name.
static InstanceRef pattern(MutableWorld& world, const scene::ShaderCall& call, Diagnostics& d) {
    if (call.name == "PxrSeExpr") return expression(world, call, d);
    Diagnostics reported;
    InstanceRef i = world.instance(call, rsl::ShaderKind::Surface, reported, true);
    for (const Diagnostic& m : reported.all()) {
        if (i || m.code != Rie::NoShader) {
            d.report(m);
            continue;
        }
        d.reportOnce("pattern:" + call.name,
                     {Severity::Warning,
                      Rie::NoShader,
                      call.place,
                      "there is no pattern \"" + call.name + "\": parameters that are connected to it keep their own values",
                      m.hint,
                      {}});
    }
    return i;
}

void addPatterns(MutableWorld& world, const ShaderInstance& shader, const std::map<std::string, scene::ShaderRef>& coshaders,
                 std::vector<std::pair<std::string, scene::ShaderRef>>& to, Diagnostics& d) {
    std::map<std::string, scene::ShaderRef> reached;
    std::vector<InstanceRef> rest;
    const auto follow = [&](const ShaderInstance& i) {
        for (const auto& [of, c] : i.connections) {
            const auto call = coshaders.find(c.handle);
            if (call == coshaders.end() || !reached.emplace(*call).second) continue;
            auto [known, fresh] = world.coShaders_.try_emplace(call->second.get());
            if (fresh) known->second = pattern(world, *call->second, d);
            if (known->second) rest.push_back(known->second);
        }
    };
    follow(shader);
    while (!rest.empty()) {
        const InstanceRef i = std::move(rest.back());
        rest.pop_back();
        follow(*i);
    }
    to.insert(to.end(), reached.begin(), reached.end());
}

} // namespace alpenglow::world
