// From a frame's description to something that can be traced.
#include "base/file.h"
#include "geometry/build.h"
#include "geometry/dice.h"
#include "transport/engine.h"
#include <chrono>
#include <cstdlib>
#include <filesystem>

namespace alpenglow::transport {

namespace {

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// The shaders that ship: beside the program's build tree, else where it was built from.
std::string shippedShaders() {
    std::error_code e;
    std::filesystem::path exe = std::filesystem::read_symlink("/proc/self/exe", e);
    for (std::filesystem::path p = exe.parent_path(); !p.empty() && p != p.root_path(); p = p.parent_path())
        if (std::filesystem::exists(p / "shaders" / "matte.sl", e)) return (p / "shaders").string();
    return ALPENGLOW_SHADER_DIR;
}

// "did you mean ..." among the shader sources on the search path; or empty.
std::string nearShader(const std::string& name, const std::vector<std::string>& directories) {
    std::vector<std::string> names;
    std::error_code e;
    for (const auto& directory : directories)
        for (const auto& f : std::filesystem::directory_iterator(directory.empty() ? "." : directory, e))
            if (f.path().extension() == ".sl" && names.size() < 10000) names.push_back(f.path().stem().string());
    std::string near = nearestName(name, names);
    return near.empty() ? "" : "did you mean \"" + near + "\"?";
}

// Screen window: ri.md 3.1; frame aspect from FrameAspectRatio or the format.
void screenWindow(const scene::Options& o, double w[4]) {
    if (o.screenWindow && o.screenWindow->size() == 4) {
        for (int i = 0; i < 4; ++i) w[i] = (*o.screenWindow)[size_t(i)];
        return;
    }
    double pa = o.pixelAspect > 0 ? o.pixelAspect : 1, a = o.frameAspect ? *o.frameAspect : o.xres * pa / std::max(o.yres, 1);
    if (!(a > 0)) a = 1;
    double x = a >= 1 ? a : 1, y = a >= 1 ? 1 : 1 / a;
    w[0] = -x; w[1] = x; w[2] = -y; w[3] = y;
}

float attributeNumber(const scene::Attributes& a, const std::string& key, float fallback) {
    const scene::Param* p = a.value(key);
    return p && !p->numbers.empty() ? p->numbers[0] : fallback;
}

// Visibility bits. Unset: everything sees everything under path; elsewhere only camera and shadow rays of the file's own asking.
uint32_t visibilityOf(const scene::Attributes& a, bool path) {
    auto on = [&](const char* name, bool fallback) {
        const scene::Param* p = a.value(std::string("visibility:") + name);
        if (!p) return fallback;
        if (!p->strings.empty()) return p->strings[0] != "transparent";
        return !p->numbers.empty() && p->numbers[0] != 0;
    };
    bool traced = on("trace", path);
    uint32_t bits = 0;
    if (on("camera", true)) bits |= accel::kCamera;
    if (on("diffuse", traced)) bits |= accel::kDiffuse;
    if (on("specular", traced)) bits |= accel::kSpecular;
    // Under path shadow rays are the renderer's own; elsewhere they are traced only when asked for, and old files that ask
    // (transmission(), trace()) without saying who may be seen mean everything.
    const scene::Param* casts = a.value("render:casts_shadows"); // BMRT's word
    if (on("transmission", true) && !(casts && !casts->strings.empty() && casts->strings[0] == "none")) bits |= accel::kTransmission;
    return bits;
}

void transformParameter(std::vector<float>& v, rsl::Base base, const Matrix& m) {
    for (size_t i = 0; i + 2 < v.size() && base != rsl::Base::Matrix; i += 3) {
        Vec3d p(v[i], v[i + 1], v[i + 2]);
        switch (base) {
        case rsl::Base::Point: p = transformPoint(m, p); break;
        case rsl::Base::Vector: p = transformVector(m, p); break;
        case rsl::Base::Normal: p = transformNormal(m, p); break;
        default: return;
        }
        v[i] = float(p.x); v[i + 1] = float(p.y); v[i + 2] = float(p.z);
    }
    if (base == rsl::Base::Matrix) // given relative to shader space
        for (size_t i = 0; i + 15 < v.size(); i += 16) {
            Matrix a;
            for (int k = 0; k < 16; ++k) a.m[k / 4][k % 4] = v[i + size_t(k)];
            a = a * m;
            for (int k = 0; k < 16; ++k) v[i + size_t(k)] = float(a.m[k / 4][k % 4]);
        }
}

} // namespace

bool WorldImpl::matrix(const std::string& from, const std::string& to, Matrix& out) const {
    auto toCurrent = [&](const std::string& name, Matrix& m) {
        if (name == "current" || name == "camera" || name == "eye") { m = Matrix{}; return true; }
        if (name == "world") { m = worldToCamera_; return true; }
        if (name == "screen") { m = inverse(cameraToScreen_); return true; }
        if (name == "NDC") { m = inverse(screenToNdc_) * inverse(cameraToScreen_); return true; }
        if (name == "raster") { m = inverse(ndcToRaster_) * inverse(screenToNdc_) * inverse(cameraToScreen_); return true; }
        if (auto i = frame_->coordinateSystems.find(name); i != frame_->coordinateSystems.end()) { m = i->second.first() * worldToCamera_; return true; }
        if (auto i = frame_->options.cameraSpaces.find(name); i != frame_->options.cameraSpaces.end()) { m = i->second.first(); return true; }
        if (name == "object" || name == "shader") { m = worldToCamera_; return true; } // no object here (imagers, lights): world
        return false;
    };
    Matrix a, b;
    bool known = toCurrent(from, a);
    bool knownTo = toCurrent(to, b);
    if (!known || !knownTo) {
        diagnostics_->reportOnce("space:" + (known ? to : from),
                                 {Severity::Warning, Rie::BadHandle, {}, "unknown coordinate system \"" + (known ? to : from) + "\"; taken as \"current\"", {}, {}});
    }
    if (to == "screen") b = Matrix{}, out = a * cameraToScreen_;
    else if (to == "NDC") out = a * cameraToScreen_ * screenToNdc_;
    else if (to == "raster") out = a * cameraToScreen_ * screenToNdc_ * ndcToRaster_;
    else out = a * inverse(b);
    return known && knownTo;
}

InstanceRef WorldImpl::instance(const scene::ShaderCall& call, rsl::ShaderKind kind, Diagnostics& d, bool anyKind) {
    double begin = seconds();
    Diagnostics said; // the compiler knows no scene: messages without a place get the call's
    auto program = compiler_->load(call.name, settings_.shaderPaths, said);
    for (Diagnostic m : said.all()) {
        if (m.place.file.empty()) {
            m.place = call.place;
            if (m.hint.empty()) m.hint = nearShader(call.name, settings_.shaderPaths);
        }
        d.report(std::move(m));
    }
    facts_.compileSec += seconds() - begin;
    if (!program) return nullptr;
    if (auto same = rsl::ShaderCompiler::variant(program, kind)) program = same; // a class can be several kinds of shader
    if (program->kind() != kind && !anyKind) {
        d.report(Severity::Error, Rie::NoShader, call.place,
                 "shader \"" + call.name + "\" is a " + rsl::toString(program->kind()) + " shader, not a " + rsl::toString(kind) + " shader");
        return nullptr;
    }
    auto i = std::make_shared<ShaderInstance>();
    i->name = call.name;
    i->program = program;
    i->toCurrent = call.toWorld.first() * worldToCamera_;
    i->place = call.place;

    // Defaults: the shader's own expressions in the instance's spaces.
    auto spaces = [&](const std::string& from, const std::string& to, float out[16]) {
        Matrix m;
        bool known = true;
        if (from == "shader" && to == "current") m = i->toCurrent;
        else if (from == "current" && to == "shader") m = inverse(i->toCurrent);
        else known = matrix(from, to, m);
        for (int k = 0; k < 16; ++k) out[k] = float(m.m[k / 4][k % 4]);
        return known;
    };
    for (auto& v : compiler_->parameterDefaults(program, d, spaces)) {
        if (v.type.base == rsl::Base::String && v.type.array != 0) { // elements have names of their own: "maps[1]"
            for (size_t e = 0; e < v.strings.size(); ++e) i->parameters.strings[v.name + "[" + std::to_string(e) + "]"] = v.strings[e];
        } else if (v.type.base == rsl::Base::String) i->parameters.strings[v.name] = v.strings.empty() ? "" : v.strings[0];
        else i->parameters.numbers[v.name] = std::move(v.numbers);
    }
    for (const scene::Param& given : call.params) {
        const rsl::ParameterInfo* p = nullptr;
        std::vector<std::string> names;
        for (const auto& q : program->parameters()) {
            names.push_back(q.name);
            if (q.name == given.name) p = &q;
        }
        if (!p) {
            std::string near = nearestName(given.name, names);
            d.reportOnce("parameter:" + call.name + ":" + given.name,
                         {Severity::Warning, Rie::BadToken, given.place.file.empty() ? call.place : given.place,
                          "shader \"" + call.name + "\" has no parameter \"" + given.name + "\"; it is ignored",
                          near.empty() ? "" : "did you mean \"" + near + "\"?", {}});
            continue;
        }
        if (p->type.base == rsl::Base::String) {
            const size_t most = p->type.array ? size_t(std::max(1, p->type.array)) : 1;
            for (size_t e = 0; e < std::min(most, given.strings.size()); ++e)
                i->parameters.strings[p->type.array ? given.name + "[" + std::to_string(e) + "]" : given.name] = given.strings[e];
            continue;
        }
        std::vector<float> v = given.numbers;
        size_t want = size_t(rsl::componentCount(p->type.base)) * size_t(std::max(1, p->type.array));
        if (v.size() == 1 && want == 3 && p->type.base == rsl::Base::Color) v.assign(3, v[0]);
        if (v.size() < want) {
            d.report(Severity::Warning, Rie::Consistency, given.place.file.empty() ? call.place : given.place,
                     "parameter \"" + given.name + "\" of shader \"" + call.name + "\" needs " + std::to_string(want) + " numbers, got " + std::to_string(v.size()) +
                         "; the default is used");
            continue;
        }
        v.resize(want);
        transformParameter(v, p->type.base, i->toCurrent);
        i->parameters.numbers[given.name] = std::move(v);
    }
    return i;
}

InstanceRef WorldImpl::builtin(const std::string& name, rsl::ShaderKind kind, Diagnostics& d) {
    scene::ShaderCall call;
    call.name = name;
    return instance(call, kind, d);
}

InstanceRef WorldImpl::withCoShaders(const InstanceRef& shader, const scene::Attributes& a, Diagnostics& d) {
    if (!shader || !shader->program->program().handles || a.coshaders.empty()) return shader;
    std::vector<const void*> key{shader.get()};
    for (const auto& [handle, call] : a.coshaders) key.push_back(call.get());
    InstanceRef& bound = withCoShaders_[key];
    if (bound) return bound;
    auto copy = std::make_shared<ShaderInstance>(*shader);
    for (const auto& [handle, call] : a.coshaders) {
        auto [i, fresh] = coShaders_.try_emplace(call.get());
        if (fresh) i->second = instance(*call, rsl::ShaderKind::Surface, d, true);
        if (!i->second) continue;
        rsl::CoShader c = rsl::ShaderCompiler::coShader(i->second->program, handle);
        for (const auto& [name, v] : i->second->parameters.numbers) c.numbers[name] = v;
        for (const auto& [name, v] : i->second->parameters.strings) c.strings[name] = v;
        copy->coShaders.push_back(std::move(c));
    }
    return bound = copy;
}

BoundKernel WorldImpl::kernel(const ShaderInstance& i, const std::vector<std::string>& outputs, const std::vector<std::string>& varying, bool mixed, bool path,
                              Diagnostics& d) {
    rsl::KernelOptions o;
    o.lanes = settings_.lanes;
    o.mixed = mixed;
    o.path = path;
    o.suspend = settings_.suspend && i.program->kind() == rsl::ShaderKind::Surface;
    o.outputs = outputs;
    for (const auto& [k, v] : i.parameters.strings) o.stringParameters.push_back({k, v});
    o.coShaders = i.coShaders;
    o.varyingParameters = varying;
    if (i.program->kind() == rsl::ShaderKind::Surface || i.program->kind() == rsl::ShaderKind::Volume) o.messages = lightMessages_;
    double begin = seconds();
    auto k = compiler_->kernel(i.program, o, d);
    facts_.compileSec += seconds() - begin;
    if (!k) return {};
    ++facts_.kernels;
    facts_.cacheHits += k->fromCache();
    (k->facts().suspends ? facts_.suspending : facts_.affine)++;
    return bindKernel(std::move(k), mixed, path, this);
}

std::shared_ptr<const World> World::build(std::shared_ptr<const scene::Frame> frame, const Settings& settings, Diagnostics& d) {
    double begin = seconds();
    auto w = std::make_shared<WorldImpl>();
    w->frame_ = frame;
    w->settings_ = settings;
    w->diagnostics_ = &d;
    const scene::Options& o = frame->options;
    bool path = settings.hider == Hider::Path;
    w->worldToCamera_ = o.worldToCamera.first();
    w->cameraToWorld_ = inverse(w->worldToCamera_);
    double sw[4];
    screenWindow(o, sw);
    double near = o.clipNear, far = std::min(double(o.clipFar), 1e30);
    if (o.projection == "perspective") {
        double k = 1 / std::tan(o.fov * kPi / 360);
        Matrix m;
        m.m[0][0] = m.m[1][1] = k;
        m.m[2][2] = far / (far - near);
        m.m[2][3] = 1;
        m.m[3][2] = -far * near / (far - near);
        m.m[3][3] = 0;
        w->cameraToScreen_ = m;
    } else {
        w->cameraToScreen_ = translateMatrix(0, 0, -near) * scaleMatrix(1, 1, 1 / (far - near));
    }
    w->screenToNdc_ = translateMatrix(-sw[0], -sw[3], 0) * scaleMatrix(1 / (sw[1] - sw[0]), -1 / (sw[3] - sw[2]), 1);
    w->ndcToRaster_ = scaleMatrix(o.xres, o.yres, 1);
    w->maxDepth_ = path ? 32 : 4;
    if (auto i = o.values.find("trace:maxdepth"); i != o.values.end() && !i->second.numbers.empty())
        w->maxDepth_ = int(std::clamp(double(i->second.numbers[0]), -1.0, double(limits::kPathDepth))); // what no int holds, too
    if (settings.maxDepth >= 0) w->maxDepth_ = settings.maxDepth;
    w->maxDepth_ = std::min(w->maxDepth_, limits::kPathDepth);
    w->textures_ = std::make_unique<texture::TextureSystem>(d);
    rsl::ShaderCompiler::Settings cs;
    cs.cacheDirectory = settings.cacheDirectory;
    cs.dialect = settings.dialect;
    cs.allowExec = settings.allowExec;
    cs.pluginPaths = settings.pluginPaths;
    w->compiler_ = std::make_shared<rsl::ShaderCompiler>(cs);
    if (const char* e = std::getenv("ALPENGLOW_SHADERS"))
        for (auto& path : splitSearchPath(e)) w->settings_.shaderPaths.push_back(path);
    w->settings_.shaderPaths.push_back(shippedShaders());
    for (const std::string& name : settings.outputs) {
        bool scalar = name == "z" || name == "u" || name == "v" || name == "s" || name == "t" || name == "alpha" || name == "du" || name == "dv" || name == "time";
        w->outputWidths_.push_back(scalar ? 1 : 3);
    }

    w->shapes_ = geometry::buildShapes(*frame, d);

    w->clippingPlanes_ = o.clippingPlanes;
    w->bindLights(d, [path](const geometry::Shape& s) { return visibilityOf(s.attributes(), path); });

    // Surfaces: what may be shaded together shares a binding.
    std::map<std::pair<const scene::ShaderCall*, int>, InstanceRef> instances;
    auto instanceOf = [&](const scene::ShaderRef& r, rsl::ShaderKind kind) -> InstanceRef {
        if (!r) return nullptr;
        auto [i, fresh] = instances.try_emplace({r.get(), int(kind)});
        if (fresh && !(r->name == "null" && kind != rsl::ShaderKind::Surface)) i->second = w->instance(*r, kind, d);
        return i->second;
    };
    // What a surface and its co-shaders ask about the primitive, with the type that the first of them wants.
    const auto asked = [](const ShaderInstance& i) {
        std::map<std::string, rsl::Type> all = i.program->program().primitiveVariables;
        for (const rsl::CoShader& c : i.coShaders) all.insert(c.program->primitiveVariables.begin(), c.program->primitiveVariables.end());
        return all;
    };
    const auto bindCoShaders = [&](const InstanceRef& i, const scene::Attributes& a) { return w->withCoShaders(i, a, d); };
    InstanceRef fallback = w->builtin(path ? "matte" : "defaultsurface", rsl::ShaderKind::Surface, d);
    if (!fallback) {
        d.report(Severity::Severe, Rie::NoShader, {}, "the shaders that ship with the program were not found",
                 "set ALPENGLOW_SHADERS to the folder that holds matte.sl");
        return nullptr;
    }
    std::map<std::string, int> bindingByKey;
    std::map<const void*, int> programs;
    std::map<std::vector<int>, int> lightLists;
    std::map<std::pair<int, int>, int> groups;
    std::vector<uint32_t> visibility;
    Engine engine(std::shared_ptr<const WorldImpl>(std::shared_ptr<const WorldImpl>{}, w.get()), d); // runs kernels while the world is made
    for (const auto& shape : w->shapes_) {
        const scene::Attributes& a = shape->attributes();
        visibility.push_back(visibilityOf(a, path));
        InstanceRef surface = bindCoShaders(instanceOf(a.surface, rsl::ShaderKind::Surface), a);
        bool explicitSurface = surface != nullptr;
        if (!surface) surface = fallback;
        std::vector<std::string> varying;
        for (const auto& v : shape->primvars())
            for (const auto& p : surface->program->parameters())
                if (p.name == v.name && p.type.base != rsl::Base::String) varying.push_back(p.name);
        for (const auto& [name, type] : asked(*surface)) { // getvar(null, name, ...)
            const int v = shape->findPrimvar(name);
            const int width = type.base == rsl::Base::Void ? 0 : rsl::componentCount(type.base) * std::max(1, type.array);
            if (v >= 0 && (width == 0 || width == shape->primvars()[size_t(v)].outWidth()) &&
                std::find(varying.begin(), varying.end(), name) == varying.end())
                varying.push_back(name);
        }
        std::sort(varying.begin(), varying.end());
        std::string key;
        auto add = [&](auto v) { key.append(reinterpret_cast<const char*>(&v), sizeof v); };
        add(surface.get());
        add(a.displacement.get());
        add(a.atmosphere.get());
        for (const auto& [handle, call] : a.coshaders) add(call.get());
        for (int l : a.lights) add(l);
        add(-1);
        add(a.areaLight);
        add(a.opacity.x); add(a.opacity.y); add(a.opacity.z);
        add(a.matte);
        add(a.shadingRate);
        add(attributeNumber(a, "trace:maxdiffusedepth", -1));
        add(attributeNumber(a, "trace:maxspeculardepth", -1));
        for (const auto& v : varying) key += v + ";";
        bool ownOpacity = shape->findPrimvar("Os") >= 0;
        key += ownOpacity ? "Os;" : "";
        for (const char* name : {"shade:transmissionhitmode", "visibility:transmission"})
            if (const scene::Param* p = a.value(name); p && !p->strings.empty()) key += p->strings[0] + ";";
        auto [it, fresh] = bindingByKey.try_emplace(key, int(w->bindings_.size()));
        if (fresh) {
            SurfaceBinding b;
            b.surface = surface;
            b.explicitSurface = explicitSurface;
            b.displacement = bindCoShaders(instanceOf(a.displacement, rsl::ShaderKind::Displacement), a);
            // A class with surface and displacement is both.
            if (!a.displacement && explicitSurface && rsl::ShaderCompiler::variant(surface->program, rsl::ShaderKind::Displacement))
                b.displacement = bindCoShaders(instanceOf(a.surface, rsl::ShaderKind::Displacement), a);
            b.atmosphere = bindCoShaders(instanceOf(a.atmosphere, rsl::ShaderKind::Volume), a);
            b.interior = instanceOf(a.interior, rsl::ShaderKind::Volume);
            b.exterior = instanceOf(a.exterior, rsl::ShaderKind::Volume);
            std::vector<std::string> outputs{"Ci", "Oi"};
            for (const auto& n : settings.outputs) {
                bool known = n == "P" || n == "N" || n == "Cs" || n == "Os" || n == "u" || n == "v" || n == "s" || n == "t" || n == "Ng" || n == "I" || n == "dPdu" || n == "dPdv";
                for (const auto& p : surface->program->parameters()) known |= p.name == n && p.output;
                known |= surface->program->program().channels.count(n) > 0;
                for (const rsl::CoShader& co : surface->coShaders) known |= co.program->channels.count(n) > 0;
                if (known && n != "Ci" && n != "Oi") outputs.push_back(n);
            }
            if (path) // lighting shadeops: lights run when the surface's kernel is done
                for (const auto& p : surface->program->parameters())
                    if (p.output && p.type.base != rsl::Base::String && p.type.array == 0 &&
                        std::binary_search(w->lightMessages_.begin(), w->lightMessages_.end(), p.name))
                        outputs.push_back("param:" + p.name);
            b.surfaceS = w->kernel(*surface, outputs, varying, false, path, d);
            if (!b.surfaceS) { // an error was reported: the default surface stands in
                b.surface = surface = fallback;
                b.surfaceS = w->kernel(*fallback, {}, {}, false, path, d);
                varying.clear();
                outputs.clear();
            }
            b.surfaceV = w->kernel(*surface, outputs, varying, true, path, d);
            if (settings.mixedOnly) b.surfaceS = b.surfaceV;
            if (!b.surfaceS || !b.surfaceV) return nullptr;
            if (b.atmosphere) {
                b.atmosphereS = w->kernel(*b.atmosphere, {"Ci", "Oi", "slope:Ci"}, {}, false, false, d);
                if (!b.atmosphereS) b.atmosphere = nullptr;
                else if (b.atmosphereS.kernel->facts().suspends) {
                    d.reportOnce("atmosphere:" + b.atmosphere->name, {Severity::Warning, Rie::Unimplement, b.atmosphere->place,
                                 "volume shader \"" + b.atmosphere->name + "\" waits for rays (" + b.atmosphereS.kernel->facts().whyNot + "); it is left out", {}, {}});
                    b.atmosphere = nullptr;
                } else if (b.atmosphereS.plan->output("slope:Ci") < 0)
                    d.reportOnce("atmosphere:" + b.atmosphere->name, {Severity::Info, Rie::NoError, b.atmosphere->place,
                                 "volume shader \"" + b.atmosphere->name + "\" is not affine in Ci as written; what light loses in it is measured between Ci = 0 and 1", {}, {}});
            }
            if (b.displacement) {
                // The derivatives are for the surface shader: bumps on top of the displacement.
                b.displacementS = w->kernel(*b.displacement, {"P", "N", "Du:P", "Dv:P", "Du:N", "Dv:N"}, {}, false, false, d);
                if (!b.displacementS) b.displacement = nullptr;
            }
            for (const auto& in : b.surfaceS.kernel->inputs()) b.usesObjectSpace |= in.name.find("object") != std::string::npos && in.name.rfind("space:", 0) == 0;
            b.lights = w->withParts(a.lights);
            b.lightList = lightLists.try_emplace(b.lights, int(lightLists.size())).first->second;
            if (size_t(b.lightList) == w->sampledLights_.size()) {
                auto& sampled = w->sampledLights_.emplace_back();
                for (int l : b.lights) {
                    const BoundLight& light = w->lights_[size_t(l)];
                    bool point = light.kind == LightKind::Point || light.kind == LightKind::Distant;
                    if (light.kernel && (point || (light.kind == LightKind::Area && !light.emitter->empty()))) sampled.push_back(l);
                }
                std::sort(sampled.begin(), sampled.end());
                sampled.erase(std::unique(sampled.begin(), sampled.end()), sampled.end());
            }
            b.areaLight = a.areaLight;
            b.matte = a.matte;
            b.shadingRate = a.shadingRate;
            b.maxDiffuse = int(attributeNumber(a, "trace:maxdiffusedepth", path ? -1 : 1));
            b.maxSpecular = int(attributeNumber(a, "trace:maxspeculardepth", path ? -1 : 2));
            b.attributes = shape->attributesRef();
            // Displaced shapes and different kernels never share a batch.
            b.program = programs.try_emplace(b.displacement ? static_cast<const void*>(b.displacement.get()) : b.surfaceV.kernel.get(), int(programs.size())).first->second;
            auto [group, firstOfGroup] = groups.try_emplace({b.program, b.lightList}, w->groups_);
            w->groups_ += firstOfGroup;
            b.group = group->second;
            w->bindOpacity(b, *shape, varying, engine, d);
            w->allOpaque_ &= !b.opacityKernel && b.shadowOpacity == Color(1);
            w->bindings_.push_back(std::move(b));
        }
        w->bindingOf_.push_back(it->second);
        if (path && w->bindings_[size_t(it->second)].atmosphere && a.areaLight >= 0) w->hazyEmitters_[shape.get()] = it->second;
    }

    // Dicing, with displacement by the same kernels that shade.
    geometry::DiceOptions dice;
    dice.camera = geometry::DiceCamera::from(o);
    std::map<const geometry::Shape*, int> bindingOfShape;
    for (size_t i = 0; i < w->shapes_.size(); ++i) bindingOfShape[w->shapes_[i].get()] = w->bindingOf_[i];
    WorldImpl* raw = w.get();
    dice.displace = [raw, &bindingOfShape, &d](const geometry::Shape& shape, geometry::DiceGrid& grid) {
        const SurfaceBinding& b = raw->bindings_[size_t(bindingOfShape.at(&shape))];
        if (!b.displacement || b.displacementS.kernel->facts().suspends) return;
        Engine engine(std::shared_ptr<const WorldImpl>(std::shared_ptr<const WorldImpl>{}, raw), d);
        BatchContext c;
        c.engine = &engine;
        c.bound = &b.displacementS;
        c.binding = &b;
        for (size_t i = 0; i < grid.points.size(); ++i) {
            ShadePoint p;
            p.shape = &shape;
            p.surface = grid.points[i];
            p.P = p.surface.P;
            p.N = p.surface.N;
            p.I = p.P;
            p.du = grid.du[i];
            p.dv = grid.dv[i];
            c.points.push_back(p);
        }
        std::vector<shading::InstanceView> views(c.points.size(), {&b.displacement->parameters, &b.displacement->toCurrent});
        c.batch = std::make_shared<shading::Batch>(b.displacementS.kernel, *b.displacementS.plan, c.points, views, *raw);
        engine.bindCall(c.batch->call(), c);
        b.displacementS.kernel->run(&c.batch->call());
        int out = c.batch->output("P");
        for (size_t i = 0; out >= 0 && i < grid.P.size(); ++i) grid.P[i] = c.batch->color(out, int(i));
    };
    dice.declaredBound = [raw, &bindingOfShape](const geometry::Shape& shape) {
        geometry::DiceOptions::DeclaredBound bound;
        const SurfaceBinding& b = raw->bindings_[size_t(bindingOfShape.at(&shape))];
        const InstanceRef both[] = {b.displacement, b.surface == b.displacement ? nullptr : b.surface};
        for (const InstanceRef& i : both) {
            if (!i || !b.displacement || (i == b.surface && !shape.attributes().displacement)) continue; // one class is both
            const auto number = i->parameters.numbers.find("__displacementbound_sphere");
            if (number == i->parameters.numbers.end() || number->second.empty()) continue;
            bound.radius += std::max(0.0, double(number->second[0]));
            const auto space = i->parameters.strings.find("__displacementbound_coordinatesystem");
            if (bound.space.empty() && space != i->parameters.strings.end()) bound.space = space->second;
        }
        return bound;
    };
    geometry::diceShapes(w->shapes_, dice, d);
    w->accel_ = std::make_unique<accel::Accel>(w->shapes_, visibility, d);
    w->bindSentStrings(d);
    w->measureLights(engine, d);
    for (const auto& [shape, binding] : w->hazyEmitters_) {
        w->lights_[size_t(shape->attributes().areaLight)].hazy = true;
        for (int part : w->lights_[size_t(shape->attributes().areaLight)].parts) w->lights_[size_t(part)].hazy = true;
    }
    w->facts_.shapes = w->shapes_.size();
    w->facts_.buildSec = seconds() - begin - w->facts_.compileSec;
    return w;
}

void WorldImpl::bindOpacity(SurfaceBinding& b, const geometry::Shape& shape, const std::vector<std::string>& varying, Engine& engine, Diagnostics& d) {
    const scene::Attributes& a = shape.attributes();
    std::string mode = "shader";
    for (const char* name : {"render:casts_shadows", "shade:transmissionhitmode", "visibility:transmission"}) // BMRT's, PRMan's, the older ones
        if (const scene::Param* p = a.value(name); p && !p->strings.empty()) mode = p->strings[0];
    std::string what = b.surfaceS.kernel->facts().opacity;
    bool varies = shape.findPrimvar("Os") >= 0;
    b.shadowOpacity = mode == "opaque" ? Color(1) : a.opacity;
    if (mode == "opaque" || mode == "primitive" || (mode == "Os" && !varies) || (what == "Os" && !varies)) return;
    if (what == "1") {
        b.shadowOpacity = Color(1);
        return;
    }
    BoundKernel k = kernel(*b.surface, {"Oi"}, varying, false, false, d);
    if (!k || k.plan->Oi < 0) return;
    if (k.kernel->facts().suspends) {
        d.reportOnce("opacity:" + b.surface->name, {Severity::Warning, Rie::NoError, b.surface->place,
                     "the opacity of shader \"" + b.surface->name + "\" depends on traced rays; its shadow has the primitive's Opacity", {}, {}});
        return;
    }
    bool constant = !varies && k.kernel->sites().empty();
    for (const auto& in : k.kernel->inputs()) {
        bool parameter = in.name.rfind("param:", 0) == 0 && std::find(varying.begin(), varying.end(), in.name.substr(6)) == varying.end();
        constant &= parameter || in.name == "Os" || (in.name == "Cs" && shape.findPrimvar("Cs") < 0);
    }
    if (!constant) {
        b.opacityKernel = std::move(k);
        return;
    }
    std::vector<ShadePoint> point(1);
    point[0].shape = &shape;
    shading::InstanceView view{&b.surface->parameters, &b.surface->toCurrent};
    BatchContext c;
    c.engine = &engine;
    c.bound = &k;
    c.points.swap(point);
    c.batch = std::make_shared<shading::Batch>(k.kernel, *k.plan, c.points, std::span(&view, 1), *this);
    engine.bindCall(c.batch->call(), c);
    k.kernel->run(&c.batch->call());
    Color o = c.batch->color(k.plan->Oi, 0);
    for (int i = 0; i < 3; ++i) b.shadowOpacity[i] = std::isfinite(o[i]) ? std::clamp(o[i], 0.f, 1.f) : 1;
}

bool WorldImpl::runImager(int count, const float* x, const float* y, float* r, float* g, float* b, float* alpha, Diagnostics& d) const {
    const scene::ShaderRef& imager = frame_->options.imager;
    if (!imager) return false;
    std::lock_guard lock(imagerMutex_);
    auto* self = const_cast<WorldImpl*>(this); // compiles on first use, under the lock
    InstanceRef i = self->instance(*imager, rsl::ShaderKind::Imager, d);
    if (!i) return false;
    BoundKernel k = self->kernel(*i, {}, {}, false, false, d);
    if (!k || k.kernel->facts().suspends) return false;
    Engine engine(std::shared_ptr<const WorldImpl>(std::shared_ptr<const WorldImpl>{}, this), d);
    constexpr int kChunk = 4096;
    for (int begin = 0; begin < count; begin += kChunk) {
        int n = std::min(kChunk, count - begin);
        BatchContext c;
        c.engine = &engine;
        c.bound = &k;
        c.points.resize(size_t(n));
        for (int p = 0; p < n; ++p) {
            ShadePoint& s = c.points[size_t(p)];
            int at = begin + p;
            s.P = {x[at], y[at], 0};
            s.surface.u = s.surface.s = x[at] / float(std::max(1, frame_->options.xres)); // not in RISpec; imagers of Aqsis have them
            s.surface.v = s.surface.t = y[at] / float(std::max(1, frame_->options.yres));
            s.Ci = {r[at], g[at], b[at]};
            s.Oi = Color(alpha[at]);
            s.alpha = alpha[at];
        }
        std::vector<shading::InstanceView> views(size_t(n), {&i->parameters, &i->toCurrent});
        c.batch = std::make_shared<shading::Batch>(k.kernel, *k.plan, c.points, views, *this);
        engine.bindCall(c.batch->call(), c);
        k.kernel->run(&c.batch->call());
        int ci = c.batch->output("Ci"), ai = c.batch->output("alpha");
        for (int p = 0; p < n; ++p) {
            int at = begin + p;
            if (ci >= 0) {
                Color v = c.batch->color(ci, p);
                r[at] = v.x; g[at] = v.y; b[at] = v.z;
            }
            if (ai >= 0) alpha[at] = c.batch->value(ai, 0, p);
        }
    }
    return true;
}

} // namespace alpenglow::transport
