// Data of the integrator's block stages: blocks of 16 points in rows. A row has one number for each point. No standard header
// beyond <cstdint>: code for newer processors must not leave a copy of a library's inline function for others.
#pragma once
#include "bsdf/lobelanes.h"
#include "lanes/names.h"
#include <cstdint>

namespace alpenglow::lanes {

inline constexpr int kBlock = kLobeBlock; ///< points of a block
using Row = float[kBlock];                ///< a number for each point
/// A set of points of a block, as bits: bit i is point i.
using Lanes = uint32_t;

/// Shaded points. Positions and directions in current space.
struct alignas(64) VertexBlock {
    Row P[3], n[3];  ///< the point; the unit geometric normal
    Row error;       ///< bound on the distance from P to the surface that rays hit
    Row bias;        ///< > 0: distance from P at which rays start, Attribute "trace" "bias"; 0: by `error`
    Row I[3];        ///< incident vector, of any length
    Row weight[3];   ///< throughput of the incoming ray
    Row clear[3];    ///< transparency, 0 to 1; valid if `through` is set
    Row beyond[3];   ///< what goes on behind the point: `clear`, except for photons at surfaces that are invisible from behind
    Row energyScale; ///< by select(): factor of indirect light for lighting shadeops (energy rule); 1 if reflectance is at most 1
    Row passes;      ///< by select() and pick(): probability of continuing behind the point; 1: in addition to lobes
    int32_t bounces[kBlock];                                           ///< of the incoming ray, since the camera
    uint32_t low[kBlock], high[kBlock], index[kBlock], vertex[kBlock]; ///< keys of random numbers: NumberBlock
    uint32_t lightVertex[kBlock];                                      ///< replaces `vertex` for light samples
    Lanes points = 0;
    Lanes guided = 0;       ///< points of guide rays: only mirrors are followed
    Lanes last = 0;         ///< points at the depth limit of the picture
    Lanes deep[2] = {0, 0}; ///< points where no specular ([0]), no diffuse ([1]) ray is sent, because of any depth limit
    bool through = false;   ///< some point is transparent
    bool waits = false;     ///< a kernel waits for each ray and reads its distance: rays without contribution are sent, too
};

/// The lobes that a call site requests at the points of a block.
struct alignas(64) LobeBlock {
    Row weight[3];       ///< of the request, without the ray's throughput
    Row lobe[kLobeRows]; ///< LobeRow
    Row chosen;          ///< by select(): probability of following its ray
    Lanes asked = 0;     ///< points whose lobe has a weight
    Lanes lights = 0;    ///< points whose lobe samples lights
    Lanes ownOrigin = 0; ///< by request(): points whose ray starts elsewhere
    Lanes stays = 0;     ///< points whose lobe sends no ray for another reason than depth
    Lanes ended = 0;     ///< by select(): points where a depth limit ends the ray that would have been sent
    Lanes failed = 0;    ///< by select(): points whose probability is not finite; no ray is sent
    Lanes narrow = 0;    ///< points where photons treat the lobe as a mirror, though it is no delta
    Lanes left = 0;      ///< of these: points where it leaves the lights that send photons to them
    Lanes boundless = 0; ///< points where only the depth limit of the picture ends its ray
    /// Empties all sets, for the next block; rows keep their values.
    void forget() { asked = lights = ownOrigin = stays = ended = failed = narrow = left = boundless = 0; }
};

/// Argument rows of a call: index after the weight, `stride` floats apart; -1: not given.
struct LobeArguments {
    int axis = -1;                     ///< not given: the normal
    int wo = -1, horizon = -1, a = -1; ///< rows of a triple or a number
    int from = -1;                     ///< trace(): where its ray starts
    int lights = -1;      ///< trace(): "samplearealights" or "samplelights"; points that say no are looked at one by one
    int samples = -1;     ///< trace(): how many rays it asks for; more than kMostSamples are reported point by point
    float otherwise = 0;  ///< `a` where there is no row
    float perRow = 0;     ///< > 0: `a` is this over the row
    bool needsWo = false; ///< the kind reads the direction toward the viewer
    bool traces = false;  ///< trace(): a direction of length 0 asks for nothing
    bool options = false; ///< trace(): it has parameters that are read point by point (integrator/blockoptions.cpp)
    /// Of distributions (DistributionParams): rows that are copied as they are, from kRowRoughness on; of those that are not
    /// given, the number that stands for them.
    bool surface = false;
    int rows[kRowAlbedo - kRowRoughness] = {};
    float numbers[kRowAlbedo - kRowRoughness] = {}; ///< values where rows[] is -1
};
inline constexpr float kMostSamples = 4096;

/// Samples of one light at the points of a block.
struct alignas(64) LightBlock {
    Row w[3];                              ///< unit, toward the light
    Row Cl[3];                             ///< its light there
    Row density;                           ///< of the sample: per steradian if rays can hit the light, else the divisor of Cl
    Row end[3];                            ///< emitters: end of the shadow ray
    Row far;                               ///< other lights: length of the shadow ray
    Row keptDiffuse, keptSpecular;         ///< fractions reflected by both kinds of lobes: __nondiffuse, __nonspecular
    Lanes asked = 0;                       ///< points with a sample
    Lanes metDiffuse = 0, metSpecular = 0; ///< points whose rays of these kinds could hit the light
    bool emitter = false;                  ///< `end` is set
    bool met = false;                      ///< rays can hit it: multiple importance sampling applies
    const float* draws = nullptr;          ///< a row, samples of the light that the lobe takes; null: one
    bool hasPart = false;                  ///< `part` is set
    Row part;                              ///< MIS weight of samples of this kind
};

/// An emitter of a few flat triangles with one normal each, current space: data for Emitter::sample().
struct FlatEmitter {
    static constexpr int kMost = 4; ///< most triangles
    int count = 0, cornerCount = 0; ///< triangles; different corners
    double corner[3 * kMost][3];    ///< unique corners
    int corners[kMost][3];          ///< of triangles
    float normal[kMost][3];         ///< unit
    // Near points are sampled uniformly by solid angle.
    double centre[3];
    double near2, least2;         ///< squared: near if closer to the centre; accurate if farther from a corner
    double mostAngle, leastAngle; ///< of a triangle; of all
    // Other points are sampled uniformly by area.
    double cumulative[kMost]; ///< areas, cumulative including this triangle
    double perArea;           ///< one over the total area
    bool oneSided = false;    ///< emits on one side only
};

/// Shadow rays of a block toward one light.
struct alignas(64) ShadowBlock {
    Row origin[3], direction[3], length; ///< camera space; direction: unit
    Row light[3];                        ///< by contribute(): unoccluded light
};

/// Continuing rays of paths from a block.
struct alignas(64) ScatterBlock {
    int32_t site[kBlock];             ///< by pick(): site of the selected lobe; -1: none
    Row scale;                        ///< one over the probability of that
    Row direction[3], colour[3], pdf; ///< by take: for that lobe; pdf is 0 for delta lobes
    Row request[3], spread, indirect; ///< of that lobe: weight, half angle in radians, and 1 if `energyScale` applies, else 0
    Row origin[3], weight[3];         ///< by extend()
    uint32_t vertex[kBlock];          ///< by name(): random number key
    Row dice;                         ///< for the roulette, in [0, 1)
    Lanes goes = 0, single = 0;       ///< single: delta lobes, without pdf
};

/// Rays in the layout of the queues: a row for each word of a scheduler task (integrator/raywords.h). A pointer takes two rows.
struct alignas(64) RayBlock {
    static constexpr int kWords = 32; ///< rows, and words of a task
    /// PathRay's members of these names.
    int32_t depth[kBlock], target[kBlock];
    Row origin[3], direction[3], maxDistance, weight[3];
    uint32_t sample[2][kBlock], kind[2][kBlock], media[2][kBlock];
    uint32_t vertex[kBlock];
    uint32_t bounces[kBlock];  ///< 16 bits each: all bounces, and diffuse ones in the upper half
    uint32_t specular[kBlock]; ///< specular bounces; layers in the upper half
    uint32_t path[kBlock];     ///< light path state; bounces in media in the upper half
    uint32_t flags[kBlock];    ///< requested rays; above them PathRay::first to passed, and the trail
    /// Members of PathRay and of its Footprint; `binding` and `extra` are indices, -1: none.
    Row pdf, lobeOrigin[3];
    int32_t binding[kBlock];
    Row width, spread;
    int32_t extra[kBlock];
    Row importance;
};

/// Roulette rule: none, by throughput, or by the weight of the followed lobe (bsdf/sampling.h).
enum class Roulette : uint8_t { None, Throughput, Local };

/// What select() must know of a call site.
struct SiteRules {
    bool lighting = false; ///< a lighting shadeop
    bool diffuse = false;  ///< its rays are diffuse
    bool endless = false;  ///< depth limits do not end its rays
};
/// Rules of select().
struct SelectRules {
    const SiteRules* sites = nullptr; ///< one for each site
    bool unbiased = false;            ///< disables the energy rule
    bool all = false;                 ///< each lobe is followed, with probability 1, instead of one of them
};
/// Further results of select(): points whose reflectance exceeds 1, alone or with transparency; points with probabilities that
/// are not finite.
struct Selected {
    Lanes bright = 0, brightWithClear = 0, failed = 0; ///< sets of points
    Lanes cut = 0;                                     ///< points of VertexBlock::last where a lobe would have been followed
};

} // namespace alpenglow::lanes
