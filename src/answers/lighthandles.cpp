// Lights that a shader calls by their handles: getlight, getlights, islightcategory, handle->light(), handle->parameter.
#include "base/category.h"
#include "answers/answers.h"
#include "answers/lightloop.h"
#include "world/lightobjects.h"
#include <bit>
#include <charconv>

namespace alpenglow::transport {

/// The number in a handle; -1: it is that of no light.
static int numberIn(const std::string& handle) {
    if (handle.rfind(kLightHandle, 0) != 0) return -1;
    int n = -1;
    const char* digits = handle.c_str() + sizeof kLightHandle - 1;
    return std::from_chars(digits, handle.c_str() + handle.size(), n).ec == std::errc() ? n : -1;
}

int Answers::numberOfLight(const SurfaceBinding* surface, int32_t handle) {
    if (!surface) return -1;
    const auto [known, fresh] = lightOfHandle_.try_emplace(handle, -1);
    if (fresh) known->second = numberIn(rsl::internedString(handle));
    const auto& on = surface->lights;
    return known->second < 0 || std::find(on.begin(), on.end(), known->second) == on.end() ? -1 : known->second;
}

int32_t Answers::handleOf(int light) {
    const auto [known, fresh] = handles_.try_emplace(light, 0);
    if (fresh) known->second = rsl::internString(handleOfLight(light, world_->lights_[size_t(light)].handle));
    return known->second;
}

/// A parameter, or one element or component of it: "steps[1]", "lightcolor[0]". The nearest where the index is outside.
static std::optional<Told> partTold(const ShaderInstance& light, const std::string& name) {
    const size_t bracket = name.find('[');
    if (bracket == std::string::npos) return toldBy(light, name);
    std::optional<Told> t = toldBy(light, name.substr(0, bracket));
    if (!t || !t->kind) return std::nullopt;
    float index = 0;
    std::from_chars(name.c_str() + bracket + 1, name.c_str() + name.size(), index);
    if (!t->elements && *t->kind == rsl::ir::Kind::Triple) {
        t->kind = rsl::ir::Kind::Float;
        t->elements = 3;
    }
    if (!t->elements) return std::nullopt;
    const size_t at = size_t(index > 0 ? std::min(index, float(t->elements - 1)) : 0.f), each = size_t(rsl::ir::components(*t->kind));
    if (*t->kind == rsl::ir::Kind::String && at < t->texts.size()) t->texts = {std::string(t->texts[at])};
    else if (const size_t from = at * each; from + each <= t->numbers.size())
        t->numbers = std::vector<float>(t->numbers.begin() + long(from), t->numbers.begin() + long(from + each));
    else return std::nullopt;
    t->elements = 0;
    return t;
}

void Answers::lightHandles(KernelRun& c, int site, int first, uint64_t mask, int lanes, const float* in, float* out) {
    const SiteInfo& s = c.bound->sites[size_t(site)];
    const rsl::ir::Site& d = *s.site;
    const size_t width = size_t(lanes);
    auto put = [&](size_t row, int lane, float v) { out[row * width + size_t(lane)] = v; };
    auto text = [&](int lane) { // interned
        return d.argKinds.empty() || d.argKinds[0] != rsl::ir::Kind::String ? s.nameId : std::bit_cast<int32_t>(in[lane]);
    };
    LightLoop& loop = lightLoop(c, first, lanes);
    auto each = [&](auto&& body) {
        for (int lane = 0; lane < lanes; ++lane)
            if ((mask >> lane & 1) && first + lane < int(c.points.size())) body(lane);
    };
    auto visible = [&](const BoundLight& l) { return bool(l.kernel); };
    // In a light's own shader the lights are those of the surface that it lights.
    auto bindingOf = [&](int lane) { return !c.light ? c.binding : c.lit ? c.lit->binding(first + lane) : nullptr; };
    if (d.op == "islightcategory") {
        if (loop.light >= 0)
            each([&](int lane) {
                const int32_t want = text(lane);
                checkCategory(c, d, want);
                put(0, lane, isOfCategory(want, loop.light) ? 1 : 0);
            });
        return;
    }
    if (d.op == "currentlight") {
        if (loop.light >= 0) each([&](int lane) { put(0, lane, std::bit_cast<float>(handleOf(loop.light))); });
        return;
    }
    if (d.op == "getlights") { // rows: how many, then the handles
        each([&](int lane) {
            const int32_t want = text(lane);
            checkCategory(c, d, want);
            int n = 0;
            if (const SurfaceBinding* surface = bindingOf(lane))
                for (int i : surface->lights) {
                    const BoundLight& l = world_->lights_[size_t(i)];
                    if (!visible(l) || !isOfCategory(want, i)) continue;
                    if (n == limits::kLightHandles) {
                        diagnostics_.reportOnce("getlights", {Severity::Error, Rie::Limit, {}, "getlights() gives no more than " + std::to_string(limits::kLightHandles) +
                                                              " lights; the others are left out", {}, {}});
                        break;
                    }
                    put(size_t(++n), lane, std::bit_cast<float>(handleOf(i)));
                }
            put(0, lane, float(n));
        });
        return;
    }
    if (d.op == "getlight") {
        each([&](int lane) {
            const std::string& want = rsl::internedString(text(lane));
            if (const SurfaceBinding* surface = bindingOf(lane))
                for (int i : surface->lights)
                    if (visible(world_->lights_[size_t(i)]) && world_->lights_[size_t(i)].handle == want) {
                        put(0, lane, std::bit_cast<float>(handleOf(i)));
                        break;
                    }
        });
        return;
    }
    std::map<int, uint64_t> asked; // lights of the handles
    each([&](int lane) {
        if (int l = numberOfLight(bindingOf(lane), text(lane)); l >= 0) asked[l] |= uint64_t(1) << lane;
    });
    if (d.op == "lightparameter") { // rows: found, value
        const ServiceCall call(c, diagnostics_, site, first, mask, lanes, in, out);
        for (auto [li, of] : asked) {
            const auto tell = [&](const std::string& name, uint64_t points) {
                std::optional<Told> t = partTold(*world_->lights_[size_t(li)].instance, name);
                if (!t) return;
                if (t->kind == rsl::ir::Kind::Float && !t->elements && d.resultKinds.size() > 1 && d.resultKinds[1] == rsl::ir::Kind::Triple) { // a float also where a color is wanted
                    t->kind = rsl::ir::Kind::Triple;
                    t->numbers.assign(3, t->numbers.empty() ? 0.f : t->numbers[0]);
                }
                for (int lane = 0; lane < lanes; ++lane)
                    if (points >> lane & 1) call.answer(lane, *t);
            };
            const bool element = d.argKinds.back() == rsl::ir::Kind::Float; // which one stands last
            if (!d.strings.empty() && !element) {
                tell(d.strings.back(), of);
                continue;
            }
            for (int lane = 0; lane < lanes; ++lane) { // a name that is not known stands behind the handle
                if (!(of >> lane & 1)) continue;
                std::string name = d.strings.empty() ? rsl::internedString(std::bit_cast<int32_t>(in[width + size_t(lane)])) : d.strings.back();
                if (const float at = element ? in[(d.argKinds.size() - 1) * width + size_t(lane)] : 0; element)
                    name += "[" + std::to_string(at >= 1 ? int(std::min(at, float(limits::kShaderArray))) : 0) + "]";
                tell(name, uint64_t(1) << lane);
            }
        }
        return;
    }
    if (c.light) return; // one light does not run another: they could run each other without end (the builder says so)
    // lightcall: handle, P; rows: found, L (light to surface), Cl, Ol, place for the distance.
    c.lightDistance.assign(width, 1e38f);
    LightLoop turn;
    turn.depth = loop.depth + 1; // a call is a loop of its own
    turn.rows.assign(7 * width, 0);
    for (int lane = 0; lane < lanes; ++lane) {
        for (size_t r = 0; r < 3; ++r) turn.rows[r * width + size_t(lane)] = in[(r + 1) * width + size_t(lane)];
        turn.rows[6 * width + size_t(lane)] = float(kPi);
    }
    for (auto [li, of] : asked) {
        const BoundLight& light = world_->lights_[size_t(li)];
        LightLoop::Kept kept;
        uint64_t lit = 0;
        std::vector<float> sum(width), weight(width);
        for (int k = 0; k < light.samples; ++k) {
            LightLoop::Kept one;
            one.out.assign(9 * width, 0);
            one.distance.assign(width, 1e38f);
            one.values.assign(width * size_t(light.valueWidth), 0);
            const uint64_t now = sampleLight(c, turn, li, k, light.samples, first, of, lanes, one);
            if (k == 0) kept = one;
            if (k == 0 && light.sentCl >= 0) {
                LightLoop::Kept& ran = turn.kept[keptName(turn, light, li, 0, world_->settings_.hider == Hider::Path)];
                ran = one;
                ran.have = of;
            }
            lit |= now;
            if (light.samples == 1) break;
            // One of the samples, drawn in proportion to what it gives, stands for the sum of all.
            for (int lane = 0; lane < lanes; ++lane) {
                if (!(now >> lane & 1)) continue;
                const size_t at = size_t(lane);
                const float w = maxComponent(Color(one.out[3 * width + at], one.out[4 * width + at], one.out[5 * width + at]));
                if (!(w > 0) || !std::isfinite(w)) continue;
                const ShadePoint& p = c.points[size_t(first + lane)];
                sum[at] += w;
                const float u = p.ray ? random(*p.ray).one(childVertex(p.ray->vertex, kLightPoint + uint32_t(li), uint32_t(k)), kChooseLight, 0) : 0.5f;
                if (u * sum[at] >= w) continue;
                weight[at] = w;
                for (size_t r = 0; r < 9; ++r) kept.out[r * width + at] = one.out[r * width + at];
                kept.distance[at] = one.distance[at];
            }
        }
        for (size_t at = 0; at < width; ++at)
            for (size_t r = 3; r < 6 && weight[at] > 0; ++r) kept.out[r * width + at] *= sum[at] / weight[at];
        for (int lane = 0; lane < lanes; ++lane) {
            if (!(of >> lane & 1)) continue;
            put(0, lane, 1);
            for (size_t r = 0; r < 9; ++r) put(r + 1, lane, !(lit >> lane & 1) ? r < 6 ? 0.f : 1.f : (r < 3 ? -1.f : 1.f) * kept.out[r * width + size_t(lane)]);
            c.lightDistance[size_t(lane)] = kept.distance[size_t(lane)];
        }
    }
}

} // namespace alpenglow::transport
