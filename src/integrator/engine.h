// The inside of Integrator, for the rooms of transport only: following a slice of rays, shading what they hit, and what becomes
// of requests.
#pragma once
#include "answers/answers.h"
#include "integrator/batchcontext.h"
#include "integrator/flight.h"
#include "integrator/photonjob.h"
#include "integrator/recordings.h"
#include "integrator/samples.h"
#include "integrator/vertex.h"
#include <array>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>

namespace alpenglow::transport {

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

/// n or -n: the one on the side of the surface at p that a ray in direction dir comes from.
inline Vec3 onSeenSide(const Vec3& n, const ShadePoint& p, const Vec3& dir) {
    return (dot(n, p.surface.n) > 0) == (dot(dir, p.surface.n) < 0) ? n : -n;
}

/// Whether nothing goes on behind any point of a batch that has run.
bool isOpaque(const shading::Batch&);

/// Questions that shadow rays answer: their weights hold the ray's throughput.
inline bool asksShadows(SiteKind k) { return k == SiteKind::Transmission || k == SiteKind::Occlusion || k == SiteKind::Ambient; }

/// Whether a call only notes what it asks for: trace() and transmission() always do, the shadeops of lobes only where the engine
/// estimates them.
inline bool isRequest(SiteKind k, bool path) {
    return k == SiteKind::Trace || k == SiteKind::Transmission || k == SiteKind::Occlusion || k == SiteKind::Subsurface ||
           k == SiteKind::Gather || (path && k >= SiteKind::Ambient && k <= SiteKind::LightVisibility);
}

class Engine final : public Sched::RayService, public Tracer {
public:
    Engine(std::shared_ptr<const WorldImpl>, Diagnostics&);
    ~Engine() override;
    bool trace(std::span<const CameraRay>, std::span<SampleResult>, const StopFlag* stop);
    /// Whether what runs now is done again, with fewer points at a time, when a shader asks for more rays than there is room for.
    bool beginsAnew() const { return beginsAnew_; }
    /// Whether a ray of the last trace() came to the bound of a procedural that is not made yet (Unmade): its results are void.
    bool unfinished() const { return unfinished_; }
    void setUnfinished(bool u) { unfinished_ = u; }
    /// What rays meet, or whether anything is in their way. At such a bound they end. together: neighbours go the same way.
    void meet(std::span<const accel::Ray>, std::span<accel::Hit>, bool together = false);
    bool meet(const accel::Ray&, accel::Hit&);
    void block(std::span<const accel::Ray>, std::span<uint8_t>);
    void follow(std::span<const Sched::Task> slice, Sched&) override; // hits.cpp
    bool settle(Sched&) override;
    /// From now on this may happen on the way of rays; before the first trace(). It must outlive the engine.
    void happens(FlightEvent& e) { events_.push_back(&e); }
    /// For events: the flight is over, and its ray goes on as `next`, a copy of it with what has changed (at least the vertex).
    /// way: how far it has come, where it goes straight on. flight.cpp
    void divert(Flight&, PathRay next, Sched&, float way = 0);
    Counters counters;
    uint64_t& raysOf(RayType);      ///< the counter of such rays
    const int32_t totalReflection_; ///< the label of rays that Counters::totalReflected counts

    // faults.cpp
    /// A value on the way of a ray is not a finite number: the whole camera sample is left out. `what` made it, at `place`: said
    /// once.
    void notFinite(const PathRay*, const std::string& what, const SourcePlace& place);
    void notFinite(const PathRay* ray, const char* what, const ShaderInstance* of);
    void notFinite(const BatchContext&, const PathRay&, uint32_t site); ///< what a call site gives
    /// The only way that light is added to targets: to that one, and their parts to the outputs that share it. deposit.cpp
    void deposit(Sched&, const Deposit&);
    // photons.cpp
    /// Emits photons by number and follows them to the end: what comes to rest goes to `out`, in an order that depends on nothing
    /// else. This engine then follows photons only. False: `stop` was set, and `out` is void.
    bool emit(const PhotonJob&, uint32_t first, uint32_t count, std::vector<StoredPhoton>& out, const StopFlag* stop);
    /// Not null: photons are followed, not what a camera sees.
    PhotonTrace* photonTrace() const { return photonTrace_.get(); }
    /// The photons of a ray's sample; null: none.
    const photons::PhotonGrid* passOf(const PathRay& r) const {
        return r.sample && !photonTrace_ ? world_->photons_->pass(r.sample->sample) : nullptr;
    }
    /// Whether light of this emitter that a ray has met is among the photons of its sample.
    bool bringsPhotons(const PathRay& r, int light) const {
        return (r.trail & shading::kTrailMirrored) && passOf(r) && world_->photons_->lightsOfPasses[size_t(light)];
    }
    /// The same to the part of the outputs by light path alone.
    void depositPart(Sched&, const PathRay*, uint16_t end, const Color& light);
    void depositThroughVolume(Sched&, const PathRay&, const Color& met, const Color& shown); // shadegroup.cpp
    // lightevents.cpp: PathRay::path from event to event. All keep 0.
    /// The same by a loop over lights, or by ambient(), under that label.
    uint16_t atLoop(const ShadePoint&, const PathRay&, const Vec3& w, int label) const;
    uint16_t atLobe(const LobeVertex&, const ShadePoint&, const PathRay&, const Vec3& w) const; ///< scattered towards w, unit
    uint16_t atLight(uint16_t path, const BoundLight& l) const {
        return path ? lightPaths_->next(path, lightSymbols_[size_t(&l - world_->lights_.data())]) : 0;
    }
    /// Photons are known by where they rest: as if a mirror had sent them there from a light without a label.
    uint16_t atPhotons(uint16_t path) const { return pathEvent(pathEvent(path, mirror_), loopLight_); }
    uint16_t pathEvent(uint16_t path, int32_t symbol) const { return path ? lightPaths_->next(path, symbol) : 0; }
    int labelOf(const std::string&) const;
    void prepareLightPaths();
    const scene::LightPaths* lightPaths_ = nullptr;                                         ///< Settings::lightPaths, under path
    std::vector<int32_t> lightSymbols_;                                                     ///< by light
    int32_t straight_ = 0, volume_ = 0, object_ = 0, map_ = 0, loopLight_ = 0, mirror_ = 0; ///< events without labels
    int loopLabel_ = -1, ambientLabel_ = -1;
    mutable std::unordered_map<int32_t, int> labelOfRays_; ///< by interned text
    mutable std::unordered_map<const LobeKind*, int> labelOfLobe_;
    std::vector<TargetId> partTargets_; ///< by camera sample and part
    std::vector<uint16_t> straights_;   ///< by shadow ray, surfaces that it went straight through; where somebody asks
    // lights.cpp
    /// Light arriving at queries from one light; for area lights `samples[i]` is the point on the emitter.
    void evaluateLight(const BoundLight&, std::vector<ShadePoint>& queries, std::span<LightValue> out,
                       const LightCall& = {}) override;
    /// Runs a light's kernel that waits for rays, strip by strip.
    void runWaitingLight(BatchContext&);
    /// Adds what a light's kernel asks for beside its Cl: shadows. The queries are not in the batch.
    void addLightPairs(BatchContext&, std::vector<ShadePoint>& queries, std::span<LightValue>);
    /// What a transmission() or trace() of a light's kernel gives at a point that it lights, followed to the end at once.
    shading::TargetValue rayOfLight(BatchContext&, const SiteInfo&, int point, const std::function<float(int)>& row,
                                    uint32_t occurrence, TraceSums* sums = nullptr);
    void shadowLight(const KernelRun&, const BoundLight&, int first, uint32_t draw, std::span<const ShadePoint>,
                     std::span<const int> laneOf, std::span<LightValue>) override;
    /// What a light said of its shadow; nonsense is reported once and left out.
    void takeShadowSays(LightValue&, const BoundLight&, float radius, float samples);
    // hemisphere.cpp
    /// The rays of an occlusion() at p, for `out`: together they bring `weight` where nothing is met.
    void hemisphereRays(const BatchContext&, const SiteInfo&, const ShadePoint& p, const Vec3& at, const geometry::SurfacePoint*,
                        const std::function<float(int)>& row, const Color& weight, TargetId, uint32_t site, uint32_t occurrence,
                        std::vector<ShadowRay>& out);
    int fewer(const OcclusionSite&, const std::function<float(int)>& row, int count, const BatchContext&) const;
    bool agree(std::vector<ShadowRay>&, size_t begin, HemisphereRays&, const Color& weight);
    /// What one of them brings of which so much came through, 0 to 1; what it tells besides goes to `sums`, which may be null.
    Color openLight(const ShadowRay&, const Color& transmitted, TraceSums* sums) const;
    /// How many samples a call sends, whose shader says `asked`: Attribute "irradiance" "nsamples" of the shape where that is
    /// nothing, 4096 at most; more are reported once.
    int samplesOf(float asked, const geometry::Shape*, const SiteInfo&, const BatchContext&);
    std::vector<HemisphereRays> hemispheres_; ///< of `shadows`
    render::NumberRows hemisphereNumbers_;    ///< of the rays of one call
    std::vector<Deposit> settled_;            ///< of calls that no ray is sent for any more; taken with the shadow rays
    // recordings.cpp
    /// What records say of the hemisphere that a call asks for at a point of a batch. Nothing: it is to be found exactly. In a
    /// pass that finds records one may be begun there; then it is anything. `kind`: of the call's rays.
    std::optional<Color> recorded(const BatchContext&, const SiteInfo&, int point, const std::function<float(int)>& row,
                                  const RayKind* kind, uint32_t occurrence);
    void sendRecord(const BatchContext&, int point, uint32_t call, uint32_t occurrence, Recording&);
    void followRecords(Sched&); ///< sends the rays of those that were begun
    void blockedRecord(Recording&);
    void keepRecordings(const Sched&); ///< once all rays are followed
    void forgetRecordings();
    std::vector<Recording> recordings_;
    size_t recordsSent_ = 0;
    /// What the attributes of a shape say: samples, and the bias, < 0 where there is none.
    struct OfShape {
        int samples;
        float bias;
    };
    const OfShape& ofShape(const geometry::Shape*);
    std::unordered_map<const scene::Attributes*, OfShape> ofShapes_;
    TurnedAway::Tally* tallyOf(const BatchContext&, const SiteInfo&, const ShadePoint&, const Vec3& normal);
    /// The same of a call that looks for light about a unit normal: whether its own primitive is before it.
    void noteTurnedAway(const BatchContext&, const SiteInfo&, int point, const Vec3& normal);
    std::map<std::pair<const SiteInfo*, const geometry::Shape*>, TurnedAway::Tally*> tallies_;
    // gatherloop.cpp
    /// What the shaders at a hit give to the gather whose ray met it; `point` of a batch that has run.
    /// Parameters at points that rays of gathers have met, as these have sent them.
    void takeSent(BatchContext&) const;
    void tellGather(const BatchContext&, int point, struct GatherSent&);
    std::unordered_map<TargetId, GatherSent*> gathered_; ///< rays of gathers that ask shaders, by target
    // shadowrays.cpp
    /// What is left of light along each ray. `ray`: for the random numbers and footprint of shaders on the way; may be null.
    void transmittances(std::span<const ShadowRay>, std::span<Color> out);
    Color transmittance(const ShadowRay&);
    void passSurfaces(std::span<const ShadowRay>, std::span<Color> out); ///< what surfaces and media leave
    /// The rays of a transmission() from a to b, for `out`: as many as it asks for, each with its share of `weight`.
    void transmissionRays(const SiteInfo&, const ShadePoint&, const Vec3& at, const geometry::SurfacePoint*,
                          const std::function<float(int)>& row, const Color& weight, TargetId, uint32_t site, uint32_t occurrence,
                          std::vector<ShadowRay>& out);
    /// Oi at hits of one binding.
    void opacities(std::span<const OpacityQuery>, std::span<Color> out);
    void takeOpacities(std::span<const OpacityQuery> met, const std::function<void(size_t, const Color&)>& take);
    /// Whether surfaces that block all light are looked for first and by themselves, the others only where a ray may meet them.
    bool meetsOpaqueAlone(const ShadowRay&) const;
    void blockedByOpaque(std::span<const ShadowRay>, std::span<Color> out);
    void blockedByAll(std::span<const ShadowRay>, std::span<Color> out);
    bool blockedInRows(std::span<const ShadowRay>, std::span<Color> out); // hitrows.cpp
    // haze.cpp
    /// Runs a volume shader over points with Ci, Oi, I, P set. The points' Ci is void afterwards. The binding is that of what was
    /// met. `surface`, `of`: the run of the surface shader, and the points' numbers there; may be missing.
    void haze(const Medium&, const SurfaceBinding&, std::vector<ShadePoint>&, std::span<Haze> out, bool wantSlope,
              BatchContext* surface = nullptr, std::span<const int> of = {});
    void keepOutputs(const shading::Batch& volume, BatchContext& surface, std::span<const int> of);
    /// Fills c.haze for points first to first + count - 1 of a shaded batch.
    void hazeOfBatch(BatchContext&, int first, int count, bool wantSlope);
    /// Takes from the light of emitters what their atmosphere takes between them and the lit points.
    /// inMedium: LightCall::inMedium.
    void hazeOfEmitters(const BoundLight&, std::span<const ShadePoint>, std::span<LightValue>, const std::vector<char>* inMedium);
    // media.cpp
    /// Where a ray from a point of a batch in direction w begins.
    void tellLost(const shading::Media*, const ShadePoint&) const; ///< says once that a ray was in more volumes than are known
    const shading::Media* mediaTowards(const KernelRun&, int point, const Vec3& w);
    /// SurfaceBinding::beyond().
    const shading::Media* mediaBeyond(const SurfaceBinding&, const shading::Media* from, const Vec3& n, const Vec3& in,
                                      const Vec3& to);
    const shading::Media* kept(const shading::Media&); ///< the same, for good; null where it is none
    static int mediumOf(const shading::Media* m) { return m ? m->top() : -1; }
    /// Where shadow rays between a and b begin, one of which may be the point `at` of a surface. Those that end there are turned
    /// about.
    void shadowsInMedia(std::span<ShadowRay>, const Vec3& a, const Vec3& b, const Vec3& at, const geometry::SurfacePoint*,
                        const SurfaceBinding*);
    /// A part of a shadow ray inside a medium.
    struct MediumPart {
        int medium;
        size_t ray;
        Vec3 from, to;
    };
    /// Takes from `out`, by ray, what the media leave of light.
    void dim(std::span<const MediumPart>, std::span<const ShadowRay>, std::span<Color> out);
    // manylights.cpp
    /// Probability that a light is among those that are sampled at a point of the binding at `at`, after so many bounces.
    float chanceOf(int light, int binding, const Vec3& at, int bounces) const;
    // raysets.cpp
    /// For one call. f: a row of its arguments; from: the shape whose shader calls, or null, whose Attribute "grouping"
    /// "tracesubset" holds where no subset is given. Also tells the type and the label of the rays.
    shading::RaySet raySetOf(const SiteInfo&, const std::function<float(int)>& f, const geometry::Shape* from, RayType& type,
                             int32_t& label);
    /// ShapeSubsets::find() without a lock from the second time on; texts are interned. `from`: whose "tracesubset" holds.
    const uint8_t* shapesOf(int32_t subset, int32_t exclude, const scene::Attributes* from);
    std::map<std::tuple<int32_t, int32_t, const scene::Attributes*>, const uint8_t*> subsetsKnown_;
    std::vector<int> apartAt_; ///< points of the batch that ask for indirect light beside direct light (rsl::kPairApart)
    std::map<std::pair<const rsl::ir::Site*, int32_t>, const LobeKind*> lobesNamed_; ///< of names that calls have made
    Answers& answers() { return answers_; }
    // lightoutputs.cpp
    /// For the camera's points of a batch that is filled: runs for the outputs that light reaches.
    std::vector<std::shared_ptr<BatchContext>> asides(const BatchContext&, Sched&);
    /// A lobe of a batch, and the pair that it came from.
    struct AskedLobe {
        int lobe, record, lane;
    };
    void requestPairs(BatchContext&, std::span<const Color> slope, std::vector<AskedLobe>* asked, Sched&,
                      bool lobesToo = true); // shadegroup.cpp
    bool ambientLights_ = false;             ///< some light answers ambient()
    /// A pair of an output that shares no lobe of Ci, or not in all components.
    struct AskedAside {
        BatchContext* run;
        int record, lane;
        Color weight;
    };
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
    void requestShadows(BatchContext&, const SiteInfo&, int point, const std::function<float(int)>& row, const Color& weight,
                        TargetId, bool owns, uint32_t occurrence);
    template <class Row> const LobeKind* lobeOf(const BatchContext&, const SiteInfo&, const Row&);
    template <class Row> const RayKind* raysOfTrace(const SiteInfo&, const Row&, const ShadePoint&);
    /// What a trace() says of its lobe and its rays; false: its weight is 0, and nothing is sent.
    template <class Row>
    bool askOfTrace(const BatchContext&, const SiteInfo&, const ShadePoint&, const Row&, LobeVertex&, LobeParams&);
    void request(BatchContext&, const SiteInfo&, int point, const float* in, int lanes, int lane, Color weight, TargetId,
                 bool owns, uint32_t occurrence);
    /// `in`: rows of the call's arguments, and behind them two: ShadowReach::radius and the vertex of its random numbers.
    void lightVisibility(BatchContext&, const SiteInfo&, int point, const float* in, int lanes, int lane, Color weight, TargetId);
    // ambient.cpp
    std::vector<AmbientAsked> ambients_; ///< of the batch whose requests are taken
    render::NumberRows ambientNumbers_;
    void drawAmbient(const BatchContext&, std::vector<AmbientAsked>&);
    void gatherAmbient(BatchContext&); ///< makes shadow rays of them
    void sendAmbient(const BatchContext&, const AmbientAsked&, const Color& light, int number, int& last);
    /// Where a ray from a point of a batch in direction w starts.
    Vec3 leave(const BatchContext&, size_t point, const Vec3& w) const;
    /// What outputs of the surface are now, for lights that ask; of a kernel that waits they stay as they were at the call.
    void tellOutputs(LitValues&, const BatchContext&, size_t point) const;
    /// Says once a shader that its indirect light is scaled down. more: it reflects more than it receives by itself.
    void tellScaled(const SurfaceBinding&, bool more);
    /// Gathers light over `lobes` (gather.h).
    void gather(BatchContext&, Sched&);
    /// The environment map of a trace() in direction w (unit, current space).
    Color mapTowards(const TraceSite&, const Vec3& w, float spread) const;
    void flushShadows(Sched&);
    void tellAsker(const BatchContext&, int point, const Color& opacity, Sched&);
    /// `asked`: by lane, the rays that a waiting kernel has asked for there.
    void finishStrip(BatchContext&, int first, int lanes, Sched&, std::span<const uint32_t> asked = {});
    /// The share of the light from behind a shaded point that comes through, 0 to 1.
    Color clearAt(const BatchContext&, int point) const;
    /// Of a ray, what goes on behind its point: clearAt(), of some photons more.
    Color goesOn(const BatchContext&, int point) const;
    Color leftBehind(const BatchContext&, int point) const; ///< of it, by what the volume before the point takes
    const WorldImpl& world() const { return *world_; }
    const Rules& rules() const { return rules_; }
    Diagnostics& diagnostics() { return diagnostics_; }
    // Of batches in rows (hits.cpp): BatchContext::surfaces, and the points of those who need them after all.
    void placeSurfaces(BatchContext&);
    void pointsOfRows(BatchContext&);
    void keepIndirect(BatchContext&);
    void fillBatch(BatchContext&); // shadegroup.cpp
    void viewsOf(const BatchContext&);
    const shading::ParameterRows* parametersOf(int binding, const shading::BatchPlan&);
    /// By binding, the last two that were asked for: of the kernels for one binding and for several.
    std::vector<std::array<std::unique_ptr<const shading::ParameterRows>, 2>> parameters_;
    void tellClear(BatchContext&);
    void shadeGroup(const std::shared_ptr<BatchContext>&, Sched&);
    void takeDisplacement(BatchContext&); // displace.cpp
    /// Runs the displacement shader at the points of a batch (all of one binding); null where it waits for rays. displacement.cpp
    std::shared_ptr<BatchContext> displace(const BatchContext&);
    /// Points of surfaces whose shaders move P, once the kernel has its inputs: rays met, and will leave, the facets.
    /// displacement.cpp
    static void moveToFacets(BatchContext&);
    void bindCall(rsl::KernelCall&, BatchContext&);
    Random random(const PathRay& r) const { return Random(r.sample ? r.sample->numbers : noSample_.numbers); }
    /// The one that stays, of a kind that is made.
    const RayKind* kindOf(const RayKind&);
    const RayExtra& extraOf(const PathRay& r) const { return r.extra < 0 ? noExtra_ : extras_[size_t(r.extra)]; }
    /// For PathRay::extra of one ray, which has it alone: freeExtra() when its points are shaded. -1 where there is nothing in
    /// it.
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
    std::vector<TargetId> lightTargets_;    ///< by camera sample, WorldImpl::lightOutputs_
    TargetId nowhere_ = shading::kNoTarget; ///< nobody reads it
    std::vector<int> litBy_;                ///< RayExtra::lit of the queries of a light
    std::vector<LitValues> litValues_;      ///< of what runs now; only where lights ask for outputs of surfaces
    std::vector<SampleResult*> results;     ///< of the call of trace()
    // subsurface.cpp
    /// The lobe of a subsurface(): its rays walk below the surface.
    void requestSubsurface(BatchContext&, const SiteInfo&, const ShadePoint&, const std::function<float(int)>& row, LobeVertex&);
    /// What Attribute "subsurface" says of a shape.
    struct SubsurfaceOfShape;
    const SubsurfaceOfShape& subsurfaceOf(const scene::Attributes&);
    /// Shapes with the same group bound one inside: those of a name, or of the same attributes.
    int groupNamed(const std::string&);
    std::map<const scene::Attributes*, std::shared_ptr<const SubsurfaceOfShape>> subsurfaces_;
    std::map<std::string, int> groups_;
    HalfSpaces halfSpaces_;
    std::vector<Below> below_;     ///< of `lobes`
    std::vector<WalkAsked> walks_; ///< that the lobes of a batch have asked for; taken where these are done
    /// Follows the walks below surfaces that a batch has asked for. subsurface.cpp
    void walk(BatchContext&, Sched&);
    std::vector<int> spoiled_; ///< PathSample::path of samples that notFinite() has seen; some twice
    std::vector<LobeVertex> lobes;
    LobeColumns lobeRows_; ///< of `lobes`
    std::vector<ShadowRay> shadows;
    std::vector<MoreLight> moreLight_; ///< of `shadows`
    const StopFlag* stop = nullptr;
    /// Of rays that gather photons, those whose surface has a map: they get what that says, and leave the batch. photonmodels.cpp
    void takeGlobalMaps(BatchContext&, Sched&);
    const photons::PhotonMap* globalMapOf(int binding);
    std::unordered_map<int, const photons::PhotonMap*> globalMaps_; ///< by binding
    void beginTrace();                                              ///< nothing waits and nothing is spoiled
    void endTrace(const Sched&);                                    ///< counts what the scheduler saw, and forgets
    accel::Ray rayOf(const PathRay&) const;                         ///< as the tree follows it
    void clip(accel::Ray&) const;                                   ///< keeps a camera ray within the clipping planes
    float levelOfSample(const CameraRay&) const;                    ///< PathSample::level
    void beginRay(const CameraRay&, size_t i, PathRay&);            ///< the i-th of a call
    /// What is left of light along camera rays, behind each surface that they meet: SampleResult::left. depths.cpp
    bool seeThrough(std::span<const CameraRay>, std::span<SampleResult>);
    bool emitAll(const PhotonJob&, uint32_t first, uint32_t count);
    const shading::Media* aboutLight(const EmissionPlan::Light&, const struct EmissionStart&);
    void tiltPhotons(BatchContext&); ///< photonscatter.cpp
    // photonmodels.cpp
    /// Photons at points whose surfaces scatter them by a model, or whose kernel waits for rays.
    void photonsByModel(BatchContext&, Sched&);
    /// Lobes of the models of a batch's points in the place of those that its kernel asked for; `all`: of every point.
    void takeModels(BatchContext&, bool all);
    std::unique_ptr<PhotonTrace> photonTrace_;

private:
    /// Hits of a group that wait to be shaded together. They hold their targets.
    struct HitQueue {
        std::vector<accel::Hit> hits;
        std::vector<PathRay> rays;
        std::vector<TargetId> targets;
        bool waits = false; ///< its kernel waits for rays; then
        size_t room = 0;    ///< so many of its points may be shaded now
    };
    std::vector<HitQueue> hitQueues_; ///< by SurfaceBinding::group, then for rays that take primitives as they are
    std::vector<size_t> groupsWithHits_;
    size_t hitsWaiting_ = 0;
    void cast(std::span<const Sched::Task>);
    bool castRows(std::span<const Sched::Task>); // hitrows.cpp
    void queueHit(const Sched::Task&, const accel::Hit&, Sched&);
    void shadeHits(size_t group, Sched&);
    void takeHits(HitQueue&, BatchContext&);
    void placePoints(BatchContext&);
    void completePoint(BatchContext&, size_t point);
    template <class To> void placeSurfaces(const BatchContext&, To);
    void finishBatch(std::shared_ptr<BatchContext>, Sched&);
    void fade(PathRay&, float way);
    // flight.cpp: what happens on the way. Flights that are over leave the batch, or the list.
    void fly(BatchContext&, Sched&);
    void fly(std::vector<const Sched::Task*>& missed, Sched&);
    std::vector<FlightEvent*> events_;
    std::vector<Flight> flights_;
    void shine(const BatchContext&, Sched&);
    std::vector<class KernelStrip*> waiting_; ///< whose requests nobody has followed yet
    std::vector<PathSample> samples_;
    PathSample noSample_; ///< of the call of trace()
    std::vector<RayExtra> extras_;
    std::vector<int32_t> freeExtras_;
    const RayExtra noExtra_;
    std::unordered_map<uint64_t, std::deque<RayKind>> kinds_; ///< by hash
    const RayKind* lastKind_ = nullptr;
    std::deque<shading::Media> media_;
    friend class KernelStrip;
    friend class Gather;
    friend class BlockVertices;
    friend class RowShading;
    friend class MediumFlights;
    friend class Walks;
    std::unique_ptr<FlightEvent> flightsInMedia_; ///< where the world has media that scatter, or priorities
    int leaks_ = 0;                               ///< rays that left the scene inside of such a medium
    /// For rays that met a light: `of`, by query, is RayExtra::lit. It must outlive the result.
    LitSurface litBy(std::span<const int> of) const;
    /// Contexts and their memory are used again: a slice makes several, of some hundred kilobytes.
    std::shared_ptr<BatchContext> takeContext();
    void giveBack(std::shared_ptr<BatchContext>); ///< kept when nobody else has it
    std::vector<std::shared_ptr<BatchContext>> pool_;
    std::unique_ptr<class Gather> gather_; ///< its memory is used again
    std::unique_ptr<class BlockVertices> blockVertices_;
    std::unique_ptr<class RowShading> rows_;
    std::vector<accel::Ray> rays_, shadowRays_;
    std::vector<accel::Hit> hits_, found_;
    std::vector<uint32_t> given_; ///< of a slice, the rays whose points are given
    std::vector<geometry::HitRef> run_;
    std::vector<uint8_t> blocked_;
    std::vector<shading::InstanceView> views_;
    std::vector<uint32_t> viewOf_, occurrence_;
    std::vector<int> slotOf_; ///< by binding: its place in views_, else -1
    bool traceAll(std::span<const CameraRay>, std::span<SampleResult>, const StopFlag* stop);
    void forget(); ///< what a trace() that has ended, or was given up, leaves behind
    /// Rays followed at once: enough to fill batches, few enough that their points stay in the cache of a core. Fewer once a
    /// shader has asked for more rays at the points of a batch than there is room for.
    static constexpr int kSliceOfPath = limits::kSliceRays / 8;
    int raysAtOnce_ = kSliceOfPath;
    bool beginsAnew_ = false, unfinished_ = false;
    bool rowsToRays_ = false; ///< what rays meet is found in rows: accel::Accel::takesRows()
    bool grids_ = false;      ///< some ray of this call meets a point that is given
    std::unique_ptr<Sched> sched_;
    /// The rays of a trace() in a light, by the engine that rayOfLight() keeps for it.
    shading::TargetValue follow(BatchContext&, const SiteInfo&, int point, const std::function<float(int)>& row,
                                uint32_t occurrence);
    std::unique_ptr<Engine> inner_; ///< inner(): with nothing in it
    Engine& inner();
    void takeInner(); ///< what it has counted
    void gatherOfLight(BatchContext&, const SiteInfo&, int first, std::span<uint32_t> asked);
    void followGather(std::span<struct GatherSent>);
    void misses(std::span<const Sched::Task* const>, Sched&);
    struct Met {
        int light;
        TargetId target;
        const ShadePoint* point;
    };
    /// Light that emitters send along the rays that met them; sorted by light.
    void emission(std::span<const Met>, Sched&);
    /// Goes on behind a point. `chance`: with which it was chosen to; `asked`: rays that a waiting kernel has asked for there.
    void passThrough(const SurfaceBinding&, const PathRay&, TargetId, const ShadePoint&, const Color& transparency, float chance,
                     uint32_t asked, Sched&);
    std::shared_ptr<const WorldImpl> world_;
    Diagnostics& diagnostics_;
    render::SeedKey seed_;
    Rules rules_;
    Answers answers_;
    std::vector<Color> transmitted_;
    /// Points of a waiting kernel that may be shaded now, so that its frames stay within a quarter of the limit; at least one
    /// strip. `other`: the same shader for points of several surfaces, or null; which of the two runs is not known yet.
    int roomFor(const rsl::CompiledKernel&, const rsl::CompiledKernel* other, const Sched&) const;
    std::unordered_map<const rsl::CompiledKernel*, size_t> frameOf_; ///< bytes of a strip's frame, of kernels that were started
    std::set<const void*> tamed_,
        tamedClear_; ///< shaders that were named because they reflect more than they receive; with what comes through
};

} // namespace alpenglow::transport
