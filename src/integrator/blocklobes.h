// What a call site of a kernel asks for at the points of a batch, in blocks.
#pragma once
#include "base/numberblock.h"
#include "integrator/beside.h"
#include "lanes/blocks.h"
#include "lobes/lobelanes.h"
#include "shading/point.h"
#include "world/arealight.h"
#include "world/sites.h"

namespace alpenglow::transport {

/// A call site of the kernel that asks for lobes of some points.
struct BlockLobes {
    int number = 0;                 ///< of the kernel, or kFlight
    const SiteInfo* info = nullptr; ///< null: no call, but a medium that scatters
    const LobeKind* kind = nullptr;
    const LobeLanes* lanes = nullptr;
    const RayKind* rays = nullptr;
    bool lighting = false; ///< a lighting shadeop
    bool lights = false;   ///< its lobe samples lights
    bool diffuse = false;  ///< of its rays
    std::vector<LobeBlock> lobes;
    std::vector<Beside> beside; ///< by point, lights that its rays may pass; empty: none do
    std::vector<float> narrow;  ///< of kernels with strips below a block: arguments, by block

    /// Points of a block whose lobe may be followed and spreads light.
    Lanes spreads(size_t block) const;
    /// Beside::weigh() for the points of a block. value: room for kValueRows.
    void weighBeside(size_t block, Row* value);
    /// Makes densities of lobes alone, toward w, those of all draws. pointOf: by lane, the point of the batch.
    void addBeside(Lanes, const Row* w, const size_t* pointOf, float* pdf) const;
    /// Draws directions by u, some of them beside lights, to `drawn`, kDrawnRows.
    void draw(size_t block, Lanes, render::NumberBlock& u, Row* drawn) const;
};

/// A sample of a light for a point in a medium, and what the medium makes of light from there.
struct BlockLit {
    size_t point;
    Vec3 w, end; ///< toward the light, unit; of an emitter where the way to it ends
    Color Cl;
    float density, far, kept, phase; ///< as in LightBlock; kept: by diffuse lobes
    float shadowRadius;              ///< LightValue
    Vec3 L;                          ///< where that is not 0
};

/// What a light is asked at points.
struct BlockQuery {
    int point = 0;
    Emitter::Sample sample;
};

/// Points that have one of a light; of these, those whose rays could meet it by chance.
struct BlockPlaced {
    Lanes points = 0, metDiffuse = 0, metSpecular = 0;
};

} // namespace alpenglow::transport
