// Arguments of a gather() statement, resolved when its kernel is bound.
#pragma once
#include "rsl/front/protocol.h"
#include "texture/skydirections.h"
#include "world/impl.h"
#include <algorithm>

namespace alpenglow::world {

/// One gather(): what its rays ask of what they hit, and where the answers go.
struct GatherSite {
    /// Where rays go: into the scene, nowhere (samplepattern), or toward samples of an environment map.
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
        rsl::ir::Kind kind = rsl::ir::Kind::Float; ///< of a component
    };
    int number = 0;                     ///< index of the statement in its kernel
    Category category = Category::Rays; ///< by the statement's category
    bool cosine = false;                ///< "distribution" "cosine"; else uniform
    int threshold = -1;                 ///< row of "othreshold"
    std::vector<Output> outputs;        ///< in the order of the rows
    /// Values sent to parameters of shaders at hits: argument rows.
    struct Sent {
        rsl::PairName::To to;
        std::string parameter; ///< name of the parameter
        rsl::ir::Kind kind;    ///< of an element
        int row;               ///< of the first element
        int lengthRow;         ///< of the number of elements; -1: no array
        int elements;          ///< at most
    };
    std::vector<Sent> sent;
    /// Whether values are sent to shaders of that kind.
    bool sendsTo(rsl::PairName::To to) const {
        return std::any_of(sent.begin(), sent.end(), [to](const Sent& s) { return s.to == to; });
    }
    int width = 1;                               ///< rows for a ray: whether it hit, then the outputs
    bool shades = false;                         ///< shaders must run at hits
    bool light = false;                          ///< and their light counts
    bool opacity = false, asks = false;          ///< requests surface:Oi; requests parameters and outputs of shaders
    const texture::SkyDirections* sky = nullptr; ///< owned by the world
};

/// Sets SiteInfo::gather for the call sites of a kernel.
void linkGathers(BoundKernel&, const rsl::CompiledKernel&, const WorldImpl&);

/// Names that gather() statements of shaders use.
struct GatheredNames {
    std::set<std::string> surface, displacement; ///< "x" of "surface:x", "displacement:x"
    /// Parameters that values are sent to, so that they vary from ray to ray: "x" of "send:surface:x", with the most elements.
    std::map<std::pair<rsl::PairName::To, std::string>, int> sent;
    /// Adds what a name of a gather() means. `length`: of the array behind it, -1: any.
    void add(const std::string& name, int length);
    /// Varying parameters of a shader, including those that numbers are sent to.
    std::vector<std::string> withSent(std::vector<std::string> varying, const ShaderInstance&, rsl::PairName::To) const;
    /// Parameters that take texts, or arrays of any length: ShaderInstance::sent.
    std::vector<rsl::SentParameter> sentTexts(const ShaderInstance&, rsl::PairName::To) const;
};

/// Adds the names that a shader file uses. True: some are no literals; then every text of the file is added, and the texts that
/// the scene gives its parameters may be names as well.
bool gatheredNames(const rsl::Program&, GatheredNames&);

} // namespace alpenglow::world
