// The inside of World, for transport/ only: what hits, shaders and lights are bound to.
#pragma once
#include "accel/accel.h"
#include "rsl/compiler.h"
#include "rsl/passes/optimize.h"
#include "rsl/printlog.h"
#include "shading/batch.h"
#include "texture/texture.h"
#include "world/arealight.h"
#include "transport/integrator.h"
#include "world/lightchooser.h"
#include "lobes/lobe.h"
#include <atomic>
#include <functional>
#include <mutex>
#include <set>
#include <unordered_map>

namespace alpenglow::transport {

using shading::RayType;

/// The kind of a ray as visibility masks know it.
inline uint32_t visibilityBit(RayType t) {
    switch (t) {
    case RayType::Camera: return accel::kCamera;
    case RayType::Diffuse: return accel::kDiffuse;
    case RayType::Specular: return accel::kSpecular;
    default: return accel::kTransmission;
    }
}

/// What a call that sends rays says of them (rsl.md, table 6.10). Rows of arguments, or -1.
struct RaySite {
    int bias = -1, maxDistance = -1, maxHit = -1, cone = -1, samples = -1, base = -1;
    int subset = -1, exclude = -1, sides = -1, mode = -1, label = -1, type = -1; ///< strings that are known only when the shader runs
    std::string subsetText, excludeText;
    int32_t subsetId = 0, excludeId = 0;  ///< the same, interned
    shading::RaySet set;                  ///< what is known beforehand
    RayType rays = RayType::Specular;
    bool fixed = false;                   ///< nothing of the set, the label and the type is known only when the shader runs
};

/// The subsets of a world's shapes that rays were restricted to.
class ShapeSubsets {
public:
    /// By shape, whether rays of this "subset" and "excludesubset" consider it; null: all. Good as long as the world. Thread safe.
    const uint8_t* find(const class WorldImpl&, const std::string& wanted, const std::string& unwanted) const;

private:
    mutable std::mutex mutex_;
    mutable std::map<std::string, std::vector<uint8_t>> kept_;
};

/// Where the rarer parameters of a trace() lie.
struct TraceSite {
    int udir = -1, roughness = -1, roughnessv = -1, absorption = -1, tint = -1; ///< rows, or -1
    std::vector<std::pair<int, int>> eta; ///< row, components
    std::vector<int> lobes;               ///< rows of the elements of "lobeparameters"
    int part = -1;                        ///< of the form that gives an array
    texture::Handle map = nullptr;        ///< "environmentmap"
    Matrix toMap;                         ///< current to "environmentspace"
    bool sums = false;                    ///< it asks for transmission or for parts of the result
    bool onlyLights = false;              ///< for nothing but what area lights send
};

/// What a texture() or environment() asks of a map. Rows of `in`, or -1.
struct TextureSite {
    std::string name;                     ///< of the map; "" where `computed`, or there is none
    bool computed = false;                ///< each point names its map, in row 0
    texture::LookupOptions options;       ///< what is the same for all points
    int filter = -1, channel = -1, fill = -1, width = -1, swidth = -1, twidth = -1, blur = -1, sblur = -1, tblur = -1;
    int count = 0;                        ///< numbers of the result
    int slopes = 0, firsts = 0;           ///< derivatives that are wanted, the first ones of them (rsl/passes/gradients.h)
    std::vector<int> rows;                ///< of the coordinates
    /// The map that is the same for all points, opened when first asked for. `place`: gives the SourcePlace of the call.
    template <class Place> texture::Handle map(const class WorldImpl&, Place&& place) const;

private:
    mutable std::atomic<texture::Handle> map_{nullptr};
    mutable std::atomic<bool> opened_{false};
};

/// What a call site of a kernel means to the engine, worked out once per kernel.
enum class SiteKind : uint8_t {
    Unknown, Ambient, Diffuse, Specular, Phong, Trace, Transmission, LightVisibility, ///< requests
    Illuminance, Texture, Environment, Printf, Message, LightSource, Attribute, Option, RendererInfo, RayInfo, RayLevel, TextureInfo, LightSetup, LightHandles, PrimitiveVariable, ShaderName, Text, Other
};
struct SiteInfo {
    SiteKind kind = SiteKind::Unknown;
    const rsl::ir::Site* site = nullptr;
    std::vector<int> rows;                     ///< first row of each argument in `in` (after the weight for Emit)
    std::map<std::string, int> named;          ///< row of an optional pair's value
    std::map<std::string, std::string> text;   ///< constant string pairs
    std::map<std::string, int> resultRows;     ///< "" and output names -> first row of `out`
    int resultRowCount = 0;
    /// Of `resultRows`, those of requests; -1: not asked for.
    struct Results {
        int value = -1, distance = -1, transmission = -1, normal = -1;
        int environment = -1, unshadowedEnvironment = -1, areaLight = -1, unshadowedAreaLight = -1;
    } results;
    bool givesDistance() const { return kind == SiteKind::Trace && site->resultType.base == rsl::Base::Float; }
    const LobeKind* lobe = nullptr;            ///< Trace: the distribution; the lobe of a lighting shadeop
    float exponent = 1;                        ///< Specular: this over the roughness (shadeops/specular.h)
    int rowWo = -1, rowExponent = -1, rowCone = -1, rowHorizon = -1, rowLights = -1; ///< of `named`
    std::shared_ptr<const struct TraceSite> trace; ///< Trace: what only some calls use
    std::shared_ptr<const RaySite> rays;       ///< Trace, Transmission
    std::shared_ptr<const TextureSite> map;    ///< Texture, Environment
    bool setUp = false, refresh = false, outside = false; ///< loops: "__setup", "lightcache" "refresh"; queries: "__outside" of loops
    int rowCategory = -1;                      ///< LightSetup: of "category", in the setup's arguments
    uint64_t sentStrings = 0;                  ///< of sentStrings(): its hash, 0 for none
    int32_t nameId = 0;                        ///< the first string of the call, interned; 0: none, or known only when it runs
    /// Outputs of the surface that lights ask for: name, row, numbers.
    struct Output { std::string name; int row, size; };
    std::vector<Output> outputs;
    int32_t label = 0;                         ///< of its rays: interned, for rayinfo()
};

/// How many rows the argument of a call has that begins at `row`.
size_t rowsOf(const SiteInfo&, int row);

/// A kernel and the meaning of its sites.
struct BoundKernel {
    std::shared_ptr<const rsl::CompiledKernel> kernel;
    std::shared_ptr<const shading::BatchPlan> plan;
    std::vector<SiteInfo> sites;
    bool mixed = false;
    bool path = false;                         ///< lobe shadeops are requests; else they are answered at once
    explicit operator bool() const { return kernel != nullptr; }
};
BoundKernel bindKernel(std::shared_ptr<const rsl::CompiledKernel>, bool mixed, bool path, class WorldImpl*);

/// A shader call of the scene: its program, and the values of its parameters in current space.
struct ShaderInstance {
    std::string name;
    std::shared_ptr<const rsl::CompiledShader> program;
    shading::ParameterBlock parameters;
    std::set<std::string> given; ///< parameters that have no default: the scene gave them
    std::map<std::string, SourcePlace> handlePlaces; ///< of those of type `shader` that the scene gave: where
    std::vector<rsl::CoShader> coShaders; ///< those of the attributes under which the shader was named
    Matrix toCurrent;
    SourcePlace place;
    bool differences = false; ///< how its kernels take derivatives (rsl/kernel.h)
};
using InstanceRef = std::shared_ptr<const ShaderInstance>;

enum class LightKind : uint8_t { Ambient, Point, Distant, Environment, Area };

/// Attribute "light" "samplingstrategy": who sees an area light or a sky, illuminance loops or trace(). The lighting shadeops see all.
enum class LightStrategy : uint8_t { Both, Illuminance, Trace };

struct BoundLight {
    LightKind kind = LightKind::Ambient;
    InstanceRef instance;
    BoundKernel kernel;
    std::shared_ptr<Emitter> emitter;          ///< Area
    int outL = -1, outCl = -1, outOl = -1, outLit = -1;
    /// Output parameters, whose values the kernel gives: name, output, components; then what all of them take.
    struct Value { std::string name; int output, components, aov = -1; }; ///< aov: where an outputchannel() lies among the AOVs
    std::vector<Value> values;
    int valueWidth = 0;
    bool asksSurface = false;                  ///< its kernel asks for parameters of the surface that it lights
    bool channels = false;                     ///< some of `values` are AOVs
    bool cone = false;                         ///< Distant: solar() with an angle, which path samples
    /// Of a light that sends through generateSamples(): where in `values` the ways and the light of its samples begin; -1: another light.
    int sentL = -1, sentCl = -1;
    bool shadows = false;                      ///< outside of path: its light is traced (Attribute "light" "shadows" "on")
    /// Kernels for strings that a surface sends: by sentStrings() of the loop.
    std::map<std::string, BoundKernel> variants;
    int nonDiffuse = -1, nonSpecular = -1;     ///< outputs, or -1
    std::string handle;
    int samples = 1;
    const scene::Light* source = nullptr;
    std::vector<int> parts;                    ///< lights of the further blocks of the same shader
    LightStrategy strategy = LightStrategy::Both;
    float intensityScale = 0;                  ///< > 0: Cl is an intensity over squared distance; radiance is Cl d^2 times this
    bool mean = false; ///< Area: gives the mean of its Cl over its surface, with no other factor, and no ray finds it
    bool hazy = false;                         ///< Area, path: some of its shapes lie in an atmosphere
    uint32_t pointNeeds = geometry::kNeedAll;  ///< geometry::PointNeed of the points of an emitter
    // For the choice among many lights: brightness at distance 1 (Distant: anywhere; Area: radiance times area / pi).
    float power = 0;
    Vec3 centre;
    float radius = 0;
    int group = -1;                            ///< WorldImpl::lightGroups_; -1: none
};

/// What a surface takes from shadow rays: the same everywhere, or what a kernel says that gives Oi alone.
struct Opacity {
    Color constant{1};
    BoundKernel kernel;
    bool opaque() const { return !kernel && constant == Color(1); }
};

/// A volume shader as it runs: of an atmosphere, or of the inside or outside of primitives.
struct Medium {
    InstanceRef shader;
    BoundKernel kernel;
    const geometry::Shape* shape = nullptr;    ///< inside and outside: the first primitive, and its binding, for rays that meet nothing
    int binding = -1;
};

/// An output that displays ask for and that light reaches: a kernel of its own gives it, so that Ci is what it is without the
/// display.
struct LightOutput {
    /// `own`, `main`: by site of this kernel and of the surface's, the first site of the surface's that is the same call; -1:
    /// none.
    struct Kernel { BoundKernel bound; std::vector<int> own, main; };
    int number = 0;                            ///< WorldImpl::lightOutputs_
    std::string slot;                          ///< as kernels call it: "d", of an array "list[1]"
    std::vector<std::string> outputs;
    Kernel S, V;                               ///< as SurfaceBinding::surfaceS, surfaceV
};
/// Where it lies among the AOVs.
struct LightOutputPlace {
    std::string slot;
    int aov = 0, component = 0, size = 3;      ///< which AOV; numbers of it before this output; 1 or 3
    int first = -1;                            ///< of all numbers of a sample; -1: beyond the width of the AOV
};

/// Shapes with the same surface, atmosphere and light list are shaded together.
struct SurfaceBinding {
    InstanceRef surface, displacement, interior, exterior; ///< the last two are asked by messages
    BoundKernel surfaceS;
    BoundKernel surfaceV;                      ///< only where batches of the scene need it: several bindings, or different spaces
    BoundKernel displacementS;
    Medium atmosphere;                         ///< no shader: none
    int inside = -1, outside = -1;             ///< WorldImpl::media_ of Interior and Exterior; -1: none
    /// Where a ray is that comes from `from` and leaves a point with normal n in direction `to`; it arrived in direction `in`.
    shading::Media beyond(const shading::Media& from, const Vec3& n, const Vec3& in, const Vec3& to) const;
    bool displacementTells = false;            ///< displacementS gives the outputs of its shader, for those who ask by displacement()
    BoundKernel moveS;                         ///< P as the surface shader leaves it, where that displaces the primitive (no displacement shader)
    std::vector<LightOutput> lightOutputs;
    std::vector<char> aside;                   ///< by AOV: `lightOutputs` give it; empty: none
    std::vector<int> lights;                   ///< indices into lights
    int group = 0;                             ///< equal: same program and light list, so that points are shaded in one batch
    int program = 0;                           ///< equal: the same kernel, so that points may share a V batch
    int lightList = 0;                         ///< equal: the same list of lights
    bool usesObjectSpace = false;              ///< the kernel reads "object" or "shader" matrices that differ inside the binding
    int areaLight = -1;                        ///< the light whose geometry this is
    bool explicitSurface = true;
    Opacity opacity;                           ///< as the attributes say
    Opacity primitiveOpacity, shaderOpacity;   ///< for rays with a "hitmode"; only where there are some
    const Opacity& opacityFor(shading::HitMode m) const {
        return m == shading::HitMode::Default ? opacity : m == shading::HitMode::Primitive ? primitiveOpacity : shaderOpacity;
    }
    uint32_t primitiveFor = 0;                 ///< visibility bits of rays that take the primitive as it is (Attribute "shade")
    bool asPrimitive(shading::HitMode m, RayType t) const {
        return m == shading::HitMode::Primitive || (m == shading::HitMode::Default && (primitiveFor & visibilityBit(t)));
    }
    bool matte = false;
    float shadingRate = 1;
    int maxDiffuse = -1, maxSpecular = -1;
    float bias = 0;                            ///< Attribute "trace" "bias"; 0: the hit's own error bound
    uint32_t pointNeeds = geometry::kNeedAll;  ///< geometry::PointNeed of hits
    scene::AttributesRef attributes;
};

class WorldImpl final : public World, public shading::SpaceResolver {
public:
    const scene::Frame& frame() const override { return *frame_; }
    const Settings& settings() const override { return settings_; }
    Facts facts() const override { return facts_; }
    std::vector<int> outputWidths() const override { return outputWidths_; }
    std::vector<std::string> missingOutputs() const override { return missingOutputs_; }
    std::vector<std::string> knownOutputs() const override;
    void flushPrints(bool keep) const override { keep ? prints_.flush() : prints_.discard(); }
    bool runImager(int, const float*, const float*, float*, float*, float*, float*, Diagnostics&,
                   const StopFlag* stop) const override;
    bool matrix(const std::string& from, const std::string& to, Matrix& out) const override;
    /// Works out the matrices of kernel inputs "space:FROM>TO" once, before the first ray: matrix() then looks them up.
    void keepSpaces(const std::vector<std::string>& inputs);
    std::map<std::string, std::map<std::string, Matrix>> spaces_; ///< from, to
    /// Whether a space of this name is predefined or the scene has one.
    bool knowsSpace(const std::string& name) const;

    InstanceRef instance(const scene::ShaderCall&, rsl::ShaderKind, Diagnostics&, bool anyKind = false);
    /// Handles among these parameters that name neither one of `bound` nor a light: null, and an error with the place.
    void dropMissingHandles(const ShaderInstance& of, std::map<std::string, std::string>& texts,
                            const std::vector<std::pair<std::string, scene::ShaderRef>>& bound, Diagnostics&) const;
    /// A shader that uses co-shaders, with those that these attributes have and, of these lights (indices into Frame::lights),
    /// the class lights that have what it calls; any other as it is.
    InstanceRef withCoShaders(const InstanceRef&, const std::map<std::string, scene::ShaderRef>& coshaders, Diagnostics&,
                              const std::vector<int>& lights = {});
    /// Fills outputWidths_: how many numbers each AOV has in the shaders of the frame.
    void measureOutputs();
    InstanceRef builtin(const std::string& name, rsl::ShaderKind, Diagnostics&);
    rsl::KernelOptions kernelOptions(const ShaderInstance&, const std::vector<std::string>& outputs, const std::vector<std::string>& varying, bool mixed,
                                     bool path) const;
    BoundKernel kernel(const ShaderInstance&, const std::vector<std::string>& outputs, const std::vector<std::string>& varying, bool mixed,
                       bool path, Diagnostics&, const std::string& light = "Ci");
    /// The outputs of the kernel() of an instance, and whether light that it asks for reaches them.
    std::vector<rsl::ir::OutputLight> lightOfOutputs(const ShaderInstance&, const std::vector<std::string>& outputs,
                                                     const std::vector<std::string>& varying, bool path) const;

    /// Matrices of the camera, from the frame's options.
    void setCamera(const scene::Options&);
    /// Of a surface shader (as it is bound) that assigns P: the kernel that gives P alone, run when shapes are diced. None where the shader leaves
    /// P as it is, and where light or rays decide, which is reported.
    BoundKernel movingKernel(const ShaderInstance&, const BoundKernel&, const std::vector<std::string>& varying, Diagnostics&);
    /// Makes the meshes that rays meet.
    void diceShapes(Diagnostics&);
    /// Says by light and binding what is to be known of points, when all kernels are bound.
    void setPointNeeds();
    void displaceGrid(const SurfaceBinding&, const geometry::Shape&, geometry::DiceGrid&, Diagnostics&) const;
    /// Fills lights_; visibility: kinds of rays that can meet a shape.
    void bindLights(Diagnostics&, const std::function<uint32_t(const geometry::Shape&)>& visibility);
    /// The lights of a list and the further blocks of their shaders.
    std::vector<int> withParts(const std::vector<int>& lights) const;
    /// Light kernels for the strings that the surfaces' loops send. After all surfaces are bound.
    void bindSentStrings(Diagnostics&);
    /// How bright the lights are; which area lights mean an intensity. After everything else is built.
    void measureLights(class Engine&, Diagnostics&);
    /// What the shape takes from shadow rays. `mode`: "shader", "primitive", "opaque" or "Os"; "": what the attributes say.
    Opacity opacityOf(const SurfaceBinding&, const geometry::Shape&, std::string mode, const std::vector<std::string>& varying, Engine&, Diagnostics&);
    /// Fills choosers_, and lightGroups_ where there are many lights; after measureLights().
    void makeChoosers(Diagnostics&);
    void groupLights(Diagnostics&);

    std::shared_ptr<const scene::Frame> frame_;
    Settings settings_;
    bool rispecSpecular_ = false;              ///< specular() has RISpec's exponent (shadeops/specular.h)
    std::map<const scene::ShaderCall*, InstanceRef> coShaders_;              ///< instances, one a request
    std::map<std::vector<const void*>, InstanceRef> withCoShaders_;          ///< by shader, then the requests of its co-shaders
    Facts facts_;
    std::vector<geometry::ShapeRef> shapes_;
    std::unordered_map<const geometry::Shape*, uint32_t> numberOfShape_; ///< index into shapes_
    bool traceSubsets_ = false;                ///< some shape has Attribute "grouping" "tracesubset"
    std::vector<int> bindingOf_;               ///< by shape
    std::vector<SurfaceBinding> bindings_;
    std::vector<Medium> media_;                ///< of Interior and Exterior
    shading::Media eye_;                       ///< where camera rays begin
    void findEye();                            ///< fills eye_; once rays can be sent
    void goOn(accel::Ray&, const accel::Hit&) const; ///< behind what it met
    int groups_ = 0;                           ///< number of different SurfaceBinding::group
    std::vector<BoundLight> lights_;
    std::unique_ptr<accel::Accel> accel_;
    Matrix worldToCamera_, cameraToWorld_;
    Matrix cameraToScreen_, screenToNdc_, ndcToRaster_;
    std::vector<int> outputWidths_;
    std::vector<std::string> missingOutputs_;
    /// All shaders that could give an output.
    std::set<const ShaderInstance*> givers() const;
    std::vector<LightOutputPlace> lightOutputs_;
    std::unique_ptr<texture::TextureSystem> textures_;
    std::shared_ptr<rsl::ShaderCompiler> compiler_;
    Diagnostics* diagnostics_ = nullptr;
    mutable rsl::PrintLog prints_;
    mutable std::mutex imagerMutex_;
    struct BoundImager { bool bound = false; InstanceRef shader; BoundKernel kernel; };
    BoundImager imager_;                       ///< by runImager(), under the lock
    bool built_ = false;                       ///< threads read the world now
    std::vector<std::string> lightMessages_;   ///< parameters of surfaces that lights and atmospheres ask for, sorted
    std::set<std::string> lightDisplacements_; ///< outputs of displacement shaders that lights ask for; "": of names made when they run
    bool lightsAsk_ = false;                   ///< some light asks about the surface that it lights (BoundLight::asksSurface)
    bool lightsAsk() const { return lightsAsk_; }
    int maxDepth_ = 32;
    /// The most trace() calls of lights that shading a point brings, about: of limits::kLightsSampled lights, for each loop over
    /// lights and lighting shadeop of the surface that has most of them.
    int lightTraces_ = 0;
    void countLightTraces();
    bool lightChannels_ = false;               ///< lights give AOVs by outputchannel()
    bool footprints_ = false;                  ///< some kernel reads du or dv
    bool allOpaque_ = true;                    ///< no opacity below 1: shadow rays need no shading
    /// Where that is not so, by shape, what rays without a "hitmode" may be asked to meet alone: shapes that block all light, and the
    /// others; and a box about those.
    struct ByOpacity {
        std::vector<uint8_t> opaque, clear;
        geometry::Bounds clearBounds;
    } byOpacity_;
    void sortByOpacity();
    bool fades_ = false;                       ///< some shape is between levels of detail
    bool hitModes_ = false;                    ///< some call has a "hitmode"
    BoundKernel primitiveHit_;                 ///< shows primitives as they are; only where some ray may want that
    ShapeSubsets subsets_;
    std::vector<std::vector<int>> sampledLights_; ///< by SurfaceBinding::lightList: lights that get samples, in order
    /// Lights of one program that one kernel call evaluates for points that ask for different ones of them.
    struct LightGroup { BoundKernel kernel; };
    std::vector<LightGroup> lightGroups_;
    /// By the same: empty where all of them are sampled at every vertex. numberOf: by light, its place in the list, else -1.
    struct ChooserOfList { LightChooser chooser; std::vector<int> numberOf; };
    std::vector<ChooserOfList> choosers_;
    std::unordered_map<const geometry::Shape*, int> hazyEmitters_; ///< emitters in an atmosphere -> their binding
    float clipNear_ = 0, clipFar_ = 1;         ///< of the request Clipping, for depth()
    std::vector<std::pair<Vec3d, Vec3d>> clippingPlanes_; ///< camera space point, normal; camera rays see nothing on the normal's side
};

// Two threads that come first both open the map: the same one.
template <class Place> texture::Handle TextureSite::map(const WorldImpl& world, Place&& place) const {
    if (!opened_.load(std::memory_order_acquire)) {
        if (!name.empty()) map_.store(world.textures_->open(name, world.settings_.texturePaths, place()), std::memory_order_relaxed);
        opened_.store(true, std::memory_order_release);
    }
    return map_.load(std::memory_order_relaxed);
}

} // namespace alpenglow::transport
