#include "integrator/specularsearch.h"
#include "bsdf/sampling.h"
#include "integrator/integrator.h"
#include "integrator/lightkernels.h"
#include "services/random.h"
#include <cmath>

namespace alpenglow::integrator {

namespace {

constexpr float kElsewhere = .125f;     ///< share of trials that begin anywhere: the seeds of a cell may lack a path to it
constexpr uint32_t kMostTrials = 2048;  ///< of a path that was found; if none finds it again, its light is too low
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

bool isDistant(const EmissionPlan::Light& l) { return l.light->kind == LightKind::Distant; }

} // namespace

/// A search for one query.
struct SpecularSearch::State {
    /// What the probes of a round tell.
    enum class Round {
        Step,    ///< whether `next` comes closer
        Columns, ///< the derivatives at `at`
        Light    ///< the light of the path that was found
    };
    const CausticSeed* seed = nullptr;
    const EmissionPlan::Light* light = nullptr;
    uint32_t trial = 0; ///< of all; counts from 0
    bool done = false;
    Round round = Round::Step;
    Vec3 direction;        ///< of the rays of a distant light
    Vec3 t, u;             ///< of steps in this trial
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
    // The path that was found.
    uint32_t foundIn = 0; ///< trial
    int foundLight = -1;
    Vec3 foundAt;
    uint64_t foundWay = 0;
};

SpecularSearch::SpecularSearch(std::shared_ptr<const WorldImpl> w, const CausticSeeds& seeds, Diagnostics& d)
    : seeds_(seeds), pipeline_(w, d), plan_(pipeline_.stages().lightKernels, {.caustics = true, .learns = true, .unmet = true}),
      met_(plan_.met(true)), moves_(w->moves()) {
    job_.plan = &plan_;
    job_.met = met_.data();
    job_.seed = w->settings().seed;
    job_.caustics = job_.learns = true;
    job_.models = false;
}

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

/// Begins a trial.
void SpecularSearch::begin(State& s, const Query& q) {
    const Vec2 u = Random(q.numbers).pair(q.vertex, kSpecularSeed, s.trial);
    const CausticSeeds::Cell& from = u.y < kElsewhere ? seeds_.anywhere() : *q.cell;
    const CausticSeed& seed = seeds_.seed(from, std::min(uint32_t(u.x * float(from.count)), from.count - 1));
    s.seed = &seed;
    s.light = planned(seed.light);
    s.rounds = 0;
    s.share = 1;
    s.begun = s.fresh = s.straight = false;
    s.round = State::Round::Step;
    if (!s.light) {
        s.done = true;
        return;
    }
    if (isDistant(*s.light)) s.direction = directionOf(*s.light, q);
    const Basis f(isDistant(*s.light) ? s.direction : seed.start);
    s.t = f.t, s.u = f.u;
    s.at = s.next = seed.start;
    if (isDistant(*s.light)) // all starts of a direction are in one plane
        s.at = s.next = seed.start - s.direction * (dot(seed.start - plan_.centre, s.direction) + plan_.radius * 1.001f);
    s.columns[0] = seed.columns[0], s.columns[1] = seed.columns[1];
    if (moves_ || s.light->light->cone) return; // the seed was sent at another time, or in another direction
    const Vec3 way = seed.P - q.P;
    s.miss = way - seed.dir * dot(way, seed.dir);
    s.begun = true;
    s.step = stepFor(s.columns, s.miss);
    if (std::isfinite(s.step.x + s.step.y)) take(s);
    else s.round = State::Round::Columns;
}

/// Sets the start that the next round tries.
void SpecularSearch::take(State& s) const {
    const float size = std::hypot(s.step.x, s.step.y), most = std::min(s.share, kLongest * s.seed->step / std::max(size, 1e-30f));
    s.taken = {s.step.x * most, s.step.y * most};
    s.next = moved(s, s.at, s.taken);
    s.round = State::Round::Step;
}

/// A start next to another: by components along t and u.
Vec3 SpecularSearch::moved(const State& s, const Vec3& start, Vec2 by) const {
    const Vec3 to = start + s.t * by.x + s.u * by.y;
    return isDistant(*s.light) ? to : normalize(to);
}

PhotonProbe SpecularSearch::probeAt(const State& s, const Query& q, const Vec3& start) const {
    PhotonProbe p;
    const bool distant = isDistant(*s.light);
    p.light = s.seed->light;
    p.origin = distant ? start : s.light->place;
    p.dir = distant ? s.direction : start;
    p.time = q.time;
    p.cone = Random(q.numbers).pair(q.vertex, kSpecularCone, 0);
    PhotonJob job = job_;
    job.pass = s.seed->pass;
    p.numbers = job.numbers(s.seed->number);
    p.bounces = s.seed->bounces;
    return p;
}

/// The probes of a round.
void SpecularSearch::ask(State& s, const Query& q) {
    s.first = probes_.size();
    const float h = s.seed->step;
    if (s.round == State::Round::Step) {
        probes_.push_back(probeAt(s, q, s.next));
        return;
    }
    probes_.push_back(probeAt(s, q, s.at));
    probes_.push_back(probeAt(s, q, moved(s, s.at, {h, 0})));
    probes_.push_back(probeAt(s, q, moved(s, s.at, {0, h})));
    if (s.round == State::Round::Columns) return;
    probes_[s.first].power = true;
    probes_.push_back(probeAt(s, q, moved(s, s.at, {-h, 0})));
    probes_.push_back(probeAt(s, q, moved(s, s.at, {0, -h})));
}

void SpecularSearch::answer(State& s, const Query& q, Found& found) {
    if (s.round == State::Round::Step) takeStep(s, q, found);
    else if (s.round == State::Round::Columns) takeColumns(s, q, found);
    else takeLight(s, q, found);
}

/// Accepts the start of this round if it comes closer, and steps on from there; else takes a shorter step from the last.
void SpecularSearch::takeStep(State& s, const Query& q, Found& found) {
    const ProbeEnd& e = ends_[s.first];
    Vec3 miss;
    if (++s.rounds > kMostRounds || s.seed->bounces > q.bounces) return endTrial(s, q, false, found);
    if (!meets(e, q.P, e.dir, miss) || (s.begun && !(dot(miss, miss) < dot(s.miss, s.miss)))) {
        s.share *= .5f;
        if (!s.begun || s.share < kLeastShare) return endTrial(s, q, false, found);
        if (s.fresh) take(s);
        else s.round = State::Round::Columns;
        return;
    }
    if (s.begun) { // Broyden's rule: the columns explain what the step has done
        const Vec3 off = (miss - s.miss - s.columns[0] * s.taken.x - s.columns[1] * s.taken.y) /
                         std::max(s.taken.x * s.taken.x + s.taken.y * s.taken.y, 1e-30f);
        s.columns[0] += off * s.taken.x, s.columns[1] += off * s.taken.y;
        s.share = std::min(1.f, 2 * s.share);
        s.straight = dot(miss, miss) < kStraight * kStraight * dot(s.miss, s.miss);
    }
    s.begun = true;
    s.fresh = false;
    s.at = s.next;
    s.miss = miss;
    s.way = e.way;
    stepOn(s, q, found);
}

/// Derivatives at the accepted start.
void SpecularSearch::takeColumns(State& s, const Query& q, Found& found) {
    const ProbeEnd* const e = &ends_[s.first];
    Vec3 at[3];
    if (!meets(e[0], q.P, e[0].dir, at[0])) return endTrial(s, q, false, found);
    for (int k = 1; k < 3; ++k) {
        if (e[k].way != e[0].way || !meets(e[k], q.P, e[0].dir, at[k])) return endTrial(s, q, false, found);
        s.columns[k - 1] = (at[k] - at[0]) / s.seed->step;
    }
    s.miss = at[0];
    s.way = e[0].way;
    s.fresh = true;
    stepOn(s, q, found);
}

/// The next step from the accepted start; where it is short the trial has arrived.
void SpecularSearch::stepOn(State& s, const Query& q, Found& found) {
    s.step = stepFor(s.columns, s.miss);
    const float size = std::hypot(s.step.x, s.step.y);
    if (!std::isfinite(size)) return endTrial(s, q, false, found);
    if (!(size < kArrived * s.seed->step)) return take(s);
    if (s.fresh || s.straight) return endTrial(s, q, true, found);
    s.round = State::Round::Columns;
}

/// A path was found: its light is that of the beam over the area that the beam covers at the point.
void SpecularSearch::takeLight(State& s, const Query& q, Found& found) {
    const ProbeEnd* const e = &ends_[s.first];
    Vec3 at[5];
    bool there[5];
    for (int k = 0; k < 5; ++k) there[k] = meets(e[k], q.P, e[0].dir, at[k]) && e[k].way == e[0].way;
    const float h = s.seed->step;
    Vec3 column[2];
    for (int k = 0; k < 2; ++k) {
        const int plus = 1 + k, minus = 3 + k;
        if (!there[0] || (!there[plus] && !there[minus])) {
            s.done = true;
            return;
        }
        column[k] = there[plus] && there[minus] ? (at[plus] - at[minus]) / (2 * h)
                    : there[plus]               ? (at[plus] - at[0]) / h
                                                : (at[0] - at[minus]) / h;
    }
    const Color Cl = e[0].light / length(cross(column[0], column[1]));
    if (!isFinite(Cl) || !(maxComponent(Cl) > 0)) {
        s.done = true;
        return;
    }
    found = {s.foundLight, e[0].origin, Cl, e[0].keptDiffuse, e[0].keptSpecular};
    ++counts_.found;
    ++s.trial;
    begin(s, q);
}

/// The first trial decides whether there is a path; the others count until one finds it again.
void SpecularSearch::endTrial(State& s, const Query& q, bool arrived, Found& found) {
    if (found.light < 0) {
        if (!arrived) {
            s.done = true;
            return;
        }
        s.foundIn = s.trial;
        s.foundLight = s.seed->light;
        s.foundAt = s.at;
        s.foundWay = s.way;
        const Basis f(isDistant(*s.light) ? s.direction : s.at);
        s.t = f.t, s.u = f.u;
        s.round = State::Round::Light;
        return;
    }
    const uint32_t trials = s.trial - s.foundIn;
    const bool again =
        arrived && s.seed->light == s.foundLight && s.way == s.foundWay && length(s.at - s.foundAt) < kSame * s.seed->step;
    if (again || trials >= kMostTrials) {
        counts_.lost += !again;
        found.Cl *= float(trials);
        s.done = true;
        return;
    }
    ++s.trial;
    begin(s, q);
}

bool SpecularSearch::run(std::span<const Query> queries, std::span<Found> found, const StopFlag* stop) {
    std::vector<State> states(queries.size());
    std::fill(found.begin(), found.end(), Found());
    counts_.searches += queries.size();
    for (size_t i = 0; i < queries.size(); ++i) begin(states[i], queries[i]);
    for (;;) {
        probes_.clear();
        for (size_t i = 0; i < queries.size(); ++i)
            if (!states[i].done) ask(states[i], queries[i]);
        if (probes_.empty()) return true;
        ends_.resize(probes_.size());
        counts_.probes += probes_.size();
        if (!pipeline_.probe(job_, probes_, ends_, stop)) return false;
        for (size_t i = 0; i < queries.size(); ++i)
            if (!states[i].done) answer(states[i], queries[i], found[i]);
    }
}

} // namespace alpenglow::integrator
