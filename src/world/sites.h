// Meaning of a kernel's call sites, resolved when the kernel is bound, so that no name is compared at run time.
#pragma once
#include "accel/accel.h"
#include "bsdf/lobe.h"
#include "lanes/blocks.h"
#include "rsl/compiler.h"
#include "rsl/front/protocol.h"
#include "shading/batch.h"
#include "texture/texture.h"
#include "world/names.h"
#include <atomic>
#include <mutex>

namespace alpenglow::world {

using shading::RayType;
using shading::ShadePoint;
class WorldImpl;

/// The bit of a ray type in visibility masks.
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

/// Ray parameters of a call (3Delight manual, table 6.10). Argument rows, or -1.
struct RaySite {
    int bias = -1, maxDistance = -1, maxHit = -1, cone = -1, samples = -1, base = -1; ///< rows of these parameters
    int subset = -1, exclude = -1, sides = -1, mode = -1, label = -1,
        type = -1;                       ///< strings computed at run time
    std::string subsetText, excludeText; ///< "subset" and "excludesubset", if known in advance
    int32_t subsetId = 0, excludeId = 0; ///< interned
    shading::RaySet set;                 ///< the part known in advance
    RayType rays = RayType::Specular;    ///< type of the rays
    bool fixed = false;                  ///< set, label and type are known in advance
    bool saysSides = false;              ///< "hitsides" is given
};

/// "falloff" and "falloffmode" of a hemisphere call: rows, or -1.
struct FadeSite {
    int strength = -1, mode = -1; ///< rows
};

/// Irradiance caching (world/records.h) of a call. Rows, or -1.
struct RecordSite {
    int variation = -1, pixels = -1; ///< "maxvariation", "maxpixeldist"
    uint64_t call = 0;               ///< key of the call; 0: not available from records
};

/// Rare parameters of a trace().
struct TraceSite {
    int udir = -1, roughness = -1, roughnessv = -1, absorption = -1, tint = -1, weight = -1; ///< rows, or -1
    int distribution = -1;                ///< row of a distribution name computed at run time
    std::vector<std::pair<int, int>> eta; ///< row, components
    std::vector<int> lobes;               ///< rows of the elements of "lobeparameters"
    int part = -1;                        ///< for the form that returns an array
    texture::Handle map = nullptr;        ///< "environmentmap"
    Matrix toMap;                         ///< current space to "environmentspace"
    bool sums = false;                    ///< returns transmission or parts of the result
    bool onlyLights = false;              ///< returns light of area lights only
    bool hemisphere = false;              ///< of indirectdiffuse(): without "samples" Attribute "irradiance" "nsamples" applies
    bool apart = false;                   ///< rsl::kPairApart: excludes lights; for diffuse(): includes lights only
    bool axis = false;                    ///< has "axis": mean over directions on its side only
    bool openness = false;                ///< queries occlusion of its rays: every sample sends one
    FadeSite fade;                        ///< "falloff"
    RecordSite records;                   ///< "maxvariation" and its like
};

/// Parameters of occlusion() beyond TraceSite. Rows, or -1.
struct OcclusionSite {
    int cone = -1, axis = -1, adaptive = -1, least = -1; ///< least: "minsamples"
    FadeSite fade;                                       ///< "falloff"
    RecordSite records;                                  ///< "maxvariation" and its like
    bool uniform = false;                                ///< "distribution" "uniform"
};
/// Parameters of subsurface(). Rows, or -1: Attribute "subsurface" applies.
struct SubsurfaceSite {
    /// Rows of these parameters.
    int samples = -1, scattering = -1, absorption = -1, path = -1, diffusePath = -1, reflectance = -1, index = -1, scale = -1,
        anisotropy = -1, point = -1, normal = -1;
    /// How light spreads below the surface.
    enum class Model : uint8_t { Walk, Dipole, BetterDipole } model = Model::Walk;
    std::string group; ///< "": from the attribute
};
struct GatherSite;  // world/gathersite.h
struct CloudSite;   // world/cloudsite.h
struct PointSite;   // world/pointsite.h
struct Service;     // world/service.h
struct ServiceSite; // world/service.h

/// Parameters of a photonmap() or caustic(). Rows, or -1.
struct PhotonSite {
    std::string name;                                                          ///< name of the map; "" if `computed`, or missing
    bool computed = false;                                                     ///< name computed for each point, in row 0
    bool caustic = false;                                                      ///< the caustic map of the surface's attributes
    bool radiance = false;                                                     ///< of radiance; else of irradiance
    int point = -1, normal = -1, estimator = -1, minBounces = -1, lookup = -1; ///< rows
};

/// Parameters of a texture() or environment(). Argument rows, or -1.
struct TextureSite {
    std::string name;               ///< name of the map; "" if `computed`, or missing
    bool computed = false;          ///< name computed for each point, in row 0
    texture::LookupOptions options; ///< those equal for all points
    /// Rows of these parameters.
    int filter = -1, channel = -1, fill = -1, width = -1, swidth = -1, twidth = -1, blur = -1, sblur = -1, tblur = -1;
    /// shadow(): -1 if not given, then the frame's options apply; `source`: corners of an area light.
    int samples = -1, bias = -1, bias0 = -1, bias1 = -1, gapbias = -1, source[4] = {-1, -1, -1, -1};
    float shadowSamples = 16, shadowBias0 = .225f, shadowBias1 = .225f;
    int count = 0;              ///< components of the result
    int slopes = 0, firsts = 0; ///< requested derivatives; of these, first derivatives (rsl/passes/gradients.h)
    std::vector<int> rows;      ///< of the coordinates
    /// The map if it is the same for all points, opened at first use. `place`: returns the SourcePlace of the call.
    template <class Place> texture::Handle map(const class WorldImpl&, Place&& place) const;

private:
    // A cache of map(): whichever thread opens the map, the handle is the same.
    mutable std::atomic<texture::Handle> map_{nullptr};
    mutable std::atomic<bool> opened_{false};
};

/// Kind of a call site, resolved once per kernel.
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
    GatherIteration,
    Photons,
    SkySamples,
    Bake,
    Bake3d,
    Texture3d,
    PointHemisphere,
    PointSubsurface,
    Service, ///< answered by SiteInfo::service, and of no interest elsewhere
    Other
};
struct SiteInfo {
    SiteKind kind = SiteKind::Unknown;       ///< what kind of call it is
    const rsl::ir::Site* site = nullptr;     ///< as it was compiled; outlives this
    std::vector<int> rows;                   ///< first row of each argument in `in` (after the weight for Emit)
    std::map<std::string, int> named;        ///< row of an optional pair's value
    std::map<std::string, std::string> text; ///< constant string pairs
    std::map<std::string, int> resultRows;   ///< "" and output names -> first row of `out`
    int resultRowCount = 0;                  ///< number of rows
    /// For requests, entries of `resultRows`; -1: not requested.
    struct Results {
        int value = -1, distance = -1, transmission = -1, normal = -1; ///< first rows
        int open = -1;                                                 ///< "environmentdir", not normalised
        int environment = -1, unshadowedEnvironment = -1, areaLight = -1, unshadowedAreaLight = -1; ///< first rows
    } results;
    bool givesDistance() const { return kind == SiteKind::Trace && site->resultType.base == shadeops::Base::Float; }
    const LobeKind* lobe = nullptr; ///< Trace: the distribution; the lobe of a lighting shadeop
    float exponent = 1;             ///< Specular: this over the roughness (shadeops/specular.h)
    int rowWo = -1, rowExponent = -1, rowCone = -1, rowHorizon = -1, rowLights = -1; ///< of `named`
    bool allLights = false; ///< Trace: rowLights is of "samplelights": point, spot and distant lights are sampled, too
    std::shared_ptr<const struct TraceSite> trace;    ///< Trace: what only some calls use; Diffuse: null, or `apart`
    std::shared_ptr<const OcclusionSite> occlusion;   ///< Occlusion, which has `trace` for its map, too
    std::shared_ptr<const SubsurfaceSite> subsurface; ///< Subsurface
    std::shared_ptr<const GatherSite> gather;         ///< Gather, GatherIteration
    std::shared_ptr<const RaySite> rays;              ///< Trace, Transmission, Occlusion, Gather
    std::shared_ptr<const TextureSite> map;           ///< Texture, Environment
    std::shared_ptr<const PhotonSite> photons;        ///< Photons
    std::shared_ptr<const CloudSite> cloud;           ///< Bake, Bake3d, Texture3d
    std::shared_ptr<const PointSite> points;          ///< PointHemisphere, PointSubsurface
    const Service* service = nullptr;                 ///< answers the call; null: a request, or a call of another kind
    std::shared_ptr<const ServiceSite> resolved;      ///< what `service` has resolved
    bool setUp = false, refresh = false;              ///< loops: with a setup; "lightcache" "refresh"
    bool outside = false;                             ///< queries: outside of light loops
    bool once = false;                                ///< printf: in construct()
    bool uniform = false;                             ///< queries: the destination is uniform
    bool open = false, array = false;                 ///< its array length can change; it is an array
    int rowCategory = -1;                             ///< LightSetup: row of "category" in the setup's arguments
    /// LightSetup: values for parameters of lights, as argument rows; element: index in the array that is sent, or -1.
    struct Sent {
        std::string parameter;  ///< name of the parameter
        int element, row, size; ///< its first row, and their number
    };
    std::vector<Sent> sent;
    /// The same for strings, and all of them as a key of BoundLight::variants with its hash: "name\1value\2" for each; "" and 0:
    /// none.
    std::vector<std::pair<std::string, std::string>> sentStrings;
    std::string sentKey;
    uint64_t sentHash = 0;
    /// LightSetup: arguments visible to lights: rows `first` to `end`, exclusive, and a salt for their key.
    struct Shown {
        int first, end;
        uint64_t salt;
    };
    std::vector<Shown> shown;
    int rowN = -1;      ///< LightSetup: row of "N"
    int32_t nameId = 0; ///< first string of the call, interned; 0: none, or computed at run time
    /// Outputs of the surface that lights query: row, components.
    struct Output {
        rsl::OutputName name; ///< of the surface's kernel
        int row, size;        ///< first row, and the number of components
    };
    std::vector<Output> outputs;
    int32_t label = 0;                          ///< label of its rays, interned, for rayinfo()
    std::shared_ptr<const LobeArguments> block; ///< how its request is read in rows; null: one by one
};

/// Number of rows of the argument that begins at `row`.
size_t rowsOf(const SiteInfo&, int row);

/// What the calls of a kernel need of the whole world. A world joins those of all its kernels.
struct KernelNeeds {
    bool records = false;       ///< some call may use irradiance caching
    bool footprints = false;    ///< du or dv is read
    bool hitModes = false;      ///< some call has a "hitmode"
    bool globalPhotons = false; ///< an indirectdiffuse() may use a global photon map
    bool facePlaces = false;    ///< positions on faces are read
    bool bakes = false;         ///< bake() or bake3d() writes
    bool bakesCentres = false;  ///< one of these may request the centres of micropolygons
    /// Joins both.
    KernelNeeds& operator|=(const KernelNeeds& o) {
        records |= o.records, footprints |= o.footprints, hitModes |= o.hitModes;
        globalPhotons |= o.globalPhotons, facePlaces |= o.facePlaces;
        bakes |= o.bakes, bakesCentres |= o.bakesCentres;
        return *this;
    }
};

/// A kernel with its resolved call sites.
struct BoundKernel {
    std::shared_ptr<const rsl::CompiledKernel> kernel;
    std::shared_ptr<const shading::BatchPlan> plan; ///< sources of the inputs
    std::vector<SiteInfo> sites;
    KernelNeeds needs;   ///< of its calls
    bool mixed = false;  ///< batches may mix instances
    bool path = false;   ///< lobe shadeops are requests; else they are evaluated at once
    bool blocks = false; ///< all its requests can be read in rows (SiteInfo::block)
    /// There is a kernel.
    explicit operator bool() const { return kernel != nullptr; }
};
/// File position of a call.
SourcePlace placeOf(const rsl::ir::Site&, const rsl::CompiledKernel&);
/// Resolves the call sites of a kernel for a world. Opens the maps that they name.
BoundKernel bindKernel(std::shared_ptr<const rsl::CompiledKernel>, bool mixed, bool path, const WorldImpl&);

} // namespace alpenglow::world
