// Guide, in blocks: guidescatter.h for vertices that are followed 16 at a time (blockvertices.h), with its bits.
#pragma once
#include "integrator/blockvertices.h"
#include "integrator/guiderays.h"

namespace alpenglow::transport {

class BlockVertices::Guided {
public:
    explicit Guided(BlockVertices&, GuideRays&);
    bool on() const { return guide_.on(); }
    /// Marks the points of a block whose rays the guide aimed.
    void mark(size_t block, const BatchContext&);
    /// Behind select(): sends the guide's rays of all points.
    void run(BatchContext&, Sched&);
    /// Behind run(): trail and pdf of the rays that go on from a block, where lobe and incoming ray say anything of them.
    void keep(size_t block, const BatchContext&);

private:
    /// The lobe of a point that the guide helps: number of its site; -1: none.
    struct Point {
        int site = -1;
        GuideRays::Aim aim;
    };
    Point pointOf(size_t block, int lane, const BatchContext&) const;
    void send(size_t block, int site, Lanes, BatchContext&, Sched&);
    BlockVertices& b_;
    GuideRays& guide_;
    std::vector<Point> points_; ///< of all blocks
    alignas(64) Row w_[3];      ///< directions of a block's rays
};

} // namespace alpenglow::transport
