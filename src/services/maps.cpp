// texture(), environment(), shadow() and textureinfo(). Arguments are resolved in advance (TextureSite); only numbers are read
// for each point.
#include "services/services.h"
#include "texture/shadow.h"
#include "world/unknownfilter.h"
#include <fmt/format.h>

namespace alpenglow::services {

namespace {

constexpr float kDefaultBias = .225f; ///< of shadow(), in world units: TextureSite::shadowBias0 where no option says another

/// The filter that a point names; reports unknown names once.
texture::Filter filterOf(const TextureSite& t, const ServiceCall& call, int lane) {
    const std::string& name = rsl::internedString(std::bit_cast<int32_t>(call.at(t.filter, lane)));
    if (const auto known = texture::filterByName(name)) return *known;
    call.diagnostics.reportOnce("texturefilter:" + name, unknownFilter(name, call.d.op, call.place()));
    return t.options.filter;
}

/// Reads the options of a lookup for one point.
void readOptions(const TextureSite& t, const ServiceCall& call, int lane, texture::LookupOptions& o) {
    const auto number = [&](int row, float fallback) { return row < 0 ? fallback : call.at(row, lane); };
    if (t.filter >= 0) o.filter = filterOf(t, call, lane);
    const float width = number(t.width, 1), blur = number(t.blur, 0);
    o.swidth = number(t.swidth, width);
    o.twidth = number(t.twidth, width);
    o.sblur = number(t.sblur, blur);
    o.tblur = number(t.tblur, blur);
    o.fill = number(t.fill, 0);
}

/// texture(): with one position and its footprint, or with four positions.
void lookupTexture(const TextureSite& t, const ServiceCall& call, int lane, texture::Handle map, int channel,
                   const texture::LookupOptions& o, float* v, float* g, float* cu) {
    const auto row = [&](size_t k) { return call.at(t.rows[k], lane); };
    if (t.rows.size() >= 8) {
        float ss[4], tt[4];
        for (size_t k = 0; k < 4; ++k) {
            ss[k] = row(2 * k);
            tt[k] = row(2 * k + 1);
        }
        texture::lookupQuad(map, channel, t.count, ss, tt, o, v, g, cu);
    } else if (t.rows.size() >= 6) {
        texture::lookup2D(map, channel, t.count, row(0), row(1), row(2), row(3), row(4), row(5), o, v, g, cu);
    }
}

/// environment(): the same with directions.
void lookupEnvironment(const TextureSite& t, const ServiceCall& call, int lane, texture::Handle map,
                       const texture::LatLong& latLong, int channel, const texture::LookupOptions& o, float* v, float* g,
                       float* cu) {
    const auto vec = [&](size_t k) {
        const int r = t.rows[k];
        return Vec3(call.at(r, lane), call.at(r + 1, lane), call.at(r + 2, lane));
    };
    if (t.rows.size() >= 4) {
        const Vec3 q[4] = {vec(0), vec(1), vec(2), vec(3)};
        texture::environmentQuad(map, latLong, channel, t.count, q, o, v, g, cu);
    } else {
        texture::environment(map, latLong, channel, t.count, vec(0), vec(1), vec(2), o, v, g, cu);
    }
}

/// Result for a map that cannot be read: the color of Option "texture" "missing", by channel; the fill value for further
/// channels.
void answerMissing(const TextureSite& t, const ServiceCall& call, const Color& colour) {
    call.eachLane([&](int lane) {
        const int first = t.channel < 0 ? 0 : int(call.at(t.channel, lane));
        for (int k = 0; k < t.count; ++k)
            call.put(k, lane, first + k >= 0 && first + k < 3 ? colour[first + k] : t.fill < 0 ? 0.f : call.at(t.fill, lane));
    });
}

/// texture() with one position for consecutive points, without derivatives, in a map that is the same for all.
bool lookupTogether(const TextureSite& t, const ServiceCall& call, texture::Handle map) {
    if (t.computed || t.slopes > 0 || t.rows.size() < 6 || t.rows.size() >= 8 || t.count < 1) return false;
    constexpr int kMost = texture::LookupLanes::kLanes;
    for (int from = 0; from < call.lanes; from += kMost) {
        texture::LookupLanes l;
        l.mask = uint32_t(call.mask >> from) & 0xffff;
        const int n = std::min(kMost, call.lanes - from);
        if (const size_t points = call.c.size(); size_t(call.first + from + n) > points)
            l.mask &= size_t(call.first + from) >= points ? 0u : (1u << (points - size_t(call.first + from))) - 1;
        if (!l.mask) continue;
        l.set(t.options);
        const auto take = [&](int row, float* to) {
            if (row >= 0) std::copy_n(call.in + size_t(row) * size_t(call.lanes) + from, n, to);
        };
        float* places[6] = {l.s, l.t, l.dsdx, l.dtdx, l.dsdy, l.dtdy};
        for (size_t k = 0; k < 6; ++k) take(t.rows[k], places[k]);
        take(t.width, l.swidth), take(t.width, l.twidth), take(t.swidth, l.swidth), take(t.twidth, l.twidth);
        take(t.blur, l.sblur), take(t.blur, l.tblur), take(t.sblur, l.sblur), take(t.tblur, l.tblur);
        take(t.fill, l.fill);
        const int leader = std::countr_zero(l.mask);
        if (t.filter >= 0)
            for (int i = 0; i < n; ++i)
                if (l.mask >> i & 1) l.filter[i] = filterOf(t, call, from + i);
        const int channel = t.channel < 0 ? 0 : int(call.at(t.channel, from + leader));
        if (t.channel >= 0) // points with other channels are handled in another pass
            for (int i = 0; i < n; ++i)
                if ((l.mask >> i & 1) && int(call.at(t.channel, from + i)) != channel) return false;
        texture::lookup2DLanes(map, channel, t.count, t.options.asLight, l);
        for (int k = 0; k < t.count; ++k)
            for (uint32_t left = l.mask; left; left &= left - 1)
                call.put(k, from + std::countr_zero(left), l.out[k][std::countr_zero(left)]);
    }
    return true;
}

} // namespace

void answerTexture(Services& answers, const ServiceCall& call) {
    const TextureSite& t = *call.s.map;
    const WorldImpl& world = answers.world();
    const auto place = [&] { return call.place(); };
    texture::LookupOptions o = t.options;
    texture::Handle map = t.computed ? nullptr : t.map(world, place);
    world.textures().keepWithinLimit();
    const std::optional<Color>& missing = world.textures().settings().missing;
    if (!t.computed && !map && missing && !t.name.empty()) return answerMissing(t, call, *missing);
    if (call.s.kind == SiteKind::Texture && lookupTogether(t, call, map)) return;
    call.eachLane([&](int lane) {
        const int32_t name = t.computed ? std::bit_cast<int32_t>(call.at(0, lane)) : 0;
        if (t.computed) map = answers.mapOfName(name, place);
        if (name && !map && missing) {
            for (int k = 0; k < t.count; ++k) call.put(k, lane, (*missing)[std::min(k, 2)]);
            return;
        }
        readOptions(t, call, lane, o);
        const int channel = t.channel < 0 ? 0 : int(call.at(t.channel, lane));
        float v[3] = {}, slopes[27] = {};
        float *g = t.slopes > 0 ? slopes : nullptr, *cu = t.slopes > t.firsts ? slopes + t.firsts : nullptr;
        if (call.s.kind == SiteKind::Texture) lookupTexture(t, call, lane, map, channel, o, v, g, cu);
        else lookupEnvironment(t, call, lane, map, world.textures().latLong(), channel, o, v, g, cu);
        for (int k = 0; k < t.count; ++k) call.put(k, lane, v[k]);
        for (int k = 0; k < t.slopes; ++k) call.put(t.count + k, lane, slopes[k]);
    });
}

/// Attribute "shadow" of a primitive: its two biases; negative if not set.
static std::pair<float, float> biasOf(ServiceMemo& memo, const scene::Attributes* a) {
    if (!a) return {-1.f, -1.f};
    const auto [at, fresh] = memo.shadowBias.try_emplace(a, -1.f, -1.f);
    if (fresh) {
        const auto number = [&](const char* name, float otherwise) {
            const scene::Param* p = a->value(name);
            return p && !p->numbers.empty() ? p->numbers[0] : otherwise;
        };
        const float bias = number("shadow:bias", -1);
        at->second = {number("shadow:bias0", bias), number("shadow:bias1", bias)};
    }
    return at->second;
}

/// Options of shadow() for one point.
static texture::ShadowOptions shadowOptions(const TextureSite& t, const ServiceCall& call, int lane,
                                            std::pair<float, float> ofPrimitive, const Matrix& toWorld) {
    const auto number = [&](int row, float otherwise) {
        const float x = row < 0 ? otherwise : call.at(row, lane);
        return std::isfinite(x) ? x : otherwise;
    };
    const auto first = [](std::initializer_list<float> list) {
        for (const float x : list)
            if (x >= 0) return x;
        return 0.f;
    };
    texture::ShadowOptions o;
    const float width = number(t.width, 1), blur = number(t.blur, 0), bias = number(t.bias, -1);
    o.swidth = number(t.swidth, width);
    o.twidth = number(t.twidth, width);
    o.sblur = number(t.sblur, blur);
    o.tblur = number(t.tblur, blur);
    o.samples = number(t.samples, t.shadowSamples);
    o.bias0 = first({number(t.bias0, -1), bias, ofPrimitive.first, t.shadowBias0});
    o.bias1 = std::max(o.bias0, first({number(t.bias1, -1), bias, ofPrimitive.second, ofPrimitive.first, t.shadowBias1}));
    o.gapbias = number(t.gapbias, 0);
    if (std::all_of(std::begin(t.source), std::end(t.source), [](int r) { return r >= 0; })) {
        o.source.emplace();
        for (size_t k = 0; k < 4; ++k) {
            const int r = t.source[k];
            (*o.source)[k] = transformPoint(toWorld, Vec3d(call.at(r, lane), call.at(r + 1, lane), call.at(r + 2, lane)));
        }
    }
    return o;
}

/// Reports a map without camera matrices, which cannot be a shadow map.
static void noteNoShadowMap(texture::Handle map, const ServiceCall& call) {
    if (!map || !map->tiles.empty() || (map->worldToCamera && map->worldToNDC)) return;
    call.diagnostics.reportOnce(
        "noshadowmap:" + map->path,
        {Severity::Warning,
         Rie::BadFile,
         call.place(),
         "shadow(): \"" + map->path + "\" is not a shadow map: it has no camera matrices, so it casts no shadow",
         "Display of type \"zfile\" or \"deepshad\", or MakeShadow of the former, makes one",
         {}});
}

/// Reports a map that sees so little depth that a bias of 0.225, which is the default, hides most of its shadows.
static void noteLargeBias(texture::Handle map, float bias, const ServiceCall& call) {
    thread_local std::pair<texture::Handle, std::string> last; // consecutive calls mostly look at the same map
    if (!map || (map == last.first && map->path == last.second)) return;
    last = {map, map->path};
    const auto depths = texture::depthsOf(*map);
    if (!depths || !(depths->second > depths->first) || bias < .25f * (depths->second - depths->first)) return;
    call.diagnostics.reportOnce(
        "largebias:" + map->path,
        {Severity::Warning,
         Rie::NoError,
         call.place(),
         fmt::format(
             "shadow(): the bias of {:g} units, the default, hides shadows of map \"{}\", whose depths are from {:.3g} to {:.3g}",
             bias, map->path, depths->first, depths->second),
         "Option \"shadow\" \"float bias\" or the parameter \"bias\" sets one that is small beside what casts shadows",
         {}});
}

void answerShadow(Services& answers, const ServiceCall& call) {
    const TextureSite& t = *call.s.map;
    const WorldImpl& world = answers.world();
    const auto place = [&] { return call.place(); };
    if (call.c.light && world.settings().hider == Hider::Path) { // traced shadows are exact
        if (t.computed || !t.name.empty())
            call.diagnostics.reportOnce("shadowmaps", {Severity::Info,
                                                       Rie::NoError,
                                                       call.place(),
                                                       "shadow maps of light shaders are not read under the hider path",
                                                       "lights trace their shadows there",
                                                       {}});
        return call.each([&](int lane, const ShadePoint&) {
            for (int k = 0; k < t.count; ++k) call.put(k, lane, 0);
        });
    }
    texture::Handle map = t.computed ? nullptr : t.map(world, place);
    noteNoShadowMap(map, call);
    bool noted = false;
    call.each([&](int lane, const ShadePoint&) {
        if (t.computed) noteNoShadowMap(map = answers.mapOfName(std::bit_cast<int32_t>(call.at(0, lane)), place), call);
        const SurfaceBinding* binding = call.binding(world, lane);
        const auto bias = biasOf(answers.memo(), binding ? binding->attributes.get() : nullptr);
        const Matrix& toWorld = world.cameraToWorld();
        const texture::ShadowOptions o = shadowOptions(t, call, lane, bias, toWorld);
        if (!noted && o.bias0 == kDefaultBias && o.bias1 == kDefaultBias) noteLargeBias(map, kDefaultBias, call);
        noted = !t.computed;
        const auto vec = [&](size_t k) {
            const int r = t.rows[k];
            return Vec3d(call.at(r, lane), call.at(r + 1, lane), call.at(r + 2, lane));
        };
        Color v(0);
        if (t.rows.size() >= 4) {
            Vec3d q[4];
            for (size_t k = 0; k < 4; ++k) q[k] = transformPoint(toWorld, vec(k));
            v = texture::shadowLookupQuad(map, q, o);
        } else if (t.rows.size() >= 3) {
            v = texture::shadowLookup(map, transformPoint(toWorld, vec(0)), transformVector(toWorld, vec(1)),
                                      transformVector(toWorld, vec(2)), o);
        }
        for (int k = 0; k < t.count; ++k) call.put(k, lane, t.count < 3 ? (v.x + v.y + v.z) / 3 : v[k]);
    });
}

namespace {

Information ofMatrix(const Matrix& m) {
    Information i;
    for (const auto& row : m.m)
        for (const double x : row) i.numbers.push_back(float(x));
    return i;
}

/// "uint8", "half", ...
std::string formatOf(const texture::TextureInfo& t) {
    return t.floating ? t.bits == 16 ? "half" : "float" : "uint" + std::to_string(t.bits);
}

} // namespace

void answerTextureInfo(Services& answers, const ServiceCall& call) {
    const auto place = [&] { return call.place(); };
    const rsl::ir::Site& d = call.d;
    // Maps store matrices from world space, shaders query from "current"
    const Matrix& fromCurrent = answers.world().cameraToWorld();
    call.each([&](int lane, const ShadePoint&) {
        int32_t asked[2] = {0, 0}; // map and field; both may vary over the points
        const std::string* known[2] = {nullptr, nullptr};
        int row = 0;
        for (size_t k = 0; k < 2; ++k) {
            if (k < d.strings.size() && !d.strings[k].empty()) known[k] = &d.strings[k];
            else if (row < int(d.argKinds.size()) && d.argKinds[size_t(row)] == rsl::ir::Kind::String)
                asked[k] = std::bit_cast<int32_t>(call.at(row++, lane));
        }
        const auto& info = answers.infoOfName(known[0] ? call.s.nameId : asked[0], place);
        const std::string& field = known[1] ? *known[1] : rsl::internedString(asked[1]);
        if (field == "exists") return call.put(0, lane, info ? 1 : 0);
        if (!info) return;
        Information i;
        if (field == "resolution") i.numbers = {float(info->width), float(info->height)};
        else if (field == "channels") i.numbers = {float(info->channels)};
        else if (field == "bitsperchannel") i.numbers = {float(info->bits)};
        else if (field == "type") i = {{}, {info->type}, true};
        else if (field == "viewingmatrix" && info->viewing) i = ofMatrix(fromCurrent * *info->viewing);
        else if (field == "projectionmatrix" && info->projection) i = ofMatrix(fromCurrent * *info->projection);
        else if (field == "wrapmodes")
            i = {{}, {std::string(texture::nameOf(info->swrap)) + "," + texture::nameOf(info->twrap)}, true};
        else if (field == "gamma") i.numbers = {info->gamma};
        else if (field == "facecount") i.numbers = {float(info->faces)};
        else if (field == "hasalpha") i.numbers = {info->alpha ? 1.f : 0.f};
        else if (field == "format") i = {{}, {formatOf(*info)}, true};
        else return;
        call.answer(lane, ShaderValue(i));
    });
}

void answerIrradiance(Services& answers, const ServiceCall& call) {
    const WorldImpl& world = answers.world();
    const bool computed = call.d.strings.empty() || call.d.strings[0].empty();
    const int row = computed ? 1 : 0;
    std::string space;
    if (const auto s = call.s.text.find("environmentspace"); s != call.s.text.end()) space = s->second;
    Matrix toMap;
    if (!space.empty()) world.matrix("current", space, toMap);
    call.each([&](int lane, const ShadePoint&) {
        const int32_t name = computed ? std::bit_cast<int32_t>(call.at(0, lane)) : call.s.nameId;
        const texture::Handle map = answers.mapOfName(name, [&] { return call.place(); });
        Vec3 n(call.at(row, lane), call.at(row + 1, lane), call.at(row + 2, lane));
        if (!space.empty()) n = Vec3(transformVector(toMap, Vec3d(n)));
        const float l = length(n);
        const Color c = map && l > 0 && std::isfinite(l) ? answers.irradianceOf(map).about(n / l) : Color(0);
        for (int k = 0; k < 3; ++k) call.put(k, lane, c[k]);
    });
}

} // namespace alpenglow::services
