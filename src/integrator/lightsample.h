// A sample of a light for a shaded point: where on the light it lies, and the point that the light's kernel runs at.
#pragma once
#include "integrator/rays.h"

namespace alpenglow::transport {

/// The random numbers of a sample.
struct LightNumbers {
    Vec2 pair;
    float choose = 0; ///< of emitters that choose among shapes
};
/// Whether a light takes LightNumbers::pair. `path`: under that hider, where cones are sampled.
inline bool takesPair(const BoundLight& l, bool path) { return l.kind == LightKind::Area || l.sky || (l.cone && path); }
inline bool takesChoice(const BoundLight& l) { return l.kind == LightKind::Area && l.emitter->chooses(); }

/// Copies what the light's kernel reads of the lit point (Ps, Ns, I, E, du, dv, time) to a query of the light. Current space.
void tellLit(ShadePoint& query, const ShadePoint& lit);
/// The origin of a light's shader space, current space: P of a light without geometry.
Vec3 originOfLight(const ShaderInstance&, float shutter);
/// The point of the light, for a query that tellLit() has filled. False: this draw brings nothing.
bool placeLightSample(const WorldImpl&, const BoundLight&, const LightNumbers&, bool path, ShadePoint& query, Emitter::Sample&);

} // namespace alpenglow::transport
