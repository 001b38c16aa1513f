// Samples of emitters of a few flat triangles for vertices in blocks: points, the light's kernel and its values in rows, no
// structure a point. What the others do in blocklights.cpp, with the same bits.
#include "wave/blockvertices.h"
#include "wave/lightsample.h"
#include <algorithm>
#include <bit>

namespace alpenglow::transport {

/// Whether points of the light come from the stage `place`, and its kernel asks for nothing but what that gives.
bool BlockVertices::inRows(const BoundLight& l) const {
    if (l.kind != LightKind::Area || l.mean || !l.emitter->flat() || world_.accel_->hasSolids()) return false;
    const auto& k = *l.kernel.kernel;
    return l.kernel.plan->readsLightRows() && k.sites().empty() && !k.facts().suspends && !k.facts().lightLoops &&
           !l.instance->moving && l.shadowRadius < 0;
}

void BlockVertices::lightInRows(const BoundLight& light, BatchContext& c) {
    placeOnEmitter(light);
    const size_t n = litBlocks_.size() * kBlock;
    auto call = e_.takeContext();
    call->engine = &e_;
    call->bound = &light.kernel;
    call->lit = nullptr;
    call->light = &light;
    call->ownShadows.clear();
    if (!call->batch) call->batch = std::make_shared<shading::Batch>();
    const std::span<const float> rows(lamp_);
    parameters_.resize(world_.lights_.size());
    auto& parameters = parameters_[size_t(&light - world_.lights_.data())];
    if (!parameters) parameters = std::make_unique<const shading::ParameterRows>(*light.kernel.plan, light.instance->parameters);
    call->batch->assign(light.kernel.kernel, *light.kernel.plan,
                        {rows.first(3 * n), rows.subspan(3 * n, 3 * n), rows.subspan(6 * n, 3 * n)},
                        {&light.instance->parameters, &light.instance->toCurrent, nullptr, parameters.get()});
    e_.bindCall(call->batch->call(), *call);
    light.kernel.kernel->run(&call->batch->call());
    call->ran();
    takeRows(light, *call->batch, c);
    e_.giveBack(std::move(call));
    connect(light, c);
}

/// A point of the light for each point of blocks where some sample it.
void BlockVertices::placeOnEmitter(const BoundLight& light) {
    const uint32_t use = kLightPoint + uint32_t(&light - world_.lights_.data());
    drawNumbers(use << 1, pairs_);
    beginLights(light);
    const size_t n = litBlocks_.size() * kBlock;
    lamp_.resize(9 * n);
    placed_.resize(litBlocks_.size());
    for (size_t k = 0; k < litBlocks_.size(); ++k) {
        const size_t b = litBlocks_[k];
        float* at = lamp_.data() + k * kBlock;
        placed_[k] =
            stages_.place(vertices_[b], *light.emitter->flat(), pairs_[b].x, pairs_[b].y, lights_[b], at, at + 3 * n, int(n));
        for (size_t q = 0; q < 3; ++q) std::copy_n(vertices_[b].P[q], kBlock, at + (6 + q) * n);
    }
}

/// The light at the points, from the outputs of its kernel.
void BlockVertices::takeRows(const BoundLight& light, const shading::Batch& from, const BatchContext& c) {
    const uint32_t seenBy = light.emitter->flatVisibility();
    queryAt_.clear();
    for (size_t k = 0; k < litBlocks_.size(); ++k) {
        const size_t b = litBlocks_[k], first = k * kBlock;
        LightBlock& l = lights_[b];
        const auto row = [&](int output, int component) { return from.row(output, component).data() + first; };
        for (int q = 0; q < 3; ++q) std::copy_n(row(light.outCl, q), kBlock, l.Cl[q]);
        if (light.intensityScale > 0) { // the kernel divided by the squared distance: radiance does not
            for (int i = 0; i < kBlock; ++i) {
                Vec3 L;
                for (int q = 0; q < 3 && light.outL >= 0; ++q) L[q] = row(light.outL, q)[i];
                const float scale = dot(L, L) * light.intensityScale;
                for (int q = 0; q < 3; ++q) l.Cl[q][i] *= scale;
            }
        }
        const auto kept = [&](int output, Row& to) {
            for (int i = 0; i < kBlock; ++i) to[i] = std::max(0.f, 1 - (output < 0 ? 0 : row(output, 0)[i]));
        };
        kept(light.nonDiffuse, l.keptDiffuse);
        kept(light.nonSpecular, l.keptSpecular);
        for (Lanes left = lit_[b] & placed_[k]; left; left &= left - 1) {
            const int i = std::countr_zero(left);
            if (light.outLit >= 0 && row(light.outLit, 0)[i] == 0) continue;
            const Color Cl{l.Cl[0][i], l.Cl[1][i], l.Cl[2][i]};
            if (!isFinite(Cl)) e_.notFinite(&c.rays[b * kBlock + size_t(i)], "Cl", light.instance.get());
            else if (!(Cl == Color(0))) l.asked |= 1u << i;
        }
        if (seenBy & visibilityBit(RayType::Diffuse)) l.metDiffuse = l.asked;
        if (seenBy & visibilityBit(RayType::Specular)) l.metSpecular = l.asked;
    }
}

} // namespace alpenglow::transport
