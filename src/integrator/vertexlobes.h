// The lobes of a batch by point, and functions that the stages of vertexsampling.h share.
#pragma once
#include "base/numberlanes.h"
#include "integrator/raystore.h"
#include "integrator/requests.h"
#include "integrator/stageset.h"
#include "integrator/surfacepoints.h"

namespace alpenglow::integrator {

/// Requests::lobes of one batch, sorted by point.
class VertexLobes {
public:
    void begin(BatchContext&, std::span<const LobeVertex>);
    BatchContext* batch = nullptr;
    std::vector<int> first, order; ///< lobes of point p in request order: order[first[p]] to order[first[p + 1]], exclusive

private:
    std::vector<int> next_;
};

/// Base of the stages over them.
class VertexStage : protected Stage {
protected:
    VertexStage(const StageSet& s, const VertexLobes& v)
        : Stage(s.context), c_(v.batch), begin_(v.first), order_(v.order), requests_(s.requests), store_(s.store),
          surfaces_(s.surfaces) {}
    std::span<const int> lobesOf(size_t point) const {
        return std::span<const int>(order_).subspan(size_t(begin_[point]), size_t(begin_[point + 1] - begin_[point]));
    }
    const PathRay& rayOf(const LobeVertex& l) const { return c_->rays[size_t(l.point)]; }
    /// Random number key of a point's light samples: affine lobes of a vertex share it, each suspended request has its own.
    uint32_t lightVertex(size_t point) const;
    Vec3 origin(const LobeVertex&, const Vec3& w) const; ///< origin of a lobe's ray in direction w
    /// Results of a waiting kernel go to a target of its own without shares; the kernel's value then has those of its ray.
    int32_t shareOf(const LobeVertex& l) const {
        return l.ownsTarget ? -1 : l.share >= 0 ? l.share : store_.extraOf(rayOf(l)).share;
    }

    BatchContext* const& c_;
    const std::vector<int>&begin_, &order_;
    Requests& requests_;
    RayStore& store_;
    SurfacePoints& surfaces_;
};

} // namespace alpenglow::integrator
