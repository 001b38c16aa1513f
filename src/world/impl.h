// The inside of World, for the rooms of transport only: what hits, shaders and lights are bound to.
#pragma once
#include "rsl/passes/optimize.h"
#include "rsl/printlog.h"
#include "scene/fwd.h"
#include "scene/motion.h"
#include "texture/irradiance.h"
#include "texture/skydirections.h"
#include "world/bound.h"
#include "world/evaluator.h"
#include "world/lightchooser.h"
#include "world/photonstore.h"
#include "world/records.h"
#include "world/turnedaway.h"
#include "world/unmade.h"
#include "world/world.h"
#include <functional>
#include <unordered_map>

namespace alpenglow::transport {

/// The subsets of a world's shapes that rays were restricted to.
class ShapeSubsets {
public:
    /// By shape, whether rays of this "subset" and "excludesubset" consider it; null: all. Good as long as the world. Thread
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
    std::vector<TurnedAwayCall> callsTurnedAway() const override { return turnedAway_.blocked(); }
    std::vector<std::string> knownOutputs() const override;
    void flushPrints(bool keep) const override { keep ? prints_.flush() : prints_.discard(); }
    bool interpolates() const override { return interpolates_; }
    size_t keepRecords() const override { return records_.keep(); }
    bool runImager(int, const float*, const float*, float*, float*, float*, float*, Diagnostics&,
                   const StopFlag* stop) const override;
    bool matrix(const std::string& from, const std::string& to, Matrix& out) const override;
    /// Works out the matrices of a kernel's spaces once, before the first ray: matrix() then looks them up.
    void keepSpaces(std::span<const rsl::InputName> spaces);
    std::map<std::string, std::map<std::string, Matrix>> spaces_; ///< from, to
    /// Whether a space of this name is predefined or the scene has one.
    bool knowsSpace(const std::string& name) const;

    InstanceRef instance(const scene::ShaderCall&, rsl::ShaderKind, Diagnostics&, bool anyKind = false);
    void setParameters(ShaderInstance&, const scene::ShaderCall&, Diagnostics&);
    void takeValues(ShaderInstance&, const std::vector<rsl::ParameterValue>& given, Diagnostics&);
    /// Handles among these parameters that name neither one of `bound` nor a light: null, and an error with the place.
    void dropMissingHandles(const ShaderInstance& of, std::map<std::string, std::string>& texts,
                            const std::vector<std::pair<std::string, scene::ShaderRef>>& bound, Diagnostics&) const;
    /// A shader that uses co-shaders, with those that these attributes have and, of these lights (indices into Frame::lights),
    /// the class lights that have what it calls; any other as it is.
    InstanceRef withCoShaders(const InstanceRef&, const std::map<std::string, scene::ShaderRef>& coshaders, Diagnostics&,
                              const scene::LightSet& lights = {});
    /// Fills outputWidths_: how many numbers each AOV has in the shaders of the frame.
    void measureOutputs();
    InstanceRef builtin(const std::string& name, rsl::ShaderKind, Diagnostics&);
    rsl::KernelOptions kernelOptions(const ShaderInstance&, const std::vector<std::string>& outputs,
                                     const std::vector<std::string>& varying, bool mixed, bool path) const;
    BoundKernel kernel(const ShaderInstance&, const std::vector<std::string>& outputs, const std::vector<std::string>& varying,
                       bool mixed, bool path, Diagnostics&, const std::string& light = "Ci");
    /// Warns where a shader divides by a parameter that is 0.
    void sayZeroDivisions(const ShaderInstance&, const rsl::KernelOptions&, Diagnostics&);
    std::set<std::string> zeroDivisors_; ///< shaders, their calls and such parameters that it has looked at
    /// The outputs of the kernel() of an instance, and whether light that it asks for reaches them.
    std::vector<rsl::ir::OutputLight> lightOfOutputs(const ShaderInstance&, const std::vector<std::string>& outputs,
                                                     const std::vector<std::string>& varying, bool path) const;

    /// Matrices of the camera, from the frame's options.
    void setCamera(const scene::Options&);
    /// Of a surface shader (as it is bound) that assigns P: the kernel that gives P alone, run when shapes are diced. None where
    /// the shader leaves P as it is, and where rays decide, or lights that need more than their shaders, which is reported.
    BoundKernel movingKernel(const ShaderInstance&, const BoundKernel&, const scene::LightSet&,
                             const std::vector<std::string>& varying, Diagnostics&);
    /// Fills numberOfShape_ and moves_.
    void numberShapes();
    /// Makes the meshes that rays meet.
    void diceShapes(Diagnostics&);
    bool movesPoints(const SurfaceBinding&, const geometry::Shape&) const;
    /// No shader and no light sends rays or wants points of whole surfaces: pictures are made of rays of the camera alone. Once
    /// surfaces are bound.
    bool onlyCameraRays() const;
    /// Says by light and binding what is to be known of points, when all kernels are bound.
    void setPointNeeds();
    void displaceGrid(const SurfaceBinding&, const geometry::Shape&, geometry::DiceGrid&, Diagnostics&) const;
    /// photons: with what its generatePhoton() gives.
    BoundKernel lightKernel(const ShaderInstance&, bool photons, Diagnostics&);
    void bindPhotons(BoundLight&, Diagnostics&);
    void bindLightOutputs(BoundLight&, int block);
    /// Fills lights_; visibility: kinds of rays that can meet a shape.
    void bindLights(Diagnostics&, const std::function<uint32_t(const geometry::Shape&)>& visibility);
    /// The lights of a list of the scene's, and the further blocks of their shaders.
    scene::LightSet withParts(const scene::LightSet& lights) const;
    /// Calls f for the lights of such a list: of a shader with several blocks one behind the other. Until f says true.
    template <class F> void eachLight(const scene::LightSet& lights, F&& f) const {
        for (const int l : lights) {
            if (size_t(l) >= sceneLights_) return; // the rest are parts, which follow their shader's first block
            if (f(l)) return;
            for (const int part : lights_[size_t(l)].parts)
                if (f(part)) return;
        }
    }
    /// Light kernels for the strings that the surfaces' loops send. After all surfaces are bound.
    void bindSentStrings(Diagnostics&);
    /// How bright the lights are; which area lights mean an intensity. After everything else is built.
    void measureLights(Evaluator&, Diagnostics&);
    /// What the shape takes from shadow rays. `mode`: "shader", "primitive", "opaque" or "Os"; "": what the attributes say.
    Opacity opacityOf(const SurfaceBinding&, const geometry::Shape&, std::string mode, const std::vector<std::string>& varying,
                      Evaluator&, Diagnostics&);
    /// Fills choosers_, and lightGroups_ where there are many lights; after measureLights().
    void makeChoosers(Diagnostics&);
    void groupLights(Diagnostics&);

    std::shared_ptr<const scene::Frame> frame_;
    size_t sceneLights_ = 0;   ///< lights of frame_; those after them in lights_ are further blocks of their shaders
    MakeEvaluator evaluators_; ///< kept for the imager
    Settings settings_;
    bool rispecSpecular_ = false;                                   ///< specular() has RISpec's exponent (shadeops/specular.h)
    std::map<const scene::ShaderCall*, InstanceRef> coShaders_;     ///< instances, one a request
    std::map<std::vector<const void*>, InstanceRef> withCoShaders_; ///< by shader, then the requests of its co-shaders
    Facts facts_;
    std::vector<geometry::ShapeRef> shapes_;
    /// Index into shapes_; of a placed geometry, its first place.
    std::unordered_map<const geometry::Shape*, uint32_t> numberOfShape_;
    /// What numbers of a shape are drawn by: its own, or where procedurals wait, what does not depend on which were made.
    uint32_t keyOfShape(uint32_t shape) const { return keysOfShapes_.empty() ? shape : keysOfShapes_[shape]; }
    std::vector<uint32_t> keysOfShapes_; ///< empty: their numbers
    std::unique_ptr<Unmade> unmade_;     ///< null: the frame has no procedurals that wait
    geometry::Bounds procedurals_;       ///< around all that wait or have waited
    void findProcedurals();              ///< fills these two
    /// Encloses everything, and does not depend on which procedurals were made.
    geometry::Bounds bounds() const {
        geometry::Bounds b = accel_->bounds();
        b.add(procedurals_);
        return b;
    }
    scene::Shutter shutter_;
    bool moves_ = false;        ///< some shape does
    bool shadesAtOpen_ = false; ///< surfaces are shaded where they are when the shutter opens, and send rays then
    float timeAt(float shutter) const { return float(shutter_.at(double(shutter))); }
    /// time and dtime of a point at its shutter: the whole shutter where surfaces are shaded as it opens, else an instant.
    void tellTime(shading::ShadePoint& p) const {
        p.time = timeAt(p.shutter);
        p.dtime = shadesAtOpen_ && shutter_.opens() ? float(shutter_.close - shutter_.open) : 0;
    }
    /// When a ray goes, as part of the time that the shutter is open.
    float shutterOf(const shading::PathRay& r) const { return shadesAtOpen_ && !r.camera() ? 0 : r.shutter(); }
    /// dPdtime of a point of a shape.
    Vec3 pointsVelocity(const geometry::Shape& s, const geometry::SurfacePoint& p) const {
        return shutter_.opens() ? s.velocity(p) / float(shutter_.close - shutter_.open) : Vec3(0.f);
    }
    bool traceSubsets_ = false;  ///< some shape has Attribute "grouping" "tracesubset"
    std::vector<int> bindingOf_; ///< by shape
    std::vector<SurfaceBinding> bindings_;
    std::vector<Medium> media_; ///< of Interior and Exterior
    shading::Media eye_;        ///< where camera rays begin
    bool scatters_ = false;     ///< some of media_ do
    void findEye();             ///< fills eye_; once rays can be sent
    /// Fills what a medium's shader says of it by its outputs.
    void bindHomogeneous(Medium&, Evaluator&, Diagnostics&);
    void placeLights(Evaluator&); ///< finds where lights stand that scattering media may be near; after all is bound
    void goOn(accel::Ray&, const accel::Hit&) const; ///< behind what it met
    int groups_ = 0;                                 ///< number of different SurfaceBinding::group
    std::vector<BoundLight> lights_;
    std::vector<uint8_t> shining_; ///< by shape: rays find an area light there
    void findShining();            ///< fills it; never empty
    std::unique_ptr<accel::Accel> accel_;
    Matrix worldToCamera_, cameraToWorld_;
    Matrix cameraToScreen_, screenToNdc_, ndcToRaster_;
    std::vector<rsl::OutputName> wanted_; ///< Settings::outputs
    std::vector<int> outputWidths_;
    std::vector<std::string> missingOutputs_;
    /// All shaders that could give an output.
    std::set<const ShaderInstance*> givers() const;
    std::vector<LightOutputPlace> lightOutputs_;
    std::unique_ptr<texture::TextureSystem> textures_;
    std::shared_ptr<rsl::ShaderCompiler> compiler_;
    Diagnostics* diagnostics_ = nullptr;
    mutable rsl::PrintLog prints_;
    texture::IrradianceTables irradiance_;
    texture::SkyDirectionTables skyMaps_;
    std::shared_ptr<PhotonStore> photons_; ///< changes between passes only, when nobody follows rays
    std::shared_ptr<CloudStore> clouds_;   ///< point clouds that are read, and what is baked; keeps itself safe
    std::shared_ptr<PtexStore> ptex_;      ///< Ptex files that are read; keeps itself safe
    mutable TurnedAway turnedAway_;
    bool globalMaps_ = false; ///< some surface has a global photon map, and some indirectdiffuse() may meet it
    mutable LightRecords records_;
    bool interpolates_ = false; ///< some call may want records
    mutable std::mutex imagerMutex_;
    struct BoundImager {
        bool bound = false;
        InstanceRef shader;
        BoundKernel kernel;
    };
    BoundImager imager_;                     ///< by runImager(), under the lock
    bool built_ = false;                     ///< threads read the world now
    std::vector<std::string> lightMessages_; ///< parameters of surfaces that lights and atmospheres ask for, sorted
    std::set<std::string>
        lightDisplacements_; ///< outputs of displacement shaders that lights ask for; "": of names made when they run
    bool lightsAsk_ = false; ///< some light asks about the surface that it lights (BoundLight::asksSurface)
    bool lightsAsk() const { return lightsAsk_; }
    int maxDepth_ = 32;
    /// The most trace() calls of lights that shading a point brings, about: of limits::kLightsSampled lights, for each loop over
    /// lights and lighting shadeop of the surface that has most of them.
    int lightTraces_ = 0;
    void countLightTraces();
    bool lightChannels_ = false; ///< lights give AOVs by outputchannel()
    bool footprints_ = false;    ///< some kernel reads du or dv
    bool allOpaque_ = true;      ///< no opacity below 1: shadow rays need no shading
    /// Where that is not so, by shape, what rays without a "hitmode" may be asked to meet alone: shapes that block all light, and
    /// the others; and a box about those.
    struct ByOpacity {
        std::vector<uint8_t> opaque, clear;
        geometry::Bounds clearBounds;
        /// Of the others where they are few: these alone, and the numbers that its shapes have here; else null.
        std::unique_ptr<accel::Accel> few;
        std::vector<uint32_t> numbers;
    } byOpacity_;
    bool mediaOverrule_ = false; ///< media differ in priority: some surfaces bound nothing, and stop no ray, inside of others
    void sortByOpacity(std::span<const uint32_t> visibility);
    /// What surfaces are to photons that are visible to rays as `visibility` says, by shape. photonattributes.cpp
    void bindPhotons(std::span<const uint32_t> visibility);
    bool fades_ = false;       ///< some shape is between levels of detail
    bool hitModes_ = false;    ///< some call has a "hitmode"
    BoundKernel primitiveHit_; ///< shows primitives as they are; only where some ray may want that
    ShapeSubsets subsets_;
    /// Lights that surfaces have in common.
    struct LightList {
        scene::LightSet lights;
        /// Those that get samples, in order. With `ofAll`: not listed, they are those of allSampled_ that are in `lights`.
        std::vector<int> sampled;
        LightChooser chooser; ///< over `sampled`; empty where each of them is sampled at every vertex
        LightChooser deeper;  ///< the same behind the first vertex of a path, where fewer are sampled; empty where `chooser` is
        bool ofAll = false;
    };
    std::vector<LightList> lightLists_; ///< by SurfaceBinding::lightList
    /// Where lists would take too much room together, the later ones share one list and its chooser.
    std::vector<int> allSampled_;
    LightChooser allChooser_, allDeeper_;
    size_t listed_ = 0; ///< numbers in LightList::sampled of all lists
    bool getsSamples(const BoundLight&) const;
    const std::vector<int>& sampledOf(const LightList& l) const { return l.ofAll ? allSampled_ : l.sampled; }
    const LightChooser& chooserOf(const LightList& l) const { return l.ofAll ? allChooser_ : l.chooser; }
    /// What chooses lights at a vertex after so many bounces; empty: each is sampled.
    const LightChooser& chooserAt(const LightList& l, int bounces) const {
        return bounces == 0 ? chooserOf(l) : l.ofAll ? allDeeper_ : l.deeper;
    }
    std::vector<int> skies_; ///< what rays see that meet nothing: lights of kind Environment and Ambient
    /// Finds where skies are bright (BoundLight::sky). Before surfaces are bound.
    void tabulateSkies(Evaluator&);
    /// Lights of one program that one kernel call evaluates for points that ask for different ones of them.
    struct LightGroup {
        BoundKernel kernel;
    };
    std::vector<LightGroup> lightGroups_;
    std::unordered_map<const geometry::Shape*, int> hazyEmitters_; ///< emitters in an atmosphere -> their binding
    float clipNear_ = 0, clipFar_ = 1;                             ///< of the request Clipping, for depth()
    std::vector<std::pair<Vec3d, Vec3d>>
        clippingPlanes_; ///< camera space point, normal; camera rays see nothing on the normal's side
};

// Two threads that come first both open the map: the same one.
template <class Place> texture::Handle TextureSite::map(const WorldImpl& world, Place&& place) const {
    if (!opened_.load(std::memory_order_acquire)) {
        if (!name.empty())
            map_.store(world.textures_->open(name, world.settings_.texturePaths, place()), std::memory_order_relaxed);
        opened_.store(true, std::memory_order_release);
    }
    return map_.load(std::memory_order_relaxed);
}

} // namespace alpenglow::transport
