// Light samples where points, kernel and values are rows, without a structure for each point: emitters of a few flat triangles,
// and lights without geometry. lightvalues.cpp handles the other lights, with the same bits.
#include "base/direction.h"
#include "integrator/accumulator.h"
#include "integrator/batchpool.h"
#include "integrator/kernelinputs.h"
#include "integrator/lightkernels.h"
#include "integrator/lightsample.h"
#include "integrator/lightsampling.h"
#include <algorithm>
#include <bit>

namespace alpenglow::integrator {

/// Whether stage `place` makes the points on the light, or the light is a point, and its kernel needs nothing else.
bool LightSampling::inRows(const BoundLight& l, const BoundKernel& of) const {
    const bool emitter = l.kind == LightKind::Area;
    if (!of || l.inAtmosphere || l.asksSurface || l.channels || l.sentCl >= 0 || (emitter && !l.emitter)) return false;
    if (!emitter && of.plan->readsNormal()) return false; // it is the shading normal of the lit point, which rows lack
    if (emitter ? l.mean || l.emitter->flat().empty() || world_.accel().hasSolids() : l.isSky() || l.cone) return false;
    for (size_t i = 0; emitter && i < l.emitter->flat().size(); ++i)
        if (of.plan->overriddenBy(l.emitter->flatShape(i))) return false;
    const auto& k = *of.kernel;
    return of.plan->readsLightRows() && k.sites().empty() && !k.facts().suspends && !k.facts().lightLoops && !l.instance->moving;
}

/// Samples the light for each lit point of v_.litBlocks.
void LightSampling::askInRows(const BoundLight& light, const BatchContext& c) {
    placeInRows(light, c.between || !rules_.pickOne ? nullptr : guideOf(world_, light));
    const size_t n = v_.litBlocks.size() * kBlock;
    auto call = batches_.take();
    call->bound = &light.kernel;
    call->lit = nullptr;
    call->light = &light;
    call->ownShadows.clear();
    if (!call->batch) call->batch = std::make_shared<shading::Batch>();
    const std::span<const float> rows(lamp_);
    parameters_.resize(world_.lights().size());
    auto& parameters = parameters_[size_t(&light - world_.lights().data())];
    if (!parameters) parameters = std::make_unique<const shading::ParameterRows>(*light.kernel.plan, light.instance->parameters);
    const shading::InstanceView view{&light.instance->parameters, &light.instance->toCurrent, nullptr, parameters.get()};
    call->batch->assign(light.kernel.kernel, *light.kernel.plan,
                        {rows.first(3 * n), rows.subspan(3 * n, 3 * n), rows.subspan(6 * n, 3 * n)}, {&view, 1}, {});
    inputs_.bind(call->batch->call(), *call);
    light.kernel.kernel->run(&call->batch->call());
    call->ran();
    takeRows(light, *call->batch, c);
    batches_.giveBack(std::move(call));
}

/// Chooses points on the light for blocks in which some points sample it.
void LightSampling::placeInRows(const BoundLight& light, const LightGuide* guide) {
    beginLights(light);
    const size_t n = v_.litBlocks.size() * kBlock;
    lamp_.resize(9 * n);
    placed_.assign(v_.litBlocks.size(), {0xffffu, 0xffffu, 0xffffu});
    if (light.kind == LightKind::Area) {
        const uint32_t use = kLightPoint + v_.numberOf(light);
        drawOf(light, use << 1, v_.pairs);
        if (takesChoice(light)) drawOf(light, use << 1 | SampleNumbers::kSingle, v_.choices);
    } else {
        const Vec3 origin = originOfLight(*light.instance, 0);
        for (size_t q = 0; q < 3; ++q) std::fill_n(lamp_.data() + q * n, n, origin[int(q)]);
        std::fill_n(lamp_.data() + 3 * n, 3 * n, 0.f);
    }
    for (size_t k = 0; k < v_.litBlocks.size(); ++k) {
        if (light.kind == LightKind::Area) placeOnEmitter(k, light, guide);
        for (size_t q = 0; q < 3; ++q)
            std::copy_n(v_.vertices[v_.litBlocks[k]].P[q], kBlock, lamp_.data() + (6 + q) * n + k * kBlock);
    }
}

/// The same for one of v_.litBlocks on an emitter, shape by shape, each for the points that chose it.
void LightSampling::placeOnEmitter(size_t k, const BoundLight& light, const LightGuide* guide) {
    const Emitter& emitter = *light.emitter;
    const size_t b = v_.litBlocks[k], n = v_.litBlocks.size() * kBlock;
    float *P = lamp_.data() + k * kBlock, *N = P + 3 * n;
    LightBlock& l = v_.lights[b];
    const std::span<const FlatEmitter> shapes = emitter.flat();
    const VertexBlock& v = v_.vertices[b];
    Lanes of[limits::kLightsSampled] = {};
    alignas(64) double share[kBlock];
    const GuidedLanes guided(guide, v, v_.lit[b], v_.pairs[b].x);
    for (size_t i = 0; i < size_t(kBlock); ++i) {
        const float choose = shapes.size() > 1 ? v_.choices[b].x[i] : 0;
        of[emitter.flatFrom({v.P[0][i], v.P[1][i], v.P[2][i]}, choose, share[i])] |= 1u << i;
    }
    BlockPlaced& placed = placed_[k] = {};
    for (size_t s = 0; s < shapes.size(); ++s) {
        if (!(of[s] & v_.lit[b])) continue;
        LightBlock mine;
        alignas(64) Row rows[6];
        const bool all = of[s] == 0xffffu;
        const Lanes there =
            of[s] & (all ? stages_.place(v, shapes[s], v_.pairs[b].x, v_.pairs[b].y, share, l, P, N, int(n))
                         : stages_.place(v, shapes[s], v_.pairs[b].x, v_.pairs[b].y, share, mine, rows[0], rows[3], kBlock));
        for (Lanes left = all ? 0 : of[s]; left; left &= left - 1) {
            const size_t i = size_t(std::countr_zero(left));
            for (size_t q = 0; q < 3; ++q) {
                P[q * n + i] = rows[q][i], N[q * n + i] = rows[3 + q][i];
                l.w[q][i] = mine.w[q][i], l.end[q][i] = mine.end[q][i];
            }
            l.density[i] = mine.density[i];
        }
        placed.points |= there;
        if (emitter.flatVisibility(s) & visibilityBit(RayType::Diffuse)) placed.metDiffuse |= there;
        if (emitter.flatVisibility(s) & visibilityBit(RayType::Specular)) placed.metSpecular |= there;
    }
    if (guided.guided) followGuide(k, light, *guide, guided);
}

/// Places samples where the guide's directions lead, and gives all points that have a guide the density of the mixture.
void LightSampling::followGuide(size_t k, const BoundLight& light, const LightGuide& guide, const GuidedLanes& guided) {
    const size_t b = v_.litBlocks[k], n = v_.litBlocks.size() * kBlock;
    float *P = lamp_.data() + k * kBlock, *N = P + 3 * n;
    LightBlock& l = v_.lights[b];
    const VertexBlock& v = v_.vertices[b];
    BlockPlaced& placed = placed_[k];
    for (Lanes left = guided.guided; left; left &= left - 1) {
        const size_t i = size_t(std::countr_zero(left));
        const Vec3 from(v.P[0][i], v.P[1][i], v.P[2][i]);
        const LightGuide::Cell& cell = *guided.cell[i];
        if (guided.toward >> i & 1) {
            const Vec3 w = guide.draw(cell, from, {v_.pairs[b].x[i], v_.pairs[b].y[i]});
            Emitter::Sample s;
            geometry::SurfacePoint point;
            const Lanes bit = 1u << i;
            placed.points &= ~bit, placed.metDiffuse &= ~bit, placed.metSpecular &= ~bit;
            if (!light.emitter->sampleToward(from, w, s, point, light.pointNeeds) ||
                (s.shape->oneSided() && !(dot(intersectsNormal(point), s.direction) < 0)))
                continue;
            const Vec3 at = intersectsAt(point), end = leavesFrom(point, -s.direction);
            for (size_t q = 0; q < 3; ++q) {
                P[q * n + i] = at[int(q)], N[q * n + i] = point.n[int(q)];
                l.w[q][i] = s.direction[int(q)], l.end[q][i] = end[int(q)];
            }
            l.density[i] = s.pdf;
            placed.points |= bit;
            if (s.visibility & visibilityBit(RayType::Diffuse)) placed.metDiffuse |= bit;
            if (s.visibility & visibilityBit(RayType::Specular)) placed.metSpecular |= bit;
        }
        l.density[i] = guide.mixed(cell, l.density[i], from, {l.w[0][i], l.w[1][i], l.w[2][i]});
    }
}

/// Reads the light at the points from the outputs of its kernel.
void LightSampling::takeRows(const BoundLight& light, const shading::Batch& from, const BatchContext& c) {
    v_.values.clear();
    v_.queryAt.clear();
    if (light.shadowRadius >= 0) v_.queryAt.resize(v_.points, -1);
    for (size_t k = 0; k < v_.litBlocks.size(); ++k) {
        LightBlock& l = v_.lights[v_.litBlocks[k]];
        takeLightOf(k, light, from, c);
        l.metDiffuse = l.asked & placed_[k].metDiffuse;
        l.metSpecular = l.asked & placed_[k].metSpecular;
    }
}

/// The same for one of v_.litBlocks.
void LightSampling::takeLightOf(size_t k, const BoundLight& light, const shading::Batch& from, const BatchContext& c) {
    const size_t b = v_.litBlocks[k], first = k * kBlock;
    LightBlock& l = v_.lights[b];
    const auto row = [&](int output, int component) { return from.row(output, component).data() + first; };
    const auto way = [&](int i) {
        return light.outL < 0 ? Vec3() : Vec3(row(light.outL, 0)[i], row(light.outL, 1)[i], row(light.outL, 2)[i]);
    };
    for (int q = 0; q < 3; ++q) std::copy_n(row(light.outCl, q), kBlock, l.Cl[q]);
    for (int i = 0; light.intensityScale > 0 && i < kBlock;
         ++i) { // the kernel divided by the squared distance; radiance does not
        const float scale = dot(way(i), way(i)) * light.intensityScale;
        for (int q = 0; q < 3; ++q) l.Cl[q][i] *= scale;
    }
    const auto kept = [&](int output, Row& to) {
        for (int i = 0; i < kBlock; ++i) to[i] = std::max(0.f, 1 - (output < 0 ? 0 : row(output, 0)[i]));
    };
    kept(light.nonDiffuse, l.keptDiffuse);
    kept(light.nonSpecular, l.keptSpecular);
    if (light.kind != LightKind::Area) placeFar(light, from, first, l);
    for (Lanes left = v_.lit[b] & placed_[k].points; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        if (light.outLit >= 0 && row(light.outLit, 0)[i] == 0) continue;
        const Color Cl{l.Cl[0][i], l.Cl[1][i], l.Cl[2][i]};
        const size_t point = b * kBlock + size_t(i);
        if (!isFinite(Cl)) accumulator_.notFinite(&c.rays[point], "Cl", light.instance.get());
        else if (!(Cl == Color(0))) l.asked |= 1u << i;
        if (!(l.asked >> i & 1)) continue;
        if (light.kind != LightKind::Area) {
            LightValue says;
            if (asksShadowDisk(light, from, first + size_t(i), says)) {
                says.L = way(i);
                v_.queryAt[point] = int32_t(v_.values.size());
                v_.values.push_back(says);
            }
        }
    }
}

/// Position of a light without geometry, seen from the points of a block. at: index of the block's first point in the batch.
void LightSampling::placeFar(const BoundLight& light, const shading::Batch& from, size_t at, LightBlock& l) const {
    alignas(64) static constexpr Row kNone[3] = {};
    const float* L = light.outL < 0 ? kNone[0] : from.row(light.outL, 0).data() + at;
    const int stride = light.outL < 0 ? kBlock : int(from.row(light.outL, 1).data() - from.row(light.outL, 0).data());
    for (Lanes odd = stages_.placeFar(L, stride, light.kind == LightKind::Distant, l); odd; odd &= odd - 1) {
        const int i = std::countr_zero(odd);
        const Vec3 w = directionOr(-Vec3(L[i], L[stride + i], L[2 * stride + i]), Vec3(0, 0, 1));
        for (int q = 0; q < 3; ++q) l.w[q][i] = w[q];
    }
}

/// Whether the light has a disk-shaped shadow source, and its size. at: index in the batch.
bool LightSampling::asksShadowDisk(const BoundLight& light, const shading::Batch& from, size_t at, LightValue& v) {
    if (light.shadowRadius < 0) return false;
    const float samples = light.shadowSamples < 0 ? 1 : from.value(light.shadowSamples, 0, int(at));
    lightKernels_.takeShadowSays(v, light, from.value(light.shadowRadius, 0, int(at)), samples);
    return v.shadowRadius > 0;
}

bool LightSampling::sampleInRows(const BoundLight& light, const BatchContext& c) {
    if (!inRows_[v_.numberOf(light)]) return false;
    findLit(&light);
    askInRows(light, c);
    return true;
}

} // namespace alpenglow::integrator
