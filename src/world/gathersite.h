// What a gather statement asks for, worked out when its kernel is bound.
#pragma once
#include "texture/skydirections.h"
#include "world/impl.h"

namespace alpenglow::transport {

struct GatherSite {
    enum class Category : uint8_t { Rays, Directions, Sky };
    /// Whose value an output is.
    enum class Of : uint8_t {
        Surface,
        Displacement,
        Volume, ///< parameters and outputs of the shaders at the hit
        Light,
        Opacity, ///< surface:Ci and surface:Oi, volume:Ci and volume:Oi
        Primitive,
        Attribute, ///< of what was hit
        Origin,
        Direction,
        Length, ///< of the ray
        SkyColor,
        SkyDirection,
        SkySolidAngle ///< of a sample of an environment map
    };
    /// A row that says whether there is a value, then the value: `rows` of them; of an open array its length stands first.
    struct Output {
        Of of;
        int32_t id = 0;                     ///< its name without the prefix, interned
        int at = 0, rows = 1, elements = 0; ///< elements: 0 of what is no array
        bool open = false;
        rsl::ir::Kind kind = rsl::ir::Kind::Float;
    };
    int number = 0; ///< of the statement in its kernel
    Category category = Category::Rays;
    bool cosine = false; ///< "distribution"; else uniform
    int threshold = -1;  ///< row of "othreshold"
    std::vector<Output> outputs;
    /// Values for parameters of the surface shaders that are met: rows of arguments.
    struct Sent {
        std::string parameter;
        int row, size;
    };
    std::vector<Sent> sent;
    int width = 1;                               ///< rows of a ray: whether it hit, then the outputs
    bool shades = false;                         ///< shaders must run where a ray hits
    bool light = false;                          ///< and what arrives from there counts
    bool opacity = false, asks = false;          ///< surface:Oi; parameters and outputs of shaders
    const texture::SkyDirections* sky = nullptr; ///< the world's
};

/// Fills SiteInfo::gather of the sites of a kernel.
void linkGathers(BoundKernel&, const rsl::CompiledKernel&, WorldImpl&);

/// What the gathers of shaders name.
struct GatheredNames {
    std::set<std::string> surface, displacement; ///< "x" of "surface:x", "displacement:x"
    std::set<std::string> sent;                  ///< "x" of "send:surface:x": parameters, which differ from ray to ray then
    /// Names of varying parameters of a shader, with those that values are sent to.
    std::vector<std::string> withSent(std::vector<std::string> varying, const ShaderInstance&) const;
};

/// Adds those of a file of shaders.
void gatheredNames(const rsl::Program&, GatheredNames&);

} // namespace alpenglow::transport
