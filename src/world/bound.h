// Shaders, lights and surfaces of a frame, bound to kernels.
#pragma once
#include "world/arealight.h"
#include "world/sites.h"
#include <set>

namespace alpenglow::world {

/// A shader of the scene: its program, and parameter values in current space.
struct ShaderInstance {
    std::string name; ///< of the shader, as the scene names it
    std::shared_ptr<const rsl::CompiledShader> program;
    shading::ParameterBlock parameters;                 ///< in current space
    rsl::Connections connections;                       ///< parameters that take outputs of co-shaders
    std::set<std::string> given;                        ///< parameters set by the scene
    std::map<std::string, SourcePlace> handlePlaces;    ///< where the scene set parameters of type `shader`
    std::vector<rsl::SentParameter> sent;               ///< KernelOptions::sentParameters
    std::vector<rsl::CoShader> coShaders;               ///< from the attributes in effect at the request of this shader
    Matrix toCurrent;                                   ///< at shutter open
    std::shared_ptr<const shading::MovingSpace> moving; ///< null: shader space does not move
    /// Valid as long as this.
    shading::InstanceView view() const { return {&parameters, &toCurrent, moving.get()}; }
    /// Shader space to current at a fraction of the open shutter.
    Matrix toCurrentAt(float shutter) const { return moving ? moving->at(shutter) : toCurrent; }
    SourcePlace place;
    bool differences = false; ///< derivatives by differences (rsl/kernel.h)
};
using InstanceRef = std::shared_ptr<const ShaderInstance>;

/// Outputs of point lights: radius of the disk that casts their shadows, and number of shadow rays to it.
inline constexpr char kShadowRadius[] = "__shadowradius", kShadowSamples[] = "__shadowsamples";

/// Where a light comes from, by its illuminate and solar statements and its geometry.
enum class LightKind : uint8_t { Ambient, Point, Distant, Environment, Area };

/// Attribute "light" "samplingstrategy": whether illuminance loops or trace() see an area light or sky. Lighting shadeops see
/// all.
enum class LightStrategy : uint8_t { Both, Illuminance, Trace };

/// One block of a light shader: its kernel, its geometry, and what sampling needs to know of it.
struct BoundLight {
    LightKind kind = LightKind::Ambient; ///< how it emits
    InstanceRef instance;                ///< the shader of the scene
    BoundKernel kernel;
    std::shared_ptr<Emitter> emitter;            ///< Area
    std::shared_ptr<const class SkySampler> sky; ///< Environment, path; null: rays of lobes find it without samples
    bool importance = true;                      ///< false: not sampled where rays find it (__importancesample 0)
    /// Whether it has a density over directions: an emitter that rays can hit, or a sky.
    bool hasDensity() const { return (kind == LightKind::Area && !mean) || isSky(); }
    /// Environment, path, without a table: sampled only where a light guide knows which part is visible (lightguide.h).
    bool guidable = false;
    bool isSky() const { return sky || guidable; }
    int outL = -1, outCl = -1, outOl = -1, outLit = -1;
    /// Output parameters that the kernel computes: name, output, components; then the total width.
    struct Value {
        rsl::OutputName name;
        int output, components, aov = -1; ///< index in the kernel's outputs, and its components
    }; ///< aov: index of an outputchannel() among the AOVs
    std::vector<Value> values;
    int valueWidth = 0;
    bool asksSurface = false; ///< its kernel queries parameters of the lit surface
    bool channels = false;    ///< some of `values` are AOVs
    bool cone = false;        ///< Distant: solar() with an angle, sampled under path
    /// For lights with generateSamples(): where directions and radiances of the samples begin in `values`; -1: other lights.
    int sentL = -1, sentCl = -1;
    /// For class lights with generatePhoton(): `kernel` with four additional outputs, given here: origin, direction, power and
    /// density of a photon. Null: other lights.
    BoundKernel photons;
    int photonOutputs[4] = {};
    bool shadowless = false; ///< path: nothing casts shadows of its samples, and rays of lobes that sample it do not count it
    bool shadows = false;    ///< other hiders: its light casts traced shadows (Attribute "light" "shadows" "on")
    /// Kernels for strings that surfaces send: by SiteInfo::sentKey of the loop.
    std::map<std::string, BoundKernel> variants;
    int nonDiffuse = -1, nonSpecular = -1;        ///< outputs, or -1
    int shadowRadius = -1, shadowSamples = -1;    ///< Point: outputs, or -1
    std::string handle;                           ///< of the request
    int samples = 1;                              ///< samples of each vertex, >= 1
    const scene::Light* source = nullptr;         ///< the request; null: of the program's own
    std::vector<int> parts;                       ///< indices of the lights for further blocks of the same shader
    LightStrategy strategy = LightStrategy::Both; ///< which technique finds it
    /// Whether a ray of this kind sees the light.
    bool seenBy(const shading::RayKind& k) const {
        return k.indirectOnly ? strategy == LightStrategy::Trace : !k.fromTrace || strategy != LightStrategy::Illuminance;
    }
    float intensityScale = 0;  ///< > 0: Cl is an intensity over squared distance; radiance is Cl d^2 times this
    bool mean = false;         ///< Area: returns the mean of Cl over its surface without further factors; invisible to rays
    bool inAtmosphere = false; ///< Area, path: one of its shapes is in an atmosphere
    uint32_t pointNeeds = geometry::kNeedAll; ///< geometry::PointNeed for points on the emitter
    bool placed = false;                      ///< Point, Area: has a position: `place`, half size `extent`
    Vec3 place;                               ///< camera space
    float extent = 0;                         ///< Area: half size, camera space
    // For choosing among many lights: brightness at distance 1 (Distant: anywhere; Area: radiance times area / pi).
    float power = 0;
    Vec3 centre;
    float radius = 0;
    Cone front;                                         ///< Area: bound of the directions in which light leaves
    int group = -1;                                     ///< WorldImpl::lightGroups(); -1: none
    std::shared_ptr<const shading::ParameterRows> rows; ///< for the kernel of its group
};

/// Light from one light at a point.
struct LightValue {
    Vec3 L;                 ///< from the light to the point
    Color Cl{0}, Ol{1};     ///< radiance or irradiance / pi, as the shader has it; opacity
    bool lit = false;       ///< the point is in the light's cone
    bool ownShadow = false; ///< its shader called transmission() from or to the lit point, so Cl includes occlusion
    float nonDiffuse = 0, nonSpecular = 0; ///< weights of __nondiffuse and __nonspecular
    /// Of the disk around a point light, facing the lit point, that casts its shadows; 0: the point casts them
    float shadowRadius = 0;
    int shadowSamples = 1; ///< shadow rays to that disk, under the other hiders
    /// Fraction of this light that a lighting shadeop's lobe reflects (3Delight manual, 6.3).
    float kept(RayType t) const { return std::max(0.f, 1 - (t == RayType::Diffuse ? nonDiffuse : nonSpecular)); }
};

/// Attenuation of shadow rays by a surface: a constant, or an opacity-only kernel.
struct Opacity {
    Color constant{1};
    BoundKernel kernel;
    /// Rays of lobes may see another opacity here: the attributes give shadows their own, or the shader asks for the type of ray.
    bool differs = false;
    bool opaque() const { return !kernel && constant == Color(1); }
};

/// Parameters of a medium from the outputs of its volume shader: color __absorption and __scattering, coefficients per unit of
/// length in current space; color __emission, radiance per unit of length; float __anisotropy, mean cosine of Henyey-Greenstein,
/// -1 to 1. Coefficients >= 0, all constant in space.
struct Homogeneous {
    Color absorption{0}, scattering{0}, emission{0}; ///< per unit of length, by channel
    float anisotropy = 0;                            ///< mean cosine
    /// Per unit of length, by channel.
    Color extinction() const { return absorption + scattering; }
    /// Transmittance over a distance, by channel.
    Color transmittance(float way) const;
};

/// A bound volume shader: of an atmosphere, or of the interior or exterior of primitives.
struct Medium {
    InstanceRef shader;
    BoundKernel kernel;                             ///< of the volume shader
    std::shared_ptr<const Homogeneous> homogeneous; ///< path: scattering in closed form, no shader runs
    float priority = 0;                             ///< output float __priority: the highest wins where media overlap
    const geometry::Shape* shape =
        nullptr;      ///< interior and exterior: the first primitive, and its binding, for rays without a hit
    int binding = -1; ///< index in WorldImpl::bindings(); -1: none
};

/// An output that displays request and that receives light. A kernel of its own computes it, so that Ci does not depend on the
/// display.
struct LightOutput {
    /// `own`, `main`: for each call site of this kernel and of the surface's, the first site of the surface's kernel with the
    /// same call; -1: none.
    struct Kernel {
        BoundKernel bound; ///< of the output
        std::vector<int> own, main;
    };
    int number = 0;                   ///< WorldImpl::lightOutputs()
    rsl::OutputName slot;             ///< name in kernels: "d", or "list[1]" for an array
    std::vector<std::string> outputs; ///< names that displays ask for
    Kernel S, V;                      ///< as SurfaceBinding::surfaceS, surfaceV
};
/// Position among the AOVs.
struct LightOutputPlace {
    rsl::OutputName slot;                 ///< name in kernels
    int aov = 0, component = 0, size = 3; ///< index of the AOV; components before this output; 1 or 3
    int first = -1;                       ///< index in all numbers of a sample; -1: beyond the width of the AOV
};

/// How a surface scatters photons: by its shader's lobes, or by a model from Attribute "photon" "shadingmodel".
enum class PhotonModel : uint8_t { Shader, Matte, Plastic, Glass, Water, Chrome, Transparent };

/// Photon attributes of a surface.
struct PhotonBinding {
    std::string globalMap, causticMap;       ///< Attribute "photon"; "": none
    int estimator = 50;                      ///< photons in a lookup
    PhotonModel model = PhotonModel::Shader; ///< how photons interact
    bool meets = true;                       ///< Attribute "visibility" "photon"; unset: visible to diffuse or to specular rays
    bool intersectsBoth = true;              ///< visible to both, so photons reach every place that rays of lobes start from
};

/// Shapes with the same surface, atmosphere and lights; they are shaded together.
struct SurfaceBinding {
    InstanceRef surface, displacement, interior, exterior; ///< the last two are targets of messages
    BoundKernel surfaceS;                                  ///< for batches of one binding
    BoundKernel surfaceV;                                  ///< only if batches need it: several bindings, or different spaces
    BoundKernel displacementS;                             ///< of the displacement shader
    Medium atmosphere;                                     ///< null shader: none
    int inside = -1, outside = -1;                         ///< WorldImpl::media() of Interior and Exterior; -1: none
    float insidePriority = 0, outsidePriority = 0;         ///< the higher one overrules the other
    /// Whether the surface is no boundary where a ray is: a medium of higher priority than its interior is on both sides.
    bool overruled(const shading::Media* at) const {
        return inside >= 0 && at && at->count && at->top() != inside && at->topPriority() > insidePriority;
    }
    /// The media of a ray in medium `from` that arrives at a point with normal n in direction `in` and leaves in direction `to`.
    shading::Media beyond(const shading::Media& from, const Vec3& n, const Vec3& in, const Vec3& to) const;
    bool displacementQueried = false; ///< displacementS computes its shader's outputs for displacement() queries
    BoundKernel entering;             ///< entering light by its subsurface() calls (rsl::kEntering); null: by lights
    BoundKernel moveS; ///< P as the surface shader writes it, if that displaces the primitive (no displacement shader)
    std::vector<LightOutput> lightOutputs;   ///< each with a kernel of its own
    std::vector<char> inLightOutputs;        ///< by AOV: computed by `lightOutputs`; empty: none
    scene::LightSet lights;                  ///< lights that are on, with the parts of their shaders: WorldImpl::eachLight()
    int group = 0;                           ///< equal: same program and lights; points are shaded in one batch
    int program = 0;                         ///< equal: same kernel; points may share a V batch
    int lightList = 0;                       ///< equal: same lights; index in WorldImpl::lightLists()
    bool usesObjectSpace = false;            ///< the kernel reads "object" or "shader" matrices that differ within the binding
    int areaLight = -1;                      ///< the area light of this geometry
    bool explicitSurface = true;             ///< false: the default surface
    Opacity opacity;                         ///< by attributes
    Opacity primitiveOpacity, shaderOpacity; ///< for rays with a "hitmode"; set only if there are any
    /// The attenuation of rays with this "hitmode".
    const Opacity& opacityFor(shading::HitMode m) const {
        return m == shading::HitMode::Default ? opacity : m == shading::HitMode::Primitive ? primitiveOpacity : shaderOpacity;
    }
    uint32_t primitiveFor = 0; ///< visibility bits of rays that see the primitive's own Color and Opacity (Attribute "shade")
    /// Whether such a ray sees the primitive's Color and Opacity instead of its shaders.
    bool asPrimitive(shading::HitMode m, RayType t) const {
        return m == shading::HitMode::Primitive || (m == shading::HitMode::Default && (primitiveFor & visibilityBit(t)));
    }
    bool matte = false;
    bool vanishes = false;                    ///< its shader is invisible everywhere: no light, fully transparent
    float shadingRate = 1;                    ///< pixels
    int maxDiffuse = -1, maxSpecular = -1;    ///< bounces of a path that may hit it: -1: no limit of its own
    float bias = 0;                           ///< Attribute "trace" "bias"; 0: the error bound of the hit
    uint32_t pointNeeds = geometry::kNeedAll; ///< geometry::PointNeed for hits
    scene::AttributesRef attributes;          ///< never null
    PhotonBinding photons;                    ///< for photon maps
};

} // namespace alpenglow::world
