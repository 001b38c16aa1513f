// Guide rays for vertices in blocks of 16 (blockvertices.h).
#pragma once
#include "integrator/blockvertices.h"
#include "integrator/guiderays.h"

namespace alpenglow::integrator {

class BlockVertices::Guided {
public:
    explicit Guided(BlockVertices&, GuideRays&);
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
    Point pointOf(size_t block, int lane, const BatchContext&) const;
    void send(size_t block, int site, Lanes, BatchContext&, Sched&);
    BlockVertices& b_;
    GuideRays& guide_;
    std::vector<Point> points_; ///< over all blocks
    alignas(64) Row w_[3];      ///< directions of the guide rays of a block
};

} // namespace alpenglow::integrator
