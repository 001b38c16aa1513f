// The stages that work on blocks of points (blocks.h), at 4, 8 and 16 lanes; the processor chooses once. Every width gives the
// same bits: a stage works point by point, never on two of them, in a fixed order of operations.
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

namespace alpenglow::transport {

struct Stages {
    /// Fills the rows that `needs` (LobeNeed) names for points of `asked` and LobeBlock::asked, weights included, with those
    /// whose weight is not 0. Returns the points that one by one must be looked at: numbers that are not finite, directions whose
    /// square no float holds, rays that do not start at the point.
    Lanes (*request)(const VertexBlock&, const LobeArguments&, const float* weight, int stride, Lanes asked, LobeBlock&);
    /// LobeBlock::chosen, VertexBlock::energyScale and passes.
    Selected (*select)(VertexBlock&, LobeBlock* const* sites, int count, const SelectRules&);
    /// A point of the emitter for each of the block, by pairs of numbers, 0 to 1; share: the chances with which the emitter was
    /// chosen. Writes LightBlock::w, density and end, and P and N, three rows each, `stride` floats apart. Returns the points
    /// that have one.
    Lanes (*place)(const VertexBlock&, const FlatEmitter&, const float* x, const float* y, const double* share, LightBlock&,
                   float* P, float* N, int stride);
    /// The same where each point has an emitter of its own: so many pointers as a block has points, none null.
    Lanes (*placeEach)(const VertexBlock&, const FlatEmitter* const* lamps, const float* x, const float* y, const double* share,
                       LightBlock&, float* P, float* N, int stride);
    /// Of lights without geometry, by the way L from them (three rows): LightBlock::w, far and density. endless: they stand
    /// nowhere.
    /// Returns the points whose L is of a length that one by one must be looked at.
    Lanes (*placeFar)(const float* L, int stride, bool endless, LightBlock&);
    /// Shadow rays from the points toward the light: ShadowBlock::origin, direction and length.
    void (*aim)(const VertexBlock&, const LightBlock&, ShadowBlock&);
    /// For points of LobeBlock::lights and LightBlock::asked. kept: a row, what the lobe takes of the light; met: points from
    /// where its rays could meet the light; ahead: only where the way to the emitter is along its direction. value: of the lobe
    /// toward the light, kValueRows. Returns the points where something arrives; `failed`: gets those where the value is not a
    /// number.
    Lanes (*contribute)(const VertexBlock&, const LobeBlock&, const LightBlock&, const float* kept, Lanes met, bool ahead,
                        const float* value, ShadowBlock&, Lanes* failed);
    /// Which lobe is followed, by one number a point, 0 to 1: ScatterBlock::site and scale; VertexBlock::passes is 0 where one
    /// is.
    void (*pick)(VertexBlock&, const LobeBlock* const* sites, int count, const float* number, ScatterBlock&);
    /// For points that follow the lobe of `site`: `drawn` (kDrawnRows) becomes ScatterBlock::direction, then `value` (kValueRows)
    /// of lobes that spread colour and pdf.
    void (*takeDirections)(const LobeBlock&, int site, bool lighting, const float* drawn, ScatterBlock&);
    void (*takeValues)(const LobeBlock&, int site, const float* value, ScatterBlock&);
    /// ScatterBlock::vertex, as childVertex() of answers/random.h. key: by site, the call site's number.
    void (*name)(const VertexBlock&, const uint32_t* key, ScatterBlock&);
    /// Paths end by the rule and ScatterBlock::dice. Returns points whose throughput is not finite.
    Lanes (*extend)(const VertexBlock&, Roulette, ScatterBlock&);
    /// Structures of `words` words (at least 16) each, `stride` bytes apart, to a row for each word. Rows have kBlock numbers:
    /// behind the first `count` structures the last one stands again.
    void (*load)(const void* from, int stride, int count, int words, void* rows);
    /// The structures of some points one behind the other, of 16 words or a multiple. Returns how many; what one more would take
    /// is overwritten.
    int (*store)(const void* rows, int words, Lanes points, void* to);
    /// LightChooser::choose() for some points of a block: P, three rows, and a random number each. Room for
    /// LightTree::kMostChosen a point. Returns how many; those of a point are in no order.
    int (*chooseLights)(const LightTree&, const Row* P, const float* random, Lanes points, ChosenLight* to);
};

/// The stages at 4, 8 or 16 lanes; null where this processor cannot run that.
const Stages* stages(int lanes);
/// The widest that this processor runs.
const Stages& stages();

} // namespace alpenglow::transport
