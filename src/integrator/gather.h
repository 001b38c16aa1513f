// What becomes of the lobes that a batch asks light for (Engine::lobes), stage by stage, each in a file of its own:
//   choose   how much each lobe gives back, and the chance that its ray is followed (choose.cpp)
//   beside   lights that rays of the lobes may pass in a medium (beside.cpp)
//   light    points of lights for the points of the batch, and what the lights' kernels send from there (lightpoints.cpp)
//   connect  lobes with those points: contributions, with one shadow ray for all lobes of a vertex that can share it
//            (connect.cpp)
//   skies    at the last vertex of a path: skies that only rays would find (lastskies.cpp)
//   scatter  directions of the lobes whose rays are followed, and the rays (scatter.cpp)
// A stage reads what the ones before it wrote and changes nothing else; none looks at two points at a time, so results do not
// depend on who shares the batch.
#pragma once
#include "integrator/engine.h"
#include "integrator/photonjob.h"

namespace alpenglow::transport {

class Gather {
public:
    explicit Gather(Engine& e) : e_(e), world_(e.world()), rules_(e.rules()) {}
    /// Gathers light over Engine::lobes, all of points of this batch, and takes them. Shadow rays are left in Engine::shadows.
    void run(BatchContext&, Sched&);

private:
    /// A lobe that light of a query reaches from direction w. `turn`: how many queries have reached it before.
    struct Reached {
        int query, lobe, turn;
        Vec3 w;
        LobeValue value;
    };
    /// A lobe whose rays are sent: `count` of them, each with `scale` times its weight. `goes`, `w`: the ray of this turn.
    /// `vertex`: of that ray; `dice`: the number of its roulette; `drawn`: beside a light.
    /// `back`, of photons along narrow lobes: what the other way gives back, over the density, in the place of weight and value.
    struct Sent {
        int point, lobe, count;
        float scale;
        bool goes;
        Vec3 w;
        LobeValue value;
        uint32_t vertex = 0;
        float dice = 0;
        Color back{0};
        bool drawn = false;
        bool again = false; ///< its draw brings nothing, and another is made
        bool idle = false;  ///< its ray brings no light: it tells what is in the way
    };
    /// Sample `nth` of `of` that a point takes of a light. Lobes that ask for fewer have the first ones.
    struct Draw {
        int nth = 0, of = 1;
    };
    /// What lights are asked for at points of the batch, one kernel call; row by row a query.
    struct LightQueries {
        std::vector<ShadePoint> at; ///< the light's point; the first `count` are used
        std::vector<int> point;     ///< of the batch
        std::vector<const BoundLight*> light;
        std::vector<float> chance; ///< that the light is sampled there
        std::vector<float> spread; ///< of the lobes that it is for; < 0: for all of its point
        std::vector<Draw> draw;
        std::vector<Emitter::Sample> drawn;
        std::vector<LightValue> value;
        size_t count = 0;
        ShadePoint& add(int point, const BoundLight&, float chance, Draw);
        void dropLast();
        void clear();
    };

    // gather.cpp
    void sortByPoint();
    void tellLights();
    std::span<const int> lobesOf(size_t point) const {
        return std::span<const int>(order_).subspan(size_t(begin_[point]), size_t(begin_[point + 1] - begin_[point]));
    }
    const PathRay& rayOf(const LobeVertex& l) const { return c_->rays[size_t(l.point)]; }
    /// The key of a point's light samples: affine lobes of a vertex share them, each suspended request has its own.
    uint32_t lightVertex(size_t point) const;
    /// Where a ray from a point in direction w starts.
    Vec3 origin(size_t point, const Vec3& w) const;
    /// Where a ray of a lobe starts.
    Vec3 origin(const LobeVertex&, const Vec3& w) const;
    /// A waiting kernel's result goes to the target of its own that has no shares; what it makes of it has those of its ray.
    int32_t shareOf(const LobeVertex& l) const { return l.ownsTarget ? -1 : l.share >= 0 ? l.share : e_.extraOf(rayOf(l)).share; }

    // choose.cpp
    void choose();
    void choosePoint(size_t point);
    bool tooDeep(const LobeVertex&, const PathRay&, const SurfaceBinding&) const;
    float energyScale(size_t point, const Color& reflected, const Color& clear);

    // albedo.cpp
    bool albedoIsMeasured(const LobeVertex&) const; ///< once `delta` is known
    void measureAlbedos();

    // beside.cpp
    void besideLights();
    void besideLight(size_t point);
    static float densityBeside(const LobeVertex&, const Vec3& w, float ofLobe);
    static std::optional<Vec3> drawBeside(const LobeVertex&, Vec2& u);

    // lightpoints.cpp
    void light(Sched&);
    bool choose(const WorldImpl::LightList&, const std::vector<int>& on, std::vector<int>& touched);
    void lightOf(const BoundLight&, std::span<const std::pair<int, float>> chosen, const BoundKernel* shared, Sched&);
    void askWanted(const BoundKernel* shared, Sched&);
    bool samples(const LobeVertex&, const BoundLight&) const;
    int lightSamples(const LobeVertex&) const;
    int want(const BoundLight&, std::span<const std::pair<int, float>> chosen, int first);
    void placeWanted();
    bool place(ShadePoint&, Emitter::Sample&, const BoundLight&, size_t& number) const;
    void queriesByWidth(size_t point, const BoundLight&);
    void askLights(const BoundKernel* shared);

    // connect.cpp
    void connect();
    void reach(int query);
    void evaluate();
    bool meets(const LobeVertex&, int query, const Vec3& w, const Vec3& from, const Vec3& end) const;
    void send(const Reached&);
    Color contribution(const Reached&);

    // unshadowed.cpp
    void unshadowed(const LobeVertex&, const Vec3& w, const Color& through, const Color& environment, TraceSums&);

    // lastskies.cpp
    void lastSkies();
    void lastSky(int light);

    // scatter.cpp
    void scatter(Sched&);
    bool picks(size_t point) const;
    void pick(size_t point, float number);
    void draw(int turn);
    void drawAgain(int turn);
    void throwDice(int turn);
    void sendRay(const Sent&, Sched&);
    bool meetsEmitter(const LobeVertex&, const Vec3& w) const;
    /// The chance with which the ray goes on; 0: it does not.
    float roulette(const LobeVertex&, const Sent&, uint16_t& asked, const Color& weight) const;

    // photonscatter.cpp
    bool spreads(const LobeVertex&) const;
    bool mirrors(const LobeVertex&) const;
    /// `below`: narrowBelow(); in: the direction from which the lobe's point was seen, unit.
    bool isNarrow(const LobeVertex& l, float below, const Vec3& in) const;
    bool seesAll(const LobeVertex&) const;
    uint8_t trailBehind(const LobeVertex&) const; ///< PathRay::trail
    bool leftToPhotons(const LobeVertex&, const BoundLight&) const;
    void restPhotons();
    bool lit(const LobeVertex&) const;
    bool sampledByPaths(const LobeVertex&) const;
    /// Of a photon that goes on along a lobe; nothing: the surfaces' depths end its way.
    std::optional<PhotonDepths> depthsBehind(const LobeVertex&, const SurfaceBinding&) const;
    std::shared_ptr<BatchContext> shadeBack(std::span<Sent* const> turned, Sched&);
    void lookBack(Sched&);
    float photonWay(const LobeVertex&, Vec3& w) const;
    /// Gives lobes what they send on of the photons about their points.
    void takePhotons(Sched&);
    Color givenBack(const LobeVertex&);

    Engine& e_;
    const WorldImpl& world_;
    const Rules& rules_;
    BatchContext* c_ = nullptr;
    std::vector<int> begin_, order_,
        next_; ///< of point p the lobes order_[begin_[p]] to order_[begin_[p + 1]], as they were asked for
    std::vector<float> indirectScale_;                         ///< by point: of the rays of lighting shadeops
    std::vector<int> aimed_;                                   ///< lobes with a light beside their rays
    std::vector<float> passes_;                                ///< by point: the chance that its ray goes on behind it
    std::vector<std::vector<std::pair<int, float>>> chosenAt_; ///< many lights: by light of the list, points and chances
    std::vector<int> chosen_;                                  ///< places in the list that have some
    std::vector<std::vector<int>> ofGroup_;                    ///< many lights: by group, places in the list
    LightQueries queries_;
    render::NumberRows numbers_;
    struct Wanted {
        const BoundLight* light;
        int point;
        float chance;
        Draw draw;
    };
    std::vector<Wanted> wanted_; ///< points that ask for a light, and the chance that it was chosen there
    std::vector<Reached> reached_;
    std::vector<int> turns_; ///< by lobe: queries that have reached it
    int lastQuery_ = -1;     ///< that of the shadow ray sent last, which other lobes of its point may share
    std::vector<Sent> sent_;
    struct Near {
        Vec3 from;
        Color light; ///< radiance times steradians
    };
    std::vector<Near> near_; ///< photons about a point
};

} // namespace alpenglow::transport
