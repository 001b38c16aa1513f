// Lights by handle: getlight, getlights, islightcategory, handle->light(), handle->parameter.
#include "base/category.h"
#include "services/lightloop.h"
#include "services/services.h"
#include "world/lightobjects.h"
#include <bit>
#include <charconv>

namespace alpenglow::services {

int Services::numberOfLight(const SurfaceBinding* surface, int32_t handle) {
    if (!surface) return -1;
    const auto [known, fresh] = lightOfHandle_.try_emplace(handle, -1);
    if (fresh)
        if (const auto light = rsl::LightHandle::parse(rsl::internedString(handle))) known->second = light->light;
    return known->second >= 0 && surface->lights.contains(known->second) ? known->second : -1;
}

int32_t Services::handleOf(int light) {
    const auto [known, fresh] = handles_.try_emplace(light, 0);
    if (fresh) known->second = rsl::internString(rsl::LightHandle{light, world_->lights()[size_t(light)].handle}.text());
    return known->second;
}

/// A parameter, or one element or component of it: for steps[1], or lightcolor[0]. Clamps the index; -1: all.
static std::optional<ShaderValue> partValue(const ShaderInstance& light, const std::string& name, int element) {
    std::optional<ShaderValue> t = shaderParameter(light, name);
    if (element < 0 || !t) return t;
    if (!t->kind) return std::nullopt;
    if (!t->elements && *t->kind == rsl::ir::Kind::Triple) {
        t->kind = rsl::ir::Kind::Float;
        t->elements = 3;
    }
    if (!t->elements) return std::nullopt;
    const size_t at = size_t(std::min(element, t->elements - 1)), each = size_t(rsl::ir::components(*t->kind));
    if (*t->kind == rsl::ir::Kind::String && at < t->texts.size()) t->texts = {std::string(t->texts[at])};
    else if (const size_t from = at * each; from + each <= t->numbers.size())
        t->numbers = std::vector<float>(t->numbers.begin() + long(from), t->numbers.begin() + long(from + each));
    else return std::nullopt;
    t->elements = 0;
    return t;
}

/// The surface whose lights a lane refers to: for a light's own shader the lit one.
static const SurfaceBinding* litBinding(const ServiceCall& call, int lane) {
    const KernelRun& c = call.c;
    return !c.light ? c.binding : c.lit ? c.lit->binding(call.first + lane) : nullptr;
}

/// The first string of a lane, interned.
static int32_t textOf(const ServiceCall& call, int lane) {
    const auto& kinds = call.d.argKinds;
    return kinds.empty() || kinds[0] != rsl::ir::Kind::String ? call.s.nameId : std::bit_cast<int32_t>(call.in[lane]);
}

void Services::lightHandles(const ServiceCall& call) {
    const std::string& op = call.d.op;
    const LightLoop& loop = lightLoop(call.c, call.first, call.lanes);
    if (op == "islightcategory") {
        if (loop.light >= 0)
            call.each([&](int lane, const ShadePoint&) {
                const int32_t want = textOf(call, lane);
                checkCategory(call.c, call.d, want);
                call.put(0, lane, isOfCategory(want, loop.light) ? 1 : 0);
            });
        return;
    }
    if (op == "currentlight") {
        if (loop.light >= 0)
            call.each([&](int lane, const ShadePoint&) { call.put(0, lane, std::bit_cast<float>(handleOf(loop.light))); });
        return;
    }
    if (op == "getlights") return getLights(call);
    if (op == "getlight") {
        call.each([&](int lane, const ShadePoint&) {
            const std::string& want = rsl::internedString(textOf(call, lane));
            const SurfaceBinding* surface = litBinding(call, lane);
            if (!surface) return;
            world_->eachLight(surface->lights, [&](int i) {
                const BoundLight& l = world_->lights()[size_t(i)];
                const bool is = l.kernel && l.handle == want;
                if (is) call.put(0, lane, std::bit_cast<float>(handleOf(i)));
                return is;
            });
        });
        return;
    }
    LightsAsked asked;
    call.each([&](int lane, const ShadePoint&) {
        if (int l = numberOfLight(litBinding(call, lane), textOf(call, lane)); l >= 0) asked[l] |= uint64_t(1) << lane;
    });
    if (op == "lightparameter") return lightParameters(call, asked);
    if (call.c.light) return; // lights cannot run lights, which could recurse without end (the compiler reports it)
    callLights(call, asked);
}

/// Result rows: count, then the handles.
void Services::getLights(const ServiceCall& call) {
    call.each([&](int lane, const ShadePoint&) {
        const int32_t want = textOf(call, lane);
        checkCategory(call.c, call.d, want);
        int n = 0;
        if (const SurfaceBinding* surface = litBinding(call, lane))
            world_->eachLight(surface->lights, [&](int i) {
                if (!world_->lights()[size_t(i)].kernel || !isOfCategory(want, i)) return false;
                if (n == limits::kLightHandles) {
                    diagnostics_.reportOnce("getlights", {Severity::Error,
                                                          Rie::Limit,
                                                          {},
                                                          "getlights() returns at most " + std::to_string(limits::kLightHandles) +
                                                              " lights; the others are dropped",
                                                          {},
                                                          {}});
                    return true;
                }
                call.put(++n, lane, std::bit_cast<float>(handleOf(i)));
                return false;
            });
        call.put(0, lane, float(n));
    });
}

/// Result rows: found, value.
void Services::lightParameters(const ServiceCall& call, const LightsAsked& asked) {
    using rsl::ir::Kind;
    const rsl::ir::Site& d = call.d;
    const bool element = d.argKinds.back() == Kind::Float; // the index is last
    for (auto [li, of] : asked) {
        const auto answerWith = [&](const std::string& name, int part, uint64_t points) {
            std::optional<ShaderValue> t = partValue(*world_->lights()[size_t(li)].instance, name, part);
            if (!t) return;
            if (t->kind == Kind::Float && !t->elements && d.resultKinds.size() > 1 && d.resultKinds[1] == Kind::Triple) {
                t->kind = Kind::Triple; // a float also serves for a color
                t->numbers.assign(3, t->numbers.empty() ? 0.f : t->numbers[0]);
            }
            for (int lane = 0; lane < call.lanes; ++lane)
                if (points >> lane & 1) call.answer(lane, *t);
        };
        if (!d.strings.empty() && !element) {
            answerWith(d.strings.back(), -1, of);
            continue;
        }
        for (int lane = 0; lane < call.lanes; ++lane) { // a name computed at run time follows the handle
            if (!(of >> lane & 1)) continue;
            const std::string& name =
                d.strings.empty() ? rsl::internedString(std::bit_cast<int32_t>(call.at(1, lane))) : d.strings.back();
            int part = -1;
            if (const float at = element ? call.at(int(d.argKinds.size()) - 1, lane) : 0; element)
                part = at >= 1 ? int(std::min(at, float(limits::kShaderArray))) : 0;
            answerWith(name, part, uint64_t(1) << lane);
        }
    }
}

/// Arguments: handle, P. Result rows: found, L (light to surface), Cl, Ol, space for the distance.
void Services::callLights(const ServiceCall& call, const LightsAsked& asked) {
    KernelRun& c = call.c;
    const size_t width = size_t(call.lanes);
    c.lightReach.assign(width, {});
    c.lightNow = asked.size() == 1 ? int(asked.begin()->first) : -1;
    LightLoop turn;
    turn.depth = lightLoop(c, call.first, call.lanes).depth + 1; // a call counts as a loop
    c.lightDraw = drawOf(turn);
    turn.rows.assign(7 * width, 0);
    for (int lane = 0; lane < call.lanes; ++lane) {
        for (size_t r = 0; r < 3; ++r) turn.rows[r * width + size_t(lane)] = call.at(int(r) + 1, lane);
        turn.rows[6 * width + size_t(lane)] = float(kPi);
    }
    for (auto [li, of] : asked) {
        LightLoop::Kept kept;
        const uint64_t lit = callLight(call, turn, li, of, kept);
        for (int lane = 0; lane < call.lanes; ++lane) {
            if (!(of >> lane & 1)) continue;
            call.put(0, lane, 1);
            const auto row = [&](size_t r) { return (r < 3 ? -1.f : 1.f) * kept.out[r * width + size_t(lane)]; };
            for (size_t r = 0; r < 9; ++r) call.put(int(r) + 1, lane, lit >> lane & 1 ? row(r) : r < 6 ? 0.f : 1.f);
            c.lightReach[size_t(lane)] = kept.reach[size_t(lane)];
        }
    }
}

uint64_t Services::callLight(const ServiceCall& call, LightLoop& turn, int li, uint64_t of, LightLoop::Kept& kept) {
    KernelRun& c = call.c;
    const size_t width = size_t(call.lanes);
    const BoundLight& light = world_->lights()[size_t(li)];
    uint64_t lit = 0;
    std::vector<float> sum(width), weight(width);
    for (int k = 0; k < light.samples; ++k) {
        LightLoop::Kept one;
        one.out.assign(9 * width, 0);
        one.reach.assign(width, {});
        one.values.assign(width * size_t(light.valueWidth), 0);
        const uint64_t now = sampleLight(c, turn, li, k, light.samples, call.first, of, call.lanes, one);
        if (k == 0) kept = one;
        if (k == 0 && light.sentCl >= 0) {
            LightLoop::Kept& ran = turn.kept[keptName(turn, light, li, 0, world_->settings().hider == Hider::Path)];
            ran = one;
            ran.have = of;
        }
        lit |= now;
        if (light.samples == 1) break;
        // One sample, chosen in proportion to its light, represents the sum of all.
        for (int lane = 0; lane < call.lanes; ++lane) {
            if (!(now >> lane & 1)) continue;
            const size_t at = size_t(lane);
            const float w = maxComponent(Color(one.out[3 * width + at], one.out[4 * width + at], one.out[5 * width + at]));
            if (!(w > 0) || !std::isfinite(w)) continue;
            const ShadePoint& p = c.points[size_t(call.first + lane)];
            sum[at] += w;
            const uint32_t vertex = p.ray ? childVertex(p.ray->vertex, kLightPoint + uint32_t(li), uint32_t(k)) : 0;
            const float u = p.ray ? random(*p.ray).one(vertex, kChooseLight, 0) : 0.5f;
            if (u * sum[at] >= w) continue;
            weight[at] = w;
            for (size_t r = 0; r < 9; ++r) kept.out[r * width + at] = one.out[r * width + at];
            kept.reach[at] = one.reach[at];
        }
    }
    for (size_t at = 0; at < width; ++at)
        for (size_t r = 3; r < 6 && weight[at] > 0; ++r) kept.out[r * width + at] *= sum[at] / weight[at];
    return lit;
}

} // namespace alpenglow::services
