// Shaders, lights and surfaces of a frame as they are bound to kernels.
#pragma once
#include "world/arealight.h"
#include "world/sites.h"
#include <set>

namespace alpenglow::transport {

/// A shader call of the scene: its program, and the values of its parameters in current space.
struct ShaderInstance {
    std::string name;
    std::shared_ptr<const rsl::CompiledShader> program;
    shading::ParameterBlock parameters;
    std::set<std::string> given;                        ///< parameters that have no default: the scene gave them
    std::map<std::string, SourcePlace> handlePlaces;    ///< of those of type `shader` that the scene gave: where
    std::vector<rsl::CoShader> coShaders;               ///< those of the attributes under which the shader was named
    Matrix toCurrent;                                   ///< when the shutter opens
    std::shared_ptr<const shading::MovingSpace> moving; ///< null: shader space stands still
    shading::InstanceView view() const { return {&parameters, &toCurrent, moving.get()}; }
    Matrix toCurrentAt(float shutter) const { return moving ? moving->at(shutter) : toCurrent; }
    SourcePlace place;
    bool differences = false; ///< how its kernels take derivatives (rsl/kernel.h)
};
using InstanceRef = std::shared_ptr<const ShaderInstance>;

/// Outputs of lights that stand at a point: the radius of the disk that casts their shadows, and the shadow rays to it.
inline constexpr char kShadowRadius[] = "__shadowradius", kShadowSamples[] = "__shadowsamples";

enum class LightKind : uint8_t { Ambient, Point, Distant, Environment, Area };

/// Attribute "light" "samplingstrategy": who sees an area light or a sky, illuminance loops or trace(). The lighting shadeops see
/// all.
enum class LightStrategy : uint8_t { Both, Illuminance, Trace };

struct BoundLight {
    LightKind kind = LightKind::Ambient;
    InstanceRef instance;
    BoundKernel kernel;
    std::shared_ptr<Emitter> emitter;          ///< Area
    std::shared_ptr<const class SkyTable> sky; ///< Environment, path: where it is bright; null: rays of lobes find it as well
    bool importance = true;                    ///< false: no point of it is sampled where rays find it (__importancesample 0)
    /// Lobes may sample it by direction: an emitter that rays meet, or a sky.
    bool hasDensity() const { return (kind == LightKind::Area && !mean) || sky; }
    int outL = -1, outCl = -1, outOl = -1, outLit = -1;
    /// Output parameters, whose values the kernel gives: name, output, components; then what all of them take.
    struct Value {
        rsl::OutputName name;
        int output, components, aov = -1;
    }; ///< aov: where an outputchannel() lies among the AOVs
    std::vector<Value> values;
    int valueWidth = 0;
    bool asksSurface = false; ///< its kernel asks for parameters of the surface that it lights
    bool channels = false;    ///< some of `values` are AOVs
    bool cone = false;        ///< Distant: solar() with an angle, which path samples
    /// Of a light that sends through generateSamples(): where in `values` the ways and the light of its samples begin; -1:
    /// another light.
    int sentL = -1, sentCl = -1;
    /// Of a class light with generatePhoton(): `kernel` with four more outputs, which these are: where a photon begins, its
    /// direction, power and density. Null: another light.
    BoundKernel photons;
    int photonOutputs[4] = {};
    bool shadows = false; ///< outside of path: its light is traced (Attribute "light" "shadows" "on")
    /// Kernels for strings that a surface sends: by SiteInfo::sentKey of the loop.
    std::map<std::string, BoundKernel> variants;
    int nonDiffuse = -1, nonSpecular = -1;     ///< outputs, or -1
    int shadowRadius = -1, shadowSamples = -1; ///< Point: outputs, or -1
    std::string handle;
    int samples = 1;
    const scene::Light* source = nullptr;
    std::vector<int> parts; ///< lights of the further blocks of the same shader
    LightStrategy strategy = LightStrategy::Both;
    /// Whether rays find it, as far as their call says.
    bool seenBy(const shading::RayKind& k) const {
        return k.indirectOnly ? strategy == LightStrategy::Trace : !k.fromTrace || strategy != LightStrategy::Illuminance;
    }
    float intensityScale = 0; ///< > 0: Cl is an intensity over squared distance; radiance is Cl d^2 times this
    bool mean = false;        ///< Area: gives the mean of its Cl over its surface, with no other factor, and no ray finds it
    bool hazy = false;        ///< Area, path: some of its shapes lie in an atmosphere
    uint32_t pointNeeds = geometry::kNeedAll; ///< geometry::PointNeed of the points of an emitter
    bool placed = false;                      ///< Point, Area: `place` is where it stands; `extent`: half its size
    Vec3 place;
    float extent = 0;
    // For the choice among many lights: brightness at distance 1 (Distant: anywhere; Area: radiance times area / pi).
    float power = 0;
    Vec3 centre;
    float radius = 0;
    Cone front;                                         ///< Area: the directions about which its light leaves
    int group = -1;                                     ///< WorldImpl::lightGroups_; -1: none
    std::shared_ptr<const shading::ParameterRows> rows; ///< for the kernel of its group
};

/// What a light gives at a point.
struct LightValue {
    Vec3 L;
    Color Cl{0}, Ol{1};
    bool lit = false;
    bool ownShadow = false; ///< its shader asked transmission() from or to the lit point: Cl has what is in the way already
    float nonDiffuse = 0, nonSpecular = 0; ///< weights of __nondiffuse and __nonspecular
    float shadowRadius = 0; ///< of the disk about a point light, facing the lit point, that casts its shadows; 0: the point does
    int shadowSamples = 1;  ///< rays to that disk, outside of path
    /// What a lobe of a lighting shadeop keeps of this light (3Delight manual, 6.3).
    float kept(RayType t) const { return std::max(0.f, 1 - (t == RayType::Diffuse ? nonDiffuse : nonSpecular)); }
};

/// What a surface takes from shadow rays: the same everywhere, or what a kernel says that gives Oi alone.
struct Opacity {
    Color constant{1};
    BoundKernel kernel;
    bool opaque() const { return !kernel && constant == Color(1); }
};

/// What a volume shader says of the medium that it stands for by outputs of these names and types: color __absorption and
/// __scattering, coefficients a unit of length of current space; color __emission, radiance that a unit of length adds; float
/// __anisotropy, the mean cosine of Henyey and Greenstein, -1 to 1. All >= 0 and the same everywhere.
struct Homogeneous {
    Color absorption{0}, scattering{0}, emission{0};
    float anisotropy = 0;
    Color extinction() const { return absorption + scattering; }
    /// What is left of light after so long a way, channel by channel.
    Color left(float way) const;
};

/// A volume shader as it runs: of an atmosphere, or of the inside or outside of primitives.
struct Medium {
    InstanceRef shader;
    BoundKernel kernel;
    std::shared_ptr<const Homogeneous> homogeneous; ///< path: light is scattered in it in closed form, and no shader runs
    float priority = 0;                             ///< output float __priority: where media overlap the highest counts
    const geometry::Shape* shape =
        nullptr; ///< inside and outside: the first primitive, and its binding, for rays that meet nothing
    int binding = -1;
};

/// An output that displays ask for and that light reaches: a kernel of its own gives it, so that Ci is what it is without the
/// display.
struct LightOutput {
    /// `own`, `main`: by site of this kernel and of the surface's, the first site of the surface's that is the same call; -1:
    /// none.
    struct Kernel {
        BoundKernel bound;
        std::vector<int> own, main;
    };
    int number = 0;       ///< WorldImpl::lightOutputs_
    rsl::OutputName slot; ///< as kernels call it: "d", of an array "list[1]"
    std::vector<std::string> outputs;
    Kernel S, V; ///< as SurfaceBinding::surfaceS, surfaceV
};
/// Where it lies among the AOVs.
struct LightOutputPlace {
    rsl::OutputName slot;
    int aov = 0, component = 0, size = 3; ///< which AOV; numbers of it before this output; 1 or 3
    int first = -1;                       ///< of all numbers of a sample; -1: beyond the width of the AOV
};

/// What surfaces do to photons: what their shaders' lobes do to light, or what Attribute "photon" "shadingmodel" names.
enum class PhotonModel : uint8_t { Shader, Matte, Plastic, Glass, Water, Chrome, Transparent };

/// What the attributes of a surface say of photons.
struct PhotonBinding {
    std::string globalMap, causticMap; ///< Attribute "photon"; "": none
    int estimator = 50;                ///< photons of a lookup
    PhotonModel model = PhotonModel::Shader;
    bool meets = true;     ///< Attribute "visibility" "photon"; unset: met by diffuse or by specular rays
    bool meetsBoth = true; ///< met by both, so that photons can go wherever rays of lobes come from
};

/// Shapes with the same surface, atmosphere and light list are shaded together.
struct SurfaceBinding {
    InstanceRef surface, displacement, interior, exterior; ///< the last two are asked by messages
    BoundKernel surfaceS;
    BoundKernel surfaceV; ///< only where batches of the scene need it: several bindings, or different spaces
    BoundKernel displacementS;
    Medium atmosphere;             ///< no shader: none
    int inside = -1, outside = -1; ///< WorldImpl::media_ of Interior and Exterior; -1: none
    float insidePriority = 0, outsidePriority = 0;
    /// Whether the surface bounds nothing where a ray is: a medium that counts for more than its inside is on both sides of it.
    bool overruled(const shading::Media* at) const {
        return inside >= 0 && at && at->count && at->top() != inside && at->topPriority() > insidePriority;
    }
    /// Where a ray is that comes from `from` and leaves a point with normal n in direction `to`; it arrived in direction `in`.
    shading::Media beyond(const shading::Media& from, const Vec3& n, const Vec3& in, const Vec3& to) const;
    bool displacementTells = false; ///< displacementS gives the outputs of its shader, for those who ask by displacement()
    BoundKernel entering; ///< what its subsurface() calls say of light that enters (rsl::kEntering); none: from the lights
    BoundKernel moveS;    ///< P as the surface shader leaves it, where that displaces the primitive (no displacement shader)
    std::vector<LightOutput> lightOutputs;
    std::vector<char> aside;      ///< by AOV: `lightOutputs` give it; empty: none
    scene::LightSet lights;       ///< that are on, with the parts of their shaders: WorldImpl::eachLight()
    int group = 0;                ///< equal: same program and light list, so that points are shaded in one batch
    int program = 0;              ///< equal: the same kernel, so that points may share a V batch
    int lightList = 0;            ///< equal: the same lights; WorldImpl::lightLists_
    bool usesObjectSpace = false; ///< the kernel reads "object" or "shader" matrices that differ inside the binding
    int areaLight = -1;           ///< the light whose geometry this is
    bool explicitSurface = true;
    Opacity opacity;                         ///< as the attributes say
    Opacity primitiveOpacity, shaderOpacity; ///< for rays with a "hitmode"; only where there are some
    const Opacity& opacityFor(shading::HitMode m) const {
        return m == shading::HitMode::Default ? opacity : m == shading::HitMode::Primitive ? primitiveOpacity : shaderOpacity;
    }
    uint32_t primitiveFor = 0; ///< visibility bits of rays that take the primitive as it is (Attribute "shade")
    bool asPrimitive(shading::HitMode m, RayType t) const {
        return m == shading::HitMode::Primitive || (m == shading::HitMode::Default && (primitiveFor & visibilityBit(t)));
    }
    bool matte = false;
    bool vanishes = false; ///< its shader shows nothing and lets all light through, wherever it is met
    float shadingRate = 1;
    int maxDiffuse = -1, maxSpecular = -1;
    float bias = 0;                           ///< Attribute "trace" "bias"; 0: the hit's own error bound
    uint32_t pointNeeds = geometry::kNeedAll; ///< geometry::PointNeed of hits
    scene::AttributesRef attributes;
    PhotonBinding photons;
};

} // namespace alpenglow::transport
