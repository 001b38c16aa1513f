// subsurface(): what calls say of what lies below, and the walks that batches have asked for (subsurface.h follows them).
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"
#include "integrator/vertex.h"
#include "world/below.h"
#include <map>

namespace alpenglow::transport {

class OcclusionCalls;
struct StageSet;

class SubsurfaceWalks final : Stage {
public:
    explicit SubsurfaceWalks(const StageSet&);
    /// The lobe of a subsurface(): its rays walk below the surface.
    void request(BatchContext&, const SiteInfo&, const ShadePoint&, const std::function<float(int)>& row, LobeVertex&);
    /// Follows the walks that a batch has asked for.
    void walk(BatchContext&, Sched&);
    void clear();
    /// What Attribute "subsurface" says of a shape. Shapes with the same group bound one inside: those of a name, or of the same
    /// attributes.
    struct OfShape : SubsurfaceValues {
        using SubsurfaceValues::SubsurfaceValues;
        int group = 0;
    };
    const OfShape& ofShape(const scene::Attributes&);

    std::vector<Below> below;     ///< of Requests::lobes
    std::vector<WalkAsked> walks; ///< that the lobes of a batch have asked for; taken where these are done
    HalfSpaces halfSpaces;

private:
    int groupNamed(const std::string&);
    std::map<const scene::Attributes*, std::shared_ptr<const OfShape>> shapes_;
    std::map<std::string, int> groups_;
    const StageSet& set_;
    OcclusionCalls& occlusion_;
};

} // namespace alpenglow::transport
