// Displacement at dicing: by displacement shaders, by classes that are both, and by surface shaders that move P.
#include "geometry/dice.h"
#include "geometry/picture_sides.h"
#include "geometry/placed.h"
#include "rsl/ir/edit.h"
#include "rsl/moves.h"
#include "scene/scene.h"
#include "world/mutableworld.h"
#include "world/turned.h"

namespace alpenglow::world {

namespace {

/// Why a kernel that computes P alone cannot run at dicing; "" if it can. `moves`: P changes; `loops`: P depends on light loops,
/// which may be possible.
std::string undiceable(const rsl::ir::Kernel& k, bool& moves, bool& loops) {
    using rsl::ir::Op;
    std::string why;
    rsl::ir::forEach(k.body, [&](const rsl::ir::Inst* i) {
        const auto op = [&]() -> const std::string& { return k.sites[size_t(i->site)].op; };
        if (i->op == Op::Output) {
            const rsl::ir::Inst* v = i->args[0];
            moves |= !(v->op == Op::Input && k.inputs[size_t(v->index)].name == "P");
        } else if (i->op == Op::LightLoop) {
            loops = true;
        } else if (i->op == Op::Request || i->op == Op::Emit) {
            why = op() == "lightvisibility" ? "light" : op() + "()";
        } else if (i->op == Op::Service && (op() == "ambient" || op() == "getlights" || op() == "lightcall")) {
            why = "light";
        }
    });
    return why;
}

bool sendsRays(const BoundKernel& k) {
    return k.kernel->facts().suspends || std::any_of(k.sites.begin(), k.sites.end(), [](const SiteInfo& s) {
               return s.rays || s.kind == SiteKind::Occlusion || s.kind == SiteKind::Gather;
           });
}

/// Whether one iteration of a light needs only its kernel: no geometry, which does not exist yet, and no random number.
bool isKnownEarly(const BoundLight& l, bool path) {
    if (!l.kernel || l.kind == LightKind::Ambient) return true; // it has no iteration
    return l.kind != LightKind::Area && !l.shadows && !sendsRays(l.kernel) &&
           !(path && (l.cone || l.kind == LightKind::Environment));
}

} // namespace

BoundKernel MutableWorld::movingKernel(const ShaderInstance& surface, const BoundKernel& bound, const scene::LightSet& lights,
                                       const std::vector<std::string>& varying, Diagnostics& d) {
    const bool path = settings_.hider == Hider::Path;
    const auto& writes = bound.kernel->facts().writes;
    if (std::find(writes.begin(), writes.end(), "P") == writes.end()) return {};
    Diagnostics quiet; // already reported when the surface was compiled
    auto k = compiler_->analyse(*surface.program, kernelOptions(surface, {"P"}, varying, false, path), quiet);
    if (!k) return {};
    bool moves = false, loops = false;
    std::string why = undiceable(*k, moves, loops);
    if (!moves) return {};
    BoundKernel moving;
    if (why.empty()) moving = kernel(surface, {"P"}, varying, false, false, quiet);
    if (why.empty() && loops) {
        const auto sendsStrings = [](const SiteInfo& s) { return s.kind == SiteKind::LightSetup && !s.sentStrings.empty(); };
        bool late = std::any_of(moving.sites.begin(), moving.sites.end(), sendsStrings); // their kernels are built later
        eachLight(lights, [&](int l) { return late |= !isKnownEarly(lights_[size_t(l)], path); });
        if (late) why = "light";
    }
    if (!why.empty()) {
        d.reportOnce("moves:" + surface.name, {Severity::Warning,
                                               Rie::Unimplement,
                                               surface.place,
                                               "surface shader \"" + surface.name + "\" moves P by " + why +
                                                   ", which is unknown when the primitive is diced; it is not displaced",
                                               "use a displacement shader",
                                               {}});
        return {};
    }
    d.reportOnce("moves:" + surface.name,
                 {Severity::Info,
                  Rie::NoError,
                  surface.place,
                  "surface shader \"" + surface.name + "\" moves P: it displaces its primitives",
                  "Attribute \"displacementbound\" says how far for other renderers; a displacement shader is the place for it",
                  {}});
    return moving;
}

void MutableWorld::displaceGrid(const SurfaceBinding& b, const geometry::Shape& shape, geometry::DiceGrid& grid,
                                Diagnostics& d) const {
    const BoundKernel& bound = b.displacement ? b.displacementS : b.moveS;
    if (!bound || bound.kernel->facts().suspends) return;
    const ShaderInstance& shader = b.displacement ? *b.displacement : *b.surface;
    std::vector<ShadePoint> points;
    for (size_t i = 0; i < grid.points.size(); ++i) {
        ShadePoint p;
        p.shape = &shape;
        p.surface = grid.points[i];
        p.P = p.surface.P;
        p.N = p.surface.N;
        p.I = frame_->options.projection == "perspective" ? p.P : Vec3(0, 0, p.P.z); // as seen from the camera
        p.du = grid.du[i];
        p.dv = grid.dv[i];
        if (b.displacement && turnedOver(shape)) turnOver(p);
        points.push_back(p);
    }
    evaluators_(*this, d, settings_.stop, true)->run(bound, &b, points, shader.view(), [&](const shading::Batch& batch) {
        const int out = batch.output("P");
        for (size_t i = 0; out >= 0 && i < grid.P.size(); ++i) grid.P[i] = batch.color(out, int(i));
    });
}

/// Whether points of this shape differ from the primitive's, for a binding.
bool MutableWorld::movesPoints(const SurfaceBinding& b, const geometry::Shape& shape) const {
    if (!b.displacement) return bool(b.moveS);
    if (!b.displacementS || b.displacementS.kernel->facts().suspends) return true;
    const auto& writes = b.displacementS.kernel->facts().writes;
    if (std::find(writes.begin(), writes.end(), "P") == writes.end()) return false;
    std::vector<std::string> varying;
    for (const auto& v : shape.primvars()) varying.push_back(v.name);
    const ShaderInstance& shader = *b.displacement;
    return rsl::movesPoints(shader.program->program(), shader.program->shader(),
                            kernelOptions(shader, {"P"}, varying, false, settings_.hider == Hider::Path),
                            shader.parameters.numbers);
}

void MutableWorld::diceShapes(Diagnostics& d) {
    geometry::DiceOptions dice;
    dice.camera = geometry::DiceCamera::from(frame_->options);
    dice.stop = settings_.stop;
    const auto bindingOf = [&](const geometry::Shape& s) -> const SurfaceBinding& {
        return bindings_[size_t(bindingOf_[numberOfShape_.at(&s)])];
    };
    std::vector<int8_t> moves(bindings_.size(), -1); // -1: not yet determined
    for (const geometry::ShapeRef& s : shapes_) {
        const auto b = size_t(bindingOf_[numberOfShape_.at(s->placed() ? s->placed()->geometry().get() : s.get())]);
        if (moves[b] < 0) moves[b] = movesPoints(bindings_[b], *s);
    }
    dice.displaces = [&](const geometry::Shape& shape) { return moves[size_t(bindingOf_[numberOfShape_.at(&shape)])] > 0; };
    dice.displace = [&](const geometry::Shape& shape, geometry::DiceGrid& grid) {
        displaceGrid(bindingOf(shape), shape, grid, d);
    };
    dice.declaredBound = [&](const geometry::Shape& shape) {
        geometry::DiceOptions::DeclaredBound bound;
        const SurfaceBinding& b = bindingOf(shape);
        const InstanceRef both[] = {b.displacement, b.surface == b.displacement ? nullptr : b.surface};
        for (const InstanceRef& i : both) {
            if (!i || (!b.displacement && !b.moveS) || (i == b.surface && b.displacement && !shape.attributes().displacement))
                continue; // one class is both
            const auto number = i->parameters.numbers.find(rsl::kBoundSize);
            if (number == i->parameters.numbers.end() || number->second.empty()) continue;
            bound.radius += std::max(0.0, double(number->second[0]));
            const auto space = i->parameters.strings.find(rsl::kBoundSpace);
            if (bound.space.empty() && space != i->parameters.strings.end()) bound.space = space->second;
        }
        return bound;
    };
    dice.spaceOf = [&](const geometry::Shape& shape, const std::string& space, Matrix& out) {
        if (space == "object") return out = shape.toCamera(), true;
        if (space == "shader") {
            const InstanceRef& shader = bindingOf(shape).displacement ? bindingOf(shape).displacement : bindingOf(shape).surface;
            return shader ? (out = shader->toCurrent, true) : false;
        }
        return matrix(space, "current", out);
    };
    const std::optional<geometry::PictureSides> sides =
        onlyCameraRays() ? geometry::PictureSides::from(frame_->options) : std::nullopt;
    dice.picture = sides ? &*sides : nullptr;
    geometry::diceShapes(shapes_, dice, d);
}

} // namespace alpenglow::world
