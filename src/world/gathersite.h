// Arguments of a gather() statement, resolved when its kernel is bound.
#pragma once
#include "texture/skydirections.h"
#include "world/impl.h"

namespace alpenglow::transport {

struct GatherSite {
    enum class Category : uint8_t { Rays, Directions, Sky };
    /// The source of an output's value.
    enum class Of : uint8_t {
        Surface,
        Displacement,
        Volume, ///< parameters and outputs of shaders at the hit
        Light,
        Opacity, ///< surface:Ci and surface:Oi, volume:Ci and volume:Oi
        Primitive,
        Attribute, ///< of the primitive that was hit
        Origin,
        Direction,
        Length, ///< of the ray
        SkyColor,
        SkyDirection,
        SkySolidAngle ///< of a sample of an environment map
    };
    /// A presence row, then `rows` rows of values; an open array begins with its length.
    struct Output {
        Of of;
        int32_t id = 0;                     ///< name without prefix, interned
        int at = 0, rows = 1, elements = 0; ///< elements: 0 if not an array
        bool open = false;
        rsl::ir::Kind kind = rsl::ir::Kind::Float;
    };
    int number = 0; ///< index of the statement in its kernel
    Category category = Category::Rays;
    bool cosine = false; ///< "distribution" "cosine"; else uniform
    int threshold = -1;  ///< row of "othreshold"
    std::vector<Output> outputs;
    /// Values sent to parameters of surface shaders at hits: argument rows.
    struct Sent {
        std::string parameter;
        int row, size;
    };
    std::vector<Sent> sent;
    int width = 1;                               ///< rows for a ray: whether it hit, then the outputs
    bool shades = false;                         ///< shaders must run at hits
    bool light = false;                          ///< and their light counts
    bool opacity = false, asks = false;          ///< requests surface:Oi; requests parameters and outputs of shaders
    const texture::SkyDirections* sky = nullptr; ///< owned by the world
};

/// Sets SiteInfo::gather for the call sites of a kernel.
void linkGathers(BoundKernel&, const rsl::CompiledKernel&, WorldImpl&);

/// Names that gather() statements of shaders use.
struct GatheredNames {
    std::set<std::string> surface, displacement; ///< "x" of "surface:x", "displacement:x"
    std::set<std::string> sent;                  ///< "x" of "send:surface:x": parameters that then vary from ray to ray
    /// Varying parameters of a shader, including those that values are sent to.
    std::vector<std::string> withSent(std::vector<std::string> varying, const ShaderInstance&) const;
};

/// Adds the names that a shader file uses.
void gatheredNames(const rsl::Program&, GatheredNames&);

} // namespace alpenglow::transport
