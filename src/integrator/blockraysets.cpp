// Which light samples the rays of a trace() could hit, for vertices in blocks: sets of surfaces, sides; and their shadow rays,
// which pass what those rays pass.
#include "integrator/accumulator.h"
#include "integrator/blockvertices.h"
#include "integrator/raystore.h"
#include <algorithm>
#include <bit>
#include <cmath>

namespace alpenglow::integrator {

/// Whether dropUnhit() must look at each sample of a light; otherwise no point has samples on backs of emitters.
bool BlockVertices::checksHits(const BoundLight& light) const {
    if (light.kind != LightKind::Area) return false;
    return light.channels || std::any_of(sites_.begin(), sites_.begin() + long(count_),
                                         [&](const Site& s) { return s.lights && !s.lighting && (light.mean || s.sets); });
}

/// Removes samples of an emitter from l.asked that rays of a call site would not hit. By lane: points in the batch, lights,
/// indices in asked_.
void BlockVertices::dropUnhit(const Site& s, const size_t* points, const BoundLight* const* of, const int32_t* queryOf,
                              LightBlock& l) const {
    for (Lanes left = l.asked; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        const size_t query = size_t(queryOf[i]);
        const shading::RaySet& set = s.raysAt(points[i]).set;
        const geometry::Shape& shape = *asked_[query].sample.shape;
        const Vec3 w(l.w[0][i], l.w[1][i], l.w[2][i]);
        bool hit = s.lighting || !set.only || set.only[world_.numberOfShape_.at(&shape)];
        // Sides 1: rays pass through the emitter from its back, so it sends nothing there.
        if (shape.oneSided() && set.sides != accel::Sides::Both && !(s.lighting && of[i]->mean))
            hit &= (dot(intersectsNormal(queries_[query].surface), w) >= 0) == (set.sides == accel::Sides::Back);
        if (!hit) l.asked &= ~(1u << i);
    }
}

/// Adds the light of samples of emitters to the sums of a waiting trace() that returns what it would be without occlusion.
/// value_: the lobes there. some: lanes that send it.
void BlockVertices::sumUnshadowed(const Site& s, const VertexBlock& points, const LobeBlock& lobe, const LightBlock& l,
                                  Lanes some, const BatchContext& c, const size_t* pointOf) {
    for (; some; some &= some - 1) {
        const size_t i = size_t(std::countr_zero(some)), point = pointOf[i];
        TraceSums* const of = accumulator_.sumsOf(c.targets[point]);
        if (!of) continue;
        const auto row3 = [&](const float(*r)[kBlock]) { return Color(r[0][i], r[1][i], r[2][i]); };
        const float fcos = value_[kRowFcos][i];
        Color light = row3(lobe.weight) * row3(points.weight) * row3(l.Cl);
        light *= row3(&value_[kRowColour]) / (fcos * float(drawsOf(s, point)));
        of->add(TraceSums::UnshadowedAreaLight, light * (fcos / l.density[i]));
    }
}

} // namespace alpenglow::integrator
