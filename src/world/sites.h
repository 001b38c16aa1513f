// What the call sites of a kernel mean, worked out when the kernel is bound, so that no name is compared while it runs.
#pragma once
#include "accel/accel.h"
#include "lanes/blocks.h"
#include "lobes/lobe.h"
#include "rsl/compiler.h"
#include "rsl/front/protocol.h"
#include "shading/batch.h"
#include "texture/texture.h"
#include <atomic>
#include <mutex>

namespace alpenglow::transport {

using shading::RayType;
using shading::ShadePoint;
class WorldImpl;

/// The kind of a ray as visibility masks know it.
inline uint32_t visibilityBit(RayType t) {
    switch (t) {
    case RayType::Camera:
        return accel::kCamera;
    case RayType::Diffuse:
        return accel::kDiffuse;
    case RayType::Specular:
        return accel::kSpecular;
    default:
        return accel::kTransmission;
    }
}

/// What a call that sends rays says of them (3Delight manual, table 6.10). Rows of arguments, or -1.
struct RaySite {
    int bias = -1, maxDistance = -1, maxHit = -1, cone = -1, samples = -1, base = -1;
    int subset = -1, exclude = -1, sides = -1, mode = -1, label = -1,
        type = -1; ///< strings that are known only when the shader runs
    std::string subsetText, excludeText;
    int32_t subsetId = 0, excludeId = 0; ///< the same, interned
    shading::RaySet set;                 ///< what is known beforehand
    RayType rays = RayType::Specular;
    bool fixed = false;     ///< nothing of the set, the label and the type is known only when the shader runs
    bool saysSides = false; ///< "hitsides" is given
};

/// "falloff" and "falloffmode" of a hemisphere: rows, or -1.
struct FadeSite {
    int strength = -1, mode = -1;
};

/// Whether light of a hemisphere may be interpolated between records (world/records.h). Rows, or -1.
struct RecordSite {
    int variation = -1, pixels = -1; ///< "maxvariation", "maxpixeldist"
    uint64_t call = 0;               ///< what tells this call from others; 0: it asks for what is not kept in records
};

/// Where the rarer parameters of a trace() lie.
struct TraceSite {
    int udir = -1, roughness = -1, roughnessv = -1, absorption = -1, tint = -1, weight = -1; ///< rows, or -1
    int distribution = -1;                ///< the row of a name that is known only when the shader runs
    std::vector<std::pair<int, int>> eta; ///< row, components
    std::vector<int> lobes;               ///< rows of the elements of "lobeparameters"
    int part = -1;                        ///< of the form that gives an array
    texture::Handle map = nullptr;        ///< "environmentmap"
    Matrix toMap;                         ///< current to "environmentspace"
    bool sums = false;                    ///< it asks for transmission or for parts of the result
    bool onlyLights = false;              ///< for nothing but what area lights send
    bool hemisphere = false;              ///< of indirectdiffuse(): no "samples" is Attribute "irradiance" "nsamples"
    bool apart = false;                   ///< rsl::kPairApart: lights are not for it; of diffuse(): nothing but lights is
    bool axis = false;                    ///< of one with "axis": the mean over directions on its side alone
    bool openness = false;                ///< it asks what is in the way of its rays: every draw sends one
    FadeSite fade;
    RecordSite records;
};

/// What occlusion() asks beyond TraceSite. Rows, or -1.
struct OcclusionSite {
    int cone = -1, axis = -1, adaptive = -1, least = -1; ///< least: "minsamples"
    FadeSite fade;
    RecordSite records;
    bool uniform = false; ///< "distribution" "uniform"
};
/// What subsurface() says of what lies below. Rows, or -1: Attribute "subsurface" says it.
struct SubsurfaceSite {
    int samples = -1, scattering = -1, absorption = -1, path = -1, diffusePath = -1, reflectance = -1, index = -1, scale = -1,
        anisotropy = -1, point = -1, normal = -1;
    enum class Model : uint8_t { Walk, Dipole, BetterDipole } model = Model::Walk;
    std::string group; ///< "": the attribute's
};
struct GatherSite; // world/gathersite.h
struct CloudSite;  // world/cloudsite.h
struct PointSite;  // world/pointsite.h
struct PtexSite;   // world/ptexsite.h

/// What a photonmap() or caustic() asks. Rows, or -1.
struct PhotonSite {
    std::string name;      ///< of the map; "" where `computed`, or there is none
    bool computed = false; ///< each point names its map, in row 0
    bool caustic = false;  ///< that of the surface's attributes
    bool radiance = false;
    int point = -1, normal = -1, estimator = -1, minBounces = -1, lookup = -1;
};

/// What a texture() or environment() asks of a map. Rows of `in`, or -1.
struct TextureSite {
    std::string name;               ///< of the map; "" where `computed`, or there is none
    bool computed = false;          ///< each point names its map, in row 0
    texture::LookupOptions options; ///< what is the same for all points
    int filter = -1, channel = -1, fill = -1, width = -1, swidth = -1, twidth = -1, blur = -1, sblur = -1, tblur = -1;
    /// shadow(): -1 where the call does not say, then the options of the frame hold; `source`: corners of an area light.
    int samples = -1, bias = -1, bias0 = -1, bias1 = -1, gapbias = -1, source[4] = {-1, -1, -1, -1};
    float shadowSamples = 16, shadowBias0 = .225f, shadowBias1 = .225f;
    int count = 0;              ///< numbers of the result
    int slopes = 0, firsts = 0; ///< derivatives that are wanted, the first ones of them (rsl/passes/gradients.h)
    std::vector<int> rows;      ///< of the coordinates
    /// The map that is the same for all points, opened when first asked for. `place`: gives the SourcePlace of the call.
    template <class Place> texture::Handle map(const class WorldImpl&, Place&& place) const;

private:
    mutable std::atomic<texture::Handle> map_{nullptr};
    mutable std::atomic<bool> opened_{false};
};

/// What a call site of a kernel means to the integrator, worked out once per kernel.
enum class SiteKind : uint8_t {
    Unknown,
    Ambient,
    Diffuse,
    Specular,
    Phong,
    Trace,
    Transmission,
    LightVisibility,
    Occlusion,
    Subsurface,
    Gather, ///< requests
    Illuminance,
    Texture,
    Environment,
    Shadow,
    Irradiance,
    Printf,
    Message,
    LightSource,
    Attribute,
    Option,
    RendererInfo,
    RayInfo,
    RayLevel,
    TextureInfo,
    LightSetup,
    LightHandles,
    PrimitiveVariable,
    ShaderName,
    Depth,
    Transform,
    Random,
    Text,
    GatherTurn,
    Photons,
    SkySamples,
    Bake,
    Bake3d,
    Texture3d,
    PointHemisphere,
    PointSubsurface,
    Ptexture,
    Other
};
struct SiteInfo {
    SiteKind kind = SiteKind::Unknown;
    const rsl::ir::Site* site = nullptr;
    std::vector<int> rows;                   ///< first row of each argument in `in` (after the weight for Emit)
    std::map<std::string, int> named;        ///< row of an optional pair's value
    std::map<std::string, std::string> text; ///< constant string pairs
    std::map<std::string, int> resultRows;   ///< "" and output names -> first row of `out`
    int resultRowCount = 0;
    /// Of `resultRows`, those of requests; -1: not asked for.
    struct Results {
        int value = -1, distance = -1, transmission = -1, normal = -1;
        int open = -1; ///< "environmentdir", before it gets length 1
        int environment = -1, unshadowedEnvironment = -1, areaLight = -1, unshadowedAreaLight = -1;
    } results;
    bool givesDistance() const { return kind == SiteKind::Trace && site->resultType.base == rsl::Base::Float; }
    const LobeKind* lobe = nullptr; ///< Trace: the distribution; the lobe of a lighting shadeop
    float exponent = 1;             ///< Specular: this over the roughness (shadeops/specular.h)
    int rowWo = -1, rowExponent = -1, rowCone = -1, rowHorizon = -1, rowLights = -1; ///< of `named`
    bool allLights = false; ///< Trace: rowLights is of "samplelights": point, spot and distant lights are sampled, too
    std::shared_ptr<const struct TraceSite> trace;    ///< Trace: what only some calls use; Diffuse: null, or `apart`
    std::shared_ptr<const OcclusionSite> occlusion;   ///< Occlusion, which has `trace` for its map, too
    std::shared_ptr<const SubsurfaceSite> subsurface; ///< Subsurface
    std::shared_ptr<const GatherSite> gather;         ///< Gather, GatherTurn
    std::shared_ptr<const RaySite> rays;              ///< Trace, Transmission, Occlusion, Gather
    std::shared_ptr<const TextureSite> map;           ///< Texture, Environment
    std::shared_ptr<const PhotonSite> photons;        ///< Photons
    std::shared_ptr<const CloudSite> cloud;           ///< Bake, Bake3d, Texture3d
    std::shared_ptr<const PointSite> points;          ///< PointHemisphere, PointSubsurface
    std::shared_ptr<const PtexSite> ptex;             ///< Ptexture
    bool setUp = false, refresh = false;              ///< loops: they have a setup; "lightcache" "refresh"
    bool outside = false;                             ///< queries: outside of loops over lights
    bool once = false;                                ///< printf: in construct()
    bool uniform = false;                             ///< queries: the variable that takes the answer is uniform
    bool open = false, array = false;                 ///< and it is an array of a length that can change; an array
    int rowCategory = -1;                             ///< LightSetup: of "category", in the setup's arguments
    /// LightSetup: values for parameters of the lights, rows of its arguments; element: of an array that is sent, else -1.
    struct Sent {
        std::string parameter;
        int element, row, size;
    };
    std::vector<Sent> sent;
    /// The same of strings, and all of them as one key of BoundLight::variants, with its hash: "name\1value\2" of each; "" and 0:
    /// none.
    std::vector<std::pair<std::string, std::string>> sentStrings;
    std::string sentKey;
    uint64_t sentHash = 0;
    /// LightSetup: its arguments that lights can see: rows from `first` to `end`, and what tells them apart.
    struct Shown {
        int first, end;
        uint64_t salt;
    };
    std::vector<Shown> shown;
    int rowN = -1;      ///< LightSetup: of "N"
    int32_t nameId = 0; ///< the first string of the call, interned; 0: none, or known only when it runs
    /// Outputs of the surface that lights ask for: row, numbers.
    struct Output {
        rsl::OutputName name;
        int row, size;
    };
    std::vector<Output> outputs;
    int32_t label = 0;                          ///< of its rays: interned, for rayinfo()
    std::shared_ptr<const LobeArguments> block; ///< a lobe that whole blocks of points can ask for; null: point by point
};

/// How many rows the argument of a call has that begins at `row`.
size_t rowsOf(const SiteInfo&, int row);

/// A kernel and the meaning of its sites.
struct BoundKernel {
    std::shared_ptr<const rsl::CompiledKernel> kernel;
    std::shared_ptr<const shading::BatchPlan> plan;
    std::vector<SiteInfo> sites;
    bool mixed = false;
    bool path = false;   ///< lobe shadeops are requests; else they are answered at once
    bool blocks = false; ///< all that it asks for are lobes with SiteInfo::block
    explicit operator bool() const { return kernel != nullptr; }
};
/// Where in its file a call stands.
SourcePlace placeOf(const rsl::ir::Site&, const rsl::CompiledKernel&);
BoundKernel bindKernel(std::shared_ptr<const rsl::CompiledKernel>, bool mixed, bool path, WorldImpl*);

} // namespace alpenglow::transport
