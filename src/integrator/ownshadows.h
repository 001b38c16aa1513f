// Shadow rays of one call site, for vertices in blocks (blockvertices.h): calls with a bias, a limit of distance or a ray set
// share none with other calls at their point.
#pragma once
#include "integrator/blockvertices.h"

namespace alpenglow::integrator {

/// While it lives, the shadow rays of a block are those of this call site alone, if it needs its own; then the common ones are
/// back.
class BlockVertices::OwnShadows {
public:
    OwnShadows(BlockVertices& b, const Site& s) : b_(b), own_(!s.options.empty() || s.sets) {
        if (!own_) return;
        shadow_ = b.shadow_;
        std::copy_n(b.sent_, kBlock, sent_);
        std::fill_n(b.sent_, kBlock, -1);
    }
    OwnShadows(const OwnShadows&) = delete;
    OwnShadows& operator=(const OwnShadows&) = delete;
    ~OwnShadows() {
        if (!own_) return;
        b_.shadow_ = shadow_;
        std::copy_n(sent_, kBlock, b_.sent_);
    }
    /// Sets the rays, and removes samples from l.asked that rays of the call site would not hit. By lane: points in the batch,
    /// lights, and indices in asked_.
    void limit(const Site& s, const size_t* points, const BoundLight* const* lights, const int32_t* queries, LightBlock& l) {
        if (!s.options.empty()) b_.limitShadows(s, points, lights, l);
        if (b_.checksHits_) b_.dropUnhit(s, points, lights, queries, l);
    }

private:
    BlockVertices& b_;
    const bool own_;
    ShadowBlock shadow_;
    int32_t sent_[kBlock]; ///< VertexBlocks::sent_
};

} // namespace alpenglow::integrator
