// subsurface(): parameters of the material from calls and attributes, and the requested walks (subsurface.h follows them).
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"
#include "integrator/vertex.h"
#include "world/subsurfacemedium.h"
#include <map>

namespace alpenglow::integrator {

class OcclusionCalls;
struct StageSet;

/// Collects subsurface walks.
class SubsurfaceWalks final : Stage {
public:
    explicit SubsurfaceWalks(const StageSet&);
    /// Parameters of a subsurface() call at a point.
    SubsurfaceMedium mediumOf(const SiteInfo&, const ShadePoint&, const std::function<float(int)>& row);
    /// Makes the lobe of a subsurface() call: its rays walk below the surface.
    void request(BatchContext&, const SiteInfo&, const ShadePoint&, const std::function<float(int)>& row, LobeVertex&);
    /// Follows the walks that a batch has requested.
    void walk(BatchContext&, Sched&);
    /// Drops the walks that are requested.
    void clear();
    /// Attribute "subsurface" of a shape. Shapes of the same group bound one inside: shapes that give the same name, or share
    /// attributes.
    struct OfShape : SubsurfaceValues {
        using SubsurfaceValues::SubsurfaceValues;
        int group = 0;
    };
    /// Computed at first use.
    const OfShape& ofShape(const scene::Attributes&);

    std::vector<SubsurfaceMedium> media; ///< for Requests::lobes
    std::vector<WalkAsked> walks;        ///< requested by the lobes of a batch; removed when these are done
    AlbedoInversions albedoInversions;   ///< of this thread

private:
    int groupNamed(const std::string&);
    std::map<const scene::Attributes*, std::shared_ptr<const OfShape>> shapes_;
    std::map<std::string, int> groups_;
    const StageSet& set_;
    OcclusionCalls& occlusion_;
};

} // namespace alpenglow::integrator
