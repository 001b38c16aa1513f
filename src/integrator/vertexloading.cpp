#include "integrator/vertexloading.h"
#include "integrator/guidescatter.h"
#include "integrator/stageset.h"
#include "services/random.h"
#include <algorithm>

namespace alpenglow::integrator {

VertexLoading::VertexLoading(const StageSet& s, const VertexStages& v) : VertexStage(s, v), guided_(v.guide) {}

static Lanes firstPoints(size_t n) { return n >= size_t(kBlock) ? 0xffffu : (1u << n) - 1; }

void VertexLoading::begin(const BatchContext& c, bool waits) {
    v_.waits = waits;
    v_.indirect = {};
    v_.apart.clear();
    v_.loops.clear();
    v_.repeats = v_.sendsSeveral = v_.several = v_.checksHits = false;
    v_.moved = nullptr;
    v_.single = false;
    v_.litSurface.clear();
    v_.onlySite = -1;
    v_.draw = 0;
    v_.ignored = 0;
    v_.points = c.rays.size();
    v_.blocks = (v_.points + kBlock - 1) / kBlock;
    v_.vertices.resize(std::max(v_.vertices.size(), v_.blocks));
    v_.rays.resize(std::max(v_.rays.size(), v_.blocks));
}

/// Copies points and rays from structures to rows.
bool VertexLoading::loadVertices(const BatchContext& c) {
    for (size_t b = 0; b < v_.blocks; ++b) {
        const size_t first = b * kBlock, n = std::min(v_.points - first, size_t(kBlock));
        RayBlock& rays = v_.rays[b];
        stages_.load(&c.rays[first], int(sizeof(PathRay)), int(n), kRayWords, rays.origin);
        for (size_t k = 0; k < size_t(kBlock); ++k) rays.target[k] = c.targets[first + std::min(k, n - 1)];
        takeRays(rays, c.between);
        guided_.mark(b, c);
        if (c.between) loadFlown(b, c);
        else loadPoints(b, c);
        for (int i = 0; v_.waits && !v_.single && i < kBlock; ++i) // light samples of the call
            v_.vertices[b].lightVertex[i] = childVertex(v_.vertices[b].vertex[i], kLightPoint + uint32_t(c.emits[0].site), 0);
    }
    return !v_.moved || v_.single;
}

/// Copies ray data that paths need into a block.
void VertexLoading::takeRays(const RayBlock& rays, bool between) {
    VertexBlock& v = v_.vertices[size_t(&rays - v_.rays.data())];
    v.last = 0;
    for (int k = 0; k < kBlock; ++k) {
        v.bounces[k] = int16_t(rays.bounces[k]);
        v.last |= Lanes(v.bounces[k] - int16_t(rays.path[k] >> 16) - between >= world_.maxDepth())
                  << k; // scattering in media does not count
    }
    Lanes lost = 0; // in media
    for (int k = 0; k < kBlock; ++k) {
        lost |= Lanes(int16_t(rays.path[k] >> 16) >= limits::kPathDepth) << k;
        const PathSample& sample = v_.sampleOf(rays, k);
        v.low[k] = sample.numbers.low();
        v.high[k] = sample.numbers.high();
        v.index[k] = sample.numbers.index();
    }
    v.deep[0] = v.deep[1] = v.last | lost;
    v.waits = v_.waits;
    for (int q = 0; q < 3; ++q) std::copy_n(v_.waits ? v_.whole : rays.weight[q], kBlock, v.weight[q]); // relative to its target
    std::copy_n(rays.vertex, kBlock, v.vertex);
    std::copy_n(rays.vertex, kBlock, v.lightVertex);
}

/// Applies the depth limits of a surface to the lobes of a point.
void VertexLoading::endRays(size_t b, int lane, const SurfaceBinding& s, bool between) {
    if (s.maxDiffuse < 0 && s.maxSpecular < 0) return;
    const RayBlock& r = v_.rays[b];
    const int scattered = int16_t(r.path[lane] >> 16) + between;
    const int diffuse = int16_t(r.bounces[lane] >> 16) - scattered, specular = int16_t(r.specular[lane]);
    for (const int isDiffuse : {0, 1}) {
        const bool deep = (s.maxDiffuse >= 0 && diffuse + isDiffuse > s.maxDiffuse) ||
                          (s.maxSpecular >= 0 && specular + !isDiffuse > s.maxSpecular);
        v_.vertices[b].deep[isDiffuse] |= Lanes(deep) << lane;
    }
}

void VertexLoading::loadPoints(size_t b, const BatchContext& c) {
    VertexBlock& v = v_.vertices[b];
    const size_t first = b * kBlock, n = std::min(v_.points - first, size_t(kBlock));
    v.points = firstPoints(n);
    v.through = !c.clear.empty();
    const bool rows = c.points.empty();
    for (size_t k = 0; k < size_t(kBlock); ++k) {
        const size_t i = first + std::min(k, n - 1); // repeats the last point
        const SurfaceBinding& s = world_.bindings()[size_t(c.bindings[i])];
        const geometry::SurfacePoint& p = rows ? c.surfaces[i] : c.points[i].surface;
        const Vec3& P = rows ? p.P : c.points[i].P;
        if (!(P == p.P)) v_.moved = &c;
        if (s.matte && c.rays[i].camera()) v.points &= ~(1u << k);
        endRays(b, int(k), s, false);
        for (int q = 0; q < 3; ++q) {
            v.P[q][k] = P[q];
            v.n[q][k] = p.n[q];
            v.I[q][k] = rows ? c.ways[size_t(q) * v_.points + i] : c.points[i].I[q];
        }
        for (int q = 0; v.through && q < 3; ++q) v.clear[q][k] = v.beyond[q][k] = c.clear[i][q];
        v.error[k] = p.pError;
        v.bias[k] = s.bias;
    }
}

/// Fills the points of a block.
void VertexLoading::loadFlown(size_t b, const BatchContext& c) {
    VertexBlock& v = v_.vertices[b];
    const RayBlock& rays = v_.rays[b];
    const size_t first = b * kBlock, n = std::min(v_.points - first, size_t(kBlock));
    v.points = n >= size_t(kBlock) ? 0xffffu : (1u << n) - 1;
    v.through = false;
    for (size_t k = 0; k < size_t(kBlock); ++k) {
        const float t = c.flown[first + std::min(k, n - 1)].t;
        endRays(b, int(k), *c.binding, true);
        for (int q = 0; q < 3; ++q) v.P[q][k] = rays.origin[q][k] + rays.direction[q][k] * t;
    }
    for (int q = 0; q < 3; ++q) { // no sides and no viewing direction
        std::fill_n(v.n[q], kBlock, 0.f);
        std::fill_n(v.I[q], kBlock, 0.f);
        std::fill_n(v.clear[q], kBlock, 0.f);
    }
    std::fill_n(v.error, kBlock, 0.f);
    std::fill_n(v.bias, kBlock, c.binding->bias);
}

} // namespace alpenglow::integrator
