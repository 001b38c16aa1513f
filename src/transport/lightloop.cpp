// illuminance loops: which lights take their turns, and what was kept of them.
#include "transport/lightloop.h"
#include "base/category.h"
#include "transport/engine.h"
#include <bit>

namespace alpenglow::transport {

namespace {

uint64_t mixed(uint64_t h, uint64_t v) {
    h ^= v + 0x9e3779b97f4a7c15ull + (h << 6) + (h >> 2);
    return h * 0xff51afd7ed558ccdull ^ h >> 29;
}

} // namespace

std::string categoriesOf(const BoundLight& l) {
    if (!l.instance) return "";
    auto i = l.instance->parameters.strings.find("__category");
    return i == l.instance->parameters.strings.end() ? "" : i->second;
}

std::string sentStrings(const SiteInfo& s) {
    std::string key;
    for (const auto& [name, value] : s.text)
        if (name.rfind("send:light:", 0) == 0) key += name.substr(11) + '\1' + value + '\2';
    return key;
}

bool sampledAnew(const BoundLight& l, bool path) {
    return l.kind == LightKind::Area || l.sentCl >= 0 || (path && (l.cone || l.kind == LightKind::Environment));
}

// Room for limits::kLightTurns turns and more.
static constexpr int kTurnBits = 12;

uint32_t drawOf(const LightLoop& loop, int turn) {
    return uint32_t(turn) + 1 + (uint32_t(std::max(loop.depth - 1, 0)) << kTurnBits); // 0 is gather()'s
}

uint64_t keptName(const LightLoop& loop, const BoundLight& l, int light, int turn, bool path) {
    const uint64_t name = uint64_t(light) << kTurnBits | uint64_t(turn);
    return sampledAnew(l, path) && loop.depth > 1 ? name | uint64_t(loop.depth - 1) << 48 : name;
}

LightLoop& Engine::lightLoop(BatchContext& c, int first, int lanes) {
    // Strips that never wait run one after the other: they share one.
    const size_t at = c.bound->kernel->facts().suspends ? size_t(first / std::max(lanes, 1)) : 0;
    while (c.loops.size() <= at) c.loops.emplace_back();
    LightLoop& loop = c.loops[at];
    if (loop.first != first) loop.reset(first);
    return loop;
}

void Engine::lightSetup(BatchContext& c, int site, int first, uint64_t mask, int lanes, const float* in) {
    LightLoop& loop = lightLoop(c, first, lanes);
    const SiteInfo& s = c.bound->sites[size_t(site)];
    size_t rows = 0;
    for (rsl::ir::Kind k : s.site->argKinds) rows += size_t(rsl::ir::components(k));
    LightSetup& next = loop.next;
    next.setup = site;
    next.given.assign(in, in + rows * size_t(lanes));
    // The category is no matter of the lights: what was kept stays good under another.
    next.givenHash.assign(size_t(lanes), 0);
    for (const auto& [name, row] : s.named) {
        if (name == "category") continue;
        const auto following = std::min_element(s.named.begin(), s.named.end(), [row = row](const auto& a, const auto& b) {
            return (a.second > row ? a.second : INT32_MAX) < (b.second > row ? b.second : INT32_MAX);
        });
        const size_t end = following->second > row ? size_t(following->second) : rows;
        const uint64_t salt = std::hash<std::string>{}(name);
        for (int lane = 0; lane < lanes; ++lane)
            for (size_t r = size_t(row); r < end; ++r)
                next.givenHash[size_t(lane)] = mixed(next.givenHash[size_t(lane)] ^ salt, std::bit_cast<uint32_t>(in[r * size_t(lanes) + size_t(lane)]));
    }
    (void)mask;
}

int32_t Engine::lightBegin(BatchContext& c, int site, int first, uint64_t mask, int lanes, const float* rows) {
    LightLoop& loop = lightLoop(c, first, lanes);
    const SiteInfo& info = c.bound->sites[size_t(site)];
    // The loop around waits; when this one ends it is as it was.
    if (loop.around.size() <= size_t(loop.depth)) loop.around.emplace_back();
    loop.distance = c.lightDistance;
    std::swap(static_cast<LightTurns&>(loop), loop.around[size_t(loop.depth)]);
    ++loop.depth;
    std::swap(static_cast<LightSetup&>(loop), loop.next);
    loop.next.setup = -1;
    if (!info.text.count("__setup")) loop.setup = -1; // that of a loop of which nobody wanted the result
    loop.lights.clear();
    loop.light = -1;
    loop.rows.assign(rows, rows + size_t(7) * size_t(lanes));
    const auto cache = info.text.find("lightcache");
    loop.refresh = cache != info.text.end() && cache->second == "refresh";
    std::vector<std::string> wanted{info.site->strings.empty() ? "" : info.site->strings[0]};
    if (loop.setup >= 0) { // known only now: each point may have its own
        const SiteInfo& s = c.bound->sites[size_t(loop.setup)];
        if (auto row = s.named.find("category"); row != s.named.end()) {
            wanted.clear();
            for (int lane = 0; lane < lanes; ++lane)
                if (mask >> lane & 1) wanted.push_back(rsl::internedString(std::bit_cast<int32_t>(loop.given[size_t(row->second) * size_t(lanes) + size_t(lane)])));
            std::sort(wanted.begin(), wanted.end());
            wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
            for (const std::string& w : wanted) checkCategory(c, *info.site, w);
        }
    }
    if (c.binding)
        for (int i : c.binding->lights) {
            const BoundLight& l = world_->lights_[size_t(i)];
            if (!l.kernel || l.kind == LightKind::Ambient || l.strategy == LightStrategy::Trace) continue;
            const std::string have = categoriesOf(l);
            if (std::none_of(wanted.begin(), wanted.end(), [&](const std::string& w) { return inCategory(w, have); })) continue;
            for (int k = 0; k < l.samples; ++k) loop.lights.push_back({i, k});
        }
    return int32_t(loop.lights.size());
}

void Engine::lightEnd(BatchContext& c, int first, int lanes) {
    LightLoop& loop = lightLoop(c, first, lanes);
    if (loop.depth == 0) return;
    --loop.depth;
    std::swap(static_cast<LightTurns&>(loop), loop.around[size_t(loop.depth)]);
    c.lightDistance = loop.distance;
}

void Engine::checkCategory(BatchContext& c, const rsl::ir::Site& site, const std::string& expression) {
    const std::string error = categoryError(expression);
    if (error.empty()) return;
    const auto& files = c.bound->kernel->files();
    SourcePlace place{site.place.file < int(files.size()) ? files[size_t(site.place.file)] : "", site.place.line, site.place.column};
    diagnostics_.reportOnce("category:" + expression, {Severity::Warning, Rie::Syntax, place,
                            "the category \"" + expression + "\" cannot be read: " + error + "; all lights are taken", {}, {}});
}

uint64_t Engine::lightFetch(BatchContext& c, int index, int first, uint64_t mask, int lanes, float* out) {
    LightLoop& loop = lightLoop(c, first, lanes);
    if (size_t(index) >= loop.lights.size()) return 0;
    const auto [li, k] = loop.lights[size_t(index)];
    const BoundLight& light = world_->lights_[size_t(li)];
    loop.light = li;
    if (loop.setup >= 0) { // points whose own category leaves this light out
        const SiteInfo& s = c.bound->sites[size_t(loop.setup)];
        if (auto row = s.named.find("category"); row != s.named.end()) {
            const std::string have = categoriesOf(light);
            for (int lane = 0; lane < lanes; ++lane)
                if ((mask >> lane & 1) &&
                    !inCategory(rsl::internedString(std::bit_cast<int32_t>(loop.given[size_t(row->second) * size_t(lanes) + size_t(lane)])), have))
                    mask &= ~(uint64_t(1) << lane);
        }
    }
    // Kept: the same light, sample, P, Ns, sent values and outputs of the surface; of a sky also the same cone.
    const uint64_t name = keptName(loop, light, li, k, world_->settings_.hider == Hider::Path);
    LightLoop::Kept passing;
    const bool room = loop.kept.size() < limits::kLightCache || loop.kept.count(name);
    LightLoop::Kept& kept = room ? loop.kept[name] : passing;
    const size_t width = size_t(lanes);
    if (kept.key.empty()) {
        kept.key.assign(7 * width, 0);
        kept.hash.assign(width, 0);
        kept.out.assign(9 * width, 0);
        kept.distance.assign(width, 1e38f);
        kept.values.assign(width * size_t(light.valueWidth), 0);
    }
    const int same = light.kind == LightKind::Environment ? 7 : 3;
    uint64_t missing = 0;
    for (int lane = 0; lane < lanes; ++lane) {
        if (!(mask >> lane & 1)) continue;
        const size_t l = size_t(lane);
        const uint64_t hash = loop.setup < 0 ? 0 : mixed(loop.givenHash[l], sentKey(c, loop));
        bool good = !loop.refresh && (kept.have >> lane & 1) && kept.hash[l] == hash;
        for (size_t r = 0; good && r < size_t(same); ++r) good = std::bit_cast<uint32_t>(kept.key[r * width + l]) == std::bit_cast<uint32_t>(loop.rows[r * width + l]);
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
    c.lightDistance.assign(width, 1e38f);
    for (int lane = 0; lane < lanes; ++lane) {
        if (!((mask & kept.lit) >> lane & 1)) continue;
        const size_t l = size_t(lane);
        const float angle = loop.rows[6 * width + l];
        if (angle < float(kPi) && light.kind != LightKind::Environment) {
            Vec3 axis(loop.rows[3 * width + l], loop.rows[4 * width + l], loop.rows[5 * width + l]);
            const float most = std::max({std::fabs(axis.x), std::fabs(axis.y), std::fabs(axis.z)});
            if (most > 1e15f || (most > 0 && most < 1e-15f)) axis = axis / most; // its square must be a number
            const Vec3 toLight(kept.out[l], kept.out[width + l], kept.out[2 * width + l]);
            const float la = length(axis), ll = length(toLight);
            if (la > 0 && ll > 0 && !(dot(axis, toLight) >= la * ll * std::cos(angle))) continue;
        }
        lit |= uint64_t(1) << lane;
        c.lightDistance[l] = kept.distance[l];
        for (size_t r = 0; r < 9; ++r) out[r * width + l] = kept.out[r * width + l];
    }
    return lit;
}

uint64_t Engine::sentKey(const BatchContext& c, const LightLoop& loop) const {
    const std::string strings = sentStrings(c.bound->sites[size_t(loop.setup)]);
    return strings.empty() ? 0 : std::hash<std::string>{}(strings);
}

} // namespace alpenglow::transport
