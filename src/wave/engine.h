// The inside of Integrator, for transport/ only: following a slice of rays, shading what they hit, and what becomes of requests.
#pragma once
#include "base/exactsum.h"
#include "answers/random.h"
#include "shading/scheduler.h"
#include "answers/lightloop.h"
#include <deque>
#include <exception>
#include <functional>
#include <set>
#include <utility>

namespace alpenglow::transport {

using shading::PathRay;
using shading::PathSample;
using shading::RayExtra;
using shading::RayKind;
using shading::Sched;
using shading::ShadePoint;
using shading::TargetId;

/// One affine pair group of a strip, as the kernel emitted it: rows of `lanes` floats, the first three the weight.
struct EmitRecord { int site = 0, first = 0, lanes = 0; uint64_t mask = 0; size_t offset = 0; };

/// Rays that most vertices send.
inline constexpr RayKind kDiffuseKind{RayType::Diffuse, false, {}, 0}, kSpecularKind{RayType::Specular, false, {}, 0};
inline constexpr RayKind kShadowKind{
    RayType::Transmission, false, {nullptr, accel::Sides::Both, shading::HitMode::Default}, 0};

/// A visibility question: adds contribution * transmittance to the target.
struct ShadowRay {
    Vec3 origin, dir;
    float distance;
    Color contribution;
    TargetId target;
    float time;
    const PathRay* ray = nullptr;
    bool areaLight = false; ///< of a trace() that asks how much area lights give
    const RayKind* kind = &kShadowKind;     ///< whose visibility counts
    const shading::Media* media = nullptr; ///< where it begins
    int32_t share = -1;     ///< RayExtra::share
    int32_t more = -1;      ///< Engine::moreLight_: what else goes the same way; -1: nothing
};

/// Where light that reaches a target comes from: with the ray that brings it, what a path was at its end.
enum class LightEvent : uint8_t {
    Surface, ///< what a shader gives by itself (Ci)
    Output,  ///< the same of an output
    Sampled, ///< a light, sampled at a vertex
    Met,     ///< an emitter that the ray met
    Sky,     ///< a sky, or ambient light, behind everything
    Map      ///< the environment map of a trace()
};
struct Deposit {
    TargetId target = shading::kNoTarget;
    Color light;
    LightEvent event = LightEvent::Surface;
    const PathRay* path = nullptr;        ///< that brings it, up to its last vertex; may be null
    int32_t share = -1;                   ///< Engine::shares_
    const ShaderInstance* of = nullptr;   ///< that made it; null: not known
};

/// The way from a to b for a shadow ray; where an end is `at`, a shaded point of the surface `s` (null: none), that surface does not block.
struct Way { Vec3 origin, dir; float distance = 0; };
Way wayBetween(const Vec3& a, const Vec3& b, const Vec3& at, const geometry::SurfacePoint* s);

/// Light beside that of a ShadowRay, and the next of the same.
struct MoreLight { Color contribution; TargetId target; int32_t share; bool areaLight; int32_t more; };

/// What lights are told about a surface that they light: because it samples them or because one of its rays meets them.
struct LitValues {
    int binding = -1;
    std::vector<std::pair<std::string, std::vector<float>>> outputs; ///< those that are not here are as the surface was given them
    std::shared_ptr<const struct BatchContext> displaced; ///< BatchContext::displaced of the surface, and the point there
    int point = -1;
    bool output(const std::string& name, std::vector<float>& v) const;
};

/// What a trace() that asks for it is told beside its result. Sums are exact: order does not matter.
struct TraceSums {
    enum Part { Blocked, Environment, UnshadowedEnvironment, AreaLight, UnshadowedAreaLight, Count };
    ExactSum sum[Count][3];
    void add(Part p, const Color& c) {
        for (int k = 0; k < 3; ++k)
            if (std::isfinite(c[k]) && c[k] != 0) sum[p][k].add(c[k]);
    }
    Color value(Part p) const { return {sum[p][0].toFloat(), sum[p][1].toFloat(), sum[p][2].toFloat()}; }
};

/// A surface that a shadow ray met, whose opacity its shader must tell.
struct OpacityQuery { int binding; accel::Hit hit; const ShadowRay* ray; const BoundKernel* kernel; };

/// What an atmosphere makes of the light that a ray met: Ci and Oi as seen, and the coefficient of the light met.
struct Haze { Color shown, opacity, slope{1}; bool on = false; }; ///< on: a volume shader has run

/// A lobe at a point that light shall be gathered over.
struct LobeVertex {
    int point = 0;
    const LobeKind* kind = nullptr;
    LobeColumns::Place place; ///< in Engine::lobeRows_
    Color weight;          ///< of the request alone, before the ray's throughput
    TargetId target = shading::kNoTarget;
    const RayKind* rays = &kDiffuseKind;
    bool lights = true;    ///< estimate lights here
    bool deltaLights = true; ///< point, spot and distant ones too (lighting shadeops, not trace())
    bool lobeOfShader = true; ///< a lighting shadeop: counts for the energy rule and may be chosen among
    uint32_t site = 0, occurrence = 0;
    uint32_t before = 0;   ///< rays that the same waiting kernel has asked for at this point before
    float maxDistance = 1e38f;
    int samples = 1;
    bool ownsTarget = false; ///< a suspended request: the target also gets distance and transmission
    bool followed = true;  ///< its ray may be sent
    bool delta = false;    ///< kind->isDelta(params)
    bool elsewhere = false; ///< trace() from a point that is not that of the surface: `from`
    Vec3 from;
    float bias = -1;       ///< < 0: the hit's own error bound
    float base = 0;        ///< "samplebase": rays start on this part of the footprint
    int lit = -1;          ///< of Engine::litValues_
    int32_t share = -1;    ///< Engine::shares_: outputs that hold this request too; -1: none
    Color tint{1};         ///< of the environment map
    const TraceSite* trace = nullptr;
    float albedo = 0;      ///< kind->albedo(params)
    float chosen = 1;      ///< probability that the indirect ray of this lobe is followed
};

struct LightValue {
    Vec3 L;
    Color Cl{0}, Ol{1};
    bool lit = false;
    float nonDiffuse = 0, nonSpecular = 0; ///< weights of __nondiffuse and __nonspecular
    /// What a lobe of a lighting shadeop keeps of this light (rsl.md 9).
    float kept(RayType t) const { return std::max(0.f, 1 - (t == RayType::Diffuse ? nonDiffuse : nonSpecular)); }
};

/// The numbers that a solar() with an angle makes a direction of: how far from its axis (0: along it), and the turn about it.
Color coneNumbers(Vec2 random);

/// A part of what is added to a target that an output has as well, and the next one of the same light.
struct Share { TargetId target; Color ratio; int32_t next; };

/// How the hider follows light.
struct Rules {
    bool pickOne = false;          ///< path: one ray goes on from a vertex, chosen by chance; else all do
    bool roulette = false;         ///< rays end by chance
    bool lightsAtRequests = false; ///< lobes sample lights
    bool emissionCounts = false;   ///< what shines is seen by rays whose lobes sample no lights, too
    explicit Rules(const Settings& s)
        : pickOne(s.hider == Hider::Path), roulette(pickOne && s.roulette), lightsAtRequests(s.direct && !s.bsdfOnly),
          emissionCounts(pickOne) {}
};

class Engine;

inline bool isFinite(const Color& c) { return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z); }

/// Whether a shader gives an output only where it makes that name when it runs.
bool givesPerhaps(const ShaderInstance&, const std::string& output);
/// The outputs of a kernel that make up the AOV of a name: of an array all its elements. Empty: it has none.
std::vector<int> outputsNamed(const shading::Batch&, const std::string& name);
/// Before the name of an output that outputchannel() makes when the shader runs: the output that is 1 where it was made.
inline constexpr char kGiven[] = "given:";
/// Adds to the outputs of a kernel one that displays ask for, and before it the one that tells where it is given.
void addOutput(const ShaderInstance&, const std::string& name, std::vector<std::string>& outputs);
/// False where the shader might have made this output at the point, and did not.
bool givenAt(const shading::Batch&, const std::string& name, int point);

/// State of one batch while its kernel runs; KernelCall::user.
struct BatchContext {
    ~BatchContext();
    Engine* engine = nullptr;
    bool ownsExtras = false;                   ///< what its rays carry besides is freed with it
    std::shared_ptr<shading::Batch> batch;
    const BoundKernel* bound = nullptr;
    const SurfaceBinding* binding = nullptr;   ///< of the first point; the light list is the same for all
    std::vector<ShadePoint> points;
    std::vector<PathRay> rays;                 ///< of the points: ShadePoint::ray points here
    std::vector<TargetId> targets;
    std::vector<int> bindings;                 ///< by point
    std::vector<EmitRecord> emits;
    std::vector<float> arena;
    std::vector<Haze> haze;                    ///< by point; only where a volume lies before some point
    std::vector<Color> clear;  ///< by point: what goes on behind it; only while gather() runs for a kernel that does not wait
    std::vector<float> passes; ///< by point: the chance with which its ray goes on, 0: another was taken; empty: it always does
    std::deque<LightLoop> loops;               ///< Engine::lightLoop()
    std::vector<Color> ambient;                ///< Engine::ambientOf()
    std::vector<LightSheet> sheets;            ///< by turn of all lights (Engine::sheetNumber()); empty until a loop runs
    const BoundLight* light = nullptr;         ///< whose kernel runs
    const LitSurface* lit = nullptr;           ///< while a light's kernel runs: what it lights
    std::shared_ptr<BatchContext> displaced;   ///< the displacement shader's run at these points, where its outputs are asked for
    const LightOutput* aside = nullptr;        ///< the run gives this output and nothing else; `targets` are its own
    const Medium* volume = nullptr;            ///< while a volume's kernel runs
    const BatchContext* surface = nullptr;     ///< while an atmosphere's kernel runs: the surface's run that it dims
    std::vector<int> surfacePoint;             ///< by point: its number in that run
    std::vector<float> lightChannels;          ///< by point, all AOVs: what lights gave by outputchannel(), and atmospheres; empty when none did
    std::vector<uint32_t> draws;               ///< by site and point: how often random() was called there; empty until it is
    float lightVisibilityDistance = 0;
    bool forShadow = false;                    ///< the kernel tells its opacity to shadow rays
    std::vector<float> lightDistance;          ///< by lane: to the light sample; 1e38 for distant lights
    std::exception_ptr failure;                ///< of a callback while the kernel ran: exceptions cannot pass generated code
    /// After each run of the kernel: throws what a callback threw.
    void ran() { if (failure) std::rethrow_exception(std::exchange(failure, nullptr)); }
    size_t emitted = 0;                        ///< requests of all points so far
    size_t frame = 0;                          ///< bytes of the frame of the strip that was started last
    // suspended request of the strip that runs now
    int requestSite = -1, requestFirst = 0, requestLanes = 0;
    uint64_t requestMask = 0;
    std::vector<float> requestIn;
    float* requestOut = nullptr;
};

class Engine final : public Sched::RayService {
public:
    Engine(std::shared_ptr<const WorldImpl>, Diagnostics&);
    ~Engine() override;
    bool trace(std::span<const CameraRay>, std::span<SampleResult>, const StopFlag* stop);
    /// Whether what runs now is done again, with fewer points at a time, when a shader asks for more rays than there is room for.
    bool beginsAnew() const { return beginsAnew_; }
    void follow(std::span<const Sched::Task> slice, Sched&) override; // hits.cpp
    bool settle(Sched&) override;
    Counters counters;

    // faults.cpp
    /// A value on the way of a ray is not a finite number: the whole camera sample is left out. `what` made it, at `place`: said
    /// once.
    void notFinite(const PathRay*, const std::string& what, const SourcePlace& place);
    void notFinite(const PathRay* ray, const char* what, const ShaderInstance* of);
    void notFinite(const BatchContext&, const PathRay&, uint32_t site); ///< what a call site gives
    /// The only way that light is added to targets: to that one, and their parts to the outputs that share it. deposit.cpp
    void deposit(Sched&, const Deposit&);
    // lights.cpp
    /// Light arriving at queries from one light; for area lights `samples[i]` is the point on the emitter.
    void evaluateLight(const BoundLight&, std::vector<ShadePoint>& queries, std::span<LightValue> out, const LightCall& = {});
    /// What a transmission() or trace() of a light's kernel gives at a point that it lights, followed to the end at once.
    shading::TargetValue rayOfLight(BatchContext&, const SiteInfo&, int point, const std::function<float(int)>& row, uint32_t occurrence);
    // shadowrays.cpp
    /// What is left of light along each ray. `ray`: for the random numbers and footprint of shaders on the way; may be null.
    void transmittances(std::span<const ShadowRay>, std::span<Color> out);
    Color transmittance(const ShadowRay&);
    /// The rays of a transmission() from a to b, for `out`: as many as it asks for, each with its share of `weight`.
    void transmissionRays(const SiteInfo&, const ShadePoint&, const Vec3& at, const geometry::SurfacePoint*, const std::function<float(int)>& row, const Color& weight, TargetId,
                          uint32_t site, uint32_t occurrence, std::vector<ShadowRay>& out);
    /// Oi at hits of one binding.
    void opacities(std::span<const OpacityQuery>, std::span<Color> out);
    /// Whether surfaces that block all light are looked for first and by themselves, the others only where a ray may meet them.
    bool meetsOpaqueAlone(const ShadowRay&) const;
    void blockedByOpaque(std::span<const ShadowRay>, std::span<Color> out);
    // haze.cpp
    /// Runs a volume shader over points with Ci, Oi, I, P set. The points' Ci is void afterwards. The binding is that of what was met.
    /// `surface`, `of`: the run of the surface shader, and the points' numbers there; may be missing.
    void haze(const Medium&, const SurfaceBinding&, std::vector<ShadePoint>&, std::span<Haze> out, bool wantSlope, BatchContext* surface = nullptr, std::span<const int> of = {});
    void keepOutputs(const shading::Batch& volume, BatchContext& surface, std::span<const int> of);
    /// Fills c.haze for points first to first + count - 1 of a shaded batch.
    void hazeOfBatch(BatchContext&, int first, int count, bool wantSlope);
    /// Takes from the light of emitters what their atmosphere takes between them and the lit points.
    /// inMedium: LightCall::inMedium.
    void hazeOfEmitters(const BoundLight&, std::span<const ShadePoint>, std::span<LightValue>, const std::vector<char>* inMedium);
    // media.cpp
    /// Where a ray from a point of a batch in direction w begins.
    void tellLost(const shading::Media*, const ShadePoint&) const; ///< says once that a ray was in more volumes than are known
    const shading::Media* mediaTowards(const BatchContext&, int point, const Vec3& w);
    /// SurfaceBinding::beyond().
    const shading::Media* mediaBeyond(const SurfaceBinding&, const shading::Media* from, const Vec3& n, const Vec3& in,
                                      const Vec3& to);
    const shading::Media* kept(const shading::Media&); ///< the same, for good; null where it is none
    static int mediumOf(const shading::Media* m) { return m ? m->top() : -1; }
    /// Where shadow rays between a and b begin, one of which may be the point `at` of a surface. Those that end there are turned about.
    void shadowsInMedia(std::span<ShadowRay>, const Vec3& a, const Vec3& b, const Vec3& at, const geometry::SurfacePoint*, const SurfaceBinding*);
    /// A part of a shadow ray inside a medium.
    struct MediumPart { int medium; size_t ray; Vec3 from, to; };
    /// Takes from `out`, by ray, what the media leave of light.
    void dim(std::span<const MediumPart>, std::span<const ShadowRay>, std::span<Color> out);
    // manylights.cpp
    /// Probability that a light is among those that are sampled at a point of the binding at `at`.
    float chanceOf(int light, int binding, const Vec3& at) const;
    // raysets.cpp
    /// For one call. f: a row of its arguments; from: the shape whose shader calls, or null, whose Attribute "grouping"
    /// "tracesubset" holds where no subset is given. Also tells the type and the label of the rays.
    shading::RaySet raySetOf(const SiteInfo&, const std::function<float(int)>& f, const geometry::Shape* from, RayType& type,
                             int32_t& label);
    /// ShapeSubsets::find() without a lock from the second time on; texts are interned. `from`: whose "tracesubset" holds.
    const uint8_t* shapesOf(int32_t subset, int32_t exclude, const scene::Attributes* from);
    std::map<std::tuple<int32_t, int32_t, const scene::Attributes*>, const uint8_t*> subsetsKnown_;
    // messages.cpp
    /// What has been answered to shaders before, and holds for good.
    struct AnswerMemo& answers();
    // lightloop.cpp
    /// What lightBegin() is to know beyond its rows: a category, sent values, outputs of the surface.
    void lightSetup(BatchContext&, int site, int first, uint64_t mask, int lanes, const float* in);
    LightLoop& lightLoop(BatchContext&, int first, int lanes);
    /// Keeps what a light that ran for a point gives to the AOVs; `values`: BoundLight::values.
    void keepChannels(BatchContext&, const BoundLight&, int point, const float* values);
    /// Shadeops about lights and their handles: getlight, getlights, islightcategory, and what is called through a handle.
    void lightHandles(BatchContext&, int site, int first, uint64_t mask, int lanes, const float* in, float* out);
    int32_t lightBegin(BatchContext&, int site, int first, uint64_t mask, int lanes, const float* rows);
    void lightEnd(BatchContext&, int first, int lanes);
    uint64_t lightFetch(BatchContext&, int light, int first, uint64_t mask, int lanes, float* out);
    /// The same by what was kept for the strip, or is kept now.
    uint64_t fetchKept(BatchContext&, LightLoop&, int light, int turn, int first, uint64_t mask, int lanes, float* out);
    // maps.cpp
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
    // services.cpp
    void service(BatchContext&, int site, int first, uint64_t mask, int lanes, const float* in, float* out);
    void drawRandom(const class ServiceCall&); // draws.cpp
    // lightoutputs.cpp
    /// For the camera's points of a batch that is filled: runs for the outputs that light reaches. `fill` fills one.
    std::vector<std::shared_ptr<BatchContext>> asides(const BatchContext&, Sched&,
                                                      const std::function<void(BatchContext&)>& fill);
    /// A lobe of a batch, and the pair that it came from.
    struct AskedLobe { int lobe, record, lane; };
    /// A pair of an output that shares no lobe of Ci, or not in all components.
    struct AskedAside { BatchContext* run; int record, lane; Color weight; };
    /// Gives the lobes of a batch their shares; what is left is returned. The asides have run.
    std::vector<AskedAside> shareLight(const BatchContext&, std::span<const AskedLobe>,
                                       std::span<const std::shared_ptr<BatchContext>>, Sched&);
    /// What shares nothing, and the outputs whose kernels wait for rays.
    void followAsides(std::span<const AskedAside>, std::span<std::shared_ptr<BatchContext>>, Sched&);
    /// Adds the outputs of points that are done.
    void finishAside(BatchContext&, int first, int lanes, Sched&);
    /// Starts the strips of a kernel that waits for rays.
    void startStrips(const std::shared_ptr<BatchContext>&, Sched&); // strips.cpp
    /// Follows what strips have asked for since the last call: those of a batch together.
    void followStrips(Sched&) override;
    // requests.cpp
    void request(BatchContext&, const SiteInfo&, int point, const float* in, int lanes, int lane, Color weight, TargetId, bool owns,
                 uint32_t occurrence);
    void lightVisibility(BatchContext&, const SiteInfo&, int point, const float* in, int lanes, int lane, Color weight, TargetId, float distance);
    /// Gathers light over `lobes` (gather.h).
    void gather(BatchContext&, Sched&);
    /// The environment map of a trace() in direction w (unit, current space).
    Color mapTowards(const TraceSite&, const Vec3& w, float spread) const;
    void flushShadows(Sched&);
    /// `asked`: by lane, the rays that a waiting kernel has asked for there.
    void finishStrip(BatchContext&, int first, int lanes, Sched&, std::span<const uint32_t> asked = {});
    /// The share of the light from behind a shaded point that comes through, 0 to 1.
    Color clearAt(const BatchContext&, int point) const;
    const WorldImpl& world() const { return *world_; }
    const Rules& rules() const { return rules_; }
    Diagnostics& diagnostics() { return diagnostics_; }
    void shadeGroup(std::shared_ptr<BatchContext>, Sched&);
    /// Runs the displacement shader at the points of a batch (all of one binding); null where it waits for rays. displacement.cpp
    std::shared_ptr<BatchContext> displace(const BatchContext&);
    /// Points of surfaces whose shaders move P, once the kernel has its inputs: rays met, and will leave, the facets. displacement.cpp
    static void moveToFacets(BatchContext&);
    void bindCall(rsl::KernelCall&, BatchContext&);
    Random random(const PathRay& r) const { return Random(r.sample ? r.sample->numbers : noSample_.numbers); }
    /// The one that stays, of a kind that is made.
    const RayKind* kindOf(const RayKind&);
    const RayExtra& extraOf(const PathRay& r) const { return r.extra < 0 ? noExtra_ : extras_[size_t(r.extra)]; }
    /// For PathRay::extra of one ray, which has it alone: freeExtra() when its points are shaded. -1 where there is nothing in it.
    int32_t newExtra(const RayExtra&);
    void freeExtras(BatchContext&);
    void freeExtra(const PathRay& r) {
        if (r.extra >= 0) freeExtras_.push_back(r.extra);
    }
    /// Sums of a target, where its trace() asks for them; else null.
    TraceSums* sumsOf(TargetId t) {
        if (traceSums_.empty()) return nullptr;
        auto i = traceSums_.find(t);
        return i == traceSums_.end() ? nullptr : &i->second;
    }
    std::unordered_map<TargetId, TraceSums> traceSums_;
    std::vector<Share> shares_;
    std::vector<TargetId> lightTargets_; ///< by camera sample, WorldImpl::lightOutputs_
    TargetId nowhere_ = shading::kNoTarget; ///< nobody reads it
    std::vector<int> litBy_;           ///< RayExtra::lit of the queries of a light
    std::vector<LitValues> litValues_; ///< of what runs now; only where lights ask for outputs of surfaces
    std::vector<SampleResult*> results;
    std::vector<int> spoiled_;         ///< PathSample::path of samples that notFinite() has seen; some twice
    std::vector<LobeVertex> lobes;
    LobeColumns lobeRows_; ///< of `lobes`
    std::vector<ShadowRay> shadows;
    std::vector<MoreLight> moreLight_; ///< of `shadows`
    const StopFlag* stop = nullptr;

private:
    /// Hits of a group that wait to be shaded together. They hold their targets.
    struct HitQueue {
        std::vector<accel::Hit> hits;
        std::vector<PathRay> rays;
        std::vector<TargetId> targets;
        bool waits = false;                    ///< its kernel waits for rays; then
        size_t room = 0;                       ///< so many of its points may be shaded now
    };
    std::vector<HitQueue> hitQueues_;          ///< by SurfaceBinding::group, then for rays that take primitives as they are
    std::vector<size_t> groupsWithHits_;
    size_t hitsWaiting_ = 0;
    void cast(std::span<const Sched::Task>);
    void queueHit(const Sched::Task&, const accel::Hit&, Sched&);
    void shadeHits(size_t group, Sched&);
    void placePoints(HitQueue&, BatchContext&);
    void shine(const BatchContext&, Sched&);
    std::vector<class KernelStrip*> waiting_; ///< whose requests nobody has followed yet
    std::vector<PathSample> samples_; ///< of the call of trace()
    PathSample noSample_;
    std::vector<RayExtra> extras_;
    std::vector<int32_t> freeExtras_;
    const RayExtra noExtra_;
    std::unordered_map<uint64_t, std::deque<RayKind>> kinds_; ///< by hash
    std::unordered_map<int32_t, texture::Handle> mapsByName_; ///< by interned name
    std::unordered_map<int32_t, std::optional<texture::TextureInfo>> infosByName_;
    const RayKind* lastKind_ = nullptr;
    std::deque<shading::Media> media_;
    friend class KernelStrip;
    friend class Gather;
    // lightloop.cpp
    void checkCategory(BatchContext&, const rsl::ir::Site&, int32_t category);
    std::set<int32_t> checkedCategories_;
    /// For rays that met a light: `of`, by query, is RayExtra::lit. It must outlive the result.
    LitSurface litBy(std::span<const int> of) const;
    LitSurface litSurface(BatchContext&, const LightLoop&, const std::vector<int>& points, int first, int lanes) const;
    void evaluateForLoop(BatchContext&, const LightLoop&, int light, int first, int lanes, std::vector<ShadePoint>&, const std::vector<int>& laneOf,
                         std::vector<LightValue>&, std::vector<float>& values);
    /// Takes from the values of one light what stands between it and the points that it lights.
    void shadowLoop(const BatchContext&, const BoundLight&, int first, std::span<const ShadePoint>, std::span<const int> laneOf, std::span<LightValue>);
    /// Sample `turn` of `turns` of a light for the points of a mask, into `kept`; gives the points that it lights.
    /// The point of a shaded batch as a light sees it when it lights `at`, for sample `turn` of `turns`; `axis`, `angle`: the
    /// loop's cone; nth: drawOf(). *factor multiplies the light. False: it gives nothing there.
    bool lightQuery(const BatchContext&, int light, int point, const Vec3& at, const Vec3& axis, float angle, int turn, int turns,
                    uint32_t nth, ShadePoint& query, float* factor) const;
    // lightsheets.cpp
    /// Which of BatchContext::sheets a sample of a light has; -1: none.
    int sheetNumber(int light, int turn);
    /// The sheet of a sample for the turn that runs now; null where it does not hold for all points of the mask.
    const LightSheet* sheetOf(BatchContext&, const LightLoop&, int light, int turn, int first, uint64_t mask, int lanes);
    /// By point of a batch, the sum of the ambient lights; they have sheets.
    const std::vector<Color>& ambientOf(BatchContext&);
    bool allAmbientHaveSheets(const SurfaceBinding&) const;
    void fillSheet(BatchContext&, const LightLoop&, int light, int turn, LightSheet&);
    /// What a sheet gives the points of a mask; those that are lit.
    uint64_t takeFromSheet(BatchContext&, LightLoop&, const LightSheet&, const BoundLight&, int first, uint64_t mask, int lanes,
                           float* out);
    /// The turns of a loop over the lights of a binding that are of a category (interned).
    const std::vector<std::pair<int, int>>& turnsOf(const SurfaceBinding&, int32_t category);
    bool isOfCategory(int32_t category, int light);
    struct TurnsOfList { std::vector<int> lights; std::vector<std::pair<int, int>> turns; };
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
    std::shared_ptr<struct AnswerMemo> answers_;
    uint64_t sampleLight(BatchContext&, const LightLoop&, int light, int turn, int turns, int first, uint64_t mask, int lanes, LightLoop::Kept& kept);
    /// Sample `turn` of a light that sends through generateSamples(), by its BoundLight::values at a point.
    static void sentSample(const BoundLight&, int turn, const float* values, LightValue&);
    /// One of those samples, in proportion to what each gives, for the sum of all. `u`: evenly from 0 to 1.
    static void chooseSent(const BoundLight&, float u, const float* values, LightValue&);
    /// The light of an interned handle, where it is one of the surface's; else -1. Null: of no surface.
    int numberOfLight(const SurfaceBinding*, int32_t handle);
    int32_t handleOf(int light); ///< interned
    std::unordered_map<int32_t, int> lightOfHandle_;
    std::unordered_map<int, int32_t> handles_;
    /// Contexts and their memory are used again: a slice makes several, of some hundred kilobytes.
    std::shared_ptr<BatchContext> takeContext();
    void giveBack(std::shared_ptr<BatchContext>); ///< kept when nobody else has it
    std::vector<std::shared_ptr<BatchContext>> pool_;
    std::unique_ptr<class Gather> gather_; ///< its memory is used again
    std::vector<accel::Ray> rays_, shadowRays_;
    std::vector<accel::Hit> hits_;
    std::vector<geometry::HitRef> run_;
    std::vector<uint8_t> blocked_;
    std::vector<shading::InstanceView> views_;
    std::vector<uint32_t> viewOf_, occurrence_;
    std::vector<int> slotOf_;                  ///< by binding: its place in views_, else -1
    bool traceAll(std::span<const CameraRay>, std::span<SampleResult>, const StopFlag* stop);
    void forget(); ///< what a trace() that has ended, or was given up, leaves behind
    /// Rays followed at once: enough to fill batches, few enough that their points stay in the cache of a core. Fewer once a
    /// shader has asked for more rays at the points of a batch than there is room for.
    static constexpr int kSliceOfPath = limits::kSliceRays / 8;
    int raysAtOnce_ = kSliceOfPath;
    bool beginsAnew_ = false;
    std::unique_ptr<Sched> sched_;
    /// The rays of a trace() in a light, by the engine that rayOfLight() keeps for it.
    shading::TargetValue follow(BatchContext&, const SiteInfo&, int point, const std::function<float(int)>& row, uint32_t occurrence);
    std::unique_ptr<Engine> inner_;
    void misses(std::span<const Sched::Task* const>, Sched&);
    struct Met { int light; TargetId target; const ShadePoint* point; };
    /// Light that emitters send along the rays that met them; sorted by light.
    void emission(std::span<const Met>, Sched&);
    /// Goes on behind a point. `chance`: with which it was chosen to; `asked`: rays that a waiting kernel has asked for there.
    void passThrough(const SurfaceBinding&, const PathRay&, TargetId, const ShadePoint&, const Color& transparency, float chance,
                     uint32_t asked, Sched&);
    std::shared_ptr<const WorldImpl> world_;
    Diagnostics& diagnostics_;
    render::SeedKey seed_;
    Rules rules_;
    std::vector<Color> transmitted_;
    uint64_t& raysOf(RayType); ///< the counter of such rays
    /// Points of a waiting kernel that may be shaded now, so that its frames stay within a quarter of the limit; at least one
    /// strip. `other`: the same shader for points of several surfaces, or null; which of the two runs is not known yet.
    int roomFor(const rsl::CompiledKernel&, const rsl::CompiledKernel* other, const Sched&) const;
    std::unordered_map<const rsl::CompiledKernel*, size_t> frameOf_; ///< bytes of a strip's frame, of kernels that were started
    std::set<const void*> tamed_,
        tamedClear_; ///< shaders that were named because they reflect more than they receive; with what comes through
};

} // namespace alpenglow::transport
