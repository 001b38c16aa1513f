// Shaders that get values from gather() statements of others.
#include "world/gathersite.h"
#include "world/surfaces.h"

namespace alpenglow::world {

void SurfaceBinder::findGathers() {
    std::map<const rsl::Program*, bool> seen; // whether names of its gather() statements are made from texts
    const auto program = [&](const rsl::Program& p, const std::map<std::string, std::string>& texts) {
        const auto [at, fresh] = seen.try_emplace(&p);
        if (fresh) at->second = gatheredNames(p, gathered_);
        for (const auto& [name, text] : texts)
            if (at->second) gathered_.add(text, -1);
    };
    const auto look = [&](const InstanceRef& i) {
        if (!i || !i->program) return;
        program(i->program->program(), i->parameters.strings);
        for (const rsl::CoShader& c : i->coShaders)
            if (c.program) program(*c.program, c.strings);
    };
    const scene::Attributes* last = nullptr;
    for (const auto& shape : world_.shapes_) {
        const scene::Attributes& a = shape->attributes();
        if (&a == last) continue;
        last = &a;
        look(instanceOf(a.surface, rsl::ShaderKind::Surface));
        look(instanceOf(a.atmosphere, rsl::ShaderKind::Volume));
    }
    for (const BoundLight& l : world_.lights_) look(l.instance);
}

SurfaceBinder::Names SurfaceBinder::receive(const geometry::Shape& shape, InstanceRef& shader, rsl::PairName::To to) {
    if (!shader) return {};
    if (const auto texts = gathered_.sentTexts(*shader, to); !texts.empty()) {
        InstanceRef& known = receiving_[{shader.get(), to}];
        if (!known) {
            auto same = std::make_shared<ShaderInstance>(*shader);
            same->sent = texts;
            known = same;
            kept_.push_back(shader);
        }
        shader = known;
    }
    return gathered_.withSent(varyingOf(shape, *shader), *shader, to);
}

} // namespace alpenglow::world
