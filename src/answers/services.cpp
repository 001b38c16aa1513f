// What the renderer answers at once: messages, the state of rays and attributes; textures in maps.cpp.
#include "rsl/services_basic.h"
#include "answers/answers.h"

namespace alpenglow::transport {

void Answers::service(KernelRun& c, int site, int first, uint64_t mask, int lanes, const float* in, float* out) {
    const ServiceCall call(c, diagnostics_, site, first, mask, lanes, in, out);
    const SiteInfo& s = call.s;
    const rsl::ir::Site& d = call.d;
    const auto each = [&](auto&& body) { call.each(body); };
    const auto at = [&](int row, int lane) { return call.at(row, lane); };
    const auto put = [&](int row, int lane, float v) { call.put(row, lane, v); };

    switch (s.kind) {
    case SiteKind::Texture:
    case SiteKind::Environment: answerTexture(*this, call); return;
    case SiteKind::TextureInfo: answerTextureInfo(*this, call); return;
    case SiteKind::Ambient: { // not under path: the sum of the ambient lights that are on
        if (!c.binding) return;
        if (!c.light && !c.volume && 2 * std::popcount(mask) >= std::min(lanes, int(c.points.size()) - first) &&
            allAmbientHaveSheets(*c.binding)) {
            const std::vector<Color>& sum = ambientOf(c);
            each([&](int lane, const ShadePoint&) {
                for (int k = 0; k < 3; ++k) put(k, lane, sum[size_t(first + lane)][k]);
            });
            return;
        }
        for (int li : c.binding->lights) {
            const BoundLight& l = world_->lights_[li];
            if (l.kind != LightKind::Ambient || !l.kernel) continue;
            std::vector<ShadePoint> q;
            std::vector<int> laneOf;
            each([&](int lane, const ShadePoint& p) {
                ShadePoint x = p;
                x.Ps = p.P;
                x.lit = &p.surface;
                x.Ns = p.N;
                x.shape = nullptr;
                q.push_back(x);
                laneOf.push_back(lane);
            });
            std::vector<LightValue> v(q.size());
            tracer_->evaluateLight(l, q, v, {});
            for (size_t i = 0; i < q.size(); ++i)
                for (int k = 0; k < 3; ++k) out[size_t(k) * lanes + laneOf[i]] += v[i].Cl[k];
        }
        return;
    }
    case SiteKind::LightSource: answerLightSource(*this, call); return;
    case SiteKind::LightSetup: lightSetup(c, site, first, mask, lanes, in); return;
    case SiteKind::LightHandles: lightHandles(c, site, first, mask, lanes, in, out); return;
    case SiteKind::Message: answerMessage(*this, call); return;
    case SiteKind::Attribute: answerAttribute(*this, call); return;
    case SiteKind::ShaderName: answerShaderName(*this, call); return;
    case SiteKind::PrimitiveVariable: answerPrimitiveVariable(call); return;
    case SiteKind::Option:
        each([&](int lane, const ShadePoint&) {
            const auto [known, fresh] = memo_.options.try_emplace(call.nameId(lane));
            if (fresh || !world_->built_) {
                const auto i = optionOf(*world_, rsl::internedString(call.nameId(lane)));
                known->second = i ? std::optional<Told>(Told(*i)) : std::nullopt;
            }
            if (known->second) call.answer(lane, *known->second);
        });
        return;
    case SiteKind::RendererInfo:
        each([&](int lane, const ShadePoint&) {
            if (const auto i = rendererInfoOf(call.name(lane))) call.answer(lane, Told(*i));
        });
        return;
    case SiteKind::RayInfo:
        each([&](int lane, const ShadePoint& p) {
            if (const auto i = rayInfoOf(call.name(lane), c.rays.empty() ? p.ray : &c.rays[size_t(first + lane)], p)) call.answer(lane, Told(*i));
        });
        return;
    case SiteKind::RayLevel:
        each([&](int lane, const ShadePoint&) {
            int depth = c.rays.empty() ? 0 : c.rays[first + lane].bounces;
            const bool shadow = c.forShadow;
            put(0, lane, d.op == "raylevel" ? float(depth) : d.op == "isindirectray" ? float(depth > 0) : float(shadow));
        });
        return;
    default: break;
    }
    if (d.op == "depth") {
        const double lo = world_->clipNear_, range = double(world_->clipFar_) - lo;
        each([&](int lane, const ShadePoint&) { put(0, lane, range > 0 ? float((double(at(2, lane)) - lo) / range) : 0); });
        return;
    }
    if (d.op == "transform" || d.op == "vtransform" || d.op == "ntransform" || d.op == "mtransform") { // spaces that are known only now
        each([&](int lane, const ShadePoint& p) {
            std::string space[2];
            int row = 0;
            for (int k = 0; k < 2; ++k) {
                space[k] = size_t(k) < d.strings.size() ? d.strings[size_t(k)] : "";
                if (space[k].empty() && row < int(d.argKinds.size()) && d.argKinds[size_t(row)] == rsl::ir::Kind::String)
                    space[k] = rsl::internedString(std::bit_cast<int32_t>(at(row++, lane)));
            }
            const Matrix m = spaceAt(*world_, space[0], space[1], p, call.binding(*world_, lane));
            float in[32], out[16];
            const int n = d.op == "mtransform" ? 16 : 3;
            const auto flatten = [&](float* to) { for (int k = 0; k < 16; ++k) to[k] = float(m.m[k / 4][k % 4]); };
            for (int k = 0; k < n; ++k) in[n == 16 ? k : 16 + k] = at(row + k, lane);
            flatten(n == 16 ? in + 16 : in);
            const rsl::Base type = d.argTypes.empty() ? rsl::Base::Point : d.argTypes.back().base;
            const char* symbol = n == 16                                                     ? "al_multiply"
                                 : d.op == "vtransform" || type == rsl::Base::Vector         ? "al_transformvector"
                                 : d.op == "ntransform" || type == rsl::Base::Normal         ? "al_transformnormal"
                                                                                             : "al_transformpoint";
            rsl::evaluateRuntime(symbol, in, n == 16 ? 32 : 19, out, n);
            for (int k = 0; k < n; ++k) put(k, lane, out[k]);
        });
        return;
    }
    if (d.op == "random") {
        drawRandom(call);
        return;
    }
    rsl::basicService(d, mask, lanes, in, out, diagnostics_, [&](int lane, const std::string& text) {
        if (first + lane >= int(c.points.size())) return;
        if (c.aside || (c.binding && c.bound == &c.binding->moveS)) return; // the surface shader says it when it shades
        const ShadePoint& p = c.points[size_t(first + lane)];
        const shading::PathRay* r = c.rays.empty() ? p.ray : &c.rays[size_t(first + lane)];
        rsl::PrintKey key;
        if (r) {
            if (r->sample) {
                key.sample = r->sample->sample;
                key.x = r->sample->px;
                key.y = r->sample->py;
            }
            key.bounces = r->bounces;
            key.vertex = r->vertex;
        }
        if (!c.bound->kernel->files().empty()) key.program = c.bound->kernel->files().front();
        if (s.text.count("__once")) // in construct()
            return world_->prints_.once(std::to_string(d.place.file) + ":" + std::to_string(d.place.line) + ":" + std::to_string(d.place.column), key.program, text);
        key.place = {p.P.x, p.P.y, p.P.z};
        world_->prints_.add(key, text);
    }, &c.bound->kernel->files());
}

} // namespace alpenglow::transport
