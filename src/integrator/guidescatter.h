// Rays of the caustic guide from vertices, and what MIS needs to know of it at the others (guiderays.h). Reads
// VertexBlocks::sites after LobeSelection; sends rays.
#pragma once
#include "integrator/guiderays.h"
#include "integrator/vertexblocks.h"

namespace alpenglow::integrator {

class MediaStacks;

/// Sends the guide's rays from the vertices of a block.
class GuideScatter final : VertexStage {
public:
    GuideScatter(const StageSet&, const VertexStages&);
    /// The world has a guide.
    bool on() const { return guide_.on(); }
    /// Marks the rays of a block that were aimed by the guide.
    void mark(size_t block, const BatchContext&);
    /// After select(): sends the guide rays of all points.
    void run(BatchContext&, Sched&);
    /// After run(): sets trail and pdf of the next rays of a block where they depend on the lobe and the incoming ray.
    void keep(size_t block, const BatchContext&);

private:
    /// The lobe of a point that gets a guide ray, by call site; -1: none.
    struct Point {
        int site = -1;
        GuideRays::Aim aim;
    };
    int siteOf(size_t block, int lane, const BatchContext&, GuideRays::Query&) const;
    Lanes draw(size_t block, Lanes, const BatchContext&);
    void send(size_t block, int site, Lanes, BatchContext&, Sched&);
    GuideRays& guide_;
    MediaStacks& media_;
    std::vector<Point> points_; ///< over all blocks
    alignas(64) Row w_[3];      ///< directions of the guide rays of a block
};

} // namespace alpenglow::integrator
