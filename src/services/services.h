// Answers calls of running kernels (services). Call sites are resolved in advance (world/sites.h); answers that do not depend on
// the point are cached by interned name. One for each thread: no lock.
#pragma once
#include "pointcloud/hemisphere.h"
#include "pointcloud/limits.h"
#include "services/random.h"
#include "services/servicecall.h"
#include "world/cloudstore.h"
#include "world/subsurfacemedium.h"
#include <set>

namespace alpenglow::ptex {
class Texture;
}

namespace alpenglow::services {

/// Interface to light transport for services.
class LightEvaluator {
public:
    virtual ~LightEvaluator() = default;
    /// Light arriving at queries (ShadePoint::Ps) from one light. For area lights P is the point on the emitter.
    virtual void evaluateLight(const BoundLight&, std::vector<ShadePoint>& queries, std::span<LightValue>, const LightCall&) = 0;
    /// Attenuates the values of one light by occlusion between it and the points that it lights: point `first` + laneOf[i] of a
    /// run. `draw`: drawOf() the loop.
    virtual void shadowLight(const KernelRun&, const BoundLight&, int first, uint32_t draw, std::span<const ShadePoint>,
                             std::span<const int> laneOf, std::span<LightValue>) = 0;
};

/// A lightsource() query to a light.
struct LightParameter {
    std::optional<ShaderValue> value; ///< value set by the scene; nothing: the light has no such parameter
    /// Consecutive components of one value.
    struct Part {
        int from, components; ///< index of the first, and their number
        size_t to;            ///< index in the other value
    };
    std::vector<Part> written; ///< written by its kernel: positions in BoundLight::values, and in the answer
};

/// Cache of answers that do not depend on the point, by interned name. One for each thread: no lock.
struct ServiceMemo {
    std::map<std::pair<int32_t, int>, LightParameter> ofLights;                                ///< by name and light
    std::map<std::pair<int32_t, const ShaderInstance*>, std::optional<ShaderValue>> ofShaders; ///< shaderParameter()
    /// attribute(), by name, row and point.
    std::map<std::tuple<int32_t, int, const scene::Attributes*, const SurfaceBinding*>, std::optional<ShaderValue>> attributes;
    std::map<std::pair<int32_t, const scene::Attributes*>, std::optional<ShaderValue>> filterLinks; ///< scene::FilterLink::acts()
    std::unordered_map<const scene::Primitive*, std::optional<ShaderValue>> boxes;    ///< kObjectBox of queried primitives
    std::unordered_map<int32_t, std::optional<ShaderValue>> options;                  ///< option(), by name
    std::unordered_map<int32_t, bool> pointAttributes;                                ///< ofPoint() of a name
    std::unordered_map<const scene::Attributes*, std::pair<float, float>> shadowBias; ///< Attribute "shadow": bias0, bias1
};

/// The services of one thread, with its caches.
class Services {
public:
    /// `lights`: null if there are no lights. building: the world is not complete, so answers that may change are not kept, and
    /// there are no photon maps yet.
    Services(const WorldImpl&, Diagnostics&, LightEvaluator* lights, bool building = false);
    /// Answers a call of any kind except requests for light. Rows are those of rsl::ServiceFn.
    void service(KernelRun&, int site, int first, uint64_t mask, int lanes, const float* in, float* out);
    // illuminance loops, as in rsl::KernelCall (lightloop.cpp).
    int32_t lightBegin(KernelRun&, int site, int first, uint64_t mask, int lanes, const float* rows);
    /// Ends the innermost loop.
    void lightEnd(KernelRun&, int first, int lanes);
    /// Evaluates the light of an iteration for the lanes of a mask: nine rows L, Cl, Ol. Returns the lit lanes.
    uint64_t lightFetch(KernelRun&, int light, int first, uint64_t mask, int lanes, float* out);
    /// Stores the AOV values of a light that ran for a point; `values`: BoundLight::values. Defined in lightsamples.cpp.
    void keepChannels(KernelRun&, const BoundLight&, int point, const float* values);
    /// For a light with generateSamples(): chooses one sample in proportion to its light, weighted to represent the sum. `u`:
    /// uniform in [0, 1); `values`: BoundLight::values at a point.
    static void chooseSent(const BoundLight&, float u, const float* values, LightValue&);

    // Services that use the state of this class; table.cpp lists them.
    void drawRandom(const ServiceCall&);       ///< random(); draws.cpp
    void answerDepth(const ServiceCall&);      ///< depth(); dispatch.cpp
    void transformBetween(const ServiceCall&); ///< transform() and its kin between spaces named at run time; dispatch.cpp
    /// Reads arguments of a loop beyond the rows of lightBegin(): category, sent values, outputs of the surface. lightloop.cpp
    void lightSetup(KernelRun&, int site, int first, int lanes, const float* in);
    /// Shadeops for lights and handles: getlight, getlights, islightcategory, and calls through a handle. lighthandles.cpp
    void lightHandles(const ServiceCall&);

    // Shared by services in other files.
    const WorldImpl& world() const { return *world_; }
    /// Whether the world is not complete.
    bool building() const { return building_; }
    /// The cache for answers in other files.
    ServiceMemo& memo() { return memo_; }
    /// The state of the loops of a strip, which begins at this point.
    LightLoop& lightLoop(KernelRun&, int first, int lanes);
    /// The map of an interned name; takes a lock only the first time. `place`: returns the SourcePlace of the call.
    template <class Place> texture::Handle mapOfName(int32_t id, Place&& place) {
        const auto [at, fresh] = mapsByName_.try_emplace(id, nullptr);
        if (fresh && id) at->second = world_->textures().open(rsl::internedString(id), world_->settings().texturePaths, place());
        return at->second;
    }
    /// The result of textureinfo() for a map; nothing: there is no such file, which is not an error.
    template <class Place> const std::optional<texture::TextureInfo>& infoOfName(int32_t id, Place&& place) {
        const auto [at, fresh] = infosByName_.try_emplace(id);
        if (fresh && id && world_->textures().present(rsl::internedString(id), world_->settings().texturePaths))
            at->second = world_->textures().info(mapOfName(id, place));
        return at->second;
    }

    /// The photon map of an interned name; takes a lock only the first time. Null: none.
    const photonmap::PhotonMap* photonsOf(int32_t id, const ServiceCall& call) {
        const auto [at, fresh] = photonMaps_.try_emplace(id, nullptr);
        if (fresh && id) at->second = world_->photons()->find(rsl::internedString(id), call.place());
        return at->second;
    }

    /// The point cloud or brick map of an interned name; takes a lock only the first time.
    const pointcloud::CloudMap* cloudOf(int32_t id, const ServiceCall& call) {
        const auto [at, fresh] = clouds_.try_emplace(id, nullptr);
        if (fresh && id) at->second = world_->clouds().find(rsl::internedString(id), call.place());
        return at->second;
    }

    /// Records with the store what texture3d() has found in a map; takes a lock only for new facts.
    void noteLookup(const pointcloud::CloudMap* map, bool found, const ServiceCall& call) {
        char& known = lookedUp_[map];
        if (known > char(found)) return;
        known = char(1 + found);
        world_->clouds().noteLookup(map, found, call.place());
    }

    /// The same for point-based shadeops. `light`: with emitted light. With `shear` it is valid until trimOctrees().
    const pointcloud::PointOctree* octreeOf(int32_t id, bool light, const std::optional<pointcloud::Shear>& shear,
                                            const ServiceCall& call) {
        if (!shear) {
            const auto [at, fresh] = octrees_.try_emplace(int64_t(id) * 2 + light, nullptr);
            if (fresh && id) at->second = world_->clouds().octree(rsl::internedString(id), light, {}, call.place()).get();
            return at->second;
        }
        const auto [at, fresh] = shearedOctrees_.try_emplace({int64_t(id) * 2 + light, *shear});
        if (fresh && id) at->second = world_->clouds().octree(rsl::internedString(id), light, shear, call.place());
        return at->second.get();
    }
    /// Frees sheared octrees where there are many; call when none is in use.
    void trimOctrees() {
        if (shearedOctrees_.size() > limits::kShearedOctrees) shearedOctrees_.clear();
    }
    const ptex::Texture* ptexOf(int32_t id, const ServiceCall& call); ///< the same for Ptex files; ptexture.cpp
    /// Reused from call to call.
    pointcloud::Hemisphere& hemisphere() { return hemisphere_; }
    AlbedoInversions& albedoInversions() { return albedoInversions_; }

    const texture::IrradianceTable& irradianceOf(texture::Handle map) { // takes a lock only the first time
        const texture::IrradianceTable*& t = irradianceOf_[map];
        if (!t) t = &world_->irradiance().of(map, world_->textures().latLong());
        return *t;
    }
    const texture::SkyDirections& skyOf(texture::Handle map) { // likewise
        const texture::SkyDirections*& t = skyOf_[map];
        if (!t) t = &world_->skyMaps().of(map, world_->textures().latLong());
        return *t;
    }

private:
    using LightsAsked = std::map<int, uint64_t>; ///< by light: the lanes that query it
    Random random(const shading::PathRay& r) const { return Random(r.sample ? r.sample->numbers : noSample_); }
    // dispatch.cpp
    void sumAmbient(const ServiceCall&);
    void print(const ServiceCall&, int lane, const std::string& text);
    // lightloop.cpp
    /// lightFetch() from the strip's cache, which it fills.
    uint64_t fetchKept(KernelRun&, LightLoop&, int light, int turn, int first, uint64_t mask, int lanes, float* out);
    // lighthandles.cpp
    void getLights(const ServiceCall&);
    void lightParameters(const ServiceCall&, const LightsAsked&);
    /// handle->light(): a loop over the queried lights.
    void callLights(const ServiceCall&, const LightsAsked&);
    /// Evaluates all samples of a light for the points `of`, and reduces them to one for the sum: nine rows, and the distance.
    /// Returns the lit points.
    uint64_t callLight(const ServiceCall&, LightLoop& turn, int light, uint64_t of, LightLoop::Kept& kept);
    void checkCategory(KernelRun&, const rsl::ir::Site&, int32_t category);
    std::set<int32_t> checkedCategories_;
    LitSurface litSurface(KernelRun&, const LightLoop&, const std::vector<int>& points, int first, int lanes) const;
    void evaluateForLoop(KernelRun&, const LightLoop&, int light, int first, int lanes, std::vector<ShadePoint>&,
                         const std::vector<int>& laneOf, std::vector<LightValue>&, std::vector<float>& values);
    /// The query point of a light that lights `at`, for a point of a shaded batch and sample `turn` of `turns`; `axis`, `angle`:
    /// cone of the loop; nth: drawOf(). *factor multiplies the light. Returns false if no light arrives.
    bool lightQuery(const KernelRun&, int light, int point, const Vec3& at, const Vec3& axis, float angle, int turn, int turns,
                    uint32_t nth, ShadePoint& query, float* factor) const;
    // lightsheets.cpp
    /// Index in KernelRun::sheets of a light sample; -1: none.
    int sheetNumber(int light, int turn);
    /// The sheet of a light sample for the current iteration; null if it is not valid for all points of the mask.
    const LightSheet* sheetOf(KernelRun&, const LightLoop&, int light, int turn, int first, uint64_t mask, int lanes);
    /// By point of a batch: sum of the ambient lights, from sheets.
    const std::vector<Color>& ambientOf(KernelRun&);
    bool allAmbientHaveSheets(const SurfaceBinding&) const;
    void fillSheet(KernelRun&, const LightLoop&, int light, int turn, LightSheet&);
    /// Copies the light of a sheet to the points of a mask; returns the lit ones.
    uint64_t takeFromSheet(KernelRun&, LightLoop&, const LightSheet&, const BoundLight&, int first, uint64_t mask, int lanes,
                           float* out);
    /// The iterations of a loop over the lights of a binding in a category (interned).
    const std::vector<std::pair<int, int>>& turnsOf(const SurfaceBinding&, int32_t category);
    bool isOfCategory(int32_t category, int light);
    struct TurnsOfList {
        scene::LightSet lights;
        std::vector<std::pair<int, int>> turns;
    };
    std::unordered_map<uint64_t, TurnsOfList> turnsOf_; ///< by category and list of lights
    std::unordered_map<uint64_t, bool> ofCategory_;     ///< by category and light
    std::vector<int> sheetNumbers_;                     ///< by light: index of its first sample's sheet; -1: no sheets
    int sheets_ = 0;
    struct SheetRoom {
        std::vector<ShadePoint> q;
        std::vector<int> of;
        std::vector<float> factor, values;
        std::vector<LightValue> v;
    } sheetRoom_;
    /// Evaluates sample `turn` of `turns` of a light for the points of a mask, into `kept`; returns the lit points.
    uint64_t sampleLight(KernelRun&, const LightLoop&, int light, int turn, int turns, int first, uint64_t mask, int lanes,
                         LightLoop::Kept& kept);
    /// Sample `turn` of a light with generateSamples(), from its BoundLight::values at a point.
    static void sentSample(const BoundLight&, int turn, const float* values, LightValue&);
    /// The light of an interned handle if it is one of the surface's; else -1. Null: any light.
    int numberOfLight(const SurfaceBinding*, int32_t handle);
    int32_t handleOf(int light); ///< interned
    std::unordered_map<int32_t, int> lightOfHandle_;
    std::unordered_map<int, int32_t> handles_;

    const WorldImpl* world_;
    Diagnostics& diagnostics_;
    LightEvaluator* lightEvaluator_;
    const bool building_;
    SeedKey seed_;
    SampleNumbers noSample_; ///< for points without a camera sample
    ServiceMemo memo_;
    std::unordered_map<texture::Handle, const texture::IrradianceTable*> irradianceOf_;
    std::unordered_map<texture::Handle, const texture::SkyDirections*> skyOf_;
    std::unordered_map<int32_t, const photonmap::PhotonMap*> photonMaps_; ///< by interned name
    std::unordered_map<int32_t, const pointcloud::CloudMap*> clouds_;     ///< by interned name
    std::unordered_map<const pointcloud::CloudMap*, char> lookedUp_; ///< 1: the store knows of a lookup; 2: of a successful one
    std::unordered_map<int64_t, const pointcloud::PointOctree*> octrees_;
    std::map<std::pair<int64_t, pointcloud::Shear>, std::shared_ptr<const pointcloud::PointOctree>> shearedOctrees_;
    std::unordered_map<int32_t, const ptex::Texture*> ptex_; ///< by interned name
    pointcloud::Hemisphere hemisphere_;
    AlbedoInversions albedoInversions_;
    std::unordered_map<int32_t, texture::Handle> mapsByName_; ///< by interned name
    std::unordered_map<int32_t, std::optional<texture::TextureInfo>> infosByName_;
};

// dispatch.cpp: option(); rayinfo(), rendererinfo() and raylevel().
void answerOption(Services&, const ServiceCall&);
void answerRay(const ServiceCall&);
// maps.cpp: texture() and environment(); textureinfo().
void answerTexture(Services&, const ServiceCall&);
void answerShadow(Services&, const ServiceCall&);
void answerTextureInfo(Services&, const ServiceCall&);
// indirectdiffuse() with a map and a direction.
void answerIrradiance(Services&, const ServiceCall&);
void answerPhotons(Services&, const ServiceCall&); // photons.cpp
void answerSky(Services&, const ServiceCall&);     // sky.cpp
// pointclouds.cpp: bake() and bake3d(); texture3d().
void answerBake(Services&, const ServiceCall&);
void answerTexture3d(Services&, const ServiceCall&);
// pointbased.cpp: occlusion(), indirectdiffuse() and subsurface() of point clouds.
void answerPointHemisphere(Services&, const ServiceCall&);
void answerPointSubsurface(Services&, const ServiceCall&);
// messages.cpp: surface() and similar, lightsource(), attribute(), shadername(), getvar() of the primitive.
void answerMessage(Services&, const ServiceCall&);
void answerLightSource(Services&, const ServiceCall&);
void answerAttribute(Services&, const ServiceCall&);
void answerShaderName(Services&, const ServiceCall&);
void answerPrimitiveVariable(const ServiceCall&);
/// A parameter or output of a shader of the primitive at a hit; `run`: batch of that shader with the point's index, or null.
std::optional<ShaderValue> valueAtHit(Services&, const ShadePoint&, const InstanceRef& shader, int32_t name,
                                      const shading::Batch* run, int point);
// gatherrows.cpp: one iteration of a gather().
void answerGatherIteration(const ServiceCall&);

} // namespace alpenglow::services
