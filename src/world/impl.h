// Implementation of World for its users inside of the renderer: shapes, shaders and lights with their bindings.
#pragma once
#include "rsl/passes/optimize.h"
#include "rsl/printlog.h"
#include "scene/fwd.h"
#include "scene/motion.h"
#include "texture/irradiance.h"
#include "texture/skydirections.h"
#include "world/bound.h"
#include "world/deferred.h"
#include "world/evaluator.h"
#include "world/flippednormals.h"
#include "world/lightchooser.h"
#include "world/photonstore.h"
#include "world/records.h"
#include "world/service.h"
#include "world/world.h"
#include <functional>
#include <unordered_map>

namespace alpenglow::world {

/// Subsets of a world's shapes that rays are restricted to.
class ShapeSubsets {
public:
    /// By shape: whether rays with this "subset" and "excludesubset" consider it; null: all. Valid as long as the world. Thread
    /// safe.
    const uint8_t* find(const class WorldImpl&, const std::string& wanted, const std::string& unwanted) const;

private:
    mutable std::mutex mutex_;
    mutable std::map<std::string, std::vector<uint8_t>> kept_;
};

class CloudStore; // world/cloudstore.h
class PtexStore;  // world/ptexstore.h

class WorldImpl final : public World, public shading::SpaceResolver {
public:
    const scene::Frame& frame() const override { return *frame_; }
    const Settings& settings() const override { return settings_; }
    Facts facts() const override { return facts_; }
    std::vector<MapRead> mapsRead() const override;
    PhotonStore* photons() const override { return photons_.get(); }
    std::vector<int> outputWidths() const override { return outputWidths_; }
    std::vector<std::string> missingOutputs() const override { return missingOutputs_; }
    std::vector<std::pair<std::string, SourcePlace>> cloudsFoundEmpty() const override;
    std::vector<FlippedNormalsCall> callsTurnedAway() const override { return turnedAway_.blocked(); }
    NamedMedium medium(size_t) const override;
    std::vector<std::string> knownOutputs() const override;
    void flushPrints(bool keep) const override { keep ? prints_.flush() : prints_.discard(); }
    bool interpolates() const override { return needs_.records; }
    size_t keepRecords() const override { return records_.keep(); }
    bool runImager(int, const float*, const float*, float*, float*, float*, float*, Diagnostics&,
                   const StopFlag* stop) const override;
    bool matrix(const std::string& from, const std::string& to, Matrix& out) const override;
    /// Computes the matrices of a kernel's spaces once, before the first ray, so that matrix() finds them in the table.
    void keepSpaces(std::span<const rsl::InputName> spaces);
    std::map<std::string, std::map<std::string, Matrix>> spaces_; ///< from, to
    /// Whether a space is predefined or defined by the scene.
    bool knowsSpace(const std::string& name) const;

    InstanceRef instance(const scene::ShaderCall&, rsl::ShaderKind, Diagnostics&, bool anyKind = false);
    void setParameters(ShaderInstance&, const scene::ShaderCall&, Diagnostics&);
    void takeValues(ShaderInstance&, const std::vector<rsl::ParameterValue>& given, Diagnostics&);
    /// Sets handles among these parameters to null that name neither one of `bound` nor a light, and reports an error with its
    /// place.
    void dropMissingHandles(const ShaderInstance& of, std::map<std::string, std::string>& texts,
                            const std::vector<std::pair<std::string, scene::ShaderRef>>& bound, Diagnostics&) const;
    /// An instance with the co-shaders of these attributes and, from these lights (indices in Frame::lights), the class lights
    /// with methods that it calls. Returns the instance itself if it uses no co-shaders.
    InstanceRef withCoShaders(const InstanceRef&, const std::map<std::string, scene::ShaderRef>& coshaders, Diagnostics&,
                              const scene::LightSet& lights = {});
    /// Fills outputWidths_: number of components of each AOV in the shaders of the frame.
    void measureOutputs();
    InstanceRef builtin(const std::string& name, rsl::ShaderKind, Diagnostics&);
    rsl::KernelOptions kernelOptions(const ShaderInstance&, const std::vector<std::string>& outputs,
                                     const std::vector<std::string>& varying, bool mixed, bool path) const;
    BoundKernel kernel(const ShaderInstance&, const std::vector<std::string>& outputs, const std::vector<std::string>& varying,
                       bool mixed, bool path, Diagnostics&, const std::string& light = "Ci");
    /// Warns if a shader divides by a parameter that is 0.
    void sayZeroDivisions(const ShaderInstance&, const rsl::KernelOptions&, Diagnostics&);
    std::set<std::string> zeroDivisors_; ///< shaders, calls and parameters already checked
    /// Which outputs of an instance's kernel() receive requested light.
    std::vector<rsl::ir::OutputLight> lightOfOutputs(const ShaderInstance&, const std::vector<std::string>& outputs,
                                                     const std::vector<std::string>& varying, bool path) const;

    /// Sets what every world has: the frame, settings, services, camera, and the stores of maps, which are opened at first use.
    void begin(std::shared_ptr<const scene::Frame>, const Settings&, ServiceTable, Diagnostics&);
    /// Computes camera matrices from the frame's options.
    void setCamera(const scene::Options&);
    /// For a bound surface shader that assigns P: the kernel that computes P alone, run at dicing. None if the shader leaves P
    /// unchanged, or if P depends on rays or on lights that cannot be evaluated then; the latter is reported.
    BoundKernel movingKernel(const ShaderInstance&, const BoundKernel&, const scene::LightSet&,
                             const std::vector<std::string>& varying, Diagnostics&);
    /// Fills numberOfShape_ and moves_.
    void numberShapes();
    /// Makes the meshes that rays hit.
    void diceShapes(Diagnostics&);
    bool movesPoints(const SurfaceBinding&, const geometry::Shape&) const;
    /// Whether no shader or light sends rays or needs points of complete surfaces, so that only camera rays exist. Call after
    /// binding surfaces.
    bool onlyCameraRays() const;
    /// Sets pointNeeds of lights and bindings, after all kernels are bound.
    void setPointNeeds();
    void displaceGrid(const SurfaceBinding&, const geometry::Shape&, geometry::DiceGrid&, Diagnostics&) const;
    /// photons: with the outputs of generatePhoton().
    BoundKernel lightKernel(const ShaderInstance&, bool photons, Diagnostics&);
    void bindPhotons(BoundLight&, Diagnostics&);
    void bindLightOutputs(BoundLight&, int block);
    /// Fills lights_; visibility: kinds of rays that can hit a shape.
    void bindLights(Diagnostics&, const std::function<uint32_t(const geometry::Shape&)>& visibility);
    /// Adds to a list of the scene's lights the further blocks of their shaders.
    scene::LightSet withParts(const scene::LightSet& lights) const;
    /// Calls f for each light of such a list, all blocks of a shader in turn, until f returns true.
    template <class F> void eachLight(const scene::LightSet& lights, F&& f) const {
        for (const int l : lights) {
            if (size_t(l) >= sceneLights_) return; // the rest are parts, visited with their shader's first block
            if (f(l)) return;
            for (const int part : lights_[size_t(l)].parts)
                if (f(part)) return;
        }
    }
    /// Builds light kernels for the strings that loops of surfaces send. Call after all surfaces are bound.
    void bindSentStrings(Diagnostics&);
    /// Estimates the brightness of lights, and finds area lights whose Cl is an intensity. Call after everything else.
    void measureLights(Evaluator&, Diagnostics&);
    /// Attenuation of shadow rays by a shape. `mode`: "shader", "primitive", "opaque" or "Os"; "": by attributes.
    Opacity opacityOf(const SurfaceBinding&, const geometry::Shape&, std::string mode, const std::vector<std::string>& varying,
                      Evaluator&, Diagnostics&);
    /// Fills choosers_ and, if there are many lights, lightGroups_; after measureLights().
    void makeChoosers(Diagnostics&);
    void groupLights(Diagnostics&);

    std::shared_ptr<const scene::Frame> frame_;
    size_t sceneLights_ = 0;   ///< lights of frame_; later entries of lights_ are further blocks of their shaders
    MakeEvaluator evaluators_; ///< also used by the imager
    Settings settings_;
    ServiceTable services_;                                         ///< of services/, above this folder
    bool rispecSpecular_ = false;                                   ///< specular() uses RISpec's exponent (shadeops/specular.h)
    std::map<const scene::ShaderCall*, InstanceRef> coShaders_;     ///< one instance for each request
    std::map<std::vector<const void*>, InstanceRef> withCoShaders_; ///< by shader, then the requests of its co-shaders
    Facts facts_;
    std::vector<geometry::ShapeRef> shapes_;
    /// Index in shapes_; for an instanced geometry, its first instance.
    std::unordered_map<const geometry::Shape*, uint32_t> numberOfShape_;
    /// Random number key of a shape: its index, or with deferred procedurals a number that does not depend on which were
    /// expanded.
    uint32_t keyOfShape(uint32_t shape) const { return keysOfShapes_.empty() ? shape : keysOfShapes_[shape]; }
    std::vector<uint32_t> keysOfShapes_;       ///< empty: indices are used
    std::unique_ptr<DeferredBounds> deferred_; ///< null: no deferred procedurals
    geometry::Bounds procedurals_;             ///< around all deferred procedurals, expanded or not
    void findProcedurals();                    ///< fills deferred_ and procedurals_
    /// Bounding box of everything, independent of which procedurals were expanded.
    geometry::Bounds bounds() const {
        geometry::Bounds b = accel_->bounds();
        b.add(procedurals_);
        return b;
    }
    scene::Shutter shutter_;
    bool moves_ = false;        ///< some shape moves
    bool shadesAtOpen_ = false; ///< surfaces are shaded, and send rays, at shutter open
    float timeAt(float shutter) const { return float(shutter_.at(double(shutter))); }
    /// Sets time and dtime of a point from its shutter position: the whole shutter if surfaces are shaded at open, else an
    /// instant.
    void tellTime(shading::ShadePoint& p) const {
        p.time = timeAt(p.shutter);
        p.dtime = shadesAtOpen_ && shutter_.opens() ? float(shutter_.close - shutter_.open) : 0;
    }
    /// Time of a ray as a fraction of the open shutter.
    float shutterOf(const shading::PathRay& r) const { return shadesAtOpen_ && !r.camera() ? 0 : r.shutter(); }
    /// dPdtime of a point of a shape.
    Vec3 pointsVelocity(const geometry::Shape& s, const geometry::SurfacePoint& p) const {
        return shutter_.opens() ? s.velocity(p) / float(shutter_.close - shutter_.open) : Vec3(0.f);
    }
    bool traceSubsets_ = false;  ///< some shape has Attribute "grouping" "tracesubset"
    std::vector<int> bindingOf_; ///< by shape: index in bindings_
    std::vector<SurfaceBinding> bindings_;
    std::vector<Medium> media_; ///< of Interior and Exterior
    shading::Media eye_;        ///< media at the eye
    bool scatters_ = false;     ///< some of media_ scatter
    void findEye();             ///< fills eye_; requires the acceleration structure
    /// Reads the parameters of a homogeneous medium from its shader's outputs.
    void bindHomogeneous(Medium&, Evaluator&, Diagnostics&);
    void placeLights(Evaluator&);                    ///< finds positions of lights for sampling in media; call last
    void goOn(accel::Ray&, const accel::Hit&) const; ///< continues a ray behind its hit
    int groups_ = 0;                                 ///< number of distinct SurfaceBinding::group
    std::vector<BoundLight> lights_;
    std::vector<uint8_t> shining_; ///< by shape: an area light that rays can hit
    void findShining();            ///< fills shining_, which is not empty
    std::unique_ptr<accel::Accel> accel_;
    Matrix worldToCamera_, cameraToWorld_;
    Matrix cameraToScreen_, screenToNdc_, ndcToRaster_;
    std::vector<rsl::OutputName> wanted_; ///< Settings::outputs
    std::vector<int> outputWidths_;
    std::vector<std::string> missingOutputs_;
    /// All shaders that may write an output.
    std::set<const ShaderInstance*> givers() const;
    std::vector<LightOutputPlace> lightOutputs_;
    std::unique_ptr<texture::TextureSystem> textures_;
    std::shared_ptr<rsl::ShaderCompiler> compiler_;
    Diagnostics* diagnostics_ = nullptr;
    mutable rsl::PrintLog prints_;
    texture::IrradianceTables irradiance_;
    texture::SkyDirectionTables skyMaps_;
    std::shared_ptr<PhotonStore> photons_; ///< changes between passes only, while no thread traces
    std::shared_ptr<CloudStore> clouds_;   ///< point clouds, and baked data; thread safe
    std::shared_ptr<PtexStore> ptex_;      ///< Ptex files; thread safe
    mutable FlippedNormals turnedAway_;
    bool globalMaps_ = false; ///< some surface has a global photon map that an indirectdiffuse() may use
    mutable LightRecords records_;
    KernelNeeds needs_; ///< of all kernels, joined by kernel()
    struct BoundImager {
        InstanceRef shader;
        BoundKernel kernel;
    };
    BoundImager imager_; ///< null if the frame has none
    /// Compiles it and sets imager_. Its points are pixels, so its needs are not added to needs_.
    void bindImager(Diagnostics&);
    bool built_ = false;                     ///< threads may read the world
    std::vector<std::string> lightMessages_; ///< parameters of surfaces that lights and atmospheres query, sorted
    std::set<std::string>
        lightDisplacements_; ///< outputs of displacement shaders that lights query; "": names computed at run time
    bool lightsAsk_ = false; ///< some light queries the surface that it lights (BoundLight::asksSurface)
    bool lightsAsk() const { return lightsAsk_; }
    int maxDepth_ = 32;
    /// Largest number of trace() calls by lights at a shaded point, approximate: limits::kLightsSampled lights for each light
    /// loop and lighting shadeop of a surface.
    int lightTraces_ = 0;
    void countLightTraces();
    bool lightChannels_ = false; ///< lights write AOVs by outputchannel()
    bool allOpaque_ = true;      ///< no opacity below 1: shadow rays run no shaders
    /// Otherwise, by shape, subsets for rays without a "hitmode": shapes that block all light, and the others with their bounding
    /// box.
    struct ByOpacity {
        std::vector<uint8_t> opaque, clear;
        geometry::Bounds clearBounds;
        /// If few, the other shapes alone, with the index of each in this structure; else null.
        std::unique_ptr<accel::Accel> few;
        std::vector<uint32_t> numbers;
    } byOpacity_;
    /// Surfaces that shadow rays and rays of lobes see differently. Between such a pair only one technique finds a light, so it
    /// gets all of the weight of multiple importance sampling: the shadow ray (docs/design/light-transport.md).
    struct ShadowVisibility {
        std::unique_ptr<accel::Accel> lobesOnly; ///< shapes that shadow rays pass (Attribute "visibility"); null: none
        std::vector<uint8_t> shadowsOnly[2]; ///< by shape: shadow rays alone hit it; of diffuse and of specular rays; empty: none
        bool opacity = false;                ///< some Opacity::differs
        bool differs() const { return lobesOnly || opacity || !shadowsOnly[0].empty() || !shadowsOnly[1].empty(); }
    } shadowVisibility_;
    /// Fills it; `visibility`: kinds of rays that hit a shape, by shape.
    void findShadowVisibility(std::span<const uint32_t> visibility);
    bool mediaOverrule_ = false; ///< media differ in priority: inside some, surfaces are no boundaries and stop no ray
    void sortByOpacity(std::span<const uint32_t> visibility);
    /// Sets the photon visibility of surfaces; `visibility`: ray visibility, by shape. Defined in photonattributes.cpp.
    void bindPhotons(std::span<const uint32_t> visibility);
    bool fades_ = false;       ///< some shape fades between levels of detail
    BoundKernel primitiveHit_; ///< shows primitives by Color and Opacity; set only if rays can request it
    ShapeSubsets subsets_;
    /// A list of lights that surfaces share.
    struct LightList {
        scene::LightSet lights;
        /// Sampled lights, in order. With `ofAll` it is empty: they are those of allSampled_ that are in `lights`.
        std::vector<int> sampled;
        LightChooser chooser; ///< over `sampled`; empty if every light is sampled at every vertex
        LightChooser deeper;  ///< for later vertices of a path, where fewer are sampled; empty if `chooser` is
        bool ofAll = false;
    };
    std::vector<LightList> lightLists_; ///< by SurfaceBinding::lightList
    /// If the lists would be too large together, the later ones share one list and its chooser.
    std::vector<int> allSampled_;
    LightChooser allChooser_, allDeeper_;
    size_t listed_ = 0; ///< total size of LightList::sampled
    bool getsSamples(const BoundLight&) const;
    const std::vector<int>& sampledOf(const LightList& l) const { return l.ofAll ? allSampled_ : l.sampled; }
    const LightChooser& chooserOf(const LightList& l) const { return l.ofAll ? allChooser_ : l.chooser; }
    /// The chooser for a vertex after so many bounces; empty: every light is sampled.
    const LightChooser& chooserAt(const LightList& l, int bounces) const {
        return bounces == 0 ? chooserOf(l) : l.ofAll ? allDeeper_ : l.deeper;
    }
    std::vector<int> skies_; ///< lights that escaped rays see: kinds Environment and Ambient
    /// Builds the tables of skies (BoundLight::sky). Call before binding surfaces.
    void tabulateSkies(Evaluator&);
    /// Lights of one program that share a kernel call, for points that query different ones.
    struct LightGroup {
        BoundKernel kernel;
    };
    std::vector<LightGroup> lightGroups_;
    std::unordered_map<const geometry::Shape*, int> emittersInAtmosphere_; ///< emitters in an atmosphere, to their binding
    float clipNear_ = 0, clipFar_ = 1;                                     ///< of the request Clipping, for depth()
    std::vector<std::pair<Vec3d, Vec3d>>
        clippingPlanes_; ///< camera space point, normal; camera rays see nothing on the side of the normal
};

/// The world of no scene: an empty frame with the default camera and no shapes, lights or shaders. For services of shaders that
/// run without a scene (alpenglow eval and shade). `settings`: where maps are looked up.
std::shared_ptr<const WorldImpl> emptyWorld(const Settings&, ServiceTable, Diagnostics&);

// If two threads open the map at once, both get the same one.
template <class Place> texture::Handle TextureSite::map(const WorldImpl& world, Place&& place) const {
    if (!opened_.load(std::memory_order_acquire)) {
        if (!name.empty())
            map_.store(world.textures_->open(name, world.settings_.texturePaths, place()), std::memory_order_relaxed);
        opened_.store(true, std::memory_order_release);
    }
    return map_.load(std::memory_order_relaxed);
}

} // namespace alpenglow::world
