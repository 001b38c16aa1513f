// Stages over blocks of points (blocks.h) at 4, 8 and 16 lanes, selected once by processor. Every width gives the same bits: a
// stage processes points independently, in a fixed order of operations.
//
//   request     what calls ask for: rows of lobes                    reads VertexBlock, the call's arguments; writes LobeBlock
//   select      which lobe is followed with which chance             reads LobeBlock; writes LobeBlock::chosen, energyScale
//   place       points of an emitter                                 reads VertexBlock, FlatEmitter; writes LightBlock and rows
//   aim         shadow rays to samples of a light                    reads VertexBlock, LightBlock; writes ShadowBlock
//   contribute  what a lobe gives back of that light                 reads all of these; writes ShadowBlock::light
//   pick        the lobe that chance decides for                     reads LobeBlock; writes ScatterBlock
//   take        what was drawn of one lobe, to its points            reads LobeBlock; writes ScatterBlock
//   name        the random number keys of the next vertices          reads VertexBlock; writes ScatterBlock::vertex
//   extend      the next rays: throughput, roulette, origin          reads VertexBlock, ScatterBlock; writes ScatterBlock
//   chooseLights which of many lights points ask                     reads LightTree; writes ChosenLight
//   load, store structures in memory to rows, and back               reads, writes RayBlock
#pragma once
#include "lanes/blocks.h"
#include "lanes/lighttree.h"

namespace alpenglow::lanes {

/// The stages of one lane width.
struct Stages {
    /// Sets the rows named by `needs` (LobeNeed) for the points of `asked`, and LobeBlock::asked, the points of nonzero weight,
    /// including weights, and LobeBlock::ownOrigin. Returns points that must be processed one by one: numbers that are not
    /// finite, directions whose square overflows or underflows.
    Lanes (*request)(const VertexBlock&, const LobeArguments&, const float* weight, int stride, Lanes asked, LobeBlock&);
    /// Sets LobeBlock::chosen, VertexBlock::energyScale and passes.
    Selected (*select)(VertexBlock&, LobeBlock* const* sites, int count, const SelectRules&);
    /// Samples a point on the emitter for each point of the block, by pairs of numbers in [0, 1); share: probabilities of
    /// choosing the emitter. Writes LightBlock::w, density and end, and P and N, three rows each, `stride` floats apart. Returns
    /// the points with a sample.
    Lanes (*place)(const VertexBlock&, const FlatEmitter&, const float* x, const float* y, const double* share, LightBlock&,
                   float* P, float* N, int stride);
    /// The same with an emitter for each point: kBlock pointers, none null.
    Lanes (*placeEach)(const VertexBlock&, const FlatEmitter* const* lamps, const float* x, const float* y, const double* share,
                       LightBlock&, float* P, float* N, int stride);
    /// For lights without geometry, from the direction L of their light (three rows): LightBlock::w, far and density. endless:
    /// lights without a position. Returns points that must be processed one by one because of the length of L.
    Lanes (*placeFar)(const float* L, int stride, bool endless, LightBlock&);
    /// Sets shadow rays from the points to the light: ShadowBlock::origin, direction and length.
    void (*aim)(const VertexBlock&, const LightBlock&, ShadowBlock&);
    /// Adds a lobe's response for points of LobeBlock::lights and LightBlock::asked. kept: a row, fraction of the light that the
    /// lobe reflects; met: points whose rays could hit the light; ahead: valid only if the emitter is along its direction. value:
    /// of the lobe toward the light, kValueRows. Returns points with a contribution; `failed`: points with values that are not
    /// numbers.
    Lanes (*contribute)(const VertexBlock&, const LobeBlock&, const LightBlock&, const float* kept, Lanes met, bool ahead,
                        const float* value, ShadowBlock&, Lanes* failed);
    /// Selects the lobe to follow, by one number in [0, 1) for each point: ScatterBlock::site and scale; sets VertexBlock::passes
    /// to 0 where a lobe is selected.
    void (*pick)(VertexBlock&, const LobeBlock* const* sites, int count, const float* number, ScatterBlock&);
    /// For points that follow the lobe of `site`: copies `drawn` (kDrawnRows) to ScatterBlock::direction, then `value`
    /// (kValueRows) of non-delta lobes to colour and pdf.
    void (*takeDirections)(const LobeBlock&, int site, bool lighting, const float* drawn, ScatterBlock&);
    void (*takeValues)(const LobeBlock&, int site, const float* value, ScatterBlock&);
    /// Sets ScatterBlock::vertex as childVertex() of services/random.h. key: number of the call site, by site.
    void (*name)(const VertexBlock&, const uint32_t* key, ScatterBlock&);
    /// Sets origin and weight; ends paths by the rule and ScatterBlock::dice. Returns points whose throughput is not finite.
    Lanes (*extend)(const VertexBlock&, Roulette, ScatterBlock&);
    /// Transposes structures of `words` words (at least 16) each, `stride` bytes apart, to a row for each word. Rows have kBlock
    /// numbers: after the first `count` structures the last one repeats.
    void (*load)(const void* from, int stride, int count, int words, void* rows);
    /// Writes the structures of some points consecutively, of 16 words or a multiple. Returns their number; the space of one more
    /// may be overwritten.
    int (*store)(const void* rows, int words, Lanes points, void* to);
    /// LightChooser::choose() for some points of a block: P, three rows, and a random number each. `to` needs space for
    /// LightTree::kMostChosen lights for each point. Returns their number; lights of a point are in no order.
    int (*chooseLights)(const LightTree&, const Row* P, const float* random, Lanes points, ChosenLight* to);
};

/// The stages at 4, 8 or 16 lanes; null if this processor cannot run that width.
const Stages* stages(int lanes);
/// The widest that this processor can run.
const Stages& stages();

} // namespace alpenglow::lanes
