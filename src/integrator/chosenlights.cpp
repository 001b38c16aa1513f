#include "integrator/chosenlights.h"
#include "base/direction.h"
#include "integrator/accumulator.h"
#include "integrator/batchpool.h"
#include "integrator/connection.h"
#include "integrator/kernelinputs.h"
#include "integrator/lightkernels.h"
#include "integrator/lightpathstates.h"
#include "integrator/lightsample.h"
#include "integrator/medium.h"
#include "integrator/photongather.h"
#include "integrator/shadowrays.h"
#include "integrator/surfacepoints.h"
#include "world/emitterfootprint.h"
#include <algorithm>
#include <bit>

namespace alpenglow::integrator {

LightSampling::ChosenLights::ChosenLights(LightSampling& of, const StageSet& s, const VertexStages& v)
    : VertexStage(s, v), lightSampling_(of), chosenHere_(size_t(kBlock) * LightTree::kMostChosen) {
    for (const WorldImpl::LightGroup& g : world_.lightGroups())
        for (int k = 0; k < 4; ++k) all_.push_back({&g.kernel, (k & 1) != 0, {}});
    for (const BoundLight& l : world_.lights()) {
        wide_.push_back(isWide(l));
        together_.push_back(togetherOf(l));
        origins_.push_back(l.instance ? originOfLight(*l.instance, 0) : Vec3()); // none: the shader was rejected
    }
}

/// Index of the lights that share a kernel, all of them with a density or without, and sampled in rows or not.
int LightSampling::ChosenLights::togetherOf(const BoundLight& l) const {
    if (l.group < 0) return -1;
    const bool rows = !isWide(l) && lightSampling_.inRows(l, world_.lightGroups()[size_t(l.group)].kernel);
    return 4 * l.group + 2 * int(l.hasDensity()) + int(rows);
}

void LightSampling::ChosenLights::light(const WorldImpl::LightList& list, BatchContext& c, Sched& sched) {
    const std::vector<int>& on = world_.sampledOf(list);
    for (Together& t : all_) t.asked.clear(); // of a call that ended early
    choose(list);
    for (size_t k = 0; k < on.size(); ++k) {
        const int number = on[k];
        if (begin_[k] == begin_[k + 1] || (list.ofAll && !list.lights.contains(number))) continue;
        if (!world_.lights()[size_t(number)].importance) continue; // only rays find it
        const auto asked = std::span(sorted_).subspan(begin_[k], begin_[k + 1] - begin_[k]);
        if (together_[size_t(number)] < 0) {
            ask(nullptr, false, asked, c, sched);
            continue;
        }
        std::vector<Asked>& of = all_[size_t(together_[size_t(number)])].asked;
        of.insert(of.end(), asked.begin(), asked.end());
    }
    for (Together& t : all_) {
        constexpr size_t kMost = kAtOnce * kBlock;
        for (size_t first = 0; first < t.asked.size(); first += kMost) {
            const auto some = std::span(t.asked).subspan(first, std::min(kMost, t.asked.size() - first));
            ask(t.kernel, t.rows, some, c, sched);
        }
        t.asked.clear();
    }
}

/// Samples lights, as often as the points want. group: the kernel that they share; null: a single light.
void LightSampling::ChosenLights::ask(const BoundKernel* group, bool rows, std::span<const Asked> asked, BatchContext& c,
                                      Sched& sched) {
    for (v_.draw = 0; !asked.empty(); ++v_.draw) {
        v_.checksHits = lightSampling_.checksHits(world_.lights()[size_t(asked[0].light)]);
        if (rows && !v_.checksHits) askInRows(*group, asked, c);
        else askByPoints(group, asked, c);
        if (lightSampling_.shadows_.queue.size() > kShadowsAtOnce) lightSampling_.shadows_.flush(sched);
        if (!v_.several) break;
        std::vector<Asked> again;
        for (const Asked& a : asked)
            if (v_.draw + 1 < uint32_t(lightSampling_.drawsOf(world_.lights()[size_t(a.light)], size_t(a.point))))
                again.push_back(a);
        again_.swap(again);
        asked = again_;
    }
    v_.draw = 0;
}

/// Chooses the lights of each point, as indices in the list.
void LightSampling::ChosenLights::choose(const WorldImpl::LightList& list) {
    v_.drawNumbers(kChooseLight << 1 | SampleNumbers::kSingle, v_.choices);
    chosen_.clear();
    const std::vector<int>& on = world_.sampledOf(list);
    begin_.assign(on.size() + 1, 0);
    const LightTree first = world_.chooserAt(list, 0).tree(), deeper = world_.chooserAt(list, 1).tree();
    for (size_t b = 0; b < v_.blocks; ++b) {
        const VertexBlock& v = v_.vertices[b];
        Lanes begins = 0;
        for (int i = 0; i < kBlock; ++i) begins |= Lanes(v.bounces[i] == 0) << i;
        for (const auto& [tree, lanes] : {std::pair(&first, v_.lit[b] & begins), std::pair(&deeper, v_.lit[b] & ~begins)}) {
            if (!lanes) continue;
            const int n = stages_.chooseLights(*tree, v.P, v_.choices[b].x, lanes, chosenHere_.data());
            for (const ChosenLight& l : std::span(chosenHere_).first(size_t(n))) {
                chosen_.push_back({l.light, int(b) * kBlock + l.lane, l.chance});
                ++begin_[size_t(l.light)];
            }
        }
    }
    size_t sum = 0;
    for (size_t& n : begin_) sum += std::exchange(n, sum);
    sorted_.resize(chosen_.size());
    for (const Asked& a : chosen_) sorted_[begin_[size_t(a.light)]++] = {on[size_t(a.light)], a.point, a.chance};
    for (size_t k = begin_.size() - 1; k > 0; --k) begin_[k] = begin_[k - 1];
    begin_[0] = 0;
}

void LightSampling::ChosenLights::askInRows(const BoundKernel& kernel, std::span<const Asked> asked, BatchContext& c) {
    gatherPoints(asked);
    placeLights();
    auto call = lightSampling_.batches_.take();
    const shading::Batch& answers = run(kernel, asked, *call);
    v_.values.clear();
    for (size_t k = 0; k < count_; ++k) {
        takeLight(k, answers, c);
        if (blocks_[k].lights.asked) connect(blocks_[k], c);
    }
    lightSampling_.batches_.giveBack(std::move(call));
}

/// The same where light samples need points. group: the kernel that the lights share; null: a single light. Lights that filter
/// over their surface are asked for one call site after the other: their lobes differ in width.
void LightSampling::ChosenLights::askByPoints(const BoundKernel* group, std::span<const Asked> asked, BatchContext& c) {
    gatherPoints(asked);
    drawNumbers();
    lightSampling_.surfaces_.pointsOfRows(c);
    if (std::none_of(asked.begin(), asked.end(), [&](const Asked& a) { return wide_[size_t(a.light)] != 0; }))
        return askOnce(group, c);
    for (size_t k = 0; k < v_.count; ++k) {
        v_.onlySite = int(k);
        askOnce(group, c);
    }
    v_.onlySite = -1;
}

void LightSampling::ChosenLights::askOnce(const BoundKernel* group, BatchContext& c) {
    placeQueries(c);
    if (of_.empty()) return;
    std::vector<const BoundLight*> lights;
    for (const auto& [k, lane] : of_) lights.push_back(&world_.lights()[size_t(blocks_[k].asked[lane]->light)]);
    lightSampling_.askQueries(*lights[0], group, lights, c);
    for (size_t n = 0; n < of_.size(); ++n) {
        const auto& [k, lane] = of_[n];
        Questions& q = blocks_[k];
        const LightValue& v = v_.values[n];
        if (v.lit && !isFinite(v.Cl)) {
            lightSampling_.accumulator_.notFinite(&c.rays[size_t(q.asked[lane]->point)], "Cl", lights[n]->instance.get());
        } else if (v.lit && v.Cl != Color(0)) {
            lightSampling_.takeValue(q.lights, lane, *lights[n], v, v_.queries[n], v_.asked[n].sample);
            q.lights.density[lane] *= q.asked[lane]->chance;
            q.says[lane] = int32_t(n);
        }
    }
    for (size_t k = 0; k < count_; ++k)
        if (blocks_[k].lights.asked) connect(blocks_[k], c);
}

/// Makes points on the lights one by one: VertexBlocks::queries and asked.
void LightSampling::ChosenLights::placeQueries(const BatchContext& c) {
    std::vector<ShadePoint>& queries = v_.queries;
    std::vector<BlockQuery>& asked = v_.asked;
    const Site* const only = v_.onlySite < 0 ? nullptr : &v_.sites[size_t(v_.onlySite)];
    asked.clear();
    of_.clear();
    for (size_t k = 0; k < count_; ++k) {
        Questions& q = blocks_[k];
        const BoundLight& first = world_.lights()[size_t(q.asked[0]->light)];
        q.lights.emitter = first.kind == LightKind::Area;
        q.lights.met = first.hasDensity();
        q.lights.asked = q.lights.metDiffuse = q.lights.metSpecular = 0;
        for (Lanes left = q.there; left; left &= left - 1) {
            const int lane = std::countr_zero(left);
            const size_t point = size_t(q.asked[lane]->point);
            const BoundLight& light = world_.lights()[size_t(q.asked[lane]->light)];
            if (only &&
                !(lightSampling_.lightsAt(*only, light, point) && v_.draw < uint32_t(lightSampling_.drawsOf(*only, point))))
                continue;
            const LightNumbers u{{pairs_[k].x[lane], pairs_[k].y[lane]}, choices_.empty() ? 0 : choices_[k].x[lane]};
            if (asked.size() == queries.size()) queries.emplace_back(); // earlier queries are overwritten
            ShadePoint& at = queries[asked.size()];
            BlockQuery& a = asked.emplace_back();
            a.point = int(point);
            if (!lightSampling_.placeQuery(light, nullptr, u, c.points[point], at, a.sample)) {
                asked.pop_back();
                continue;
            }
            of_.emplace_back(k, lane);
            if (only && light.kind == LightKind::Area)
                setEmitterFootprint(at, c.rays[point], c.points[point].P,
                                    spreadBehind(c.rays[point], only->lobes[point / kBlock].lobe[kRowSpread][point % kBlock]));
        }
    }
    queries.resize(asked.size());
}

/// Copies the points of the light samples into rows; the last one repeats if a block is not full.
void LightSampling::ChosenLights::gatherPoints(std::span<const Asked> asked) {
    count_ = (asked.size() + kBlock - 1) / kBlock;
    blocks_.resize(std::max(blocks_.size(), count_));
    pairs_.resize(count_);
    for (size_t k = 0; k < count_; ++k) {
        Questions& q = blocks_[k];
        const size_t first = k * kBlock, n = std::min(asked.size() - first, size_t(kBlock));
        q.there = n == size_t(kBlock) ? 0xffffu : (1u << n) - 1;
        q.lights.asked = q.lights.metDiffuse = q.lights.metSpecular = 0;
        std::fill_n(q.says, kBlock, -1);
        VertexBlock& to = q.points;
        NumberBlock& numbers = pairs_[k];
        for (size_t i = 0; i < size_t(kBlock); ++i) {
            const Asked& a = asked[first + std::min(i, n - 1)];
            q.asked[i] = &a;
            const VertexBlock& v = v_.vertices[size_t(a.point / kBlock)];
            const size_t at = size_t(a.point % kBlock);
            for (int r = 0; r < 3; ++r) {
                to.P[r][i] = v.P[r][at];
                to.n[r][i] = v.n[r][at];
                to.weight[r][i] = v.weight[r][at];
            }
            to.error[i] = v.error[at];
            to.bias[i] = v.bias[at];
            numbers.low[i] = v.low[at];
            numbers.high[i] = v.high[at];
            numbers.index[i] = v.index[at];
            const BoundLight& light = world_.lights()[size_t(a.light)];
            if (v_.several)
                lightSampling_.nameDraw(v_.rays[size_t(a.point / kBlock)], int(at),
                                        uint32_t(lightSampling_.drawsOf(light, size_t(a.point))), numbers, int(i));
            const bool placed = light.kind == LightKind::Area || light.isSky();
            numbers.vertex[i] = placed ? v.lightVertex[at] : v.vertex[at];
            numbers.stream[i] = (kLightPoint + uint32_t(a.light)) << 1;
            numbers.occurrence[i] = 0;
        }
    }
}

/// Makes points on the lights: P and N of LightRows, and samples of emitters.
void LightSampling::ChosenLights::placeLights() {
    const size_t n = count_ * kBlock;
    lamp_.resize(9 * n);
    const bool emitters = world_.lights()[size_t(blocks_[0].asked[0]->light)].kind == LightKind::Area;
    if (emitters) drawNumbers();
    for (size_t k = 0; k < count_; ++k) {
        Questions& q = blocks_[k];
        q.lights.emitter = q.lights.met = emitters;
        for (size_t r = 0; r < 3; ++r) std::copy_n(q.points.P[r], kBlock, lamp_.data() + (6 + r) * n + k * kBlock);
        if (emitters) {
            placeOnEmitters(k);
            continue;
        }
        for (size_t i = 0; i < size_t(kBlock); ++i) {
            const Vec3& origin = origins_[size_t(q.asked[i]->light)];
            for (size_t r = 0; r < 3; ++r) {
                lamp_[r * n + k * kBlock + i] = origin[int(r)];
                lamp_[(3 + r) * n + k * kBlock + i] = 0;
            }
        }
    }
}

void LightSampling::ChosenLights::drawNumbers() {
    bool choices = false;
    for (size_t k = 0; k < count_; ++k)
        for (const Asked* a : blocks_[k].asked) choices |= takesChoice(world_.lights()[size_t(a->light)]);
    if (choices) {
        choices_ = pairs_;
        for (NumberBlock& n : choices_)
            for (uint32_t& stream : n.stream) stream |= SampleNumbers::kSingle;
        drawBlocks(choices_);
    } else {
        choices_.clear();
    }
    drawBlocks(pairs_);
}

void LightSampling::ChosenLights::placeOnEmitters(size_t k) {
    Questions& q = blocks_[k];
    alignas(64) double share[kBlock];
    for (size_t i = 0; i < size_t(kBlock); ++i) {
        const Emitter& e = *world_.lights()[size_t(q.asked[i]->light)].emitter;
        const float choose = e.flat().size() > 1 ? choices_[k].x[i] : 0;
        const size_t shape = e.flatFrom({q.points.P[0][i], q.points.P[1][i], q.points.P[2][i]}, choose, share[i]);
        q.lamp[i] = &e.flat()[shape];
        q.visibility[i] = e.flatVisibility(shape);
    }
    const size_t n = count_ * kBlock;
    float* P = lamp_.data() + k * kBlock;
    q.there &= stages_.placeEach(q.points, q.lamp, pairs_[k].x, pairs_[k].y, share, q.lights, P, P + 3 * n, int(n));
}

/// Runs the kernel over the light samples, each with the parameters of its light.
const shading::Batch& LightSampling::ChosenLights::run(const BoundKernel& kernel, std::span<const Asked> asked,
                                                       BatchContext& call) {
    const size_t n = count_ * kBlock;
    views_.clear();
    viewOf_.resize(n);
    for (size_t i = 0; i < n; ++i) {
        if (i >= asked.size()) {
            viewOf_[i] = viewOf_[i - 1];
            continue;
        }
        if (i == 0 || asked[i].light != asked[i - 1].light) {
            const BoundLight& l = world_.lights()[size_t(asked[i].light)];
            views_.push_back(l.instance->view());
            views_.back().rows = l.rows.get();
        }
        viewOf_[i] = uint32_t(views_.size() - 1);
    }
    call.bound = &kernel;
    call.lit = nullptr;
    call.light = &world_.lights()[size_t(asked[0].light)];
    call.ownShadows.clear();
    if (!call.batch) call.batch = std::make_shared<shading::Batch>();
    const std::span<const float> rows(lamp_);
    call.batch->assign(kernel.kernel, *kernel.plan, {rows.first(3 * n), rows.subspan(3 * n, 3 * n), rows.subspan(6 * n, 3 * n)},
                       views_, viewOf_);
    lightSampling_.inputs_.bind(call.batch->call(), call);
    kernel.kernel->run(&call.batch->call());
    call.ran();
    return *call.batch;
}

/// Reads the radiance of the lights from the outputs of their kernel.
void LightSampling::ChosenLights::takeLight(size_t k, const shading::Batch& from, const BatchContext& c) {
    Questions& q = blocks_[k];
    LightBlock& l = q.lights;
    const BoundLight& first = world_.lights()[size_t(q.asked[0]->light)]; // outputs have the same indices in all of them
    const size_t at = k * kBlock;
    const auto row = [&](int output, int component) { return from.row(output, component).data() + at; };
    const auto kept = [&](int output, Row& to) {
        for (int i = 0; i < kBlock; ++i) to[i] = std::max(0.f, 1 - (output < 0 ? 0 : row(output, 0)[i]));
    };
    for (int r = 0; r < 3; ++r) std::copy_n(row(first.outCl, r), kBlock, l.Cl[r]);
    kept(first.nonDiffuse, l.keptDiffuse);
    kept(first.nonSpecular, l.keptSpecular);
    if (!l.emitter) lightSampling_.placeFar(first, from, at, l);
    for (Lanes left = q.there; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        const BoundLight& light = world_.lights()[size_t(q.asked[i]->light)];
        const Vec3 L = light.outL < 0 ? Vec3() : Vec3(row(light.outL, 0)[i], row(light.outL, 1)[i], row(light.outL, 2)[i]);
        Color Cl{l.Cl[0][i], l.Cl[1][i], l.Cl[2][i]};
        if (light.intensityScale > 0) { // the kernel divided by the squared distance; radiance does not
            Cl *= dot(L, L) * light.intensityScale;
            for (int r = 0; r < 3; ++r) l.Cl[r][i] = Cl[r];
        }
        if (light.outLit >= 0 && row(light.outLit, 0)[i] == 0) continue;
        if (!isFinite(Cl)) lightSampling_.accumulator_.notFinite(&c.rays[size_t(q.asked[i]->point)], "Cl", light.instance.get());
        if (!isFinite(Cl) || Cl == Color(0)) continue;
        l.asked |= 1u << i;
        if (l.emitter) {
            l.metDiffuse |= Lanes((q.visibility[i] & visibilityBit(RayType::Diffuse)) != 0) << i;
            l.metSpecular |= Lanes((q.visibility[i] & visibilityBit(RayType::Specular)) != 0) << i;
        } else {
            takeShadow(q, i, L, from, at + size_t(i));
        }
        l.density[i] *= q.asked[i]->chance;
    }
}

/// Reads the shadow parameters of a light. at: index in the batch.
void LightSampling::ChosenLights::takeShadow(Questions& q, int i, const Vec3& L, const shading::Batch& from, size_t at) {
    const BoundLight& light = world_.lights()[size_t(q.asked[i]->light)];
    LightValue v;
    if (!lightSampling_.asksShadowDisk(light, from, at, v)) return;
    v.L = L;
    q.says[i] = int32_t(v_.values.size());
    v_.values.push_back(v);
}

} // namespace alpenglow::integrator
