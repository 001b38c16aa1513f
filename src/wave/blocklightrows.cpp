// Samples of lights for vertices in blocks whose points, kernel and values are rows, no structure a point: of emitters of a few
// flat triangles, and of lights without geometry. What the others do in blocklights.cpp, with the same bits.
#include "base/direction.h"
#include "wave/blockvertices.h"
#include "wave/lightsample.h"
#include <algorithm>
#include <bit>

namespace alpenglow::transport {

/// Whether points of the light come from the stage `place` or are one, and its kernel asks for nothing but what that gives.
bool BlockVertices::inRows(const BoundLight& l) const {
    const bool emitter = l.kind == LightKind::Area;
    if (emitter ? l.mean || !l.emitter->flat() || world_.accel_->hasSolids() : l.sky || l.cone) return false;
    const auto& k = *l.kernel.kernel;
    return l.kernel.plan->readsLightRows() && k.sites().empty() && !k.facts().suspends && !k.facts().lightLoops &&
           !l.instance->moving;
}

void BlockVertices::lightInRows(const BoundLight& light, BatchContext& c) {
    placeInRows(light);
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
void BlockVertices::placeInRows(const BoundLight& light) {
    beginLights(light);
    const size_t n = litBlocks_.size() * kBlock;
    lamp_.resize(9 * n);
    placed_.assign(litBlocks_.size(), 0xffffu);
    if (light.kind == LightKind::Area) {
        drawNumbers((kLightPoint + uint32_t(&light - world_.lights_.data())) << 1, pairs_);
    } else {
        const Vec3 origin = originOfLight(*light.instance, 0);
        for (size_t q = 0; q < 3; ++q) std::fill_n(lamp_.data() + q * n, n, origin[int(q)]);
        std::fill_n(lamp_.data() + 3 * n, 3 * n, 0.f);
    }
    for (size_t k = 0; k < litBlocks_.size(); ++k) {
        const size_t b = litBlocks_[k];
        float* at = lamp_.data() + k * kBlock;
        if (light.kind == LightKind::Area)
            placed_[k] =
                stages_.place(vertices_[b], *light.emitter->flat(), pairs_[b].x, pairs_[b].y, lights_[b], at, at + 3 * n, int(n));
        for (size_t q = 0; q < 3; ++q) std::copy_n(vertices_[b].P[q], kBlock, at + (6 + q) * n);
    }
}

/// The light at the points, from the outputs of its kernel.
void BlockVertices::takeRows(const BoundLight& light, const shading::Batch& from, const BatchContext& c) {
    const uint32_t seenBy = light.kind == LightKind::Area ? light.emitter->flatVisibility() : ~0u;
    values_.clear();
    queryAt_.clear();
    if (light.shadowRadius >= 0) queryAt_.resize(points_, -1);
    for (size_t k = 0; k < litBlocks_.size(); ++k) {
        LightBlock& l = lights_[litBlocks_[k]];
        takeLightOf(k, light, from, c);
        if (seenBy & visibilityBit(RayType::Diffuse)) l.metDiffuse = l.asked;
        if (seenBy & visibilityBit(RayType::Specular)) l.metSpecular = l.asked;
    }
}

/// The same of one of litBlocks_.
void BlockVertices::takeLightOf(size_t k, const BoundLight& light, const shading::Batch& from, const BatchContext& c) {
    const size_t b = litBlocks_[k], first = k * kBlock;
    LightBlock& l = lights_[b];
    const auto row = [&](int output, int component) { return from.row(output, component).data() + first; };
    const auto way = [&](int i) {
        return light.outL < 0 ? Vec3() : Vec3(row(light.outL, 0)[i], row(light.outL, 1)[i], row(light.outL, 2)[i]);
    };
    for (int q = 0; q < 3; ++q) std::copy_n(row(light.outCl, q), kBlock, l.Cl[q]);
    for (int i = 0; light.intensityScale > 0 && i < kBlock;
         ++i) { // the kernel divided by the squared distance: radiance does not
        const float scale = dot(way(i), way(i)) * light.intensityScale;
        for (int q = 0; q < 3; ++q) l.Cl[q][i] *= scale;
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
        const size_t point = b * kBlock + size_t(i);
        if (!isFinite(Cl)) e_.notFinite(&c.rays[point], "Cl", light.instance.get());
        else if (!(Cl == Color(0))) l.asked |= 1u << i;
        if (light.kind != LightKind::Area && l.asked >> i & 1) takePlace(light, point, way(i), from, first + size_t(i));
    }
}

/// Where a light without geometry stands as seen from a point. at: in the batch.
void BlockVertices::takePlace(const BoundLight& light, size_t point, const Vec3& L, const shading::Batch& from, size_t at) {
    LightBlock& l = lights_[point / kBlock];
    const size_t i = point % kBlock;
    const Vec3 w = directionOr(-L, Vec3(0, 0, 1));
    for (int q = 0; q < 3; ++q) l.w[q][i] = w[q];
    l.density[i] = 1;
    const float far = light.kind == LightKind::Distant ? 1e38f : length(L);
    l.far[i] = far < 1e30f ? far * (1 - 1e-5f) : far;
    if (light.shadowRadius < 0) return;
    LightValue v;
    v.L = L;
    e_.takeShadowSays(v, light, from.value(light.shadowRadius, 0, int(at)),
                      light.shadowSamples < 0 ? 1 : from.value(light.shadowSamples, 0, int(at)));
    if (!(v.shadowRadius > 0)) return;
    queryAt_[point] = int32_t(values_.size());
    values_.push_back(v);
}

} // namespace alpenglow::transport
