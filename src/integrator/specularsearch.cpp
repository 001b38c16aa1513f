#include "integrator/specularsearch.h"
#include "bsdf/sampling.h"
#include "integrator/integrator.h"
#include "integrator/lightkernels.h"
#include "services/random.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::integrator {

namespace {

constexpr float kElsewhere = .0625f;    ///< share of trials that begin anywhere: the seeds of a cell may lack a path to it
constexpr float kAround = .125f;        ///< the same, that begin in the cell or its neighbours
constexpr uint32_t kMostTrials = 2048;  ///< of a path that was found; if none finds it again, its light is too low
constexpr uint32_t kMostTogether = 64;  ///< trials of a search that are made at once
constexpr float kSurvives = 3;          ///< roulette of weak paths: chance over the root of their share of the light at the point
constexpr int kMostRounds = 24;         ///< of a trial
constexpr float kArrived = .1f;         ///< a step below this share of CausticSeed::step ends a trial
constexpr float kSame = 4;              ///< starts closer than this many of CausticSeed::step are of the same path
constexpr float kLongest = 400;         ///< longest step, in units of CausticSeed::step
constexpr float kLeastShare = 1.f / 64; ///< a trial ends where this part of a step does not come closer

constexpr float kStraight = 1e-3f; ///< columns that predict a step to this share of it need no check

/// Where a probe's end passes a point, relative to it: in the plane through the point with this normal.
bool meets(const ProbeEnd& e, const Vec3& P, const Vec3& normal, Vec3& at) {
    if (!e.arrives) return false;
    const float along = dot(e.dir, normal), way = dot(P - e.origin, normal);
    if (!(along > .1f) || !(way > 0)) return false;
    at = e.origin + e.dir * (way / along) - P;
    return std::isfinite(at.x + at.y + at.z);
}

/// The step that takes a miss to nothing, if the columns are its derivatives: least squares over three components.
Vec2 stepFor(const Vec3 (&column)[2], const Vec3& miss) {
    const double aa = dot(column[0], column[0]), ab = dot(column[0], column[1]), bb = dot(column[1], column[1]);
    const double am = dot(column[0], miss), bm = dot(column[1], miss), det = aa * bb - ab * ab;
    return {float((ab * bm - bb * am) / det), float((ab * am - aa * bm) / det)};
}

float sizeOf(Vec2 v) { return std::sqrt(v.x * v.x + v.y * v.y); }

} // namespace

/// A walk of a start toward a path to the point of a query.
struct SpecularSearch::Trial {
    /// What the probes of a round tell.
    enum class Round {
        Step,   ///< whether `next` comes closer
        Columns ///< the derivatives at `at`
    };
    size_t query = 0;
    const CausticSeed* seed = nullptr;
    const EmissionPlan::Light* light = nullptr;
    bool done = false, arrived = false; ///< arrived: at a path, which begins at `at`
    Round round = Round::Step;
    Vec3 direction;        ///< of the rays of a distant light
    Vec3 t, u;             ///< of steps
    Vec3 at, next;         ///< accepted start; start that this round tries
    Vec3 miss;             ///< by which the accepted start passes the point
    Vec3 columns[2];       ///< its derivatives, kept by Broyden's rule
    Vec2 step, taken;      ///< from `at`: the whole step, and the part that leads to `next`
    float share = 1;       ///< of the step
    bool begun = false;    ///< a start is accepted
    bool fresh = false;    ///< `columns` are differences at `at`
    bool straight = false; ///< `columns` told where the last step would lead
    int rounds = 0;
    uint64_t way = 0; ///< of the accepted start
    size_t first = 0; ///< in the probes of this round

    bool distant() const { return light->light->kind == LightKind::Distant; }
    /// A start next to another: by components along t and u.
    Vec3 moved(const Vec3& start, Vec2 by) const {
        const Vec3 to = start + t * by.x + u * by.y;
        return distant() ? to : normalize(to);
    }
    /// Sets the start that the next round tries.
    void take() {
        const float size = sizeOf(step), most = std::min(share, kLongest * seed->step / std::max(size, 1e-30f));
        taken = {step.x * most, step.y * most};
        next = moved(at, taken);
        round = Round::Step;
    }
    void end(bool well) { done = true, arrived = well; }
    void takeStep(const ProbeEnd&, const Vec3& P);
    void takeColumns(const ProbeEnd*, const Vec3& P);
    void stepOn();
};

SpecularSearch::SpecularSearch(const std::shared_ptr<const WorldImpl>& w, const CausticSeeds& seeds, Diagnostics& d)
    : seeds_(seeds), pipeline_(w, d), plan_(pipeline_.stages().lightKernels, {.caustics = true, .learns = true, .unmet = true}),
      met_(plan_.met(true)), moves_(w->moves()) {
    job_.plan = &plan_;
    job_.met = met_.data();
    job_.seed = w->settings().seed;
    job_.caustics = job_.learns = true;
    job_.models = false;
}

SpecularSearch::~SpecularSearch() = default;

const EmissionPlan::Light* SpecularSearch::planned(int light) const {
    for (const EmissionPlan::Light& l : plan_.lights())
        if (l.number == light) return &l;
    return nullptr;
}

/// The direction of a distant light's rays; one with an angle sends them in a cone, of which each query takes one.
Vec3 SpecularSearch::directionOf(const EmissionPlan::Light& l, const Query& q) {
    EmissionStart s;
    s.drawn.light = 0;
    s.drawn.chance = 1;
    s.drawn.time = q.time;
    s.drawn.cone = Random(q.numbers).pair(q.vertex, kSpecularCone, 0);
    startPhotons(pipeline_.stages().lightKernels, plan_, l, {&s, 1});
    return s.dir;
}

/// Trial `number` of a search.
SpecularSearch::Trial SpecularSearch::begin(const Query& q, size_t query, uint32_t number) {
    const Vec2 u = Random(q.numbers).pair(q.vertex, kSpecularSeed, number);
    const CausticSeeds::Range& from = u.y < kElsewhere ? seeds_.anywhere() : u.y < kAround ? q.cell->around : q.cell->own;
    const CausticSeed& seed = seeds_.seed(from, std::min(uint32_t(u.x * float(from.count)), from.count - 1));
    Trial t;
    t.query = query;
    t.seed = &seed;
    t.light = planned(seed.light);
    t.done = !t.light || seed.bounces > q.bounces;
    if (t.done) return t;
    t.at = t.next = seed.start;
    if (t.distant()) {
        t.direction = directionOf(*t.light, q);
        // All starts of a direction are in one plane.
        t.at = t.next = seed.start - t.direction * (dot(seed.start - plan_.centre, t.direction) + plan_.radius * 1.001f);
    }
    const Basis f(t.distant() ? t.direction : seed.start);
    t.t = f.t, t.u = f.u;
    t.columns[0] = seed.columns[0], t.columns[1] = seed.columns[1];
    if (moves_ || t.light->light->cone) return t; // the seed was sent at another time, or in another direction
    const Vec3 way = seed.P - q.P;
    t.miss = way - seed.dir * dot(way, seed.dir);
    t.begun = true;
    t.step = stepFor(t.columns, t.miss);
    if (std::isfinite(t.step.x + t.step.y)) t.take();
    else t.round = Trial::Round::Columns;
    return t;
}

PhotonProbe SpecularSearch::probeAt(const Trial& t, const Query& q, const Vec3& start) const {
    PhotonProbe p;
    p.light = t.seed->light;
    p.origin = t.distant() ? start : t.light->place;
    p.dir = t.distant() ? t.direction : start;
    p.time = q.time;
    p.cone = Random(q.numbers).pair(q.vertex, kSpecularCone, 0);
    PhotonJob job = job_;
    job.pass = t.seed->pass;
    p.numbers = job.numbers(t.seed->number);
    p.bounces = t.seed->bounces;
    return p;
}

/// Sends probes_ to ends_.
bool SpecularSearch::send(const StopFlag* stop) {
    ends_.resize(probes_.size());
    counts_.probes += probes_.size();
    for (const PhotonProbe& p : probes_) counts_.mirrors += uint64_t(p.bounces);
    return pipeline_.probe(job_, probes_, ends_, stop);
}

/// Walks all trials to their ends.
bool SpecularSearch::walk(std::span<Trial> trials, std::span<const Query> queries, const StopFlag* stop) {
    for (;;) {
        probes_.clear();
        for (Trial& t : trials) {
            if (t.done) continue;
            const Query& q = queries[t.query];
            t.first = probes_.size();
            if (t.round == Trial::Round::Step) {
                probes_.push_back(probeAt(t, q, t.next));
                continue;
            }
            const float h = t.seed->step;
            for (const Vec2 by : {Vec2{0, 0}, Vec2{h, 0}, Vec2{0, h}}) probes_.push_back(probeAt(t, q, t.moved(t.at, by)));
        }
        if (probes_.empty()) return true;
        if (!send(stop)) return false;
        for (Trial& t : trials) {
            if (t.done) continue;
            if (t.round == Trial::Round::Step) t.takeStep(ends_[t.first], queries[t.query].P);
            else t.takeColumns(&ends_[t.first], queries[t.query].P);
        }
    }
}

/// Accepts the start of this round if it comes closer, and steps on from there; else takes a shorter step from the last.
void SpecularSearch::Trial::takeStep(const ProbeEnd& e, const Vec3& P) {
    Vec3 now;
    if (++rounds > kMostRounds) return end(false);
    if (!meets(e, P, e.dir, now) || (begun && !(dot(now, now) < dot(miss, miss)))) {
        share *= .5f;
        if (!begun || share < kLeastShare) return end(false);
        if (fresh) take();
        else round = Round::Columns;
        return;
    }
    if (begun) { // Broyden's rule: the columns explain what the step has done
        const Vec3 off =
            (now - miss - columns[0] * taken.x - columns[1] * taken.y) / std::max(taken.x * taken.x + taken.y * taken.y, 1e-30f);
        columns[0] += off * taken.x, columns[1] += off * taken.y;
        share = std::min(1.f, 2 * share);
        straight = dot(now, now) < kStraight * kStraight * dot(miss, miss);
    }
    begun = true;
    fresh = false;
    at = next;
    miss = now;
    way = e.way;
    stepOn();
}

/// Derivatives at the accepted start.
void SpecularSearch::Trial::takeColumns(const ProbeEnd* e, const Vec3& P) {
    Vec3 to[3];
    if (!meets(e[0], P, e[0].dir, to[0])) return end(false);
    for (int k = 1; k < 3; ++k) {
        if (e[k].way != e[0].way || !meets(e[k], P, e[0].dir, to[k])) return end(false);
        columns[k - 1] = (to[k] - to[0]) / seed->step;
    }
    miss = to[0];
    way = e[0].way;
    fresh = true;
    stepOn();
}

/// The next step from the accepted start; where it is short the trial has arrived.
void SpecularSearch::Trial::stepOn() {
    step = stepFor(columns, miss);
    const float size = sizeOf(step);
    if (!std::isfinite(size)) return end(false);
    if (!(size < kArrived * seed->step)) return take();
    if (fresh || straight) return end(true);
    round = Round::Columns;
}

/// Light of the paths at which trials arrived: that of a beam over the area that it covers at the point.
bool SpecularSearch::light(std::span<const Trial> trials, std::span<const Query> queries, std::span<Found> found,
                           const StopFlag* stop) {
    probes_.clear();
    for (const Trial& t : trials) {
        if (!t.arrived) continue;
        Trial at = t;
        const Basis f(t.distant() ? t.direction : t.at);
        at.t = f.t, at.u = f.u;
        const float h = t.seed->step;
        probes_.push_back(probeAt(t, queries[t.query], t.at));
        probes_.back().power = true;
        for (const Vec2 by : {Vec2{h, 0}, Vec2{0, h}, Vec2{-h, 0}, Vec2{0, -h}})
            probes_.push_back(probeAt(t, queries[t.query], at.moved(t.at, by)));
    }
    if (probes_.empty()) return true;
    if (!send(stop)) return false;
    size_t first = 0;
    for (const Trial& t : trials) {
        if (!t.arrived) continue;
        found[t.query] = lightOf(t, queries[t.query].P, &ends_[first]);
        first += 5;
    }
    return true;
}

/// From the probes of a path, and of starts next to it: along t, u, -t and -u.
SpecularSearch::Found SpecularSearch::lightOf(const Trial& t, const Vec3& P, const ProbeEnd* e) const {
    Vec3 at[5], column[2];
    bool there[5];
    for (int k = 0; k < 5; ++k) there[k] = meets(e[k], P, e[0].dir, at[k]) && e[k].way == e[0].way;
    const float h = t.seed->step;
    for (int k = 0; k < 2; ++k) {
        const int plus = 1 + k, minus = 3 + k;
        if (!there[0] || (!there[plus] && !there[minus])) return {};
        column[k] = there[plus] && there[minus] ? (at[plus] - at[minus]) / (2 * h)
                    : there[plus]               ? (at[plus] - at[0]) / h
                                                : (at[0] - at[minus]) / h;
    }
    const Color Cl = e[0].light / length(cross(column[0], column[1]));
    if (!isFinite(Cl) || !(maxComponent(Cl) > 0)) return {};
    return {t.seed->light, e[0].origin, Cl, e[0].keptDiffuse, e[0].keptSpecular};
}

/// Weak paths are many and hard to find again: the roulette lets those go on that are a good part of the light there.
void SpecularSearch::roulette(std::span<const Query> queries, std::span<Found> found) const {
    for (size_t i = 0; i < found.size(); ++i) {
        const Query& q = queries[i];
        const float share = float(kPi) * luminance(found[i].Cl) / std::max(q.cell->irradiance, 1e-30f);
        const float chance = kSurvives * std::sqrt(std::max(share, 0.f));
        if (found[i].light < 0 || !(chance < 1)) continue;
        if (Random(q.numbers).one(q.vertex, kSpecularCone, 1) < chance) found[i].Cl *= 1 / chance;
        else found[i].light = -1;
    }
}

/// Counts the trials until one finds the path of a search again, more and more at once.
bool SpecularSearch::repeat(std::span<const Trial> paths, std::span<const Query> queries, std::span<Found> found,
                            const StopFlag* stop) {
    std::vector<size_t> left;
    for (size_t i = 0; i < queries.size(); ++i)
        if (found[i].light >= 0) left.push_back(i);
    std::vector<Trial> trials;
    for (uint32_t made = 0, more = 1; !left.empty(); made += more, more = std::min(3 * more, kMostTogether)) {
        trials.clear();
        for (const size_t i : left)
            for (uint32_t k = 0; k < more; ++k) trials.push_back(begin(queries[i], i, 1 + made + k));
        if (!walk(trials, queries, stop)) return false;
        size_t kept = 0;
        for (size_t k = 0; k < left.size(); ++k) {
            const Trial* const of = &trials[k * more];
            const Trial& path = paths[left[k]];
            const Trial* const again = std::find_if(of, of + more, [&](const Trial& t) {
                return t.arrived && t.seed->light == path.seed->light && t.way == path.way &&
                       length(t.at - path.at) < kSame * t.seed->step;
            });
            const bool lost = again == of + more;
            if (lost && made + more < kMostTrials) {
                left[kept++] = left[k];
                continue;
            }
            counts_.lost += lost;
            found[left[k]].Cl *= float(made + (lost ? more : uint32_t(again - of) + 1));
        }
        left.resize(kept);
    }
    return true;
}

bool SpecularSearch::run(std::span<const Query> queries, std::span<Found> found, const StopFlag* stop) {
    std::fill(found.begin(), found.end(), Found());
    counts_.searches += queries.size();
    std::vector<Trial> paths;
    for (size_t i = 0; i < queries.size(); ++i) paths.push_back(begin(queries[i], i, 0));
    if (!walk(paths, queries, stop) || !light(paths, queries, found, stop)) return false;
    for (const Found& f : found) counts_.found += f.light >= 0;
    roulette(queries, found);
    return repeat(paths, queries, found, stop);
}

double costOfSearches(const std::shared_ptr<const World>& world, const CausticSeeds& seeds, Diagnostics& d) {
    constexpr uint32_t kMost = 256;
    const auto w = std::static_pointer_cast<const WorldImpl>(world);
    SpecularSearch search(w, seeds, d);
    std::vector<SpecularSearch::Query> queries;
    const uint32_t all = seeds.anywhere().count, many = std::min(all, kMost);
    for (uint32_t i = 0; i < many; ++i) {
        const CausticSeed& s = seeds.seed(seeds.anywhere(), uint32_t(uint64_t(i) * all / many));
        SpecularSearch::Query& q = queries.emplace_back();
        q.P = s.P;
        q.cell = &seeds.find(s.P, s.side);
        q.bounces = w->maxDepth();
        q.vertex = i + 1;
    }
    std::vector<SpecularSearch::Found> found(queries.size());
    if (!search.run(queries, found, nullptr)) return 0;
    return double(search.counts().mirrors) / double(std::max<uint64_t>(search.counts().searches, 1));
}

} // namespace alpenglow::integrator
