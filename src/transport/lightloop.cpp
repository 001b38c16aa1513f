// illuminance loops: which lights, their samples, what was kept of them; and lights that a shader calls by their handles.
#include "transport/lightloop.h"
#include "base/category.h"
#include "transport/engine.h"
#include "transport/sampling.h"
#include <bit>
#include <charconv>

namespace alpenglow::transport {

namespace {

std::string categoriesOf(const BoundLight& l) {
    if (!l.instance) return "";
    auto i = l.instance->parameters.strings.find("__category");
    return i == l.instance->parameters.strings.end() ? "" : i->second;
}

uint64_t mixed(uint64_t h, uint64_t v) {
    h ^= v + 0x9e3779b97f4a7c15ull + (h << 6) + (h >> 2);
    return h * 0xff51afd7ed558ccdull ^ h >> 29;
}

constexpr char kHandle[] = "light#"; // before the number of a light, in the handles that getlights() gives

} // namespace

std::string sentStrings(const SiteInfo& s) {
    std::string key;
    for (const auto& [name, value] : s.text)
        if (name.rfind("send:light:", 0) == 0) key += name.substr(11) + '\1' + value + '\2';
    return key;
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
    loop.setup = site;
    loop.fresh = true;
    loop.given.assign(in, in + rows * size_t(lanes));
    // The category is no matter of the lights: what was kept stays good under another.
    loop.givenHash.assign(size_t(lanes), 0);
    for (const auto& [name, row] : s.named) {
        if (name == "category") continue;
        const auto next = std::min_element(s.named.begin(), s.named.end(), [row = row](const auto& a, const auto& b) {
            return (a.second > row ? a.second : INT32_MAX) < (b.second > row ? b.second : INT32_MAX);
        });
        const size_t end = next->second > row ? size_t(next->second) : rows;
        const uint64_t salt = std::hash<std::string>{}(name);
        for (int lane = 0; lane < lanes; ++lane)
            for (size_t r = size_t(row); r < end; ++r)
                loop.givenHash[size_t(lane)] = mixed(loop.givenHash[size_t(lane)] ^ salt, std::bit_cast<uint32_t>(in[r * size_t(lanes) + size_t(lane)]));
    }
    (void)mask;
}

int32_t Engine::lightBegin(BatchContext& c, int site, int first, uint64_t mask, int lanes, const float* rows) {
    LightLoop& loop = lightLoop(c, first, lanes);
    const SiteInfo& info = c.bound->sites[size_t(site)];
    if (!loop.fresh) loop.setup = -1;
    loop.fresh = false;
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
            if (l.kind == LightKind::Environment && world_->settings_.hider != Hider::Path) continue; // a sky is a light of path
            const std::string have = categoriesOf(l);
            if (std::none_of(wanted.begin(), wanted.end(), [&](const std::string& w) { return inCategory(w, have); })) continue;
            for (int k = 0; k < l.samples; ++k) loop.lights.push_back({i, k});
        }
    return int32_t(loop.lights.size());
}

void Engine::checkCategory(BatchContext& c, const rsl::ir::Site& site, const std::string& expression) {
    const std::string error = categoryError(expression);
    if (error.empty()) return;
    const auto& files = c.bound->kernel->files();
    SourcePlace place{site.place.file < int(files.size()) ? files[size_t(site.place.file)] : "", site.place.line, site.place.column};
    diagnostics_.reportOnce("category:" + expression, {Severity::Warning, Rie::Syntax, place,
                            "the category \"" + expression + "\" cannot be read: " + error + "; all lights are taken", {}, {}});
}

LitSurface Engine::litSurface(BatchContext& c, const LightLoop& loop, const std::vector<int>& points, int first, int lanes) const {
    LitSurface lit;
    lit.binding = [this, &c, &points](int q) -> const SurfaceBinding* {
        const size_t point = size_t(points[size_t(q)]);
        return point < c.bindings.size() ? &world_->bindings_[size_t(c.bindings[point])] : c.binding;
    };
    lit.output = [&c, &loop, &points, first, lanes](int q, const std::string& name, std::vector<float>& v) {
        if (loop.setup < 0) return false;
        const SiteInfo& s = c.bound->sites[size_t(loop.setup)];
        size_t argument = 0; // the arguments are in the order of the names without texts
        for (size_t n = 0; n < s.site->names.size(); ++n) {
            if (!s.site->pairStrings[n].empty()) continue;
            if (s.site->names[n] == "surface:" + name) {
                const int row = s.named.at(s.site->names[n]);
                for (int r = 0; r < rsl::ir::components(s.site->argKinds[argument]); ++r)
                    v.push_back(loop.given[size_t(row + r) * size_t(lanes) + size_t(points[size_t(q)] - first)]);
                return true;
            }
            ++argument;
        }
        return false;
    };
    return lit;
}

void Engine::evaluateForLoop(BatchContext& c, const LightLoop& loop, int li, int first, int lanes, std::vector<ShadePoint>& q,
                             const std::vector<int>& laneOf, std::vector<LightValue>& out, std::vector<float>& values) {
    const BoundLight& light = world_->lights_[size_t(li)];
    out.assign(q.size(), {});
    values.assign(q.size() * size_t(light.valueWidth), 0);
    std::vector<int> points;
    for (int lane : laneOf) points.push_back(first + lane);
    LightCall call;
    LitSurface lit;
    call.values = &values;
    if (loop.setup < 0) {
        if (light.asksSurface) lit = litSurface(c, loop, points, first, lanes), call.lit = &lit;
        evaluateLight(light, q, out, call);
        return;
    }
    // Sent values: one run for all points that send the same.
    const SiteInfo& s = c.bound->sites[size_t(loop.setup)];
    if (const std::string strings = sentStrings(s); !strings.empty())
        if (auto v = light.variants.find(strings); v != light.variants.end()) call.kernel = &v->second;
    std::vector<std::pair<std::string, std::pair<int, int>>> sent; // parameter: first row, components
    size_t argument = 0;
    for (size_t n = 0; n < s.site->names.size(); ++n) {
        if (!s.site->pairStrings[n].empty()) continue;
        const std::string& name = s.site->names[n];
        const int size = rsl::ir::components(s.site->argKinds[argument++]);
        if (name.rfind("send:light:", 0) != 0) continue;
        auto have = light.instance->parameters.numbers.find(name.substr(11));
        if (have != light.instance->parameters.numbers.end() && int(have->second.size()) == size) sent.push_back({name.substr(11), {s.named.at(name), size}});
    }
    auto normal = s.named.find("N");
    auto given = [&](int row, int lane) { return loop.given[size_t(row) * size_t(lanes) + size_t(lane)]; };
    if (normal != s.named.end())
        for (size_t i = 0; i < q.size(); ++i)
            q[i].Ns = Vec3(given(normal->second, laneOf[i]), given(normal->second + 1, laneOf[i]), given(normal->second + 2, laneOf[i]));
    std::map<std::vector<uint32_t>, std::vector<int>> groups;
    for (size_t i = 0; i < q.size(); ++i) {
        std::vector<uint32_t> key;
        for (const auto& [name, rows] : sent)
            for (int r = 0; r < rows.second; ++r) key.push_back(std::bit_cast<uint32_t>(given(rows.first + r, laneOf[i])));
        groups[std::move(key)].push_back(int(i));
    }
    for (const auto& [key, members] : groups) {
        shading::ParameterBlock block;
        if (!sent.empty()) {
            block = light.instance->parameters;
            size_t at = 0;
            for (const auto& [name, rows] : sent)
                for (int r = 0; r < rows.second; ++r) block.numbers[name][size_t(r)] = std::bit_cast<float>(key[at++]);
            call.parameters = &block;
        }
        std::vector<ShadePoint> some;
        std::vector<int> where;
        for (int i : members) some.push_back(q[size_t(i)]), where.push_back(points[size_t(i)]);
        std::vector<LightValue> result(some.size());
        std::vector<float> resultValues(some.size() * size_t(light.valueWidth));
        call.values = &resultValues;
        if (light.asksSurface) lit = litSurface(c, loop, where, first, lanes), call.lit = &lit;
        evaluateLight(light, some, result, call);
        for (size_t k = 0; k < members.size(); ++k) {
            out[size_t(members[k])] = result[k];
            std::copy_n(resultValues.begin() + long(k) * light.valueWidth, light.valueWidth, values.begin() + long(members[k]) * light.valueWidth);
        }
    }
}

void Engine::shadowLoop(const BatchContext& c, const BoundLight& light, int first, std::span<const ShadePoint> q, std::span<const int> laneOf,
                        std::span<LightValue> v) {
    std::vector<ShadowRay> rays;
    std::vector<size_t> of;
    for (size_t i = 0; i < q.size(); ++i) {
        if (!v[i].lit || !(maxComponent(v[i].Cl) > 0)) continue;
        const ShadePoint& lit = c.points[size_t(first + laneOf[i])];
        const Vec3 to = -v[i].L;
        const float far = length(to);
        if (!(far > 0)) continue;
        const Vec3 w = to / far;
        const Vec3 o = geometry::offsetOrigin(lit.surface, w, length(q[i].Ps - lit.surface.P));
        const float distance = light.kind == LightKind::Distant ? 1e38f : light.kind == LightKind::Area ? far * (1 - 1e-4f) : far * (1 - 1e-5f);
        rays.push_back({o, w, distance, Color(1), shading::kNoTarget, lit.time, lit.ray});
        of.push_back(i);
    }
    std::vector<Color> left(rays.size());
    transmittances(rays, left);
    for (size_t k = 0; k < of.size(); ++k) v[of[k]].Cl *= left[k];
}

uint64_t Engine::sampleLight(BatchContext& c, const LightLoop& loop, int li, int turn, int turns, int first, uint64_t mask, int lanes, LightLoop::Kept& kept) {
    const BoundLight& light = world_->lights_[size_t(li)];
    auto row = [&](int r, int lane) { return loop.rows[size_t(r) * size_t(lanes) + size_t(lane)]; };
    std::vector<ShadePoint> q;
    std::vector<int> laneOf;
    std::vector<float> factor;
    uint64_t lit = 0;
    for (int lane = 0; lane < lanes; ++lane) {
        if (!(mask >> lane & 1) || first + lane >= int(c.points.size())) continue;
        ShadePoint p = c.points[size_t(first + lane)];
        const Vec3 at(row(0, lane), row(1, lane), row(2, lane));
        p.Ps = at;
        p.Ns = p.N;
        p.viewI = p.I;
        p.Ci = Color(0);
        float f = 1;
        const uint32_t use = kLightPoint + uint32_t(li), nth = uint32_t(turn) + 1; // 0 is gather()'s
        if (light.kind == LightKind::Area) {
            if (!light.emitter || !p.ray) continue;
            Random rng = random(*p.ray);
            Emitter::Sample s;
            if (!light.emitter->sample(at, rng.pair(p.ray->vertex, use, nth), light.emitter->chooses() ? rng.one(p.ray->vertex, use, nth) : 0, s, p.surface)) continue;
            p.shape = s.shape;
            p.P = p.surface.P;
            p.N = p.surface.n;
            f = 1 / (float(kPi) * s.pdf * float(turns)); // cosLight A / (pi d^2 n), design decision 4
        } else if (light.kind == LightKind::Environment) {
            // The sky from directions evenly in the cone of the loop.
            if (!p.ray) continue;
            Vec3 axis(row(3, lane), row(4, lane), row(5, lane));
            float angle = row(6, lane), la = length(axis);
            bool all = !(la > 0) || !(angle < float(kPi));
            float cap = all ? 2 : 2 * std::pow(std::sin(0.5f * std::max(angle, 0.f)), 2.f); // 1 - cos of the half angle
            if (!(cap > 0)) continue;
            Random rng = random(*p.ray);
            Vec3 w = Basis(all ? Vec3(0, 0, 1) : axis / la).toWorld(sampleCone(cap, rng.pair(p.ray->vertex, use, nth)));
            p.shape = nullptr;
            p.P = at + w;
            p.N = -w;
            f = 2 * cap / float(turns); // 1 / (pi pdf n)
        } else {
            p.shape = nullptr;
            p.P = Vec3(transformPoint(light.instance->toCurrent, {0, 0, 0}));
            if (light.cone) {
                if (p.ray && world_->settings_.hider == Hider::Path) p.Ci = coneNumbers(random(*p.ray).pair(p.ray->vertex, use, nth));
                f = 1 / float(turns);
            }
        }
        q.push_back(p);
        laneOf.push_back(lane);
        factor.push_back(f);
    }
    std::vector<LightValue> v;
    std::vector<float> values;
    evaluateForLoop(c, loop, li, first, lanes, q, laneOf, v, values);
    if (light.shadows) shadowLoop(c, light, first, q, laneOf, v);
    for (size_t i = 0; i < q.size(); ++i) {
        const size_t lane = size_t(laneOf[i]);
        std::copy_n(values.begin() + long(i) * light.valueWidth, light.valueWidth, kept.values.begin() + long(lane) * light.valueWidth);
        if (!v[i].lit) continue;
        const bool sky = light.kind == LightKind::Environment;
        const Vec3 toLight = sky ? q[i].P - q[i].Ps : -v[i].L;
        const float rows[9] = {toLight.x, toLight.y, toLight.z, v[i].Cl.x * factor[i], v[i].Cl.y * factor[i], v[i].Cl.z * factor[i], v[i].Ol.x, v[i].Ol.y, v[i].Ol.z};
        for (size_t r = 0; r < 9; ++r) kept.out[r * size_t(lanes) + lane] = rows[r];
        kept.distance[lane] = sky || light.kind == LightKind::Distant ? 1e38f : length(toLight);
        lit |= uint64_t(1) << lane;
    }
    return lit;
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
    const uint64_t name = uint64_t(li) << 12 | uint64_t(k);
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
            const Vec3 axis(loop.rows[3 * width + l], loop.rows[4 * width + l], loop.rows[5 * width + l]);
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

int Engine::lightOfHandle(const BatchContext& c, const std::string& handle) const {
    if (handle.rfind(kHandle, 0) != 0 || !c.binding) return -1;
    int n = -1;
    const char* digits = handle.c_str() + sizeof kHandle - 1;
    if (std::from_chars(digits, handle.c_str() + handle.size(), n).ec != std::errc()) return -1;
    const auto& on = c.binding->lights;
    return std::find(on.begin(), on.end(), n) == on.end() ? -1 : n;
}

void Engine::lightHandles(BatchContext& c, int site, int first, uint64_t mask, int lanes, const float* in, float* out) {
    const SiteInfo& s = c.bound->sites[size_t(site)];
    const rsl::ir::Site& d = *s.site;
    const size_t width = size_t(lanes);
    auto put = [&](size_t row, int lane, float v) { out[row * width + size_t(lane)] = v; };
    auto text = [&](int lane) {
        return d.argKinds.empty() || d.argKinds[0] != rsl::ir::Kind::String ? d.strings.empty() ? std::string() : d.strings[0]
                                                                            : rsl::internedString(std::bit_cast<int32_t>(in[lane]));
    };
    LightLoop& loop = lightLoop(c, first, lanes);
    auto each = [&](auto&& body) {
        for (int lane = 0; lane < lanes; ++lane)
            if ((mask >> lane & 1) && first + lane < int(c.points.size())) body(lane);
    };
    auto visible = [&](const BoundLight& l) { return l.kernel && (l.kind != LightKind::Environment || world_->settings_.hider == Hider::Path); };
    if (d.op == "islightcategory") {
        if (loop.light >= 0)
            each([&](int lane) {
                const std::string want = text(lane);
                checkCategory(c, d, want);
                put(0, lane, inCategory(want, categoriesOf(world_->lights_[size_t(loop.light)])) ? 1 : 0);
            });
        return;
    }
    if (d.op == "getlights") { // rows: how many, then the handles
        each([&](int lane) {
            const std::string want = text(lane);
            checkCategory(c, d, want);
            int n = 0;
            if (c.binding)
                for (int i : c.binding->lights) {
                    const BoundLight& l = world_->lights_[size_t(i)];
                    if (!visible(l) || !inCategory(want, categoriesOf(l))) continue;
                    if (n == limits::kLightHandles) {
                        diagnostics_.reportOnce("getlights", {Severity::Error, Rie::Limit, {}, "getlights() gives no more than " + std::to_string(limits::kLightHandles) +
                                                              " lights; the others are left out", {}, {}});
                        break;
                    }
                    put(size_t(++n), lane, std::bit_cast<float>(rsl::internString(kHandle + std::to_string(i))));
                }
            put(0, lane, float(n));
        });
        return;
    }
    if (d.op == "getlight") {
        each([&](int lane) {
            const std::string want = text(lane);
            if (c.binding)
                for (int i : c.binding->lights)
                    if (visible(world_->lights_[size_t(i)]) && world_->lights_[size_t(i)].handle == want) {
                        put(0, lane, std::bit_cast<float>(rsl::internString(kHandle + std::to_string(i))));
                        break;
                    }
        });
        return;
    }
    std::map<int, uint64_t> asked; // lights of the handles
    each([&](int lane) {
        if (int l = lightOfHandle(c, text(lane)); l >= 0) asked[l] |= uint64_t(1) << lane;
    });
    if (d.op == "lightparameter") { // rows: found, value
        const std::string& name = d.strings.back();
        for (auto [li, of] : asked) {
            const shading::ParameterBlock& p = world_->lights_[size_t(li)].instance->parameters;
            const auto n = p.numbers.find(name);
            const auto t = p.strings.find(name);
            const bool wantsText = d.resultKinds[1] == rsl::ir::Kind::String;
            if (wantsText ? t == p.strings.end() : n == p.numbers.end() || (int(n->second.size()) < s.resultRowCount - 1 && n->second.size() != 1)) continue;
            for (int lane = 0; lane < lanes; ++lane) {
                if (!(of >> lane & 1)) continue;
                put(0, lane, 1);
                if (wantsText) put(1, lane, std::bit_cast<float>(rsl::internString(t->second)));
                else for (int r = 0; r < s.resultRowCount - 1; ++r) put(size_t(r) + 1, lane, n->second[n->second.size() == 1 ? 0 : size_t(r)]); // a float also where a color is wanted
            }
        }
        return;
    }
    // lightcall: handle, P; rows: found, L (light to surface), Cl, Ol, place for the distance.
    c.lightDistance.assign(width, 1e38f);
    LightLoop turn;
    turn.rows.assign(7 * width, 0);
    for (int lane = 0; lane < lanes; ++lane) {
        for (size_t r = 0; r < 3; ++r) turn.rows[r * width + size_t(lane)] = in[(r + 1) * width + size_t(lane)];
        turn.rows[6 * width + size_t(lane)] = float(kPi);
    }
    for (auto [li, of] : asked) {
        LightLoop::Kept kept;
        kept.out.assign(9 * width, 0);
        kept.distance.assign(width, 1e38f);
        kept.values.assign(width * size_t(world_->lights_[size_t(li)].valueWidth), 0);
        uint64_t lit = sampleLight(c, turn, li, 0, 1, first, of, lanes, kept);
        for (int lane = 0; lane < lanes; ++lane) {
            if (!(of >> lane & 1)) continue;
            put(0, lane, 1);
            for (size_t r = 0; r < 9; ++r) put(r + 1, lane, !(lit >> lane & 1) ? r < 6 ? 0.f : 1.f : (r < 3 ? -1.f : 1.f) * kept.out[r * width + size_t(lane)]);
            c.lightDistance[size_t(lane)] = kept.distance[size_t(lane)];
        }
    }
}

} // namespace alpenglow::transport
