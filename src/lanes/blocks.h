// What the stages of the integrator read and write: blocks of 16 points, row by row. A row is a number of each point. No standard
// header beyond <cstdint>: what compiles for newer processors must not leave a copy of a library's inline function behind for
// others.
#pragma once
#include "lobes/lobelanes.h"
#include <cstdint>

namespace alpenglow::transport {

inline constexpr int kBlock = kLobeBlock; ///< points of a block
using Row = float[kBlock];
/// Points of a block, as bits: bit i is point i.
using Lanes = uint32_t;

/// Shaded points. Positions and directions in current space.
struct alignas(64) VertexBlock {
    Row P[3], n[3];  ///< the point; the unit normal of the geometry
    Row error;       ///< bound on the distance from P to the surface that rays meet
    Row bias;        ///< > 0: rays start so far from P along their direction, Attribute "trace" "bias"; 0: by `error`
    Row I[3];        ///< incident vector, of any length
    Row weight[3];   ///< throughput of the ray that came here
    Row clear[3];    ///< what of light from behind comes through, 0 to 1; counts where `through` is set
    Row energyScale; ///< by select(): of indirect light that lighting shadeops ask for; 1 where they reflect at most all light
    Row passes;      ///< by select() and pick(): the chance with which the ray goes on behind the point; 1: beside all others
    int32_t bounces[kBlock];
    uint32_t low[kBlock], high[kBlock], index[kBlock], vertex[kBlock]; ///< keys of random numbers: render::NumberBlock
    uint32_t lightVertex[kBlock];                                      ///< in the place of `vertex`, of light samples
    Lanes points = 0;
    Lanes guided = 0;     ///< points of rays that the caustic guide aimed: mirrors alone are followed
    Lanes last = 0;       ///< points whose lobes are not followed, for the path is as long as it may be
    bool through = false; ///< something comes through at some point
    bool waits = false;   ///< a kernel waits for each ray, which tells how far it goes: those that bring nothing are sent, too
};

/// What a call site of a kernel asks for at the points of a block: a lobe each.
struct alignas(64) LobeBlock {
    Row weight[3];       ///< of the request alone, before the ray's throughput
    Row lobe[kLobeRows]; ///< LobeRow
    Row chosen;          ///< by select(): the chance that its ray is followed
    Lanes asked = 0;
    Lanes lights = 0; ///< points whose lobe samples lights
};

/// Where a call's arguments lie: numbers of rows behind the weight, `stride` floats apart; -1: the call does not give it.
struct LobeArguments {
    int axis = -1, wo = -1, horizon = -1, a = -1;
    int from = -1;        ///< trace(): where its ray starts
    int lights = -1;      ///< trace(): "samplearealights" or "samplelights"; points that say no are looked at one by one
    int samples = -1;     ///< trace(): how many rays it asks for; more than kMostSamples are reported point by point
    float otherwise = 0;  ///< `a` where there is no row
    float perRow = 0;     ///< > 0: `a` is this over the row
    bool needsWo = false; ///< the kind reads the direction toward the viewer
    bool traces = false;  ///< trace(): a direction of length 0 asks for nothing
    /// Of distributions (DistributionParams): rows that are copied as they are, from kRowRoughness on; of those that are not
    /// given, the number that stands for them.
    bool surface = false;
    int rows[kRowAlbedo - kRowRoughness] = {};
    float numbers[kRowAlbedo - kRowRoughness] = {};
};
inline constexpr float kMostSamples = 4096;

/// Samples of one light at the points of a block.
struct alignas(64) LightBlock {
    Row w[3];                      ///< toward the light, unit
    Row Cl[3];                     ///< its light there
    Row density;                   ///< of the sample: per steradian where rays can meet the light, else what Cl is divided by
    Row end[3];                    ///< of an emitter: where the shadow ray ends
    Row far;                       ///< of another light: how far the shadow ray goes
    Row keptDiffuse, keptSpecular; ///< what lobes of either kind take of it: __nondiffuse, __nonspecular
    Lanes asked = 0;
    Lanes metDiffuse = 0, metSpecular = 0; ///< rays of these kinds could meet the light by chance
    bool emitter = false;                  ///< `end` counts
    bool met = false;                      ///< rays can meet it: multiple importance sampling
    bool parted = false;                   ///< `part` counts
    Row part;                              ///< what samples like these have of the light; others have the rest
};

/// An emitter of a few flat triangles with normals of their own, current space: how Emitter::sample() draws its points.
struct FlatEmitter {
    static constexpr int kMost = 4;
    int count = 0, cornerCount = 0;
    double corner[3 * kMost][3]; ///< each once
    int corners[kMost][3];       ///< of triangles
    float normal[kMost][3];      ///< unit
    // Near by, points are even in the solid angle of the triangles.
    double centre[3];
    double near2, least2; ///< squared distances from the centre below which it is near, from a corner above which it is sure
    double mostAngle, leastAngle; ///< of a triangle; of all
    // Else even in area.
    double cumulative[kMost]; ///< areas, up to and with this triangle
    double perArea;           ///< one over the area of all
    bool oneSided = false;    ///< gives no light behind
};

/// Shadow rays of a block toward one light.
struct alignas(64) ShadowBlock {
    Row origin[3], direction[3], length;
    Row light[3]; ///< by contribute(): what arrives along it if nothing stands between
};

/// The rays on which paths go on from a block.
struct alignas(64) ScatterBlock {
    int32_t site[kBlock];             ///< by pick(): whose lobe is followed; -1: none
    Row scale;                        ///< one over the chance of that
    Row direction[3], colour[3], pdf; ///< by take: of that lobe; pdf 0 where it is a single direction
    Row request[3], spread, indirect; ///< of that lobe: weight, half angle in radians, and 1 where `energyScale` counts, else 0
    Row origin[3], weight[3];         ///< by extend()
    uint32_t vertex[kBlock];          ///< by name(): key of random numbers
    Row dice;
    Lanes goes = 0, single = 0; ///< single: pdf is none, the lobe is a single direction
};

/// Rays, as the queues hold them: a row for each word of a task of the scheduler (integrator/raywords.h). Two rows are a pointer.
struct alignas(64) RayBlock {
    static constexpr int kWords = 32;
    int32_t depth[kBlock], target[kBlock];
    Row origin[3], direction[3], maxDistance, weight[3];
    uint32_t sample[2][kBlock], kind[2][kBlock], media[2][kBlock];
    uint32_t vertex[kBlock];
    uint32_t bounces[kBlock];  ///< 16 bits each: all, and diffuse ones above
    uint32_t specular[kBlock]; ///< bounces; layers above
    uint32_t path[kBlock];     ///< state of light paths; bounces in media above
    uint32_t flags[kBlock];    ///< rays asked for; above them PathRay::first to passed, and the trail
    Row pdf, lobeOrigin[3];
    int32_t binding[kBlock];
    Row width, spread;
    int32_t extra[kBlock];
    Row importance;
};

/// What ends paths by chance: nothing, their throughput, or what the lobe that is followed weighs (lobes/sampling.h).
enum class Roulette : uint8_t { None, Throughput, Local };

/// How select() weighs lobes.
struct SelectRules {
    uint32_t lighting = 0; ///< bit i: site i is of a lighting shadeop
    bool unbiased = false; ///< lobes may give back more than they receive
};
/// What select() has found out besides: points where lobes give back too much by themselves, or with what comes through; and
/// those whose chances are not finite.
struct Selected {
    Lanes bright = 0, brightWithClear = 0, failed = 0;
    Lanes cut = 0; ///< points of VertexBlock::last where a lobe would have been followed
};

} // namespace alpenglow::transport
