// illuminance loops: their iterations, and caches.
#include "base/category.h"
#include "base/exact.h"
#include "rsl/front/sentlights.h"
#include "services/services.h"
#include <bit>

namespace alpenglow::services {

namespace {

uint64_t mixed(uint64_t h, uint64_t v) {
    h ^= v + 0x9e3779b97f4a7c15ull + (h << 6) + (h >> 2);
    return h * 0xff51afd7ed558ccdull ^ h >> 29;
}

} // namespace

std::string categoriesOf(const BoundLight& l) {
    if (!l.instance) return "";
    auto i = l.instance->parameters.strings.find(rsl::kCategory);
    return i == l.instance->parameters.strings.end() ? "" : i->second;
}

bool sampledAnew(const BoundLight& l, bool path) {
    return l.kind == LightKind::Area || l.sentCl >= 0 || (!path && l.shadows && l.shadowRadius >= 0) ||
           (path && (l.cone || l.kind == LightKind::Environment));
}

// Bits for limits::kLightIterations iterations and more.
static constexpr int kIterationBits = 12;

uint32_t drawOf(const LightLoop& loop) {
    return 1 + (uint32_t(std::max(loop.depth - 1, 0)) << kIterationBits);
} // 0 is gather()'s

uint64_t keptName(const LightLoop& loop, const BoundLight& l, int light, int turn, bool path) {
    const uint64_t name = uint64_t(light) << kIterationBits | uint64_t(turn);
    return sampledAnew(l, path) && loop.depth > 1 ? name | uint64_t(loop.depth - 1) << 48 : name;
}

LightLoop& Services::lightLoop(KernelRun& c, int first, int lanes) {
    // Strips that never wait run one after the other and share one.
    const size_t at = c.bound->kernel->facts().suspends ? size_t(first / std::max(lanes, 1)) : 0;
    while (c.loops.size() <= at) c.loops.emplace_back();
    LightLoop& loop = c.loops[at];
    if (loop.first != first) loop.reset(first);
    return loop;
}

void Services::lightSetup(KernelRun& c, int site, int first, int lanes, const float* in) {
    LightLoop& loop = lightLoop(c, first, lanes);
    const SiteInfo& s = c.bound->sites[size_t(site)];
    size_t rows = 0;
    for (rsl::ir::Kind k : s.site->argKinds) rows += size_t(rsl::ir::components(k));
    LightSetup& next = loop.next;
    next.setup = site;
    next.given.assign(in, in + rows * size_t(lanes));
    next.givenHash.assign(size_t(lanes), 0);
    for (const SiteInfo::Shown& shown : s.shown)
        for (int lane = 0; lane < lanes; ++lane)
            for (size_t r = size_t(shown.first); r < size_t(shown.end); ++r)
                next.givenHash[size_t(lane)] = mixed(next.givenHash[size_t(lane)] ^ shown.salt,
                                                     std::bit_cast<uint32_t>(in[r * size_t(lanes) + size_t(lane)]));
}

int32_t Services::lightBegin(KernelRun& c, int site, int first, uint64_t mask, int lanes, const float* rows) {
    LightLoop& loop = lightLoop(c, first, lanes);
    const SiteInfo& info = c.bound->sites[size_t(site)];
    // Saves the outer loop, which is restored at the end of this one.
    if (loop.around.size() <= size_t(loop.depth)) loop.around.emplace_back();
    loop.reach = c.lightReach;
    std::swap(static_cast<LightIterations&>(loop), loop.around[size_t(loop.depth)]);
    ++loop.depth;
    std::swap(static_cast<LightSetup&>(loop), loop.next);
    loop.next.setup = -1;
    if (!info.setUp) loop.setup = -1; // of a loop whose result was unused
    loop.lights.clear();
    loop.light = -1;
    loop.rows.assign(rows, rows + size_t(7) * size_t(lanes));
    loop.refresh = info.refresh;
    if (!c.binding || c.dark) return 0;
    const int row = loop.setup >= 0 ? c.bound->sites[size_t(loop.setup)].rowCategory : -1;
    if (row < 0) {
        loop.lights = turnsOf(*c.binding, info.nameId);
        return int32_t(loop.lights.size());
    }
    // Names computed at run time may vary over the points.
    std::vector<int32_t> wanted;
    for (int lane = 0; lane < lanes; ++lane)
        if (mask >> lane & 1) wanted.push_back(std::bit_cast<int32_t>(loop.given[size_t(row) * size_t(lanes) + size_t(lane)]));
    std::sort(wanted.begin(), wanted.end());
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    for (int32_t w : wanted) checkCategory(c, *info.site, w);
    for (const auto& turn : turnsOf(*c.binding, 0))
        if (std::any_of(wanted.begin(), wanted.end(), [&](int32_t w) { return isOfCategory(w, turn.first); }))
            loop.lights.push_back(turn);
    return int32_t(loop.lights.size());
}

bool Services::isOfCategory(int32_t category, int light) {
    const auto [known, fresh] = ofCategory_.try_emplace(uint64_t(uint32_t(category)) << 32 | uint32_t(light));
    if (fresh) known->second = inCategory(rsl::internedString(category), categoriesOf(world_->lights()[size_t(light)]));
    return known->second;
}

const std::vector<std::pair<int, int>>& Services::turnsOf(const SurfaceBinding& b, int32_t category) {
    TurnsOfList& known = turnsOf_[uint64_t(uint32_t(category)) << 32 | uint32_t(b.lightList)];
    if (known.lights == b.lights) return known.turns; // indices of lists are assigned while the world is built
    known.lights = b.lights;
    known.turns.clear();
    const bool samples = world_->settings().hider == Hider::Path || rsl::internedString(category) == rsl::kSampleLoop;
    world_->eachLight(b.lights, [&](int i) {
        const BoundLight& l = world_->lights()[size_t(i)];
        if (!samples && l.instance && l.instance->parameters.numbers.count(rsl::kSentOnly)) return false;
        if (l.kernel && l.kind != LightKind::Ambient && l.strategy != LightStrategy::Trace && isOfCategory(category, i))
            for (int k = 0; k < l.samples; ++k) known.turns.push_back({i, k});
        return false;
    });
    return known.turns;
}

void Services::lightEnd(KernelRun& c, int first, int lanes) {
    LightLoop& loop = lightLoop(c, first, lanes);
    if (loop.depth == 0) return;
    --loop.depth;
    std::swap(static_cast<LightIterations&>(loop), loop.around[size_t(loop.depth)]);
    c.lightReach = loop.reach;
    c.lightNow = loop.light;
    c.lightDraw = drawOf(loop);
}

void Services::checkCategory(KernelRun& c, const rsl::ir::Site& site, int32_t category) {
    if (!checkedCategories_.insert(category).second) return;
    const std::string& expression = rsl::internedString(category);
    const std::string error = categoryError(expression);
    if (error.empty()) return;
    const auto& files = c.bound->kernel->files();
    SourcePlace place{site.place.file < int(files.size()) ? files[size_t(site.place.file)] : "", site.place.line,
                      site.place.column};
    diagnostics_.reportOnce("category:" + expression,
                            {Severity::Warning,
                             Rie::Syntax,
                             place,
                             "the category \"" + expression + "\" cannot be read: " + error + "; all lights are taken",
                             {},
                             {}});
}

uint64_t Services::lightFetch(KernelRun& c, int index, int first, uint64_t mask, int lanes, float* out) {
    LightLoop& loop = lightLoop(c, first, lanes);
    if (size_t(index) >= loop.lights.size()) return 0;
    const auto [li, k] = loop.lights[size_t(index)];
    loop.light = li;
    const int row = loop.setup >= 0 ? c.bound->sites[size_t(loop.setup)].rowCategory : -1;
    if (row >= 0) // points whose category excludes this light
        for (int lane = 0; lane < lanes; ++lane)
            if ((mask >> lane & 1) &&
                !isOfCategory(std::bit_cast<int32_t>(loop.given[size_t(row) * size_t(lanes) + size_t(lane)]), li))
                mask &= ~(uint64_t(1) << lane);
    if (const LightSheet* sheet = sheetOf(c, loop, li, k, first, mask, lanes))
        return takeFromSheet(c, loop, *sheet, world_->lights()[size_t(li)], first, mask, lanes, out);
    return fetchKept(c, loop, li, k, first, mask, lanes, out);
}

namespace {
/// The cone of a loop at its points. Most loops have a uniform angle.
class LoopCone {
public:
    LoopCone(const LightLoop& loop, size_t width) : rows_(loop.rows.data()), width_(width) {}
    /// Whether the cone contains this direction.
    bool has(size_t lane, const Vec3& toLight) {
        const float angle = rows_[6 * width_ + lane];
        if (!(angle < float(kPi))) return true;
        Vec3 axis(rows_[3 * width_ + lane], rows_[4 * width_ + lane], rows_[5 * width_ + lane]);
        const float most = std::max({std::fabs(axis.x), std::fabs(axis.y), std::fabs(axis.z)});
        if (most > 1e15f || (most > 0 && most < 1e-15f)) axis = axis / most; // keeps its square finite
        const float la = length(axis), ll = length(toLight);
        if (angle != angle_) cosine_ = float(exact::cos(angle_ = angle));
        return !(la > 0 && ll > 0) || dot(axis, toLight) >= la * ll * cosine_;
    }

private:
    const float* rows_;
    size_t width_;
    float angle_ = 0, cosine_ = 1;
};
} // namespace

uint64_t Services::takeFromSheet(KernelRun& c, LightLoop& loop, const LightSheet& sheet, const BoundLight& light, int first,
                                 uint64_t mask, int lanes, float* out) {
    const size_t width = size_t(lanes), size = size_t(sheet.size), from = size_t(first);
    const size_t most = std::min(width, size - std::min(size, from));
    if (const size_t values = size_t(light.valueWidth)) {
        loop.values.assign(width * values, 0);
        std::copy_n(sheet.values.begin() + long(from * values), most * values, loop.values.begin());
    }
    c.lightReach.assign(width, {});
    c.lightDraw = drawOf(loop);
    c.lightNow = int(&light - world_->lights().data());
    LoopCone cone(loop, width);
    uint64_t lit = 0;
    for (size_t lane = 0; lane < most; ++lane) {
        const auto at = [&](size_t r) { return sheet.out[r * size + from + lane]; };
        if (!(mask >> lane & 1) || !sheet.lit[from + lane] || !cone.has(lane, {at(0), at(1), at(2)})) continue;
        lit |= uint64_t(1) << lane;
        c.lightReach[lane] = sheet.reach[from + lane];
    }
    for (size_t r = 0; r < 9; ++r)
        for (size_t lane = 0; lane < most; ++lane)
            if (lit >> lane & 1) out[r * width + lane] = sheet.out[r * size + from + lane];
    return lit;
}

uint64_t Services::fetchKept(KernelRun& c, LightLoop& loop, int li, int k, int first, uint64_t mask, int lanes, float* out) {
    const BoundLight& light = world_->lights()[size_t(li)];
    // Cache key: light, sample, P, Ns, sent values and outputs of the surface; for a sky also the cone.
    const uint64_t name = keptName(loop, light, li, k, world_->settings().hider == Hider::Path);
    LightLoop::Kept passing;
    const bool room = loop.kept.size() < limits::kLightCache || loop.kept.count(name);
    LightLoop::Kept& kept = room ? loop.kept[name] : passing;
    const size_t width = size_t(lanes);
    if (kept.key.empty()) {
        kept.key.assign(7 * width, 0);
        kept.hash.assign(width, 0);
        kept.out.assign(9 * width, 0);
        kept.reach.assign(width, {});
        kept.values.assign(width * size_t(light.valueWidth), 0);
    }
    const int same = light.kind == LightKind::Environment ? 7 : 3;
    uint64_t missing = 0;
    const uint64_t sent = loop.setup < 0 ? 0 : c.bound->sites[size_t(loop.setup)].sentHash;
    for (int lane = 0; lane < lanes; ++lane) {
        if (!(mask >> lane & 1)) continue;
        const size_t l = size_t(lane);
        const uint64_t hash = loop.setup < 0 ? 0 : mixed(loop.givenHash[l], sent);
        bool good = !loop.refresh && (kept.have >> lane & 1) && kept.hash[l] == hash;
        for (size_t r = 0; good && r < size_t(same); ++r)
            good = std::bit_cast<uint32_t>(kept.key[r * width + l]) == std::bit_cast<uint32_t>(loop.rows[r * width + l]);
        if (good) continue;
        missing |= uint64_t(1) << lane;
        kept.hash[l] = hash;
        for (size_t r = 0; r < 7; ++r) kept.key[r * width + l] = loop.rows[r * width + l];
    }
    if (missing) {
        kept.have |= missing;
        kept.lit = (kept.lit & ~missing) | sampleLight(c, loop, li, k, light.samples, first, missing, lanes, kept);
    }
    loop.values = kept.values;
    uint64_t lit = 0;
    c.lightReach.assign(width, {});
    c.lightDraw = drawOf(loop);
    c.lightNow = li;
    LoopCone cone(loop, width);
    for (int lane = 0; lane < lanes; ++lane) {
        if (!((mask & kept.lit) >> lane & 1)) continue;
        const size_t l = size_t(lane);
        if (light.kind != LightKind::Environment && !cone.has(l, {kept.out[l], kept.out[width + l], kept.out[2 * width + l]}))
            continue;
        lit |= uint64_t(1) << lane;
        c.lightReach[l] = kept.reach[l];
        for (size_t r = 0; r < 9; ++r) out[r * width + l] = kept.out[r * width + l];
    }
    return lit;
}

} // namespace alpenglow::services
