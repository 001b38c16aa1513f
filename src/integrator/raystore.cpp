// The kind of ray that a call requests, if it is known only at run time; storage of shared ray data.
#include "integrator/raystore.h"
#include "integrator/batchcontext.h"
#include "integrator/context.h"
#include "integrator/samples.h"
#include "integrator/stageset.h"
#include "world/raysets.h"
#include <bit>

namespace alpenglow::integrator {

RayStore::RayStore(const StageSet& s) : Stage(s.context) { noSample.numbers = SampleNumbers(Sampler(context_.seed, 0, 0), 0); }

using shading::RaySet;

const uint8_t* RayStore::shapesOf(int32_t subset, int32_t exclude, const scene::Attributes* from) {
    // If the call names no subset, the attribute of the calling shape applies.
    const auto [known, fresh] = subsetsKnown_.try_emplace({subset, exclude, from}, nullptr);
    if (!fresh) return known->second;
    std::string wanted = rsl::internedString(subset);
    if (wanted.empty() && from) wanted = attributeText(*from, "grouping:tracesubset");
    return known->second = world_.subsets().find(world_, wanted, rsl::internedString(exclude));
}

RaySet RayStore::raySetOf(const SiteInfo& s, const std::function<float(int)>& f, const geometry::Shape* from, RayType& type,
                          int32_t& label) {
    const RaySite& r = *s.rays;
    RaySet set = r.set;
    const auto id = [&](int row) { return std::bit_cast<int32_t>(f(row)); };
    const auto word = [&](int row) -> const std::string& { return rsl::internedString(id(row)); };
    type = r.rays;
    label = r.label >= 0 ? id(r.label) : s.label;
    if (r.type >= 0)
        if (const std::string& t = word(r.type); !t.empty()) type = rayTypeOf(t);
    if (r.sides >= 0)
        if (const auto sides = sidesOf(word(r.sides))) set.sides = *sides;
    if (r.mode >= 0)
        if (const auto mode = modeOf(word(r.mode))) set.mode = *mode;
    const int32_t subset = r.subset >= 0 ? id(r.subset) : r.subsetId, exclude = r.exclude >= 0 ? id(r.exclude) : r.excludeId;
    const bool ofShape = subset == 0 && from && world_.traceSubsets();
    if (r.subset >= 0 || r.exclude >= 0 || ofShape) set.only = shapesOf(subset, exclude, ofShape ? &from->attributes() : nullptr);
    return set;
}

float RayStore::levelOf(const CameraRay& c) const {
    return Random(SampleNumbers(Sampler(context_.seed, c.px, c.py), c.sample)).one(0, kLevel, 0);
}

/// Attenuates a ray by distance if its call requests it ("falloff").
void RayStore::fade(PathRay& r, float way) {
    RayExtra& x = extras_[size_t(r.extra)];
    if (!x.fade.fades()) return;
    x.whole = r.weight;
    x.kept = x.fade.at(double(x.way) + way);
    r.weight *= x.kept;
}

/// From here on rays carry light of surfaces only: emission is in their targets.
void RayStore::keepIndirect(BatchContext& c) {
    if (std::exchange(c.indirectKept, true)) return;
    for (PathRay& r : c.rays) {
        if (r.extra < 0) continue;
        RayExtra& x = extras_[size_t(r.extra)];
        if (x.indirect == 1) continue;
        if (!x.fade.fades()) x.whole = r.weight;
        r.weight *= x.indirect;
    }
}

const RayKind* RayStore::kindOf(const RayKind& k) {
    if (lastKind_ && *lastKind_ == k) return lastKind_;
    const uint64_t what = uint64_t(uint32_t(k.label)) << 32 | uint64_t(k.type) << 16 | uint64_t(k.fromTrace) << 12 |
                          uint64_t(k.set.sides) << 8 | uint64_t(k.set.mode);
    std::deque<RayKind>& known = kinds_[mix64(what ^ mix64(reinterpret_cast<uintptr_t>(k.set.only)))];
    auto found = std::find(known.begin(), known.end(), k);
    if (found == known.end()) found = known.insert(known.end(), k);
    return lastKind_ = &*found;
}

int32_t RayStore::newExtra(const RayExtra& e) {
    if (e == noExtra_) return -1;
    if (freeExtras_.empty()) {
        extras_.push_back(e);
        return int32_t(extras_.size()) - 1;
    }
    const int32_t at = freeExtras_.back();
    freeExtras_.pop_back();
    extras_[size_t(at)] = e;
    return at;
}

void RayStore::freeExtras(BatchContext& c) {
    if (!std::exchange(c.extrasOf, nullptr)) return;
    for (const PathRay& r : c.rays) freeExtra(r);
}

void RayStore::forgetExtras() {
    extras_.clear();
    freeExtras_.clear();
}

} // namespace alpenglow::integrator
