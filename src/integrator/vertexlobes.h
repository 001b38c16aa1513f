// The lobes of a batch by point, and what all stages over them ask (gather.h).
#pragma once
#include "base/numberlanes.h"
#include "integrator/raystore.h"
#include "integrator/requests.h"
#include "integrator/stageset.h"
#include "integrator/surfacepoints.h"

namespace alpenglow::transport {

/// Requests::lobes of one batch, sorted by point.
class VertexLobes {
public:
    void begin(BatchContext&, std::span<const LobeVertex>);
    BatchContext* batch = nullptr;
    std::vector<int> first, order; ///< of point p the lobes order[first[p]] to order[first[p + 1]], as they were asked for

private:
    std::vector<int> next_;
};

/// A stage over them.
class VertexStage : protected Stage {
protected:
    VertexStage(const StageSet& s, const VertexLobes& v)
        : Stage(s.context), c_(v.batch), begin_(v.first), order_(v.order), requests_(s.requests), store_(s.store),
          surfaces_(s.surfaces) {}
    std::span<const int> lobesOf(size_t point) const {
        return std::span<const int>(order_).subspan(size_t(begin_[point]), size_t(begin_[point + 1] - begin_[point]));
    }
    const PathRay& rayOf(const LobeVertex& l) const { return c_->rays[size_t(l.point)]; }
    /// The key of a point's light samples: affine lobes of a vertex share them, each suspended request has its own.
    uint32_t lightVertex(size_t point) const;
    Vec3 origin(const LobeVertex&, const Vec3& w) const; ///< where a ray of a lobe in direction w starts
    /// A waiting kernel's result goes to the target of its own that has no shares; what it makes of it has those of its ray.
    int32_t shareOf(const LobeVertex& l) const {
        return l.ownsTarget ? -1 : l.share >= 0 ? l.share : store_.extraOf(rayOf(l)).share;
    }

    BatchContext* const& c_;
    const std::vector<int>&begin_, &order_;
    Requests& requests_;
    RayStore& store_;
    SurfacePoints& surfaces_;
};

} // namespace alpenglow::transport
