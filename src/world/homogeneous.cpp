// Homogeneous scattering media: parameters from outputs of volume shaders.
#include "base/exact.h"
#include "world/mutableworld.h"
#include "world/outputs.h"

namespace alpenglow::world {

using rsl::OutputName;

namespace {

constexpr float kMostAnisotropy = 0.999f;

/// Whether a shader has an output of this name and type.
bool hasOutput(const ShaderInstance& s, const char* name, shadeops::Base type) {
    for (const rsl::ParameterInfo& p : s.program->parameters())
        if (p.name == name) return p.output && !p.type.array && p.type.base == type;
    return false;
}

/// Whether a kernel is constant in space.
bool sameEverywhere(const rsl::CompiledKernel& k) {
    bool same = k.sites().empty();
    for (const auto& in : k.inputs()) same &= rsl::InputName::parse(in.name).kind == rsl::InputName::Kind::Parameter;
    return same;
}

} // namespace

Color Homogeneous::transmittance(float way) const {
    const Color sigma = extinction();
    Color t(float(exact::exp(-double(sigma.x) * way)));
    if (sigma.y != sigma.x) t.y = float(exact::exp(-double(sigma.y) * way));
    if (sigma.z != sigma.x) t.z = float(exact::exp(-double(sigma.z) * way));
    return t;
}

void MutableWorld::bindHomogeneous(Medium& m, Evaluator& evaluator, Diagnostics& d) {
    const ShaderInstance& shader = *m.shader;
    std::vector<std::string> names, outputs;
    for (const char* name : {"__absorption", "__scattering", "__emission"})
        if (hasOutput(shader, name, shadeops::Base::Color)) names.push_back(name);
    const bool medium = std::find_if(names.begin(), names.end(), [](const auto& n) { return n != "__emission"; }) != names.end();
    for (const char* name : {"__anisotropy", "__priority"})
        if (hasOutput(shader, name, shadeops::Base::Float)) names.push_back(name);
    if (names.empty()) return;
    for (const std::string& name : names) addOutput(shader, OutputName::of(name), outputs);
    const BoundKernel k = kernel(shader, outputs, {}, false, false, d);
    if (!k || k.kernel->facts().suspends) return;
    if (!sameEverywhere(*k.kernel)) {
        d.reportOnce("homogeneous:" + shader.name,
                     {Severity::Warning,
                      Rie::Incapable,
                      shader.place,
                      "what volume shader \"" + shader.name +
                          "\" says of its medium is not the same everywhere: light is not scattered in it",
                      "__absorption, __scattering and their like may depend on parameters only; the shader's Ci counts",
                      {}});
        return;
    }
    Homogeneous h;
    const auto number = [&](float v, const std::string& name, float low) {
        if (std::isfinite(v) && v >= low) return v;
        d.reportOnce("homogeneous:" + shader.name + name,
                     {Severity::Warning,
                      Rie::Range,
                      shader.place,
                      "\"" + name + "\" of volume shader \"" + shader.name + "\" is " + std::to_string(v) + "; 0 is taken",
                      {},
                      {}});
        return 0.f;
    };
    std::vector<ShadePoint> point(1);
    evaluator.run(k, nullptr, point, shader.view(), [&](const shading::Batch& b) {
        const auto colour = [&](const char* name, Color& c) {
            if (const int o = b.output(OutputName::of(name)); o >= 0)
                for (int i = 0; i < 3; ++i) c[i] = number(b.value(o, i, 0), name, 0);
        };
        colour("__absorption", h.absorption);
        colour("__scattering", h.scattering);
        colour("__emission", h.emission);
        if (const int o = b.output(OutputName::of("__anisotropy")); o >= 0)
            h.anisotropy = std::clamp(number(b.value(o, 0, 0), "__anisotropy", -1e30f), -kMostAnisotropy, kMostAnisotropy);
        if (const int o = b.output(OutputName::of("__priority")); o >= 0)
            m.priority = number(b.value(o, 0, 0), "__priority", -1e30f);
    });
    if (!medium || settings_.hider != Hider::Path) return;
    scatters_ |= maxComponent(h.scattering) > 0;
    m.homogeneous = std::make_shared<Homogeneous>(h);
}

void MutableWorld::placeLights(Evaluator& evaluator) {
    if (!scatters_) return;
    for (BoundLight& l : lights_) {
        if (l.kind == LightKind::Area && l.kernel && l.emitter && !l.emitter->empty() && !l.mean && !l.asksSurface &&
            l.sentCl < 0) {
            const geometry::Bounds box = l.emitter->bounds();
            l.place = (box.lo + box.hi) * 0.5f;
            l.extent = length(box.hi - box.lo) * 0.5f;
            l.placed = std::isfinite(l.extent);
        }
        if (l.kind != LightKind::Point || !l.kernel || l.kernel.kernel->facts().suspends) continue;
        if (l.sentCl >= 0 || l.asksSurface || l.outL < 0) continue;
        const Vec3 at(transformPoint(l.instance->toCurrent, {0, 0, 0}));
        // Around its possible position: a spot light reveals its position only to points that it lights
        std::vector<ShadePoint> q;
        for (int k = 0; k < 26; ++k) {
            const int c = k < 13 ? k : k + 1;
            const Vec3 w = normalize(Vec3(float(c % 3 - 1), float(c / 3 % 3 - 1), float(c / 9 - 1)));
            for (float far : {1.f, 1000.f}) {
                ShadePoint& p = q.emplace_back();
                p.P = at;
                p.Ps = at + w * far;
                p.Ns = -w;
            }
        }
        std::vector<LightValue> v(q.size());
        const std::vector<ShadePoint> asked = q;
        evaluator.light(l, q, v);
        for (size_t k = 0; k < asked.size() && !l.placed; ++k) {
            l.place = asked[k].Ps - v[k].L;
            l.placed = v[k].lit && dot(v[k].L, v[k].L) > 0 && std::isfinite(dot(l.place, l.place));
        }
    }
}

} // namespace alpenglow::world
