// What a call site of a kernel asks for at the points of a batch, in blocks.
#pragma once
#include "lanes/blocks.h"
#include "lobes/lobelanes.h"
#include "shading/point.h"
#include "world/arealight.h"
#include "world/sites.h"

namespace alpenglow::transport {

/// A call site of the kernel that asks for lobes of some points.
struct BlockLobes {
    int number = 0; ///< of the kernel
    const SiteInfo* info = nullptr;
    const LobeLanes* lanes = nullptr;
    const RayKind* rays = nullptr;
    bool lighting = false; ///< a lighting shadeop
    bool lights = false;   ///< its lobe samples lights
    bool diffuse = false;  ///< of its rays
    std::vector<LobeBlock> lobes;
    std::vector<float> narrow; ///< of kernels with strips below a block: arguments, by block
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
