// Implementation of World for its users inside of the renderer: shapes, shaders and lights with their bindings, to be read.
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
    mutable std::mutex mutex_; ///< guards kept_, a cache: a set is the same whoever asks first
    mutable std::map<std::string, std::vector<uint8_t>> kept_;
};

class CloudStore; // world/cloudstore.h
class PtexStore;  // world/ptexstore.h

/// A world as kernels, rays and services read it. Nothing of it changes after World::build(): MutableWorld (mutableworld.h) has
/// what builds it. Thread safe. Spaces and bounds are those of camera space at shutter open.
class WorldImpl : public World, public shading::SpaceResolver {
public:
    const scene::Frame& frame() const final { return *frame_; }
    const Settings& settings() const final { return settings_; }
    Facts facts() const final { return facts_; }
    std::vector<MapRead> mapsRead() const final;
    PhotonStore* photons() const final { return photons_.get(); } ///< changes between passes only, while no thread traces
    std::vector<int> outputWidths() const final { return outputWidths_; }
    std::vector<std::string> missingOutputs() const final { return missingOutputs_; }
    std::vector<std::pair<std::string, SourcePlace>> cloudsFoundEmpty() const final;
    std::vector<FlippedNormalsCall> callsTurnedAway() const final { return turnedAway_.blocked(); }
    NamedMedium medium(size_t) const final;
    std::vector<std::string> knownOutputs() const final;
    void flushPrints(bool keep) const final { keep ? prints_.flush() : prints_.discard(); }
    bool interpolates() const final { return needs_.records; }
    size_t keepRecords() const final { return records_.keep(); }
    bool runImager(int, const float*, const float*, float*, float*, float*, float*, Diagnostics&,
                   const StopFlag* stop) const final;

    // Spaces and time
    bool matrix(const std::string& from, const std::string& to, Matrix& out) const final;
    /// Whether a space is predefined or defined by the scene.
    bool knowsSpace(const std::string& name) const;
    const Matrix& worldToCamera() const { return worldToCamera_; }
    const Matrix& cameraToWorld() const { return cameraToWorld_; }
    const scene::Shutter& shutter() const { return shutter_; }
    bool shadesAtOpen() const { return shadesAtOpen_; } ///< surfaces are shaded, and send rays, at shutter open
    /// The shader variable `time`, in units of the scene, at a fraction of the open shutter.
    float timeAt(float shutter) const { return float(shutter_.at(double(shutter))); }
    /// Sets time and dtime of a point from its shutter position: the whole shutter if surfaces are shaded at open, else an
    /// instant.
    void setTime(shading::ShadePoint& p) const {
        p.time = timeAt(p.shutter);
        p.dtime = shadesAtOpen_ && shutter_.opens() ? float(shutter_.close - shutter_.open) : 0;
    }
    /// Time of a ray as a fraction of the open shutter.
    float shutterOf(const shading::PathRay& r) const { return shadesAtOpen_ && !r.camera() ? 0 : r.shutter(); }
    /// dPdtime of a point of a shape.
    Vec3 pointsVelocity(const geometry::Shape& s, const geometry::SurfacePoint& p) const {
        return shutter_.opens() ? s.velocity(p) / float(shutter_.close - shutter_.open) : Vec3(0.f);
    }
    float clipNear() const { return clipNear_; } ///< of the request Clipping, for depth()
    /// Camera space.
    float clipFar() const { return clipFar_; }
    /// A point and a normal each; camera rays see nothing on the side of the normal.
    const std::vector<std::pair<Vec3d, Vec3d>>& clippingPlanes() const { return clippingPlanes_; }

    // Shapes
    const std::vector<geometry::ShapeRef>& shapes() const { return shapes_; }
    /// Index in shapes(); for an instanced geometry, its first instance.
    const std::unordered_map<const geometry::Shape*, uint32_t>& numberOfShape() const { return numberOfShape_; }
    /// Random number key of a shape: its index, or with deferred procedurals a number that does not depend on which were
    /// expanded.
    uint32_t keyOfShape(uint32_t shape) const { return keysOfShapes_.empty() ? shape : keysOfShapes_[shape]; }
    /// Whether rays can be traced: false while shaders and lights are bound, when kernels already run.
    bool canTrace() const { return accel_ != nullptr; }
    const accel::Accel& accel() const { return *accel_; }              ///< requires canTrace()
    const DeferredBounds* deferred() const { return deferred_.get(); } ///< null: no deferred procedurals
    /// Bounding box of everything, independent of which procedurals were expanded.
    geometry::Bounds bounds() const {
        geometry::Bounds b = accel_->bounds();
        b.add(procedurals_);
        return b;
    }
    bool moves() const { return moves_; }               ///< some shape moves
    bool fades() const { return fades_; }               ///< some shape fades between levels of detail
    bool traceSubsets() const { return traceSubsets_; } ///< some shape has Attribute "grouping" "tracesubset"
    /// Of rays by group.
    const ShapeSubsets& subsets() const { return subsets_; }
    void goOn(accel::Ray&, const accel::Hit&) const; ///< continues a ray behind its hit

    // Surfaces
    const std::vector<int>& bindingOf() const { return bindingOf_; } ///< by shape: index in bindings()
    const std::vector<SurfaceBinding>& bindings() const { return bindings_; }
    int groups() const { return groups_; } ///< number of distinct SurfaceBinding::group
    /// Of the shader of primitives without one.
    const BoundKernel& primitiveHit() const {
        return primitiveHit_;
    } ///< shows primitives by Color and Opacity; set only if rays can request it
    const KernelNeeds& needs() const { return needs_; } ///< of all kernels, joined
    int maxDepth() const { return maxDepth_; }          ///< bounces of a path
    bool globalMaps() const { return globalMaps_; } ///< some surface has a global photon map that an indirectdiffuse() may use

    // Opacity
    bool allOpaque() const { return allOpaque_; } ///< no opacity below 1: shadow rays run no shaders
    /// Otherwise, by shape, subsets for rays without a "hitmode": shapes that block all light, and the others with their bounding
    /// box.
    struct ByOpacity {
        std::vector<uint8_t> opaque, clear; ///< for RaySet::only
        geometry::Bounds clearBounds;       ///< camera space
        /// If few, the other shapes alone, with the index of each in this structure; else null.
        std::unique_ptr<accel::Accel> few;
        std::vector<uint32_t> numbers;
    };
    const ByOpacity& byOpacity() const { return byOpacity_; }
    /// Surfaces that shadow rays and rays of lobes see differently. Between such a pair only one technique finds a light, so it
    /// gets all of the weight of multiple importance sampling: the shadow ray (docs/design/light-transport.md).
    struct ShadowVisibility {
        std::unique_ptr<accel::Accel> lobesOnly; ///< shapes that shadow rays pass (Attribute "visibility"); null: none
        std::vector<uint8_t> shadowsOnly[2]; ///< by shape: shadow rays alone hit it; of diffuse and of specular rays; empty: none
        bool opacity = false;                ///< some Opacity::differs
        /// Both see the same otherwise.
        bool differs() const { return lobesOnly || opacity || !shadowsOnly[0].empty() || !shadowsOnly[1].empty(); }
    };
    const ShadowVisibility& shadowVisibility() const { return shadowVisibility_; }

    // Media
    const std::vector<Medium>& media() const { return media_; } ///< of Interior and Exterior
    const shading::Media& eye() const { return eye_; }          ///< media at the eye
    bool scatters() const { return scatters_; }                 ///< some of media() scatter
    /// Whether volumes of different priority overlap, so that surfaces may not count.
    bool mediaOverrule() const {
        return mediaOverrule_;
    } ///< media differ in priority: inside some, surfaces are no boundaries and stop no ray

    // Lights
    const std::vector<BoundLight>& lights() const {
        return lights_;
    } ///< those of the frame, then further blocks of their shaders
    /// Calls f for each light of a list of the scene's, all blocks of a shader in turn, until f returns true.
    template <class F> void eachLight(const scene::LightSet& lights, F&& f) const {
        for (const int l : lights) {
            if (size_t(l) >= sceneLights_) return; // the rest are parts, visited with their shader's first block
            if (f(l)) return;
            for (const int part : lights_[size_t(l)].parts)
                if (f(part)) return;
        }
    }
    const std::vector<uint8_t>& shining() const { return shining_; } ///< by shape: an area light that rays can hit; never empty
    const std::vector<int>& skies() const { return skies_; } ///< lights that escaped rays see: kinds Environment and Ambient
    /// Emitters in an atmosphere, to their binding.
    const std::unordered_map<const geometry::Shape*, int>& emittersInAtmosphere() const { return emittersInAtmosphere_; }
    bool lightsAsk() const { return lightsAsk_; } ///< some light queries the surface that it lights (BoundLight::asksSurface)
    /// Largest number of trace() calls by lights at a shaded point, approximate: limits::kLightsSampled lights for each light
    /// loop and lighting shadeop of a surface.
    int lightTraces() const { return lightTraces_; }
    /// A list of lights that surfaces share.
    struct LightList {
        scene::LightSet lights;
        /// Sampled lights, in order. With `ofAll` it is empty: they are those of all lists that are in `lights`.
        std::vector<int> sampled;
        LightChooser chooser; ///< over `sampled`; empty if every light is sampled at every vertex
        LightChooser deeper;  ///< for later vertices of a path, where fewer are sampled; empty if `chooser` is
        bool ofAll = false;   ///< it has all lights of the frame
    };
    const std::vector<LightList>& lightLists() const { return lightLists_; } ///< by SurfaceBinding::lightList
    /// The sampled lights of a list; with `ofAll` those of all lists.
    const std::vector<int>& sampledOf(const LightList& l) const { return l.ofAll ? allSampled_ : l.sampled; }
    /// The chooser over them; empty: every light is sampled.
    const LightChooser& chooserOf(const LightList& l) const { return l.ofAll ? allChooser_ : l.chooser; }
    /// The chooser for a vertex after so many bounces; empty: every light is sampled.
    const LightChooser& chooserAt(const LightList& l, int bounces) const {
        return bounces == 0 ? chooserOf(l) : l.ofAll ? allDeeper_ : l.deeper;
    }
    /// Lights of one program that share a kernel call, for points that query different ones.
    struct LightGroup {
        BoundKernel kernel;
    };
    const std::vector<LightGroup>& lightGroups() const { return lightGroups_; } ///< by BoundLight::group

    // Outputs
    const std::vector<rsl::OutputName>& wanted() const { return wanted_; }    ///< Settings::outputs
    const std::vector<int>& widthsOfOutputs() const { return outputWidths_; } ///< outputWidths(), without a copy
    /// In the order of SurfaceBinding::lightOutputs.
    const std::vector<LightOutputPlace>& lightOutputs() const { return lightOutputs_; }

    // Services
    ServiceTable services() const { return services_; }
    bool rispecSpecular() const { return rispecSpecular_; }    ///< specular() uses RISpec's exponent (shadeops/specular.h)
    Diagnostics& diagnostics() const { return *diagnostics_; } ///< of the build; thread safe
    /// Thread safe, so that const users may fill the caches in them.
    texture::TextureSystem& textures() const { return *textures_; }
    const texture::IrradianceTables& irradiance() const { return irradiance_; }
    const texture::SkyDirectionTables& skyMaps() const { return skyMaps_; }
    CloudStore& clouds() const { return *clouds_; } ///< point clouds, and baked data; thread safe
    PtexStore& ptex() const { return *ptex_; }      ///< Ptex files; thread safe
    /// Thread safe; const users write messages and records.
    rsl::PrintLog& prints() const { return prints_; }
    FlippedNormals& turnedAway() const { return turnedAway_; }
    LightRecords& records() const { return records_; }

protected:
    WorldImpl() = default;
    /// All shaders that may write an output.
    std::set<const ShaderInstance*> givers() const;

    std::shared_ptr<const scene::Frame> frame_;
    MakeEvaluator evaluators_; ///< of the build, and for the imager
    Settings settings_;
    ServiceTable services_; ///< of services/, above this folder
    bool rispecSpecular_ = false;
    Facts facts_;
    Diagnostics* diagnostics_ = nullptr;

    std::map<std::string, std::map<std::string, Matrix>> spaces_; ///< from, to: those that kernels read, computed once
    Matrix worldToCamera_, cameraToWorld_;
    Matrix cameraToScreen_, screenToNdc_, ndcToRaster_;
    scene::Shutter shutter_;
    bool shadesAtOpen_ = false;
    float clipNear_ = 0, clipFar_ = 1;
    std::vector<std::pair<Vec3d, Vec3d>> clippingPlanes_;

    std::vector<geometry::ShapeRef> shapes_;
    std::unordered_map<const geometry::Shape*, uint32_t> numberOfShape_;
    std::vector<uint32_t> keysOfShapes_; ///< empty: indices are used
    std::unique_ptr<accel::Accel> accel_;
    std::unique_ptr<DeferredBounds> deferred_;
    geometry::Bounds procedurals_; ///< around all deferred procedurals, expanded or not
    bool moves_ = false, fades_ = false, traceSubsets_ = false;
    ShapeSubsets subsets_;

    std::vector<int> bindingOf_;
    std::vector<SurfaceBinding> bindings_;
    int groups_ = 0;
    BoundKernel primitiveHit_;
    KernelNeeds needs_;
    int maxDepth_ = 32;
    bool globalMaps_ = false;

    bool allOpaque_ = true;
    ByOpacity byOpacity_;
    ShadowVisibility shadowVisibility_;

    std::vector<Medium> media_;
    shading::Media eye_;
    bool scatters_ = false, mediaOverrule_ = false;

    size_t sceneLights_ = 0; ///< lights of frame_; later entries of lights_ are further blocks of their shaders
    std::vector<BoundLight> lights_;
    std::vector<uint8_t> shining_;
    std::vector<int> skies_;
    std::unordered_map<const geometry::Shape*, int> emittersInAtmosphere_;
    bool lightsAsk_ = false;
    bool lightChannels_ = false; ///< lights write AOVs by outputchannel()
    int lightTraces_ = 0;
    std::vector<LightList> lightLists_;
    /// If the lists would be too large together, the later ones share one list and its chooser.
    std::vector<int> allSampled_;
    LightChooser allChooser_, allDeeper_;
    std::vector<LightGroup> lightGroups_;

    std::vector<rsl::OutputName> wanted_;
    std::vector<int> outputWidths_;
    std::vector<std::string> missingOutputs_;
    std::vector<LightOutputPlace> lightOutputs_;
    struct BoundImager {
        InstanceRef shader;
        BoundKernel kernel;
    };
    BoundImager imager_; ///< null if the frame has none

    std::unique_ptr<texture::TextureSystem> textures_;
    texture::IrradianceTables irradiance_;
    texture::SkyDirectionTables skyMaps_;
    std::shared_ptr<PhotonStore> photons_;
    std::shared_ptr<CloudStore> clouds_;
    std::shared_ptr<PtexStore> ptex_;
    // What running kernels leave behind, from many threads: no kernel of the same pass reads it, so no bit depends on the order.
    mutable rsl::PrintLog prints_;      ///< until flushPrints()
    mutable FlippedNormals turnedAway_; ///< for callsTurnedAway()
    mutable LightRecords records_;      ///< a cache of irradiance; kernels read those of earlier passes
};

/// The world of no scene: an empty frame with the default camera and no shapes, lights or shaders. For services of shaders that
/// run without a scene (alpenglow eval and shade). `settings`: where maps are looked up.
std::shared_ptr<const WorldImpl> emptyWorld(const Settings&, ServiceTable, Diagnostics&);

// If two threads open the map at once, both get the same one.
template <class Place> texture::Handle TextureSite::map(const WorldImpl& world, Place&& place) const {
    if (!opened_.load(std::memory_order_acquire)) {
        if (!name.empty())
            map_.store(world.textures().open(name, world.settings().texturePaths, place()), std::memory_order_relaxed);
        opened_.store(true, std::memory_order_release);
    }
    return map_.load(std::memory_order_relaxed);
}

} // namespace alpenglow::world
