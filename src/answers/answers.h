// What kernels are answered while they run. What a call site means is known beforehand (world/sites.h); what does not depend on
// the point is kept by interned name. One a thread: no lock.
#pragma once
#include "answers/random.h"
#include "answers/servicecall.h"
#include "clouds/hemisphere.h"
#include "clouds/limits.h"
#include "world/below.h"
#include "world/cloudstore.h"
#include <set>

namespace alpenglow::ptex {
class Texture;
}

namespace alpenglow::transport {

/// Who follows light, as far as answers ask.
class Tracer {
public:
    virtual ~Tracer() = default;
    /// Light arriving at queries (ShadePoint::Ps) from one light. Area lights: P is the point on the emitter.
    virtual void evaluateLight(const BoundLight&, std::vector<ShadePoint>& queries, std::span<LightValue>, const LightCall&) = 0;
    /// Takes from the values of one light what stands between it and the points that it lights: point `first` + laneOf[i] of a
    /// run. `draw`: drawOf() the loop.
    virtual void shadowLight(const KernelRun&, const BoundLight&, int first, uint32_t draw, std::span<const ShadePoint>,
                             std::span<const int> laneOf, std::span<LightValue>) = 0;
};

/// What lightsource() asks of a light.
struct LightParameter {
    std::optional<Told> told; ///< as the light was given it; nothing: it has none of that name
    struct Part {
        int from, components;
        size_t to;
    };
    std::vector<Part> written; ///< by its kernel: where they lie in BoundLight::values, and in the answer
};

/// Answers that do not depend on the point, so that no name is compared twice. Names are interned. One a thread: no lock.
struct AnswerMemo {
    std::map<std::pair<int32_t, int>, LightParameter> ofLights;                         ///< by name and light
    std::map<std::pair<int32_t, const ShaderInstance*>, std::optional<Told>> ofShaders; ///< toldBy()
    std::map<std::tuple<int32_t, int, const scene::Attributes*, const SurfaceBinding*>, std::optional<Told>> attributes;
    std::unordered_map<const scene::Primitive*, std::optional<Told>> boxes; ///< kObjectBox of those that were asked about
    std::unordered_map<int32_t, std::optional<Told>> options;
    std::unordered_map<int32_t, bool> pointAttributes;                                ///< ofPoint() of a name
    std::unordered_map<const scene::Attributes*, std::pair<float, float>> shadowBias; ///< Attribute "shadow": bias0, bias1
};

class Answers {
public:
    /// `tracer`: null where there are no lights.
    Answers(const WorldImpl&, Diagnostics&, Tracer* tracer);
    /// Answers a call of any kind but requests for light. Rows are those of rsl::ServiceFn.
    void service(KernelRun&, int site, int first, uint64_t mask, int lanes, const float* in, float* out);
    // illuminance loops, as rsl::KernelCall has them. lightloop.cpp
    int32_t lightBegin(KernelRun&, int site, int first, uint64_t mask, int lanes, const float* rows);
    void lightEnd(KernelRun&, int first, int lanes);
    uint64_t lightFetch(KernelRun&, int light, int first, uint64_t mask, int lanes, float* out);
    /// Keeps what a light that ran for a point gives to the AOVs; `values`: BoundLight::values. lightsamples.cpp
    void keepChannels(KernelRun&, const BoundLight&, int point, const float* values);
    /// Of a light that sends through generateSamples(), one sample, in proportion to what each gives, for the sum of all. `u`:
    /// evenly from 0 to 1; `values`: BoundLight::values at a point.
    static void chooseSent(const BoundLight&, float u, const float* values, LightValue&);

    // What answers in files of their own share.
    const WorldImpl& world() const { return *world_; }
    AnswerMemo& memo() { return memo_; }
    LightLoop& lightLoop(KernelRun&, int first, int lanes);
    /// The map of an interned name, found without a lock from the second time on. `place`: gives the SourcePlace that asks.
    template <class Place> texture::Handle mapOfName(int32_t id, Place&& place) {
        const auto [at, fresh] = mapsByName_.try_emplace(id, nullptr);
        if (fresh && id) at->second = world_->textures_->open(rsl::internedString(id), world_->settings_.texturePaths, place());
        return at->second;
    }
    /// What textureinfo() knows of it; nothing: there is no such file, which is no error.
    template <class Place> const std::optional<texture::TextureInfo>& infoOfName(int32_t id, Place&& place) {
        const auto [at, fresh] = infosByName_.try_emplace(id);
        if (fresh && id && world_->textures_->present(rsl::internedString(id), world_->settings_.texturePaths))
            at->second = world_->textures_->info(mapOfName(id, place));
        return at->second;
    }

    /// The photon map of an interned name, found without a lock from the second time on. Null: none.
    const photons::PhotonMap* photonsOf(int32_t id, const ServiceCall& call) {
        const auto [at, fresh] = photonMaps_.try_emplace(id, nullptr);
        if (fresh && id) at->second = world_->photons_->find(rsl::internedString(id), call.place());
        return at->second;
    }

    /// The point cloud or brick map of an interned name, likewise.
    const clouds::CloudMap* cloudOf(int32_t id, const ServiceCall& call) {
        const auto [at, fresh] = clouds_.try_emplace(id, nullptr);
        if (fresh && id) at->second = world_->clouds_->find(rsl::internedString(id), call.place());
        return at->second;
    }

    /// Tells the store what texture3d() has found in a map, where that is news: no lock otherwise.
    void noteLookup(const clouds::CloudMap* map, bool found, const ServiceCall& call) {
        char& known = lookedUp_[map];
        if (known > char(found)) return;
        known = char(1 + found);
        world_->clouds_->noteLookup(map, found, call.place());
    }

    /// The same for point-based shadeops. `light`: they want what its points send. With `shear` it lives until trimOctrees().
    const clouds::PointOctree* octreeOf(int32_t id, bool light, const std::optional<clouds::Shear>& shear,
                                        const ServiceCall& call) {
        if (!shear) {
            const auto [at, fresh] = octrees_.try_emplace(int64_t(id) * 2 + light, nullptr);
            if (fresh && id) at->second = world_->clouds_->octree(rsl::internedString(id), light, {}, call.place()).get();
            return at->second;
        }
        const auto [at, fresh] = shearedOctrees_.try_emplace({int64_t(id) * 2 + light, *shear});
        if (fresh && id) at->second = world_->clouds_->octree(rsl::internedString(id), light, shear, call.place());
        return at->second.get();
    }
    void trimOctrees() {
        if (shearedOctrees_.size() > limits::kShearedOctrees) shearedOctrees_.clear();
    }
    const ptex::Texture* ptexOf(int32_t id, const ServiceCall& call); ///< the same of Ptex files. ptexture.cpp
    clouds::Hemisphere& hemisphere() { return hemisphere_; }
    HalfSpaces& halfSpaces() { return halfSpaces_; }

    const texture::IrradianceTable& irradianceOf(texture::Handle map) { // without a lock from the second time on
        const texture::IrradianceTable*& t = irradianceOf_[map];
        if (!t) t = &world_->irradiance_.of(map, world_->textures_->latLong());
        return *t;
    }
    const texture::SkyDirections& skyOf(texture::Handle map) { // likewise
        const texture::SkyDirections*& t = skyOf_[map];
        if (!t) t = &world_->skyMaps_.of(map, world_->textures_->latLong());
        return *t;
    }

private:
    using LightsAsked = std::map<int, uint64_t>; ///< by light, the lanes that ask it
    Random random(const shading::PathRay& r) const { return Random(r.sample ? r.sample->numbers : noSample_); }
    void drawRandom(const ServiceCall&); // draws.cpp
    // services.cpp
    void sumAmbient(const ServiceCall&);
    void answerDepth(const ServiceCall&);
    void transformBetween(const ServiceCall&);
    void print(const ServiceCall&, int lane, const std::string& text);
    // lightloop.cpp
    /// What lightBegin() is to know beyond its rows: a category, sent values, outputs of the surface.
    void lightSetup(KernelRun&, int site, int first, int lanes, const float* in);
    /// lightFetch() by what was kept for the strip, or is kept now.
    uint64_t fetchKept(KernelRun&, LightLoop&, int light, int turn, int first, uint64_t mask, int lanes, float* out);
    // lighthandles.cpp
    /// Shadeops about lights and their handles: getlight, getlights, islightcategory, and what is called through a handle.
    void lightHandles(const ServiceCall&);
    void getLights(const ServiceCall&);
    void lightParameters(const ServiceCall&, const LightsAsked&);
    /// handle->light(): a loop of its own, over the lights that are asked.
    void callLights(const ServiceCall&, const LightsAsked&);
    /// All samples of a light for the points `of`, one of them for the sum of all: nine rows, and the distance. Those that it
    /// lights.
    uint64_t callLight(const ServiceCall&, LightLoop& turn, int light, uint64_t of, LightLoop::Kept& kept);
    void checkCategory(KernelRun&, const rsl::ir::Site&, int32_t category);
    std::set<int32_t> checkedCategories_;
    LitSurface litSurface(KernelRun&, const LightLoop&, const std::vector<int>& points, int first, int lanes) const;
    void evaluateForLoop(KernelRun&, const LightLoop&, int light, int first, int lanes, std::vector<ShadePoint>&,
                         const std::vector<int>& laneOf, std::vector<LightValue>&, std::vector<float>& values);
    /// The point of a shaded batch as a light sees it when it lights `at`, for sample `turn` of `turns`; `axis`, `angle`: the
    /// loop's cone; nth: drawOf(). *factor multiplies the light. False: it gives nothing there.
    bool lightQuery(const KernelRun&, int light, int point, const Vec3& at, const Vec3& axis, float angle, int turn, int turns,
                    uint32_t nth, ShadePoint& query, float* factor) const;
    // lightsheets.cpp
    /// Which of KernelRun::sheets a sample of a light has; -1: none.
    int sheetNumber(int light, int turn);
    /// The sheet of a sample for the turn that runs now; null where it does not hold for all points of the mask.
    const LightSheet* sheetOf(KernelRun&, const LightLoop&, int light, int turn, int first, uint64_t mask, int lanes);
    /// By point of a batch, the sum of the ambient lights; they have sheets.
    const std::vector<Color>& ambientOf(KernelRun&);
    bool allAmbientHaveSheets(const SurfaceBinding&) const;
    void fillSheet(KernelRun&, const LightLoop&, int light, int turn, LightSheet&);
    /// What a sheet gives the points of a mask; those that are lit.
    uint64_t takeFromSheet(KernelRun&, LightLoop&, const LightSheet&, const BoundLight&, int first, uint64_t mask, int lanes,
                           float* out);
    /// The turns of a loop over the lights of a binding that are of a category (interned).
    const std::vector<std::pair<int, int>>& turnsOf(const SurfaceBinding&, int32_t category);
    bool isOfCategory(int32_t category, int light);
    struct TurnsOfList {
        scene::LightSet lights;
        std::vector<std::pair<int, int>> turns;
    };
    std::unordered_map<uint64_t, TurnsOfList> turnsOf_; ///< by category and list of lights
    std::unordered_map<uint64_t, bool> ofCategory_;     ///< by category and light
    std::vector<int> sheetNumbers_;                     ///< by light: of its first sample; -1: it has no sheets
    int sheets_ = 0;
    struct SheetRoom {
        std::vector<ShadePoint> q;
        std::vector<int> of;
        std::vector<float> factor, values;
        std::vector<LightValue> v;
    } sheetRoom_;
    /// Sample `turn` of `turns` of a light for the points of a mask, into `kept`; gives the points that it lights.
    uint64_t sampleLight(KernelRun&, const LightLoop&, int light, int turn, int turns, int first, uint64_t mask, int lanes,
                         LightLoop::Kept& kept);
    /// Sample `turn` of a light that sends through generateSamples(), by its BoundLight::values at a point.
    static void sentSample(const BoundLight&, int turn, const float* values, LightValue&);
    /// The light of an interned handle, where it is one of the surface's; else -1. Null: of no surface.
    int numberOfLight(const SurfaceBinding*, int32_t handle);
    int32_t handleOf(int light); ///< interned
    std::unordered_map<int32_t, int> lightOfHandle_;
    std::unordered_map<int, int32_t> handles_;

    const WorldImpl* world_;
    Diagnostics& diagnostics_;
    Tracer* tracer_;
    render::SeedKey seed_;
    render::SampleNumbers noSample_; ///< of points that no camera sample has found
    AnswerMemo memo_;
    std::unordered_map<texture::Handle, const texture::IrradianceTable*> irradianceOf_;
    std::unordered_map<texture::Handle, const texture::SkyDirections*> skyOf_;
    std::unordered_map<int32_t, const photons::PhotonMap*> photonMaps_; ///< by interned name
    std::unordered_map<int32_t, const clouds::CloudMap*> clouds_;       ///< by interned name
    std::unordered_map<const clouds::CloudMap*, char> lookedUp_; ///< 1: the store knows that it was; 2: that something is there
    std::unordered_map<int64_t, const clouds::PointOctree*> octrees_;
    std::map<std::pair<int64_t, clouds::Shear>, std::shared_ptr<const clouds::PointOctree>> shearedOctrees_;
    std::unordered_map<int32_t, const ptex::Texture*> ptex_; ///< by interned name
    clouds::Hemisphere hemisphere_;
    HalfSpaces halfSpaces_;
    std::unordered_map<int32_t, texture::Handle> mapsByName_; ///< by interned name
    std::unordered_map<int32_t, std::optional<texture::TextureInfo>> infosByName_;
};

// services.cpp: option(); rayinfo(), rendererinfo() and raylevel().
void answerOption(Answers&, const ServiceCall&);
void answerRay(const ServiceCall&);
// maps.cpp: texture() and environment(); textureinfo().
void answerTexture(Answers&, const ServiceCall&);
void answerShadow(Answers&, const ServiceCall&);
void answerTextureInfo(Answers&, const ServiceCall&);
// indirectdiffuse() of a map and a direction.
void answerIrradiance(Answers&, const ServiceCall&);
void answerPhotons(Answers&, const ServiceCall&); // photons.cpp
void answerSky(Answers&, const ServiceCall&);     // sky.cpp
// clouds.cpp: bake() and bake3d(); texture3d().
void answerBake(Answers&, const ServiceCall&);
void answerTexture3d(Answers&, const ServiceCall&);
// pointbased.cpp: occlusion(), indirectdiffuse() and subsurface() of point clouds.
void answerPointHemisphere(Answers&, const ServiceCall&);
void answerPointSubsurface(Answers&, const ServiceCall&);
void answerPtexture(Answers&, const ServiceCall&); // ptexture.cpp
// messages.cpp: surface() and its kin, lightsource(), attribute(), shadername(), getvar() of the primitive.
void answerMessage(Answers&, const ServiceCall&);
void answerLightSource(Answers&, const ServiceCall&);
void answerAttribute(Answers&, const ServiceCall&);
void answerShaderName(Answers&, const ServiceCall&);
void answerPrimitiveVariable(const ServiceCall&);
/// A parameter or output of a shader of the primitive at a point that was hit; `run`: of that shader, with the point's number
/// there, or null.
std::optional<Told> toldAtHit(Answers&, const ShadePoint&, const InstanceRef& shader, int32_t name, const shading::Batch* run,
                              int point);
// gatherrows.cpp: a turn of a gather.
void answerGatherTurn(const ServiceCall&);

} // namespace alpenglow::transport
