// Stage LightSampling: samples each light for each point with lobes that need it, one kernel call a light. In scenes with many
// lights each point chooses some, and lights of one program share a call.
#include "integrator/lightsampling.h"
#include "integrator/connection.h"
#include "integrator/kernelinputs.h"
#include "integrator/lightkernels.h"
#include "integrator/lightsample.h"
#include "integrator/litsurfaces.h"
#include "integrator/mediastacks.h"
#include "integrator/photonscatter.h"
#include "integrator/raystore.h"
#include "integrator/requests.h"
#include "integrator/shadowrays.h"
#include "world/emitterfootprint.h"

namespace alpenglow::integrator {

LightSampling::LightSampling(const StageSet& s, const VertexLobes& v, Connection& connection, PhotonScatter& photonScatter)
    : VertexStage(s, v), connection_(connection), photonScatter_(photonScatter), inputs_(s.inputs), lightKernels_(s.lightKernels),
      litSurfaces_(s.litSurfaces), media_(s.media), shadows_(s.shadows) {}

namespace {
/// Queries of lights that share a call are answered in portions: those of all points of a batch do not fit into the cache of a
/// core.
constexpr size_t kQueriesAtOnce = 512;
constexpr int kSamplesAtOnce = 16; ///< of a light at a point, at once: limits the memory of a batch
} // namespace

ShadePoint& LightQueries::add(int of, const BoundLight& l, float c, LightDraw which) {
    if (count == at.size()) at.emplace_back(); // else overwritten
    point.push_back(of);
    light.push_back(&l);
    chance.push_back(c);
    spread.push_back(-1);
    draw.push_back(which);
    drawn.emplace_back();
    return at[count++];
}

void LightQueries::dropLast() {
    --count;
    point.pop_back();
    light.pop_back();
    chance.pop_back();
    spread.pop_back();
    draw.pop_back();
    drawn.pop_back();
}

void LightQueries::clear() {
    count = 0;
    point.clear();
    light.clear();
    chance.clear();
    spread.clear();
    draw.clear();
    drawn.clear();
}

/// Whether a lobe samples this light. trace() without "samplelights" samples emitters only; it samples none that illuminance
/// loops handle.
bool LightSampling::samples(const LobeVertex& l, const BoundLight& light) const {
    if (!light.importance && (l.trace || rules_.emissionCounts)) return false; // only rays find it
    if (photonScatter_.leftToPhotons(l, light)) return false;
    if (light.guidable && (l.ownsTarget || !l.followed || !(l.chosen > 0))) return false; // the guide completes a ray
    return l.lights && !l.elsewhere && !l.delta && (light.kind == LightKind::Area || light.isSky() || l.deltaLights) &&
           (l.lobeOfShader || light.strategy != LightStrategy::Illuminance);
}

/// Samples of each light that a lobe takes: as many as its rays.
int LightSampling::lightSamples(const LobeVertex& l) const {
    return l.trace && (l.ownsTarget || !rules_.pickOne) ? l.samples : 1;
}

/// Queries the lights of wanted_: a single light, or several with the kernel `shared`.
void LightSampling::askWanted(const BoundKernel* shared, Sched& sched) {
    queries.clear();
    placeWanted();
    askLights(shared);
    connection_.connect();
    if (shadows_.queue.size() > kShadowsAtOnce) shadows_.flush(sched);
}

/// Samples a light at all points that need it; with `shared` the last portion is left in wanted_.
void LightSampling::lightOf(const BoundLight& light, std::span<const std::pair<int, float>> chosen, const BoundKernel* shared,
                            Sched& sched) {
    for (int first = 0, most = 1; first < most; first += kSamplesAtOnce) {
        most = want(light, chosen, first);
        if (!shared || wanted_.size() >= kQueriesAtOnce) askWanted(shared, sched);
    }
}

/// Fills chosenAt_: by light, the points that chose it; or, if every point samples every light, the first entry only. Returns
/// true in the first case.
bool LightSampling::chooseLights(const WorldImpl::LightList& list, const std::vector<int>& on, std::vector<int>& touched) {
    const bool many = rules_.pickOne && !(world_.chooserOf(list).empty() && list.deeper.empty());
    touched.clear();
    if (!many) {
        chosenAt_.resize(std::max<size_t>(chosenAt_.size(), 1));
        for (size_t point = 0; point < c_->points.size(); ++point)
            if (begin_[point] != begin_[point + 1]) chosenAt_[0].push_back({int(point), 1.f});
        for (size_t k = 0; k < on.size() && !chosenAt_[0].empty(); ++k)
            if (!list.ofAll || list.lights.contains(on[k])) touched.push_back(int(k));
        return false;
    }
    chosenAt_.resize(std::max(chosenAt_.size(), on.size()));
    LightChooser::Chosen chosen;
    for (size_t point = 0; point < c_->points.size(); ++point) {
        if (begin_[point] == begin_[point + 1]) continue;
        const LightChooser& chooser = world_.chooserAt(list, c_->rays[point].bounces);
        if (chooser.empty()) {
            chosen.clear();
            for (size_t k = 0; k < on.size(); ++k) chosen.push_back({int(k), 1.f});
        } else {
            chooser.choose(c_->points[point].P, store_.random(c_->rays[point]).one(lightVertex(point), kChooseLight, 0), chosen);
        }
        for (auto [i, chance] : chosen) {
            if (list.ofAll && !list.lights.contains(on[size_t(i)])) continue;
            if (chosenAt_[size_t(i)].empty()) touched.push_back(i);
            chosenAt_[size_t(i)].push_back({int(point), chance});
        }
    }
    std::sort(touched.begin(), touched.end());
    return true;
}

void LightSampling::run(Sched& sched) {
    const SurfaceBinding& binding = world_.bindings_[size_t(c_->bindings[0])]; // the list is the same for the whole batch
    const WorldImpl::LightList& list = world_.lightLists_[size_t(binding.lightList)];
    const std::vector<int>& on = world_.sampledOf(list);
    std::vector<int>& touched = chosen_; // indices in the list of lights that some point samples
    const bool many = chooseLights(list, on, touched);
    // Lights of one program that share a kernel call are consecutive (WorldImpl::lightGroups_); the others are separate.
    std::vector<std::vector<int>>& grouped = ofGroup_; // indices in the list
    grouped.resize(world_.lightGroups_.size());
    for (const int k : touched) {
        const auto& at = chosenAt_[many ? size_t(k) : 0];
        const BoundLight& light = world_.lights_[size_t(on[size_t(k)])];
        if (many && light.group >= 0) {
            grouped[size_t(light.group)].push_back(k);
            continue;
        }
        lightOf(light, at, nullptr, sched);
        if (many) chosenAt_[size_t(k)].clear();
    }
    for (size_t g = 0; many && g < grouped.size(); ++g) {
        const BoundKernel* const kernel = &world_.lightGroups_[g].kernel;
        for (int k : grouped[g]) {
            lightOf(world_.lights_[size_t(on[size_t(k)])], chosenAt_[size_t(k)], kernel, sched);
            chosenAt_[size_t(k)].clear();
        }
        askWanted(kernel, sched);
        grouped[g].clear();
    }
    if (!many) guidedSkies(list, sched);
    if (!many) chosenAt_[0].clear();
}

/// Samples skies that only their guide samples, at all points of chosenAt_.
void LightSampling::guidedSkies(const WorldImpl::LightList& list, Sched& sched) {
    if (!rules_.pickOne || c_->between) return;
    for (const int number : world_.skies_) {
        const BoundLight& light = world_.lights_[size_t(number)];
        if (light.guidable && guideOf(world_, light) && list.lights.contains(number))
            lightOf(light, chosenAt_[0], nullptr, sched);
    }
}

/// Appends the points that sample a light, and draws the random numbers of kSamplesAtOnce samples from `first` on. Returns the
/// largest number of samples at a point.
int LightSampling::want(const BoundLight& light, std::span<const std::pair<int, float>> chosen, int first) {
    int most = 0;
    if (wanted_.empty()) numbers_.clear();
    const uint32_t use = kLightPoint + uint32_t(&light - world_.lights_.data());
    for (const auto& [point, chance] : chosen) {
        int count = 0;
        for (int i : lobesOf(size_t(point)))
            if (const LobeVertex& l = requests_.lobes[size_t(i)]; samples(l, light)) count = std::max(count, lightSamples(l));
        most = std::max(most, count);
        const PathRay& ray = c_->rays[size_t(point)];
        for (int k = first; k < std::min(count, first + kSamplesAtOnce); ++k) {
            wanted_.push_back({&light, point, chance, {k, count}});
            const Random random = store_.random(ray).draw(uint32_t(k), uint32_t(count));
            const uint32_t vertex = light.kind == LightKind::Area || light.isSky() ? lightVertex(size_t(point)) : ray.vertex;
            if (takesPair(light, rules_.pickOne)) numbers_.askPair(random.numbers(), vertex, use, 0);
            if (takesChoice(light)) numbers_.askOne(random.numbers(), vertex, use, 0);
        }
    }
    return most;
}

/// Makes queries of the entries of wanted_.
void LightSampling::placeWanted() {
    numbers_.draw();
    size_t number = 0;
    const BoundLight* last = nullptr;
    bool wide =
        false; // a light that filters over its surface is asked once for every width of the lobes at a point, at the same sample
    for (const auto& [of, point, chance, draw] : wanted_) {
        const BoundLight& light = *of;
        if (of != std::exchange(last, of)) wide = isWide(light);
        const ShadePoint& lit = c_->points[size_t(point)];
        ShadePoint& p = queries.add(point, light, chance, draw);
        tellLit(p, lit);
        if (!place(p, queries.drawn.back(), light, number)) {
            queries.dropLast();
        } else if (wide) {
            queriesByWidth(size_t(point), light);
        }
    }
    wanted_.clear();
}

/// Chooses the point on the light; returns false if the sample carries no light. `number`: next index in numbers_.
bool LightSampling::place(ShadePoint& p, Emitter::Sample& s, const BoundLight& light, size_t& number) const {
    LightNumbers u;
    if (takesPair(light, rules_.pickOne)) u.pair = numbers_.pair(number++);
    if (takesChoice(light)) u.choose = numbers_.one(number++);
    return placeLightSample(world_, light, c_->between || !rules_.pickOne ? nullptr : guideOf(world_, light), u, rules_.pickOne,
                            p, s);
}

/// Splits the last query by the widths with which lobes of its point see the emitter.
void LightSampling::queriesByWidth(size_t point, const BoundLight& light) {
    LightQueries& q = queries;
    const size_t first = q.count - 1;
    bool used = false;
    for (int i : lobesOf(point)) {
        const LobeVertex& l = requests_.lobes[size_t(i)];
        if (!samples(l, light)) continue;
        const float s = spreadBehind(c_->rays[point], requests_.rows.spread(l.place));
        if (used && std::find(q.spread.begin() + long(first), q.spread.end(), s) != q.spread.end()) continue;
        if (std::exchange(used, true)) {
            const Emitter::Sample drawn = q.drawn.back();
            const ShadePoint same = q.at[q.count - 1];
            q.add(int(point), light, q.chance.back(), q.draw.back()) = same;
            q.drawn.back() = drawn;
        }
        q.spread.back() = s;
        setEmitterFootprint(q.at[q.count - 1], c_->rays[point], c_->points[point].P, s);
    }
}

/// Runs the kernel of the queries' light, or of the group with kernel `shared`.
void LightSampling::askLights(const BoundKernel* shared) {
    LightQueries& q = queries;
    if (q.count == 0) return;
    const BoundLight& light = *q.light[0];
    q.at.resize(q.count);
    q.value.assign(q.count, {});
    LightCall call;
    if (shared) {
        call.kernel = shared;
        call.of = q.light;
        return lightKernels_.evaluateLight(light, q.at, q.value, call);
    }
    LitSurface lit;
    const auto told = [&](int k) -> const LitValues& {
        return litSurfaces_.values[size_t(requests_.lobes[size_t(lobesOf(size_t(q.point[size_t(k)]))[0])].lit)];
    };
    if (light.asksSurface) {
        lit.binding = [&](int k) { return told(k).binding < 0 ? nullptr : &world_.bindings_[size_t(told(k).binding)]; };
        lit.output = [&](int k, const std::string& name, std::vector<float>& now) { return told(k).output(name, now); };
        lit.displaced = [&](int k, int& point) { return point = told(k).point, told(k).displaced.get(); };
        call.lit = &lit;
    }
    std::vector<char> inMedium;
    if (!world_.media_.empty() && light.kind == LightKind::Area) {
        for (size_t k = 0; k < q.count; ++k)
            inMedium.push_back(MediaStacks::mediumOf(media_.towards(*c_, q.point[k], q.drawn[k].direction)) >= 0);
        call.inMedium = &inMedium;
    }
    const bool sends = light.sentCl >= 0; // many samples: one of them
    const size_t width = size_t(light.valueWidth);
    std::vector<float> values(light.channels || sends ? q.count * width : 0);
    if (light.channels || sends) call.values = &values;
    lightKernels_.evaluateLight(light, q.at, q.value, call);
    for (size_t k = 0; k < q.count && sends; ++k) {
        const uint32_t use = kLightPoint + uint32_t(&light - world_.lights_.data());
        const Random random = store_.random(c_->rays[size_t(q.point[k])]).draw(uint32_t(q.draw[k].nth), uint32_t(q.draw[k].of));
        const float u = random.one(lightVertex(size_t(q.point[k])), use, 0);
        Services::chooseSent(light, u, values.data() + k * width, q.value[k]);
    }
    for (size_t k = 0; k < q.count && light.channels; ++k)
        if (k == 0 || q.point[k] != q.point[k - 1]) // for several widths, the first
            inputs_.answers.keepChannels(*c_, light, q.point[k], values.data() + k * width);
}

} // namespace alpenglow::integrator
