// A light sample for a shaded point: its position on the light, and the point at which the light's kernel runs.
#pragma once
#include "integrator/rays.h"
#include "lanes/blocks.h"
#include "world/lightguide.h"

namespace alpenglow::integrator {

/// The random numbers of a light sample.
struct LightNumbers {
    Vec2 pair;        ///< in [0, 1)
    float choose = 0; ///< selects a shape of the emitter
};
/// Whether a light uses LightNumbers::pair. `path`: under the hider path, which samples cones.
inline bool takesPair(const BoundLight& l, bool path) { return l.kind == LightKind::Area || l.isSky() || (l.cone && path); }
/// Whether it uses LightNumbers::choose.
inline bool takesChoice(const BoundLight& l) { return l.kind == LightKind::Area && l.emitter->chooses(); }

/// Copies the inputs of the light's kernel from the lit point (Ps, Ns, I, E, du, dv, time) to a query. Current space.
void takeLitPoint(ShadePoint& query, const ShadePoint& lit);
/// The origin of the light's shader space in current space: P of a light without geometry. shutter: 0 to 1.
Vec3 originOfLight(const ShaderInstance&, float shutter);
/// The guide of a light's samples at surfaces under path; null: none.
const LightGuide* guideOf(const WorldImpl&, const BoundLight&);
/// How a light sample is drawn where the light has a guide.
struct GuidedDraw {
    const LightGuide::Cell* cell = nullptr; ///< null: by the light's own density
    bool toward = false;                    ///< in a direction of the guide
    /// x: number in [0, 1) that decides, then uniform in [0, 1) again.
    GuidedDraw(const LightGuide*, const Vec3& from, float& x);
};
/// The same for a block of points.
struct GuidedLanes {
    Lanes guided = 0, toward = 0;         ///< points with a cell; with a direction of the guide
    const LightGuide::Cell* cell[kBlock]; ///< by point; null: the light has no guide there
    /// x of the points' numbers as in GuidedDraw.
    GuidedLanes(const LightGuide*, const VertexBlock&, Lanes points, float* x);
};
/// Samples the point on the light for a query filled by takeLitPoint(). guide: null: by the light's own density. Returns false if
/// the sample carries no light.
bool placeLightSample(const WorldImpl&, const BoundLight&, const LightGuide* guide, const LightNumbers&, bool path,
                      ShadePoint& query, Emitter::Sample&);

} // namespace alpenglow::integrator
