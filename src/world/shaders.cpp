// Shader calls of the scene made into programs with values, and those into kernels.
#include "base/folder.h"
#include "base/limits.h"
#include "rsl/front/visit.h"
#include "rsl/ir/build.h"
#include "scene/network.h"
#include "scene/scene.h"
#include "world/fitparameter.h"
#include "world/lightobjects.h"
#include "world/mutableworld.h"
#include "world/patterns.h"
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>
#include <set>

namespace alpenglow::world {

namespace {

double compileClock() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// "did you mean ..." among the shader sources on the search path; or empty.
std::string nearShader(const std::string& name, const std::vector<std::string>& directories) {
    std::vector<std::string> names;
    for (const auto& directory : directories)
        for (const std::string& file : namesIn(directory, limits::kFolderEntries))
            if (const std::filesystem::path f = file; f.extension() == ".sl" && f.stem() != name && names.size() < 10000)
                names.push_back(f.stem().string());
    std::string near = nearestName(name, names);
    return near.empty() ? "" : "did you mean \"" + near + "\"?";
}

void transformParameter(std::vector<float>& v, shadeops::Base base, const Matrix& m) {
    for (size_t i = 0; i + 2 < v.size() && base != shadeops::Base::Matrix; i += 3) {
        Vec3d p(v[i], v[i + 1], v[i + 2]);
        switch (base) {
        case shadeops::Base::Point:
            p = transformPoint(m, p);
            break;
        case shadeops::Base::Vector:
            p = transformVector(m, p);
            break;
        case shadeops::Base::Normal:
            p = transformNormal(m, p);
            break;
        default:
            return;
        }
        v[i] = float(p.x);
        v[i + 1] = float(p.y);
        v[i + 2] = float(p.z);
    }
    if (base == shadeops::Base::Matrix) // given relative to shader space
        for (size_t i = 0; i + 15 < v.size(); i += 16) {
            Matrix a;
            for (int k = 0; k < 16; ++k) a.m[k / 4][k % 4] = v[i + size_t(k)];
            a = a * m;
            for (int k = 0; k < 16; ++k) v[i + size_t(k)] = float(a.m[k / 4][k % 4]);
        }
}

} // namespace

/// Every expression of a program, those of its parameters' defaults among them.
template <class F> static void everyExpression(const rsl::Program& program, const F& f) {
    const auto body = [&](const rsl::StmtPtr& b) {
        if (b) rsl::front::everyExpr(*b, f);
    };
    for (const auto& s : program.shaders) {
        for (const auto& p : s->parameters)
            if (p.defaultValue) rsl::front::everyExpr(*p.defaultValue, f);
        body(s->body);
    }
    rsl::front::everyFunction(program, [&](const rsl::Function& g) { body(g.body); });
}

/// Where a shader names that space: as the space of a value or of a transformation, else as the default of a parameter that
/// stands there, else wherever the text is.
static std::optional<rsl::Place> placeOfSpace(const rsl::Program& program, const std::string& name) {
    std::optional<rsl::Place> written, anywhere;
    std::set<std::string> variables; // that hold spaces
    const auto isName = [&](const rsl::Expr& e) { return e.kind == rsl::ExprKind::String && e.text == name; };
    const auto space = [&](const rsl::Expr& e) {
        if (isName(e) && !written) written = e.place;
        if (e.kind == rsl::ExprKind::Variable && e.symbol) variables.insert(e.symbol->name);
    };
    everyExpression(program, [&](const rsl::Expr& e) {
        if (isName(e) && !anywhere) anywhere = e.place;
        if (e.space) space(*e.space);
        if (e.kind == rsl::ExprKind::ShadeopCall && e.shadeop->name.ends_with("transform"))
            for (const auto& a : e.args) space(*a);
    });
    if (written) return written;
    for (const auto& s : program.shaders)
        for (const auto& p : s->parameters)
            if (p.defaultValue && isName(*p.defaultValue) && variables.count(p.symbol->name)) return p.defaultValue->place;
    return anywhere;
}

/// Warns about spaces in a shader that neither the renderer nor the scene defines, at the place of the name.
static void sayUnknownSpaces(const WorldImpl& world, const ShaderInstance& i, std::span<const rsl::InputName> which,
                             Diagnostics& d) {
    std::set<std::string> unknown;
    for (const rsl::InputName& input : which)
        for (const std::string& name : {input.from, input.to})
            if (!world.knowsSpace(name)) unknown.insert(name);
    for (const std::string& name : unknown) {
        const rsl::Program& program = i.program->program();
        const std::optional<rsl::Place> at = placeOfSpace(program, name);
        SourcePlace place = i.place;
        if (at && at->file >= 0 && size_t(at->file) < program.files.size())
            place = {program.files[size_t(at->file)], at->line, at->column};
        d.reportOnce("unknown space " + name, {Severity::Warning,
                                               Rie::BadHandle,
                                               place,
                                               "unknown coordinate system \"" + name + "\"; taken as \"current\"",
                                               {},
                                               {}});
    }
}

/// VTK and its kin give the standard imager "background" its colour as "color", which no shader of ours can name so: it is a word
/// of the language. Parameters of RIS that are such words have an underscore behind them here.
static scene::Param asDeclared(scene::Param given, const rsl::CompiledShader& shader) {
    const auto has = [&](const std::string& name) {
        return std::any_of(shader.parameters().begin(), shader.parameters().end(), [&](const auto& p) { return p.name == name; });
    };
    if (!has(given.name) && has(given.name + "_")) given.name += "_";
    if (given.name == "color" && shader.kind() == rsl::ShaderKind::Imager && shader.name() == "background")
        given.name = "background";
    return given;
}

/// Sets all parameters: values of the scene, else defaults.
void MutableWorld::takeValues(ShaderInstance& of, const std::vector<rsl::ParameterValue>& values, Diagnostics& d) {
    ShaderInstance* i = &of;
    // Defaults: expressions of the shader in the instance's spaces, given the scene's values.
    auto spaces = [&](const std::string& from, const std::string& to, float out[16]) {
        const rsl::InputName asked = rsl::InputName::space(from, to);
        sayUnknownSpaces(*this, *i, {&asked, 1}, d);
        Matrix m;
        bool known = true;
        if (from == to) m = Matrix{};
        // "object" of the shader call; surface defaults that name it are evaluated again for each primitive.
        else if ((from == "shader" || from == "object") && to == "current") m = i->toCurrent;
        else if (from == "current" && (to == "shader" || to == "object")) m = inverse(i->toCurrent);
        else known = matrix(from, to, m);
        for (int k = 0; k < 16; ++k) out[k] = float(m.m[k / 4][k % 4]);
        return known;
    };
    for (auto& v : compiler_->parameterValues(i->program, d, spaces, values)) {
        if (v.type.base == shadeops::Base::String && v.type.array != 0) { // elements have their own names: "maps[1]"
            for (size_t e = 0; e < v.strings.size(); ++e)
                i->parameters.strings[v.name + "[" + std::to_string(e) + "]"] = v.strings[e];
        } else if (v.type.base == shadeops::Base::String) i->parameters.strings[v.name] = v.strings.empty() ? "" : v.strings[0];
        else i->parameters.numbers[v.name] = std::move(v.numbers);
    }
}

InstanceRef MutableWorld::instance(const scene::ShaderCall& call, rsl::ShaderKind kind, Diagnostics& d, bool anyKind) {
    double begin = compileClock();
    Diagnostics reported; // the compiler knows no scene: messages without a place get that of the call
    auto program = compiler_->load(call.name, settings_.shaderPaths, reported);
    for (Diagnostic m : reported.all()) {
        if (m.place.file.empty()) {
            m.place = call.place;
            if (m.hint.empty()) m.hint = nearShader(call.name, settings_.shaderPaths);
        }
        d.report(std::move(m));
    }
    facts_.compileSec += compileClock() - begin;
    if (!program) return nullptr;
    if (auto same = rsl::ShaderCompiler::variant(program, kind)) program = same; // a class can be several kinds of shader
    else if (auto other =
                 anyKind ? nullptr : rsl::ShaderCompiler::ofKind(program, kind, std::filesystem::path(call.name).stem().string()))
        program = other;
    if (program->kind() != kind && !anyKind) {
        d.reportOnce("kind:" + call.name + ":" + rsl::toString(kind),
                     {Severity::Error,
                      Rie::NoShader,
                      call.place,
                      "shader \"" + call.name + "\" is a " + rsl::toString(program->kind()) + " shader, not a " +
                          rsl::toString(kind) + " shader",
                      {},
                      {}});
        return nullptr;
    }
    auto i = std::make_shared<ShaderInstance>();
    i->name = call.name;
    i->program = program;
    i->place = call.place;
    scene::Transform toWorld = scene::overShutter(call.toWorld, shutter_);
    if (!toWorld.moves()) toWorld = scene::Transform(scene::at(call.toWorld, shutter_.open));
    i->toCurrent = toWorld.first() * worldToCamera_;
    setParameters(*i, call, d);
    if (!toWorld.moves()) return i;
    auto moving = std::make_shared<shading::MovingSpace>();
    moving->times = toWorld.times;
    for (const Matrix& m : toWorld.keys) {
        ShaderInstance then = *i;
        then.parameters = {};
        then.toCurrent = m * worldToCamera_;
        Diagnostics quiet; // already reported
        setParameters(then, call, quiet);
        moving->toCurrent.push_back(then.toCurrent);
        moving->parameters.push_back(std::move(then.parameters));
    }
    i->moving = std::move(moving);
    return i;
}

/// Sets parameter values, converted to current space by its toCurrent.
void MutableWorld::setParameters(ShaderInstance& instance, const scene::ShaderCall& call, Diagnostics& d) {
    ShaderInstance* const i = &instance;
    const auto& program = i->program;
    std::vector<rsl::ParameterValue> values;
    for (const scene::Connection& c : call.connections) connect(*i, c, d);
    for (const scene::Param& written : call.params) {
        const scene::Param renamed = asDeclared(written, *program);
        const scene::Param& given = renamed;
        const rsl::ParameterInfo* p = nullptr;
        std::vector<std::string> names;
        for (const auto& q : program->parameters()) {
            names.push_back(q.name);
            if (q.name == given.name) p = &q;
        }
        if (!p && given.name == rsl::kCategory && given.strings.size() == 1) { // many old lights have no such parameter
            i->parameters.strings[rsl::kCategory] = given.strings[0];
            continue;
        }
        if (!p && (given.name == "__instanceid" || given.name == "__materialid")) continue; // RIS: labels for mattes
        if (!p) {
            std::string near = nearestName(given.name, names);
            d.reportOnce("parameter:" + call.name + ":" + given.name,
                         {Severity::Warning,
                          Rie::BadToken,
                          given.place.file.empty() ? call.place : given.place,
                          "shader \"" + call.name + "\" has no parameter \"" + given.name + "\"; it is ignored",
                          near.empty() ? "" : "did you mean \"" + near + "\"?",
                          {}});
            continue;
        }
        auto value = fitParameter(given, *p, call.name, call.place, d);
        if (!value) continue;
        if (p->open)
            i->parameters.strings[rsl::lengthParameter(given.name)] = std::to_string(
                std::max(value->strings.size(), value->numbers.size() / size_t(shadeops::componentCount(p->type.base))));
        transformParameter(value->numbers, p->type.base, i->toCurrent);
        i->given.insert(given.name);
        if (p->handle) i->handlePlaces[given.name] = given.place.file.empty() ? call.place : given.place;
        values.push_back(std::move(*value));
    }

    takeValues(*i, values, d);
}

InstanceRef MutableWorld::builtin(const std::string& name, rsl::ShaderKind kind, Diagnostics& d) {
    scene::ShaderCall call;
    call.name = name;
    return instance(call, kind, d);
}

void MutableWorld::dropMissingHandles(const ShaderInstance& of, std::map<std::string, std::string>& texts,
                                      const std::vector<std::pair<std::string, scene::ShaderRef>>& bound, Diagnostics& d) const {
    std::vector<std::string> handles;
    for (const auto& [handle, call] : bound) handles.push_back(handle);
    for (auto& [key, handle] : texts) {
        const auto place = of.handlePlaces.find(key.substr(0, key.find('[')));
        if (place == of.handlePlaces.end() || rsl::isLengthParameter(key) || handle.empty()) continue;
        const auto is = [&](const std::string& known) { return known == handle; };
        const auto isLight = [&](const scene::Light& l) { return l.handle == handle; };
        if (std::any_of(handles.begin(), handles.end(), is) || std::any_of(frame_->lights.begin(), frame_->lights.end(), isLight))
            continue;
        const std::string near = nearestName(handle, handles);
        const SourcePlace& at = place->second;
        d.reportOnce("handle:" + handle + at.file + ":" + std::to_string(at.line) + key,
                     {Severity::Error,
                      Rie::BadHandle,
                      at,
                      "there is no co-shader \"" + handle + "\": \"" + key + "\" of shader \"" + of.name + "\" is null",
                      near.empty() ? "Shader \"name\" \"" + handle + "\" makes one" : "did you mean \"" + near + "\"?",
                      {}});
        handle.clear();
    }
}

InstanceRef MutableWorld::withCoShaders(const InstanceRef& shader, const std::map<std::string, scene::ShaderRef>& coshaders,
                                        Diagnostics& d, const scene::LightSet& lights) {
    const bool connected = shader && takesOutputs(*shader), handles = shader && shader->program->program().handles;
    if (!connected && !handles) return shader;
    std::vector<std::pair<std::string, scene::ShaderRef>> called;
    for (const auto& c : coshaders)
        if (handles && !scene::isKept(c.first)) called.push_back(c);
    if (connected) addPatterns(*this, *shader, coshaders, called, d);
    const auto instanceOf = [&](const scene::ShaderRef& call, Diagnostics& to) -> const InstanceRef& {
        auto [i, fresh] = coShaders_.try_emplace(call.get());
        if (fresh) i->second = instance(*call, rsl::ShaderKind::Surface, to, true);
        return i->second;
    };
    // Names of methods and members of lights that are called, perhaps by a co-shader.
    std::set<std::string> names;
    if (handles && !lights.empty()) {
        names = calledOfLights(shader->program->program());
        for (const auto& [handle, call] : coshaders)
            if (const InstanceRef& i = instanceOf(call, d)) names.merge(calledOfLights(i->program->program()));
    }
    for (int l : names.empty() ? scene::LightSet{} : lights) {
        const BoundLight& light = lights_[size_t(l)];
        if (light.source && light.source->shader && light.instance && answers(*light.instance->program, names))
            called.emplace_back(rsl::LightHandle{l, light.handle}.text(), light.source->shader);
    }
    if (called.empty() && shader->handlePlaces.empty()) return shader;
    std::vector<const void*> key{shader.get()};
    for (const auto& [handle, call] : called) key.push_back(call.get());
    InstanceRef& bound = withCoShaders_[key];
    if (bound) return bound;
    auto copy = std::make_shared<ShaderInstance>(*shader);
    dropMissingHandles(*shader, copy->parameters.strings, called, d);
    for (const auto& [handle, call] : called) {
        Diagnostics reported; // messages about a light were reported when it was bound
        const bool light = !coshaders.count(handle);
        const InstanceRef& i = instanceOf(call, light ? reported : d);
        if (!i) continue;
        rsl::CoShader c = rsl::ShaderCompiler::coShader(i->program, handle);
        c.light = light;
        if (!(i->toCurrent == shader->toCurrent)) c.space = spaceAt(i->toCurrent);
        for (const auto& [name, v] : i->parameters.numbers) c.numbers[name] = v;
        for (const auto& [name, v] : i->parameters.strings) c.strings[name] = v;
        c.connections = i->connections;
        dropMissingHandles(*i, c.strings, called, d);
        c.computed = i->program->computedParameters(i->given, {});
        copy->coShaders.push_back(std::move(c));
    }
    return bound = copy;
}

rsl::KernelOptions MutableWorld::kernelOptions(const ShaderInstance& i, const std::vector<std::string>& outputs,
                                               const std::vector<std::string>& varying, bool mixed, bool path) const {
    rsl::KernelOptions o;
    o.lanes = settings_.lanes;
    o.mixed = mixed;
    o.path = path;
    o.differences = i.differences;
    o.suspend = settings_.suspend && i.program->kind() == rsl::ShaderKind::Surface;
    o.outputs = outputs;
    for (const auto& [k, v] : i.parameters.strings) o.stringParameters.push_back({k, v});
    o.connections = i.connections;
    o.coShaders = i.coShaders;
    o.varyingParameters = varying;
    o.sentParameters = i.sent;
    o.computedParameters = i.program->computedParameters(i.given, varying);
    if (i.program->kind() == rsl::ShaderKind::Surface || i.program->kind() == rsl::ShaderKind::Volume)
        o.messages = lightMessages_;
    return o;
}

std::vector<rsl::ir::OutputLight> MutableWorld::lightOfOutputs(const ShaderInstance& i, const std::vector<std::string>& outputs,
                                                               const std::vector<std::string>& varying, bool path) const {
    return rsl::lightOfOutputs(i.program->program(), i.program->shader(), kernelOptions(i, outputs, varying, false, path));
}

BoundKernel MutableWorld::kernel(const ShaderInstance& i, const std::vector<std::string>& outputs,
                                 const std::vector<std::string>& varying, bool mixed, bool path, Diagnostics& d,
                                 const std::string& light) {
    BoundKernel bound = kernelWithoutRays(i, outputs, varying, mixed, path, d, light);
    needs_ |= bound.needs;
    return bound;
}

BoundKernel MutableWorld::kernelWithoutRays(const ShaderInstance& i, const std::vector<std::string>& outputs,
                                            const std::vector<std::string>& varying, bool mixed, bool path, Diagnostics& d,
                                            const std::string& light) {
    mixed |= i.moving != nullptr; // points at different times have different matrices and parameters
    rsl::KernelOptions o = kernelOptions(i, outputs, varying, mixed, path);
    o.light = light;
    double begin = compileClock();
    auto k = compiler_->kernel(i.program, o, d);
    facts_.compileSec += compileClock() - begin;
    if (!k) return {};
    sayZeroDivisions(i, o, d);
    std::vector<rsl::InputName> spaces;
    for (const auto& in : k->inputs())
        if (rsl::InputName name = rsl::InputName::parse(in.name); name.kind == rsl::InputName::Kind::Space)
            spaces.push_back(std::move(name));
    if (!spaces.empty()) {
        sayUnknownSpaces(*this, i, spaces, d);
        keepSpaces(spaces);
    }
    ++facts_.kernels;
    facts_.cacheHits += k->fromCache();
    (k->facts().suspends ? facts_.suspending : facts_.affine)++;
    BoundKernel bound = bindKernel(std::move(k), mixed, path, *this);
    needs_.bakes |= bound.needs.bakes, needs_.bakesCentres |= bound.needs.bakesCentres; // an imager may bake, too
    return bound;
}

} // namespace alpenglow::world
