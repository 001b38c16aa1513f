// The lobes that a call site requests at the points of a batch, in blocks of 16.
#pragma once
#include "base/numberblock.h"
#include "bsdf/lobelanes.h"
#include "integrator/lightdirected.h"
#include "integrator/rayoptions.h"
#include "integrator/rays.h"
#include "integrator/vertex.h"
#include "lanes/blocks.h"
#include "shading/point.h"
#include "world/arealight.h"
#include "world/sites.h"
#include <algorithm>
#include <span>

namespace alpenglow::integrator {

/// A call site of the kernel that requests lobes.
struct BlockLobes {
    int number = 0;                   ///< call site of the kernel, or kSegmentEvent
    const SiteInfo* info = nullptr;   ///< null: the phase function of a medium, not a call
    const LobeKind* kind = nullptr;   ///< which lobe the site requests
    const LobeLanes* lanes = nullptr; ///< its code at the width in use
    const RayKind* rays = nullptr;    ///< of the rays that its lobes send
    bool lighting = false;            ///< a lighting shadeop
    bool lights = false;              ///< its lobe samples lights
    bool diffuse = false;             ///< its rays are diffuse
    bool apart = false;               ///< indirectdiffuse(): diffuse lobes of its points leave the light of surfaces to it
    bool direct = false;              ///< diffuse() where another call adds the light of surfaces
    bool walks = false;               ///< subsurface(): its rays walk below the surface
    bool sets = false; ///< rays of a trace() that hit other surfaces, or other sides, than rays of lighting shadeops
    uint32_t nth = 0;  ///< how many calls of a strip at this call site came before, in a loop
    std::vector<LobeBlock> lobes;
    std::vector<LightDirected> lightDirected; ///< by point: light-directed sampling (lightdirected.h); empty: none
    std::vector<float> narrow;                ///< arguments, by block, for kernels whose strips are narrower than a block
    std::vector<const float*> rows;           ///< by block: arguments of its first point, `stride` floats apart
    int stride = 0;                           ///< floats from one row to the next
    std::vector<RayOptions> options;          ///< by point; empty: none
    /// By point: the request, if it was made point by point (Requests::lobes); null: none. Empty: `rows` hold the arguments.
    std::vector<const LobeVertex*> requests;
    const LobeVertex* requestAt(size_t point) const { return requests.empty() ? nullptr : requests[point]; }
    /// How many rays the request at a point asks for, if all lobes are followed.
    int samplesAt(size_t point) const { return options.empty() ? 1 : options[point].samples; }
    /// Whether its lobe samples lights, if it is no delta.
    bool lightsAt(size_t point) const { return requests.empty() || !requests[point] ? lights : requests[point]->lights; }
    /// Rays that its lobe sends.
    const RayKind& raysAt(size_t point) const { return requests.empty() || !requests[point] ? *rays : *requests[point]->rays; }
    /// By point, for further calls of a call site: how many of the earlier ones had a weight.
    std::vector<uint32_t> occurrence;
    /// As `occurrence`; 0 where it is empty.
    uint32_t occurrenceAt(size_t point) const { return occurrence.empty() ? 0 : occurrence[point]; }

    /// Makes room for a batch and forgets the previous one: no lobe is asked for.
    void begin(size_t blocks) {
        lobes.resize(std::max(lobes.size(), blocks));
        for (size_t b = 0; b < blocks; ++b) lobes[b].forget();
        walks = apart = direct = sets = false;
        nth = 0;
        narrow.clear();
        occurrence.clear();
        options.clear();
        requests.clear();
        rows.clear();
    }
    /// Points of a block whose lobe may be followed and is not a delta.
    Lanes spreads(size_t block) const;
    /// LightDirected::weigh() for the points of a block. value: space for kValueRows rows.
    void weighLightDirected(size_t block, Row* value);
    /// Turns pdf toward w from the density of the lobes alone into the mixture density. pointOf: by lane, index in the batch.
    void addLightDirected(Lanes, const Row* w, const size_t* pointOf, float* pdf) const;
    /// Samples directions by u, some of them toward lights, and writes kDrawnRows rows to `drawn`.
    void draw(size_t block, Lanes, NumberBlock& u, Row* drawn) const;
};

/// A light sample for a point in a medium, and the value of the phase function there.
struct BlockLit {
    size_t point;
    Vec3 w, end;                     ///< w: unit, toward the light; end: end of the shadow ray at an emitter
    Color Cl;                        ///< radiance of the sample over its density, as Cl of the light
    float density, far, kept, phase; ///< as in LightBlock; kept: by diffuse lobes
    float shadowRadius;              ///< LightValue
    Vec3 L;                          ///< valid if shadowRadius is not 0
};

/// A light sample to be evaluated by a light's kernel.
struct BlockQuery {
    int point = 0; ///< index in the batch
    Emitter::Sample sample;
};

/// Points that have a sample of one light; of these, those whose diffuse or specular rays could hit the light.
struct BlockPlaced {
    Lanes points = 0, metDiffuse = 0, metSpecular = 0; ///< sets of points of the block
};

} // namespace alpenglow::integrator
