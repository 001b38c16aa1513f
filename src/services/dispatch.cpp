// Services that answer at once: messages, ray state and attributes; textures are in maps.cpp.
#include "rsl/services_basic.h"
#include "services/services.h"
#include "shading/gridpoint.h"

namespace alpenglow::services {

void Services::service(KernelRun& c, int site, int first, uint64_t mask, int lanes, const float* in, float* out) {
    const ServiceCall call(c, diagnostics_, site, first, mask, lanes, in, out);
    if (call.s.service) return call.s.service->answer(*this, call);
    switch (call.s.kind) { // what a request becomes where it is answered at once
    case SiteKind::PointHemisphere:
        return answerPointHemisphere(*this, call);
    case SiteKind::PointSubsurface:
        return answerPointSubsurface(*this, call);
    case SiteKind::Irradiance:
        return answerIrradiance(*this, call);
    case SiteKind::GatherIteration:
        return answerGatherIteration(call);
    case SiteKind::Ambient:
        return sumAmbient(call);
    default:
        break;
    }
    if (c.spilled.answer(call.d, first, mask, lanes, in, out, diagnostics_, &c.bound->kernel->files())) return;
    rsl::basicService(
        call.d, mask, lanes, in, out, diagnostics_, [&](int lane, const std::string& text) { print(call, lane, text); },
        &c.bound->kernel->files());
}

/// Under the other hiders: sum of the ambient lights that are on.
void Services::sumAmbient(const ServiceCall& call) {
    KernelRun& c = call.c;
    if (!c.binding) return;
    if (!c.light && !c.volume && 2 * std::popcount(call.mask) >= std::min(call.lanes, int(c.points.size()) - call.first) &&
        allAmbientHaveSheets(*c.binding)) {
        const std::vector<Color>& sum = ambientOf(c);
        call.each([&](int lane, const ShadePoint&) {
            for (int k = 0; k < 3; ++k) call.put(k, lane, sum[size_t(call.first + lane)][k]);
        });
        return;
    }
    for (int li : world_->skies()) {
        const BoundLight& l = world_->lights()[size_t(li)];
        if (l.kind != LightKind::Ambient || !c.binding->lights.contains(li)) continue;
        std::vector<ShadePoint> q;
        std::vector<int> laneOf;
        call.each([&](int lane, const ShadePoint& p) {
            ShadePoint x = p;
            x.Ps = p.P;
            x.lit = &p.surface;
            x.Ns = p.N;
            x.shape = nullptr;
            q.push_back(x);
            laneOf.push_back(lane);
        });
        std::vector<LightValue> v(q.size());
        lightEvaluator_->evaluateLight(l, q, v, {});
        for (size_t i = 0; i < q.size(); ++i)
            for (int k = 0; k < 3; ++k) call.out[size_t(k) * size_t(call.lanes) + size_t(laneOf[i])] += v[i].Cl[k];
    }
}

void answerOption(Services& answers, const ServiceCall& call) {
    const WorldImpl& world = answers.world();
    call.each([&](int lane, const ShadePoint&) {
        const auto [known, fresh] = answers.memo().options.try_emplace(call.nameId(lane));
        if (fresh || answers.building()) {
            const auto i = optionOf(world, rsl::internedString(call.nameId(lane)));
            known->second = i ? std::optional<ShaderValue>(ShaderValue(*i)) : std::nullopt;
        }
        if (known->second) call.answer(lane, *known->second);
    });
}

/// rayinfo(), rendererinfo(), raylevel() and similar.
void answerRay(const ServiceCall& call) {
    const KernelRun& c = call.c;
    call.each([&](int lane, const ShadePoint& p) {
        const shading::PathRay* own = c.rays.empty() ? nullptr : &c.rays[size_t(call.first + lane)];
        if (call.s.kind == SiteKind::RayLevel) {
            const int depth = own ? own->bounces : 0;
            const std::string& op = call.d.op;
            return call.put(0, lane,
                            op == "raylevel"        ? float(depth)
                            : op == "isindirectray" ? float(depth > 0)
                                                    : float(c.forShadow));
        }
        const auto i =
            call.s.kind == SiteKind::RayInfo ? rayInfoOf(call.name(lane), own ? own : p.ray, p) : rendererInfoOf(call.name(lane));
        if (i) call.answer(lane, ShaderValue(*i));
    });
}

void Services::answerDepth(const ServiceCall& call) {
    const double lo = world_->clipNear(), range = double(world_->clipFar()) - lo;
    call.each(
        [&](int lane, const ShadePoint&) { call.put(0, lane, range > 0 ? float((double(call.at(2, lane)) - lo) / range) : 0); });
}

/// transform() and similar between spaces named at run time.
void Services::transformBetween(const ServiceCall& call) {
    const rsl::ir::Site& d = call.d;
    const int n = d.op == "mtransform" ? 16 : 3;
    const shadeops::Base type = d.argTypes.empty() ? shadeops::Base::Point : d.argTypes.back().base;
    const char* symbol = n == 16                                                  ? "al_multiply"
                         : d.op == "vtransform" || type == shadeops::Base::Vector ? "al_transformvector"
                         : d.op == "ntransform" || type == shadeops::Base::Normal ? "al_transformnormal"
                                                                                  : "al_transformpoint";
    call.each([&](int lane, const ShadePoint& p) {
        std::string space[2];
        int row = 0;
        for (int k = 0; k < 2; ++k) {
            space[k] = size_t(k) < d.strings.size() ? d.strings[size_t(k)] : "";
            if (space[k].empty() && row < int(d.argKinds.size()) && d.argKinds[size_t(row)] == rsl::ir::Kind::String)
                space[k] = rsl::internedString(std::bit_cast<int32_t>(call.at(row++, lane)));
        }
        const Matrix m = spaceAt(*world_, space[0], space[1], p, call.binding(*world_, lane));
        float in[32], out[16];
        const auto flatten = [&](float* to) {
            for (int k = 0; k < 16; ++k) to[k] = float(m.m[k / 4][k % 4]);
        };
        for (int k = 0; k < n; ++k) in[n == 16 ? k : 16 + k] = call.at(row + k, lane);
        flatten(n == 16 ? in + 16 : in);
        shadeops::evaluateRuntime(symbol, in, n == 16 ? 32 : 19, out, n);
        for (int k = 0; k < n; ++k) call.put(k, lane, out[k]);
    });
}

/// Stores the text of a printf() in the world's log.
void Services::print(const ServiceCall& call, int lane, const std::string& text) {
    const KernelRun& c = call.c;
    const rsl::ir::Site& d = call.d;
    if (call.first + lane >= int(c.points.size())) return;
    if (c.lightOutput || c.again || (c.binding && c.bound == &c.binding->moveS)) return; // the run that shades reports it
    const ShadePoint& p = c.points[size_t(call.first + lane)];
    const shading::PathRay* r = c.rays.empty() ? p.ray : &c.rays[size_t(call.first + lane)];
    rsl::PrintKey key;
    if (r) {
        if (r->sample) {
            key.sample = r->sample->sample;
            key.x = r->sample->px;
            key.y = r->sample->py;
            if (const shading::GridPoint* g = r->sample->grid) key.point = g->micropolygon, key.run = g->run;
        }
        key.bounces = r->bounces;
        key.vertex = r->vertex;
    }
    if (!c.bound->kernel->files().empty()) key.program = c.bound->kernel->files().front();
    if (call.s.once) // in construct()
        return world_->prints().once(std::to_string(d.place.file) + ":" + std::to_string(d.place.line) + ":" +
                                         std::to_string(d.place.column),
                                     key.program, text);
    key.place = {p.P.x, p.P.y, p.P.z};
    key.call = {d.place.file, d.place.line, d.place.column};
    world_->prints().add(key, text);
}

} // namespace alpenglow::services
