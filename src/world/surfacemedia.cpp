// Volume shaders of surfaces: atmospheres, interiors and exteriors, with overrides by primitive variables.
#include "world/shadervalue.h"
#include "world/surfaces.h"
#include <limits>

namespace alpenglow::world {

using rsl::OutputName;

void SurfaceBinder::bindAtmosphere(SurfaceBinding& b, const Names& varying) {
    b.atmosphere = bindVolume(b.atmosphere.shader, varying);
}

Medium SurfaceBinder::bindVolume(const InstanceRef& shader, const Names& varying) {
    if (!shader) return {};
    Names outputs{"Ci", "Oi", OutputName::slope("Ci").text()};
    for (const OutputName& n : world_.wanted_)
        if (n != OutputName::of("Ci") && n != OutputName::of("Oi") && gives(*shader, n)) addOutput(*shader, n, outputs);
    Medium m;
    m.kernel = world_.kernel(*shader, outputs, varying, false, false, diagnostics_);
    if (!m.kernel) return {};
    const std::string name = "\"" + shader->name + "\"";
    if (m.kernel.kernel->facts().suspends) {
        diagnostics_.reportOnce("atmosphere:" + shader->name, {Severity::Warning,
                                                               Rie::Unimplement,
                                                               shader->place,
                                                               "volume shader " + name + " waits for rays (" +
                                                                   m.kernel.kernel->facts().whyNot + "); it is left out",
                                                               {},
                                                               {}});
        return {};
    }
    if (m.kernel.plan->output(OutputName::slope("Ci")) < 0)
        diagnostics_.reportOnce(
            "atmosphere:" + shader->name,
            {Severity::Info,
             Rie::NoError,
             shader->place,
             "volume shader " + name + " is not affine in Ci; its transmittance is measured between Ci = 0 and 1",
             {},
             {}});
    m.shader = shader;
    return m;
}

InstanceRef SurfaceBinder::volumeOf(const scene::ShaderRef& call, const geometry::Shape& shape) {
    const InstanceRef plain = instanceOf(call, rsl::ShaderKind::Volume);
    InstanceRef shader = world_.withCoShaders(plain, shape.attributes().coshaders, diagnostics_);
    if (!shader) return nullptr;
    shading::ParameterBlock own = shader->parameters;
    std::string key;
    for (const rsl::ParameterInfo& p : shader->program->parameters()) {
        const int v = shape.findPrimvar(p.name);
        if (v < 0) continue;
        const geometry::PrimVar& variable = shape.primvars()[size_t(v)];
        if (variable.cls != scene::Class::Constant) {
            diagnostics_.reportOnce(
                "medium:" + shader->name + ":" + p.name,
                {Severity::Warning,
                 Rie::Unimplement,
                 shape.place(),
                 "\"" + p.name + "\" is not the same everywhere on the primitive: it does not override the parameter of the " +
                     "volume shader \"" + shader->name + "\", which runs inside of it",
                 "a constant variable does",
                 {}});
            continue;
        }
        const std::optional<ShaderValue> value = primitiveVariable(shape, {}, p.name);
        const auto number = own.numbers.find(p.name);
        const auto text = own.strings.find(p.name);
        if (value->kind == rsl::ir::Kind::String && !value->elements && text != own.strings.end()) text->second = value->texts[0];
        else if (value->kind != ShaderValue::kindOf(p.type.base) || number == own.numbers.end()) continue;
        else if (number->second.size() != value->numbers.size()) continue;
        else number->second = value->numbers;
        key += p.name + '\1' + (value->texts.empty() ? "" : value->texts[0]);
        key.append(reinterpret_cast<const char*>(value->numbers.data()), value->numbers.size() * sizeof(float));
    }
    if (key.empty()) return shader;
    InstanceRef& known = volumes_[{shader.get(), key}];
    if (!known) {
        auto with = std::make_shared<ShaderInstance>(*shader);
        with->parameters = std::move(own);
        known = with;
    }
    return known;
}

int SurfaceBinder::mediumOf(const InstanceRef& shader, const geometry::Shape& shape) {
    if (!shader) return -1;
    for (size_t i = 0; i < world_.media_.size(); ++i)
        if (world_.media_[i].shader == shader) return int(i);
    constexpr size_t kMost = std::numeric_limits<int16_t>::max(); // limited by the type in shading::Media
    if (world_.media_.size() >= kMost) {
        diagnostics_.reportOnce("media:count", {Severity::Error,
                                                Rie::Limit,
                                                shape.place(),
                                                "a frame has no more than " + std::to_string(kMost) +
                                                    " different interiors and exteriors; the others are empty",
                                                {},
                                                {}});
        return -1;
    }
    Medium m = bindVolume(shader, {});
    if (!m.shader) return -1;
    m.shape = &shape;
    m.binding = int(world_.bindings_.size()); // the binding under construction
    world_.bindHomogeneous(m, evaluator_, diagnostics_);
    world_.media_.push_back(std::move(m));
    return int(world_.media_.size()) - 1;
}

} // namespace alpenglow::world
