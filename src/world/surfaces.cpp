#include "world/surfaces.h"
#include "rsl/front/leftmembers.h"
#include "scene/shadingrate.h"
#include "shading/faceindex.h"
#include "world/gathersite.h"
#include "world/photonattributes.h"
#include "world/service.h"
#include "world/shadervalue.h"
#include <set>

namespace alpenglow::world {

using rsl::OutputName;

float attributeNumber(const scene::Attributes& a, const std::string& key, float fallback) {
    const scene::Param* p = a.value(key);
    return p && !p->numbers.empty() ? p->numbers[0] : fallback;
}

InstanceRef SurfaceBinder::instanceOf(const scene::ShaderRef& r, rsl::ShaderKind kind, bool differences) {
    if (!r) return nullptr;
    auto [i, fresh] = instances_.try_emplace({r.get(), int(kind), differences});
    if (!fresh) return i->second;
    if (differences) {
        if (const InstanceRef exact = instanceOf(r, kind)) {
            auto same = std::make_shared<ShaderInstance>(*exact);
            same->differences = true;
            i->second = same;
        }
    } else if (!(r->name == "null" && kind != rsl::ShaderKind::Surface)) {
        i->second = world_.instance(*r, kind, diagnostics_);
    }
    return i->second;
}

/// Under path: warns once per shader if it uses the result of a light call so that indirect light cannot be followed.
static void sayDirectOnly(const ShaderInstance& shader, const rsl::CompiledKernel& kernel, Diagnostics& d) {
    const auto& direct = kernel.facts().direct;
    if (direct.empty()) return;
    SourcePlace place{shader.program->path(), 0, 0};
    const auto& [op, why, at] = direct[0];
    const auto& files = kernel.files();
    if (at.line > 0 && at.file >= 0 && size_t(at.file) < files.size() && !files[size_t(at.file)].starts_with('<'))
        place = {files[size_t(at.file)], at.line, at.column};
    const size_t more = direct.size() - 1;
    d.reportOnce("directonly:" + shader.program->path() + ":" + shader.program->name(),
                 {Severity::Warning,
                  Rie::Incapable,
                  place,
                  "shader \"" + shader.program->name() + "\" under path: " + op + "() brings direct light only" +
                      (more ? ", and so do " + std::to_string(more) + " further calls" : "") +
                      ", for it is used non-linearly: " + why,
                  "use its light in sums and products only, as in Ci = a + b * " + op +
                      "(...), where a and b do not depend on light; "
                      "`compile -W --path` shows all such places",
                  {}});
}

/// Whether a primitive variable can replace a parameter: one string, as many numbers, or elements of the same kind.
static bool overrides(const geometry::PrimVar& v, const rsl::ParameterInfo& p) {
    if (p.type.base == shadeops::Base::String || v.type == scene::Type::String)
        return p.type.base == shadeops::Base::String && v.type == scene::Type::String && !p.type.array && !p.open &&
               !v.arrayLength;
    const int each = shadeops::componentCount(p.type.base);
    return p.open ? v.arrayLength > 0 && v.outWidth() == each * v.elements() : v.outWidth() == each * std::max(1, p.type.array);
}

SurfaceBinder::Names SurfaceBinder::varyingOf(const geometry::Shape& shape, const ShaderInstance& shader) {
    Names varying;
    for (const auto& v : shape.primvars())
        for (const auto& p : shader.program->parameters()) {
            if (p.name != v.name) continue;
            if (overrides(v, p)) varying.push_back(p.name);
            else
                diagnostics_.reportOnce("override:" + shader.name + ":" + p.name,
                                        {Severity::Warning,
                                         Rie::Consistency,
                                         v.param->place,
                                         "the variable \"" + p.name +
                                             "\" of the primitive does not fit the parameter of shader \"" + shader.name +
                                             "\", which is a " + shadeops::toString(p.type) + ": the parameter is not changed",
                                         {},
                                         {}});
        }
    // The face number, if the primitive has no such variable.
    if (shape.findPrimvar(shading::kFaceIndex) < 0)
        for (const auto& p : shader.program->parameters())
            if (p.name == shading::kFaceIndex && p.type.base == shadeops::Base::Float && !p.type.array) varying.push_back(p.name);
    // Queries of a shader and its co-shaders about the primitive, with the type that the first of them uses.
    std::map<std::string, shadeops::Type> all = shader.program->program().primitiveVariables;
    for (const rsl::CoShader& c : shader.coShaders)
        all.insert(c.program->primitiveVariables.begin(), c.program->primitiveVariables.end());
    for (const auto& [name, type] : all) {
        const int v = shape.findPrimvar(name);
        const int width = type.base == shadeops::Base::Void ? 0 : shadeops::componentCount(type.base) * std::max(1, type.array);
        const bool text = v >= 0 && shape.primvars()[size_t(v)].type == scene::Type::String;
        if (v >= 0 &&
            (width == 0 || (width == shape.primvars()[size_t(v)].outWidth() && text == (type.base == shadeops::Base::String))) &&
            std::find(varying.begin(), varying.end(), name) == varying.end())
            varying.push_back(name);
    }
    std::sort(varying.begin(), varying.end());
    return varying;
}

bool SurfaceBinder::bindAll() {
    path_ = world_.settings_.hider == Hider::Path;
    fallback_ = world_.builtin(path_ && !needsHeadlight() ? "matte" : "defaultsurface", rsl::ShaderKind::Surface, diagnostics_);
    if (!fallback_) {
        diagnostics_.report(Severity::Severe, Rie::NoShader, {}, "the shaders that ship with the program were not found",
                            "set ALPENGLOW_SHADERS to the folder that holds matte.sl");
        return false;
    }
    findGathers();
    for (const auto& shape : world_.shapes_) {
        const int b = bind(shape);
        if (b < 0) return false;
        world_.bindingOf_.push_back(b);
        if (path_ && world_.bindings_[size_t(b)].atmosphere.shader && shape->attributes().areaLight >= 0)
            world_.emittersInAtmosphere_[shape.get()] = b;
    }
    return bindMixed() && bindEntering() && bindHitModes();
}

bool SurfaceBinder::bindHitModes() {
    if (!world_.needs_.hitModes) return true;
    const InstanceRef plain = world_.builtin("constant", rsl::ShaderKind::Surface, diagnostics_);
    if (plain) world_.primitiveHit_ = world_.kernel(*plain, {"Ci", "Oi"}, {}, true, path_, diagnostics_);
    if (!world_.primitiveHit_) return false;
    for (size_t i = 0; i < world_.bindings_.size(); ++i) {
        SurfaceBinding& b = world_.bindings_[i];
        b.shaderOpacity = world_.opacityOf(b, *asked_[i].shape, "shader", asked_[i].varying, evaluator_, diagnostics_);
        b.primitiveOpacity.constant = b.attributes->opacity;
        if (asked_[i].shape->findPrimvar("Os") >= 0)
            b.primitiveOpacity.kernel = world_.kernel(*plain, {"Oi"}, {}, false, false, diagnostics_);
        world_.allOpaque_ &= b.shaderOpacity.opaque() && b.primitiveOpacity.opaque();
    }
    return true;
}

/// Whether two shapes have variables of the same names and types, so that equal attributes mean equal bindings. Interiors also
/// take values of variables.
static bool sameVariables(const geometry::Shape& a, const geometry::Shape& b) {
    const auto &p = a.primvars(), &q = b.primvars();
    if (!p.empty() && (a.attributes().interior || a.attributes().exterior)) return false;
    return std::equal(p.begin(), p.end(), q.begin(), q.end(), [](const geometry::PrimVar& x, const geometry::PrimVar& y) {
        return x.name == y.name && x.cls == y.cls && x.type == y.type && x.arrayLength == y.arrayLength;
    });
}

int SurfaceBinder::bind(const geometry::ShapeRef& shape) {
    auto& [like, known] = bindingOfAttributes_[&shape->attributes()];
    if (like && sameVariables(*like, *shape)) return known;
    const int b = bindAnew(shape);
    if (b >= 0) bindingOfAttributes_[&shape->attributes()] = {shape, b};
    return b;
}

/// Key of a binding.
std::string SurfaceBinder::keyOf(const SurfaceBinding& b, const geometry::Shape& shape, bool grid,
                                 std::initializer_list<const Names*> varying) {
    const scene::Attributes& a = shape.attributes();
    std::string key;
    auto add = [&](auto v) { key.append(reinterpret_cast<const char*>(&v), sizeof v); };
    add(b.surface.get());
    add(a.displacement.get());
    add(grid);
    add(a.atmosphere.get());
    add(b.interior.get());
    add(b.exterior.get());
    for (const auto& [handle, call] : a.coshaders) add(call.get());
    for (const auto& [first, last] : a.lights.runs()) add(first), add(last);
    add(-1);
    add(a.areaLight);
    for (const float o : {a.opacity.x, a.opacity.y, a.opacity.z}) add(o);
    add(a.matte);
    add(scene::shadedArea(a));
    add(attributeNumber(a, "trace:maxdiffusedepth", -1));
    add(attributeNumber(a, "trace:maxspeculardepth", -1));
    add(attributeNumber(a, "trace:bias", 0));
    for (const Names* names : varying) {
        for (const auto& v : *names) key += v + ";";
        key += "|";
    }
    key += shape.findPrimvar("Os") >= 0 ? "Os;" : "";
    for (const char* name : {"shade:transmissionhitmode", "visibility:transmission", "shade:diffusehitmode",
                             "shade:specularhitmode", "render:casts_shadows"})
        if (const scene::Param* p = a.value(name); p && !p->strings.empty()) key += name + p->strings[0] + ";";
    return key + photonKey(a);
}

int SurfaceBinder::bindAnew(const geometry::ShapeRef& shape) {
    const scene::Attributes& a = shape->attributes();
    SurfaceBinding b;
    const bool grid = differences(*shape, !path_), diced = differences(*shape, true);
    b.surface = world_.withCoShaders(instanceOf(a.surface, rsl::ShaderKind::Surface, grid), a.coshaders, diagnostics_, a.lights);
    b.explicitSurface = b.surface != nullptr;
    if (!b.surface) b.surface = fallback_;
    b.displacement =
        world_.withCoShaders(instanceOf(a.displacement, rsl::ShaderKind::Displacement, diced), a.coshaders, diagnostics_);
    // A class with surface and displacement is both.
    const bool both =
        !a.displacement && b.explicitSurface && rsl::ShaderCompiler::variant(b.surface->program, rsl::ShaderKind::Displacement);
    if (both)
        b.displacement =
            quiet(world_.withCoShaders(instanceOf(a.surface, rsl::ShaderKind::Displacement, diced), a.coshaders, diagnostics_));
    b.atmosphere.shader = world_.withCoShaders(instanceOf(a.atmosphere, rsl::ShaderKind::Volume), a.coshaders, diagnostics_);
    const Names varying = receive(*shape, b.surface, rsl::PairName::To::Surface);
    const Names displacementVarying = receive(*shape, b.displacement, rsl::PairName::To::Displacement);
    const Names atmosphereVarying = receive(*shape, b.atmosphere.shader, rsl::PairName::To::Volume);
    b.interior = volumeOf(a.interior, *shape);
    b.exterior = volumeOf(a.exterior, *shape);
    const std::string key = keyOf(b, *shape, grid, {&varying, &displacementVarying, &atmosphereVarying});
    auto [it, fresh] = bindingByKey_.try_emplace(key, int(world_.bindings_.size()));
    if (!fresh) return it->second;

    b.inside = mediumOf(b.interior, *shape);
    b.outside = mediumOf(b.exterior, *shape);
    if (b.inside >= 0) b.insidePriority = world_.media_[size_t(b.inside)].priority;
    if (b.outside >= 0) b.outsidePriority = world_.media_[size_t(b.outside)].priority;
    // Order by queries: the atmosphere queries the surface, both query the displacement.
    const Names left = both ? leftBy(b) : Names{};
    bindDisplacement(b, displacementVarying, left);
    if (!left.empty()) hearMembers(b);
    bindAtmosphere(b, atmosphereVarying);
    if (!bindSurface(b, varying)) return -1;
    hearDisplacement(b, varying, displacementVarying, left);
    if (!b.displacement) b.moveS = world_.movingKernel(*b.surface, b.surfaceS, a.lights, asked_.back().varying, diagnostics_);
    bindLights(b, a);
    // A light without a kernel (missing shader, or not a light) was reported; its geometry is an ordinary surface.
    b.areaLight = a.areaLight >= 0 && world_.lights_[size_t(a.areaLight)].kernel ? a.areaLight : -1;
    b.matte = a.matte;
    b.shadingRate = scene::shadedArea(a);
    b.maxDiffuse = int(attributeNumber(a, "trace:maxdiffusedepth", path_ ? -1 : 1));
    b.maxSpecular = int(attributeNumber(a, "trace:maxspeculardepth", path_ ? -1 : 2));
    b.bias = std::max(0.f, attributeNumber(a, "trace:bias", 0));
    for (const auto& [name, bit] :
         {std::pair{"shade:diffusehitmode", uint32_t(accel::kDiffuse)}, {"shade:specularhitmode", uint32_t(accel::kSpecular)}})
        if (const scene::Param* p = a.value(name); p && !p->strings.empty() && p->strings[0] == "primitive")
            b.primitiveFor |= bit;
    world_.needs_.hitModes |= b.primitiveFor != 0;
    b.attributes = shape->attributesRef();
    b.photons = photonsOf(a, diagnostics_);
    // Displaced shapes and different kernels never share a batch. Equal S builds imply equal V builds.
    b.program =
        programs_
            .try_emplace({b.surfaceS.kernel.get(), b.displacement.get(), b.displacementS.kernel.get()}, int(programs_.size()))
            .first->second;
    auto [group, firstOfGroup] = groups_.try_emplace({b.program, b.lightList}, world_.groups_);
    world_.groups_ += firstOfGroup;
    b.group = group->second;
    b.opacity = world_.opacityOf(b, *shape, "", asked_.back().varying, evaluator_, diagnostics_);
    world_.allOpaque_ &= b.opacity.opaque();
    b.vanishes = vanishes(b);
    asked_.back().shape = shape;
    world_.bindings_.push_back(std::move(b));
    return it->second;
}

SurfaceBinder::Names SurfaceBinder::outputsOf(const SurfaceBinding& b) const {
    static const char* const kVariables[] = {"P", "N", "Cs", "Os", "u", "v", "s", "t", "Ng", "I", "dPdu", "dPdv"};
    Names outputs{"Ci", "Oi"};
    for (const OutputName& n : world_.wanted_) {
        const auto is = [&](const char* variable) { return n == OutputName::of(variable); };
        if (!is("Ci") && !is("Oi") && (std::any_of(std::begin(kVariables), std::end(kVariables), is) || gives(*b.surface, n)))
            addOutput(*b.surface, n, outputs);
    }
    std::set<std::string> asked;
    if (path_)
        asked.insert(world_.lightMessages_.begin(),
                     world_.lightMessages_.end());                    // lighting shadeops run lights after the surface's kernel
    asked.insert(gathered_.surface.begin(), gathered_.surface.end()); // so do gather() statements
    const bool all = b.atmosphere.shader && questions(b.atmosphere.kernel, "surface", asked);
    for (const auto& p : b.surface->program->parameters())
        if (p.output && (all || asked.count(p.name))) outputs.push_back(OutputName::parameterOf(p.name).text());
    return outputs;
}

bool SurfaceBinder::questions(const BoundKernel& k, const char* op, std::set<std::string>& names) {
    bool any = false;
    for (const SiteInfo& s : k.sites) {
        if (s.site->op != op) continue;
        const std::string name = s.site->strings.empty() ? "" : s.site->strings[0];
        if (name.empty()) any = true; // computed at run time
        else names.insert(name);
    }
    return any;
}

InstanceRef SurfaceBinder::quiet(const InstanceRef& displacement) {
    if (!displacement) return nullptr;
    InstanceRef& known = quiet_[displacement.get()];
    if (!known) {
        auto same = std::make_shared<ShaderInstance>(*displacement);
        same->parameters.strings[rsl::kBeginQuiet] = "quiet";
        known = same;
        kept_.push_back(displacement);
    }
    return known;
}

SurfaceBinder::Names SurfaceBinder::leftBy(const SurfaceBinding& b) {
    Names outputs;
    if (!b.displacement) return outputs;
    for (const std::string& name : rsl::membersLeft(b.displacement->program->shader(), b.surface->program->shader())) {
        const auto add = [&](bool length, OutputName::What what) {
            outputs.push_back(OutputName::left(name, length, what).text());
        };
        add(false, OutputName::What::Value);
        const shadeops::Type type = rsl::ownMember(b.displacement->program->shader(), name)->type;
        if (type.array) add(true, OutputName::What::Value);
        else if (type.base != shadeops::Base::String && type.base != shadeops::Base::Matrix)
            add(false, OutputName::What::Du), add(false, OutputName::What::Dv);
    }
    return outputs;
}

void SurfaceBinder::hearMembers(SurfaceBinding& b) {
    if (!b.displacement) return;
    if (b.displacementS.kernel->facts().suspends) {
        diagnostics_.reportOnce("left:" + b.displacement->name,
                                {Severity::Warning,
                                 Rie::Unimplement,
                                 b.displacement->place,
                                 "displacement() of \"" + b.displacement->name + "\" waits for rays (" +
                                     b.displacementS.kernel->facts().whyNot +
                                     "): the surface does not see its changes of members",
                                 {},
                                 {}});
        return;
    }
    auto extended = std::make_shared<ShaderInstance>(*b.surface);
    std::map<std::string, rsl::QueriedMember> members;
    for (const auto& o : b.displacementS.kernel->outputs()) {
        const OutputName name = OutputName::parse(o.name);
        if (!name.member || name.what != OutputName::What::Value) continue;
        rsl::QueriedMember& what = members[name.name];
        what.length |= name.length;
        what.count = std::max(what.count, name.element + 1);
    }
    for (const auto& [name, what] : members) extended->parameters.strings[rsl::InputName::left(name).text()] = what.text();
    InstanceRef& known = extended_[{b.surface.get(), b.displacement.get()}];
    if (!known) kept_.push_back(b.surface), known = extended;
    b.surface = known;
    b.displacementQueried = true;
}

void SurfaceBinder::hearDisplacement(SurfaceBinding& b, const Names& varying, const Names& displacementVarying,
                                     const Names& left) {
    if (!b.displacement || b.displacementS.kernel->facts().suspends) return;
    std::set<std::string> asked;
    asked = world_.lightDisplacements_;
    asked.insert(gathered_.displacement.begin(), gathered_.displacement.end());
    bool all = asked.erase("") > 0;
    all |= questions(b.surfaceS, "displacement", asked);
    all |= b.atmosphere.shader && questions(b.atmosphere.kernel, "displacement", asked);
    Names outputs = left;
    auto extended = std::make_shared<ShaderInstance>(*b.surface);
    for (const auto& p : b.displacement->program->parameters()) {
        if (!p.output || (!all && !asked.count(p.name))) continue;
        const auto add = [&](OutputName::What what) { outputs.push_back(OutputName::parameterOf(p.name, -1, what).text()); };
        add(OutputName::What::Value);
        if (p.type.array == 0 && p.type.base != shadeops::Base::String && p.type.base != shadeops::Base::Matrix)
            add(OutputName::What::Du), add(OutputName::What::Dv);
        // Type of an element, array length, and whether it varies: the surface's kernel takes it as an input with derivatives.
        int length = p.type.array ? std::max(1, p.type.array) : 0;
        const auto& given = b.displacement->parameters.strings;
        if (const auto open = given.find(rsl::lengthParameter(p.name)); p.open && open != given.end())
            length = std::atoi(open->second.c_str());
        extended->parameters.strings[rsl::InputName::displacement(p.name).text()] =
            rsl::QueriedOutput{int(ShaderValue::kindOf(p.type.base)), length, p.storage == rsl::Storage::Varying}.text();
    }
    if (outputs.size() == left.size()) return;
    bindDisplacement(b, displacementVarying, outputs);
    b.displacementQueried = b.displacement != nullptr;
    if (!b.displacementQueried) return;
    InstanceRef& known = extended_[{b.surface.get(), b.displacement.get()}];
    if (!known) known = extended;
    b.surface = known;
    asked_.pop_back();
    bindSurface(b, varying);
}

/// Whether an input is a matrix that differs between primitives.
static bool isObjectSpace(const rsl::ir::Input& input) {
    const rsl::InputName n = rsl::InputName::parse(input.name);
    const auto has = [](const std::string& space) { return space.find("object") != std::string::npos; };
    return n.kind == rsl::InputName::Kind::Space && (has(n.from) || has(n.to));
}

bool SurfaceBinder::bindSurface(SurfaceBinding& b, Names varying) {
    Names outputs = outputsOf(b);
    partLightOutputs(b, outputs, varying);
    b.surfaceS = world_.kernel(*b.surface, outputs, varying, false, path_, diagnostics_);
    if (path_ && b.surfaceS) sayDirectOnly(*b.surface, *b.surfaceS.kernel, diagnostics_);
    if (!b.surfaceS) { // an error was reported: the default surface replaces it
        b.surface = fallback_;
        varying.clear();
        outputs.clear();
        b.lightOutputs.clear();
        b.inLightOutputs.clear();
        b.surfaceS = world_.kernel(*fallback_, outputs, varying, false, path_, diagnostics_);
    }
    if (!b.surfaceS) return false;
    std::vector<const BoundKernel*> kernels{&b.surfaceS};
    for (LightOutput& o : b.lightOutputs) {
        o.S = lightKernel(b, o, varying, false);
        if (o.S.bound) kernels.push_back(&o.S.bound);
    }
    for (const BoundKernel* k : kernels)
        for (const auto& in : k->kernel->inputs()) b.usesObjectSpace |= isObjectSpace(in);
    asked_.push_back({std::move(outputs), std::move(varying), {}});
    return true;
}

bool SurfaceBinder::bindMixed() {
    std::vector<int> sharing(size_t(world_.groups_), 0);
    for (const SurfaceBinding& b : world_.bindings_) ++sharing[size_t(b.group)];
    for (size_t i = 0; i < world_.bindings_.size(); ++i) {
        SurfaceBinding& b = world_.bindings_[i];
        const bool always = world_.settings_.mixedOnly;
        b.usesObjectSpace |= b.surface->moving != nullptr; // points at different times
        if (!always && !b.usesObjectSpace && sharing[size_t(b.group)] == 1) continue;
        b.surfaceV = world_.kernel(*b.surface, asked_[i].outputs, asked_[i].varying, true, path_, diagnostics_);
        if (!b.surfaceV) return false;
        for (LightOutput& o : b.lightOutputs) o.V = lightKernel(b, o, asked_[i].varying, true);
        if (always)
            for (LightOutput& o : b.lightOutputs) o.S = o.V;
        if (always) b.surfaceS = b.surfaceV;
    }
    return true;
}

void SurfaceBinder::bindDisplacement(SurfaceBinding& b, const Names& varying, const Names& more) {
    if (!b.displacement) return;
    // Derivatives are for bump mapping by the surface shader on top of the displacement.
    Names outputs{"P", "N"};
    for (const char* of : {"P", "N"}) outputs.insert(outputs.end(), {OutputName::du(of).text(), OutputName::dv(of).text()});
    outputs.insert(outputs.end(), more.begin(), more.end());
    b.displacementS = world_.kernel(*b.displacement, outputs, varying, false, false, diagnostics_);
    bool object = false;
    if (b.displacementS)
        for (const auto& in : b.displacementS.kernel->inputs()) object |= isObjectSpace(in);
    if (object)
        b.displacementS =
            world_.kernel(*b.displacement, outputs, varying, true, false, diagnostics_); // shapes of one batch have their own
    if (!b.displacementS) b.displacement = nullptr;
}

/// Whether a kernel may request light, or query lights.
static bool asksForLight(const BoundKernel& k) {
    return std::any_of(k.sites.begin(), k.sites.end(), [](const SiteInfo& s) {
        if (s.service) return !(s.service->traits & kAsksNoLight);
        return s.kind != SiteKind::Irradiance && s.kind != SiteKind::Printf && s.kind != SiteKind::Text;
    });
}

void SurfaceBinder::bindLights(SurfaceBinding& b, const scene::Attributes& a) {
    // Emitters whose shader requests no light need no list: each has attributes, and so lights, of its own.
    const bool asks = !a.coshaders.empty() || b.atmosphere.shader || b.inside >= 0 || b.outside >= 0 || b.moveS ||
                      !b.lightOutputs.empty() || asksForLight(b.surfaceS) || asksForLight(b.displacementS) ||
                      a.value("subsurface:groupname"); // subsurface walks from other shapes of the group exit here
    if (asks) b.lights = world_.withParts(a.lights);
    b.lightList = lightLists_.try_emplace(b.lights, int(lightLists_.size())).first->second;
    if (size_t(b.lightList) != world_.lightLists_.size()) return;
    WorldImpl::LightList& list = world_.lightLists_.emplace_back();
    list.lights = b.lights;
    list.ofAll = world_.listed_ + b.lights.size() > world_.settings_.listedLights;
    if (list.ofAll) {
        if (world_.allSampled_.empty())
            for (size_t l = 0; l < world_.lights_.size(); ++l)
                if (world_.getsSamples(world_.lights_[l])) world_.allSampled_.push_back(int(l));
        return;
    }
    for (int l : b.lights)
        if (world_.getsSamples(world_.lights_[size_t(l)])) list.sampled.push_back(l);
    world_.listed_ += list.sampled.size();
}

} // namespace alpenglow::world
