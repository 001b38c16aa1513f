// Light path outputs (scene/lightpaths.h): PathRay::path from event to event. State 0 stays 0 and denotes an unclassified path.
#pragma once
#include "integrator/context.h"
#include "integrator/vertex.h"

namespace alpenglow::integrator {

struct StageSet;

/// Advances the automaton of light path outputs.
class LightPathStates final : Stage {
public:
    explicit LightPathStates(const StageSet&);
    /// The state after one more event.
    uint16_t next(uint16_t path, int32_t symbol) const { return path ? automaton->next(path, symbol) : 0; }
    /// State after scattering by a loop over lights, or by ambient(), with this label, toward w.
    uint16_t atLoop(const ShadePoint&, const PathRay&, const Vec3& w, int label) const;
    /// After scattering toward w, unit
    uint16_t atLobe(const LobeKind&, const RayKind&, bool delta, const ShadePoint&, const PathRay&, const Vec3& w) const;
    /// After the light at the end of the path.
    uint16_t atLight(uint16_t path, const BoundLight& l) const {
        return path ? automaton->next(path, lights[size_t(&l - world_.lights().data())]) : 0;
    }
    /// Photons count as reflected by a mirror, coming from a light without a label.
    uint16_t atPhotons(uint16_t path) const { return next(next(path, mirror), loopLight); }

    const scene::LightPaths* automaton = nullptr; ///< Settings::lightPaths, under path; null: no such outputs
    std::vector<int32_t> lights;                  ///< symbols, by light
    // Symbols of events without labels.
    int32_t straight = 0, volume = 0, object = 0, map = 0, loopLight = 0, mirror = 0;
    int loopLabel = -1, ambientLabel = -1;

private:
    int labelOf(const std::string&) const;
    mutable std::unordered_map<int32_t, int> labelOfRays_; ///< by interned text
    mutable std::unordered_map<const LobeKind*, int> labelOfLobe_;
};

} // namespace alpenglow::integrator
