// What the renderer answers at once: textures, messages, the state of rays and attributes.
#include "rsl/services_basic.h"
#include "transport/engine.h"
#include "transport/information.h"
#include "transport/raysets.h"
#include <bit>

namespace alpenglow::transport {

namespace {

SiteKind kindOf(const std::string& op) {
    static const std::map<std::string, SiteKind> kinds = {
        {"ambient", SiteKind::Ambient}, {"diffuse", SiteKind::Diffuse}, {"specular", SiteKind::Specular}, {"specularstd", SiteKind::Specular},
        {"phong", SiteKind::Phong}, {"trace", SiteKind::Trace}, {"transmission", SiteKind::Transmission},
        {"lightvisibility", SiteKind::LightVisibility}, {"illuminance", SiteKind::Illuminance}, {"texture", SiteKind::Texture},
        {"environment", SiteKind::Environment}, {"surface", SiteKind::Message}, {"displacement", SiteKind::Message},
        {"atmosphere", SiteKind::Message}, {"incident", SiteKind::Message}, {"opposite", SiteKind::Message}, {"lightsource", SiteKind::LightSource}, {"attribute", SiteKind::Attribute},
        {"option", SiteKind::Option}, {"rendererinfo", SiteKind::RendererInfo}, {"rayinfo", SiteKind::RayInfo},
        {"raylevel", SiteKind::RayLevel}, {"isindirectray", SiteKind::RayLevel}, {"isshadowray", SiteKind::RayLevel},
        {"textureinfo", SiteKind::TextureInfo}, {"lightsetup", SiteKind::LightSetup}, {"getlight", SiteKind::LightHandles},
        {"getlights", SiteKind::LightHandles}, {"islightcategory", SiteKind::LightHandles}, {"lightcall", SiteKind::LightHandles},
        {"lightparameter", SiteKind::LightHandles}};
    auto i = kinds.find(op);
    return i == kinds.end() ? SiteKind::Other : i->second;
}

/// How many rows the argument has that begins at `row`.
size_t rowsOf(const SiteInfo& i, int row) {
    int at = 0;
    for (auto kind : i.site->argKinds) {
        if (at == row) return size_t(rsl::ir::components(kind));
        at += rsl::ir::components(kind);
    }
    return 0;
}

/// The parameters of a trace() beyond the common ones. What is not followed is said once.
std::shared_ptr<const TraceSite> traceSite(const SiteInfo& i, const rsl::ir::Site& s, const rsl::CompiledKernel& k, WorldImpl& world) {
    auto t = std::make_shared<TraceSite>();
    const SourcePlace place{s.place.file < int(k.files().size()) ? k.files()[size_t(s.place.file)] : "", s.place.line, s.place.column};
    auto row = [&](const char* name) { auto f = i.named.find(name); return f == i.named.end() ? -1 : f->second; };
    auto text = [&](const char* name) { auto f = i.text.find(name); return f == i.text.end() ? std::string() : f->second; };
    auto said = [&](const std::string& what, const std::string& message) {
        world.diagnostics_->reportOnce("trace:" + what + place.file + std::to_string(place.line), {Severity::Warning, Rie::Unimplement, place, "trace(): " + message, {}, {}});
    };
    t->udir = row("udir");
    t->roughness = row("roughness");
    t->roughnessv = row("roughnessv");
    t->absorption = row("absorption");
    t->tint = row("environmenttint");
    const std::string part = text("__part");
    if (!part.empty()) t->part = part[0] - '0';
    std::map<int, int> ends; // by row: where the value ends
    int at = 0;
    for (auto kind : s.argKinds) {
        const int begin = at;
        ends[begin] = at += rsl::ir::components(kind);
    }
    for (const char* name : {"eta", "eta[0]", "eta[1]"})
        if (const int r = row(name); r >= 0) t->eta.push_back({r, std::min(3, ends[r] - r)});
    for (int n = 0; row(("lobeparameters[" + std::to_string(n) + "]").c_str()) >= 0; ++n) t->lobes.push_back(row(("lobeparameters[" + std::to_string(n) + "]").c_str()));
    for (const char* name : {"distribution", "bsdf", "environmentmap", "environmentspace"})
        if (row(name) >= 0) said(name, "\"" + std::string(name) + "\" must be known when the shader is compiled; it is taken as not given");
    if (const std::string map = text("environmentmap"); !map.empty()) {
        t->map = world.textures_->open(map, world.settings_.texturePaths, place);
        if (const std::string space = text("environmentspace"); !space.empty()) world.matrix("current", space, t->toMap);
    }
    for (const char* name : {"transmission", "environmentcontribution", "unshadowedenvironment", "arealightcontribution", "unshadowedarealight"})
        t->sums |= i.resultRows.count(name) > 0;
    return t;
}

} // namespace

BoundKernel bindKernel(std::shared_ptr<const rsl::CompiledKernel> k, bool mixed, bool path, WorldImpl* world) {
    BoundKernel b;
    b.path = path;
    b.mixed = mixed;
    if (!k) return b;
    for (const auto& s : k->sites()) {
        SiteInfo i;
        i.kind = kindOf(s.op);
        i.site = &s;
        int row = 0;
        std::vector<int> starts;
        for (auto kind : s.argKinds) {
            starts.push_back(row);
            row += rsl::ir::components(kind);
        }
        size_t numericPairs = 0;
        for (const auto& text : s.pairStrings) numericPairs += text.empty();
        size_t positional = starts.size() - std::min(starts.size(), numericPairs), next = positional;
        i.rows.assign(starts.begin(), starts.begin() + long(positional));
        for (size_t p = 0; p < s.names.size(); ++p) {
            if (!s.pairStrings[p].empty()) i.text[s.names[p]] = s.pairStrings[p];
            else if (next < starts.size()) i.named[s.names[p]] = starts[next++];
        }
        int out = 0;
        for (size_t r = 0; r < s.resultKinds.size(); ++r) {
            std::string name = r < s.resultNames.size() ? s.resultNames[r] : "";
            i.resultRows[name] = out;
            out += rsl::ir::components(s.resultKinds[r]);
        }
        i.resultRowCount = out;
        if (i.kind == SiteKind::Diffuse) i.lobe = findLobe("diffuse");
        if (i.kind == SiteKind::Specular) i.lobe = findLobe("specular");
        if (i.kind == SiteKind::Phong) i.lobe = findLobe("phong");
        i.standard = s.op == "specularstd";
        auto rowOf = [&](const char* name) { auto f = i.named.find(name); return f == i.named.end() ? -1 : f->second; };
        static const std::string kOutput = "surface:";
        for (const auto& [name, at] : i.named)
            if (name.rfind(kOutput, 0) == 0 && i.kind != SiteKind::LightSetup) i.outputs.push_back({name.substr(kOutput.size()), at, int(rowsOf(i, at))});
        i.rowWo = rowOf("wo");
        i.rowExponent = rowOf("exponent");
        i.rowCone = rowOf("samplecone");
        i.rowHorizon = rowOf("horizon");
        i.rowLights = rowOf("samplearealights");
        if (i.kind == SiteKind::Trace || i.kind == SiteKind::Transmission) {
            auto text = [&](const char* name) { auto f = i.text.find(name); return f == i.text.end() ? std::string() : f->second; };
            i.label = rsl::internString(!text("label").empty() ? text("label") : text("raylabel"));
            i.rays = raySite(i, *world, {s.place.file < int(k->files().size()) ? k->files()[size_t(s.place.file)] : "", s.place.line, s.place.column});
        }
        if (i.kind == SiteKind::Trace) {
            auto text = [&](const char* name, const char* fallback) { auto f = i.text.find(name); return f == i.text.end() ? std::string(fallback) : f->second; };
            std::string distribution = text("distribution", text("bsdf", "uniform").c_str());
            i.lobe = findLobe(distribution);
            if (!i.lobe) {
                i.lobe = findLobe("uniform");
                world->diagnostics_->reportOnce("distribution:" + distribution,
                    {Severity::Warning, Rie::Unimplement, {k->files().empty() ? "" : k->files()[s.place.file], s.place.line, s.place.column},
                     "trace(): distribution \"" + distribution + "\" is not yet available; one ray along R is traced", {}, {}});
            }
            i.trace = traceSite(i, s, *k, *world);
        }
        b.sites.push_back(std::move(i));
    }
    b.plan = std::make_shared<shading::BatchPlan>(*k, mixed);
    world->footprints_ |= b.plan->usesFootprint();
    b.kernel = std::move(k);
    return b;
}

void Engine::service(BatchContext& c, int site, int first, uint64_t mask, int lanes, const float* in, float* out) {
    const SiteInfo& s = c.bound->sites[site];
    const rsl::ir::Site& d = *s.site;
    auto each = [&](auto&& body) {
        for (int lane = 0; lane < lanes; ++lane)
            if ((mask >> lane & 1) && first + lane < int(c.points.size())) body(lane, c.points[first + lane]);
    };
    auto at = [&](int row, int lane) { return in[size_t(row) * lanes + lane]; };
    auto put = [&](int row, int lane, float v) { out[size_t(row) * lanes + lane] = v; };
    for (int r = 0; r < s.resultRowCount; ++r)
        for (int lane = 0; lane < lanes; ++lane)
            if (mask >> lane & 1) put(r, lane, 0);
    SourcePlace place{d.place.file < int(c.bound->kernel->files().size()) ? c.bound->kernel->files()[d.place.file] : "", d.place.line, d.place.column};

    // Writes a value to the first output after the success flag, when type and size fit.
    int valueRow = 1, valueRows = s.resultRowCount - 1;
    bool wantsString = d.resultKinds.size() > 1 && d.resultKinds[1] == rsl::ir::Kind::String;
    auto answer = [&](int lane, const std::vector<float>* numbers, const std::string* text) {
        if (wantsString) {
            if (!text) return;
            put(valueRow, lane, std::bit_cast<float>(rsl::internString(*text)));
        } else {
            if (!numbers || int(numbers->size()) < valueRows) return;
            for (int r = 0; r < valueRows; ++r) put(valueRow + r, lane, (*numbers)[r]);
        }
        put(0, lane, 1);
    };
    auto answerFrom = [&](int lane, const shading::ParameterBlock& p, const std::string& name) {
        auto n = p.numbers.find(name);
        auto t = p.strings.find(name);
        answer(lane, n == p.numbers.end() ? nullptr : &n->second, t == p.strings.end() ? nullptr : &t->second);
    };
    auto bindingAt = [&](int lane) { return c.bindings.empty() ? nullptr : &world_->bindings_[size_t(c.bindings[size_t(first + lane)])]; };
    std::string name = d.strings.empty() ? "" : d.strings[0];
    if (name.empty() && mask && !d.argKinds.empty() && d.argKinds[0] == rsl::ir::Kind::String) // known only now; the same for all
        name = rsl::internedString(std::bit_cast<int32_t>(at(0, std::countr_zero(mask))));

    switch (s.kind) {
    case SiteKind::Texture:
    case SiteKind::Environment: {
        texture::LookupOptions o;
        auto number = [&](const char* key, int lane, float fallback) { auto i = s.named.find(key); return i == s.named.end() ? fallback : at(i->second, lane); };
        if (auto f = s.text.find("filter"); f != s.text.end())
            if (auto known = texture::filterByName(f->second)) o.filter = *known;
        texture::Handle h = nullptr;
        int offset = 0;
        bool dynamic = name.empty() && !d.argKinds.empty() && d.argKinds[0] == rsl::ir::Kind::String;
        if (!dynamic && !name.empty()) h = world_->textures_->open(name, world_->settings_.texturePaths, place);
        const int count = d.resultKinds.empty() ? 0 : std::min(rsl::ir::components(d.resultKinds[0]), 3);
        // rsl/passes/gradients.h; most lookups want none. First derivatives, then second ones.
        const int slopeCount = std::min(s.resultRowCount - count, 27), firsts = count * (s.kind == SiteKind::Texture ? 2 : 3);
        each([&](int lane, const ShadePoint&) {
            if (dynamic) {
                const std::string& n = rsl::internedString(std::bit_cast<int32_t>(at(0, lane)));
                h = n.empty() ? nullptr : world_->textures_->open(n, world_->settings_.texturePaths, place);
                offset = 1;
            }
            float width = number("width", lane, 1), blur = number("blur", lane, 0);
            o.swidth = number("swidth", lane, width);
            o.twidth = number("twidth", lane, width);
            o.sblur = number("sblur", lane, blur);
            o.tblur = number("tblur", lane, blur);
            o.fill = number("fill", lane, 0);
            int channel = int(number("channel", lane, 0));
            float v[3] = {}, slopes[27] = {};
            float *g = slopeCount > 0 ? slopes : nullptr, *cu = slopeCount > firsts ? slopes + firsts : nullptr;
            auto row = [&](int k) { return at(s.rows[size_t(offset + k)], lane); };
            if (s.kind == SiteKind::Texture) {
                if (int(s.rows.size()) - offset >= 8) {
                    float ss[4], tt[4];
                    for (int k = 0; k < 4; ++k) { ss[k] = row(2 * k); tt[k] = row(2 * k + 1); }
                    texture::lookupQuad(h, channel, count, ss, tt, o, v, g, cu);
                } else if (int(s.rows.size()) - offset >= 6) {
                    texture::lookup2D(h, channel, count, row(0), row(1), row(2), row(3), row(4), row(5), o, v, g, cu);
                }
            } else {
                auto vec = [&](int k) { int r = s.rows[size_t(offset + k)]; return Vec3(at(r, lane), at(r + 1, lane), at(r + 2, lane)); };
                if (int(s.rows.size()) - offset >= 4) {
                    Vec3 q[4] = {vec(0), vec(1), vec(2), vec(3)};
                    texture::environmentQuad(h, world_->textures_->latLong(), channel, count, q, o, v, g, cu);
                } else {
                    texture::environment(h, world_->textures_->latLong(), channel, count, vec(0), vec(1), vec(2), o, v, g, cu);
                }
            }
            for (int k = 0; k < count; ++k) put(k, lane, v[k]);
            for (int k = 0; k < slopeCount; ++k) put(count + k, lane, slopes[k]);
        });
        return;
    }
    case SiteKind::Ambient: { // not under path: the sum of the ambient lights that are on
        if (!c.binding) return;
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
            evaluateLight(l, q, v);
            for (size_t i = 0; i < q.size(); ++i)
                for (int k = 0; k < 3; ++k) out[size_t(k) * lanes + laneOf[i]] += v[i].Cl[k];
        }
        return;
    }
    case SiteKind::LightSource:
        if (const LightLoop& loop = lightLoop(c, first, lanes); loop.light >= 0) {
            const BoundLight& l = world_->lights_[size_t(loop.light)];
            // What the light's shader has written; what was sent to it; what it was given.
            int offset = 0;
            const auto written = std::find_if(l.values.begin(), l.values.end(), [&](const auto& v) {
                if (v.name == name) return true;
                offset += v.components;
                return false;
            });
            const SiteInfo* setup = loop.setup >= 0 ? &c.bound->sites[size_t(loop.setup)] : nullptr;
            const auto given = l.instance->parameters.numbers.find(name);
            each([&](int lane, const ShadePoint&) {
                std::vector<float> v;
                if (written != l.values.end()) {
                    const auto from = loop.values.begin() + long(lane) * l.valueWidth + offset;
                    v.assign(from, from + written->components);
                } else if (setup && setup->named.count("send:light:" + name) && given != l.instance->parameters.numbers.end()) {
                    const size_t row = size_t(setup->named.at("send:light:" + name));
                    for (size_t r = 0; r < given->second.size() && (row + r + 1) * size_t(lanes) <= loop.given.size(); ++r)
                        v.push_back(loop.given[(row + r) * size_t(lanes) + size_t(lane)]);
                } else if (setup && setup->named.count("send:light:" + name + "[0]") && given != l.instance->parameters.numbers.end()) {
                    v = given->second; // an array that was sent: what it does not reach stays
                    size_t to = 0;
                    const size_t elements = size_t(elementsOf(l, name));
                    for (int n = 0; elements > 0; ++n) {
                        const auto row = setup->named.find("send:light:" + name + "[" + std::to_string(n) + "]");
                        if (row == setup->named.end()) break;
                        const size_t size = rowsOf(*setup, row->second);
                        if (size * elements != v.size()) break;
                        for (size_t r = 0; r < size && to < v.size(); ++r) v[to++] = loop.given[(size_t(row->second) + r) * size_t(lanes) + size_t(lane)];
                    }
                } else if (setup && setup->text.count("send:light:" + name) && l.instance->parameters.strings.count(name)) {
                    return answer(lane, nullptr, &setup->text.at("send:light:" + name));
                } else {
                    return answerFrom(lane, l.instance->parameters, name);
                }
                answer(lane, &v, nullptr);
            });
        }
        return;
    case SiteKind::LightSetup: lightSetup(c, site, first, mask, lanes, in); return;
    case SiteKind::LightHandles: lightHandles(c, site, first, mask, lanes, in, out); return;
    case SiteKind::Message:
        each([&](int lane, const ShadePoint& p) {
            if (c.lit && d.op == "surface") { // a light asks
                std::vector<float> now;
                if (c.lit->output(first + lane, name, now)) return answer(lane, &now, nullptr);
            }
            const SurfaceBinding* of = c.lit ? c.lit->binding(first + lane) : c.bindings.empty() ? nullptr : &world_->bindings_[c.bindings[first + lane]];
            if (!of) return;
            const SurfaceBinding& b = *of;
            // A ray that sees the back comes from inside.
            const bool side = d.op == "incident" || d.op == "opposite", inside = side && (dot(p.surface.n, p.I) > 0) == (d.op == "incident");
            const InstanceRef& i = side ? (inside ? b.interior : b.exterior) : d.op == "surface" ? b.surface : d.op == "displacement" ? b.displacement : b.atmosphere;
            if (i) answerFrom(lane, i->parameters, name);
        });
        return;
    case SiteKind::Attribute: {
        static const std::string kLight = "light:";
        const LightLoop* loop = c.light ? nullptr : &lightLoop(c, first, lanes);
        const scene::Light* light = c.light ? c.light->source : loop && loop->light >= 0 ? world_->lights_[size_t(loop->light)].source : nullptr;
        each([&](int lane, const ShadePoint& p) {
            std::optional<Information> i;
            if (c.light && light && light->attributes) i = attributeOf(*world_, *light->attributes, name, nullptr, nullptr); // its own
            if (!i && light && light->attributes && name.rfind(kLight, 0) == 0) i = attributeOf(*world_, *light->attributes, name.substr(kLight.size()), nullptr, nullptr);
            if (!i && light && light->attributes && name.rfind("attribute:light:", 0) == 0) i = attributeOf(*world_, *light->attributes, name, nullptr, nullptr);
            if (!i && !c.light && p.shape) i = attributeOf(*world_, p.shape->attributes(), name, &p, bindingAt(lane));
            if (i) answer(lane, i->isText ? nullptr : &i->numbers, i->isText ? &i->text : nullptr);
        });
        return;
    }
    case SiteKind::Option:
        if (const auto i = optionOf(*world_, name))
            each([&](int lane, const ShadePoint&) { answer(lane, i->isText ? nullptr : &i->numbers, i->isText ? &i->text : nullptr); });
        return;
    case SiteKind::RendererInfo:
        each([&](int lane, const ShadePoint&) {
            std::vector<float> version = {0, 1, 0, 0};
            std::string text = name == "renderer" ? "Alpenglow" : "0.1";
            if (name == "version") answer(lane, &version, nullptr);
            else if (name == "renderer" || name == "versionstring") answer(lane, nullptr, &text);
        });
        return;
    case SiteKind::RayInfo:
        each([&](int lane, const ShadePoint& p) {
            const PathRay* r = c.rays.empty() ? p.ray : &c.rays[first + lane];
            std::vector<float> v;
            std::string text;
            if (name == "type") text = r ? toString(r->type) : "light";
            else if (name == "label") text = r ? rsl::internedString(r->label) : "";
            else if (name == "depth") v = {r ? float(r->bounces) : 0};
            else if (name == "speculardepth") v = {r ? float(r->specularBounces) : 0};
            else if (name == "diffusedepth") v = {r ? float(r->diffuseBounces) : 0};
            else if (name == "origin" && r) v = {r->begin().x, r->begin().y, r->begin().z};
            else if (name == "direction" && r) v = {r->dir.x, r->dir.y, r->dir.z};
            else if (name == "length") v = {length(p.I)};
            else return;
            answer(lane, v.empty() ? nullptr : &v, v.empty() ? &text : nullptr);
        });
        return;
    case SiteKind::RayLevel:
        each([&](int lane, const ShadePoint&) {
            int depth = c.rays.empty() ? 0 : c.rays[first + lane].bounces;
            const bool shadow = c.forShadow;
            put(0, lane, d.op == "raylevel" ? float(depth) : d.op == "isindirectray" ? float(depth > 0) : float(shadow));
        });
        return;
    case SiteKind::TextureInfo:
        each([&](int lane, const ShadePoint&) {
            std::string field = d.strings.size() > 1 ? d.strings[1] : "";
            auto info = world_->textures_->info(name.empty() ? nullptr : world_->textures_->open(name, world_->settings_.texturePaths, place));
            if (field == "exists") { put(0, lane, info ? 1 : 0); return; }
            if (!info) return;
            std::vector<float> v;
            if (field == "resolution") v = {float(info->width), float(info->height)};
            else if (field == "channels") v = {float(info->channels)};
            else if (field == "bitsperchannel") v = {float(info->bits)};
            else if (field == "type") { answer(lane, nullptr, &info->type); return; }
            else return;
            answer(lane, &v, nullptr);
        });
        return;
    default: break;
    }
    if (d.op == "depth") {
        const double lo = world_->clipNear_, range = double(world_->clipFar_) - lo;
        each([&](int lane, const ShadePoint&) { put(0, lane, range > 0 ? float((double(at(2, lane)) - lo) / range) : 0); });
        return;
    }
    if (d.op == "shadername") {
        const std::string kind = d.strings.empty() ? "" : name;
        each([&](int lane, const ShadePoint&) {
            std::string text;
            if (!c.bindings.empty()) {
                const SurfaceBinding& b = world_->bindings_[c.bindings[first + lane]];
                const InstanceRef& i = kind == "surface" ? b.surface : kind == "displacement" ? b.displacement : b.atmosphere;
                if (i && (kind == "surface" || kind == "displacement" || kind == "atmosphere")) text = i->name;
            }
            put(0, lane, std::bit_cast<float>(rsl::internString(text)));
        });
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
            const Matrix m = spaceAt(*world_, space[0], space[1], p, bindingAt(lane));
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
    if (d.op == "random") { // keyed by point and call site: nothing depends on who shares the batch
        each([&](int lane, const ShadePoint& p) {
            const PathRay* r = c.rays.empty() ? p.ray : &c.rays[first + lane];
            Random rng = r ? random(*r) : Random(seed_, 0, 0, 0);
            for (int k = 0; k < s.resultRowCount; ++k) put(k, lane, rng.one(r ? r->vertex : 0, uint32_t(site), uint32_t(64 + k)));
        });
        return;
    }
    rsl::basicService(d, mask, lanes, in, out, diagnostics_, [&](int lane, const std::string& text) {
        if (first + lane >= int(c.points.size())) return;
        if (c.binding && c.bound == &c.binding->moveS) return; // the surface shader says it when it shades
        const ShadePoint& p = c.points[size_t(first + lane)];
        const PathRay* r = c.rays.empty() ? p.ray : &c.rays[size_t(first + lane)];
        rsl::PrintKey key;
        if (r) {
            key.sample = r->sample;
            key.x = r->px;
            key.y = r->py;
            key.bounces = r->bounces;
            key.vertex = r->vertex;
        }
        if (!c.bound->kernel->files().empty()) key.program = c.bound->kernel->files().front();
        key.place = {p.P.x, p.P.y, p.P.z};
        world_->prints_.add(key, text);
    }, &c.bound->kernel->files());
}

} // namespace alpenglow::transport
