// texture(), environment() and shadow() of kernels, and textureinfo(). What a call says about the lookup is known beforehand
// (TextureSite); per point only the numbers are read.
#include "answers/answers.h"
#include "texture/shadow.h"

namespace alpenglow::transport {

namespace {

/// The options of a lookup at one point.
void readOptions(const TextureSite& t, const ServiceCall& call, int lane, texture::LookupOptions& o) {
    const auto number = [&](int row, float fallback) { return row < 0 ? fallback : call.at(row, lane); };
    if (t.filter >= 0) {
        const auto known = texture::filterByName(rsl::internedString(std::bit_cast<int32_t>(call.at(t.filter, lane))));
        o.filter = known ? *known : t.options.filter;
    }
    const float width = number(t.width, 1), blur = number(t.blur, 0);
    o.swidth = number(t.swidth, width);
    o.twidth = number(t.twidth, width);
    o.sblur = number(t.sblur, blur);
    o.tblur = number(t.tblur, blur);
    o.fill = number(t.fill, 0);
}

/// texture(): with one point and its footprint, or with four.
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

/// environment(): likewise with directions.
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

} // namespace

void answerTexture(Answers& answers, const ServiceCall& call) {
    const TextureSite& t = *call.s.map;
    const WorldImpl& world = answers.world();
    const auto place = [&] { return call.place(); };
    texture::LookupOptions o = t.options;
    texture::Handle map = t.computed ? nullptr : t.map(world, place);
    call.each([&](int lane, const ShadePoint&) {
        if (t.computed) map = answers.mapOfName(std::bit_cast<int32_t>(call.at(0, lane)), place);
        readOptions(t, call, lane, o);
        const int channel = t.channel < 0 ? 0 : int(call.at(t.channel, lane));
        float v[3] = {}, slopes[27] = {};
        float *g = t.slopes > 0 ? slopes : nullptr, *cu = t.slopes > t.firsts ? slopes + t.firsts : nullptr;
        if (call.s.kind == SiteKind::Texture) lookupTexture(t, call, lane, map, channel, o, v, g, cu);
        else lookupEnvironment(t, call, lane, map, world.textures_->latLong(), channel, o, v, g, cu);
        for (int k = 0; k < t.count; ++k) call.put(k, lane, v[k]);
        for (int k = 0; k < t.slopes; ++k) call.put(t.count + k, lane, slopes[k]);
    });
}

/// Attribute "shadow" of a primitive: its two ends of the bias; negative where it says nothing.
static std::pair<float, float> biasOf(AnswerMemo& memo, const scene::Attributes* a) {
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

/// The options of shadow() at one point.
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

void answerShadow(Answers& answers, const ServiceCall& call) {
    const TextureSite& t = *call.s.map;
    const WorldImpl& world = answers.world();
    const auto place = [&] { return call.place(); };
    if (call.c.light && world.settings_.hider == Hider::Path) { // what rays tell exactly
        if (t.computed || !t.name.empty())
            call.diagnostics.reportOnce("shadowmaps", {Severity::Info, Rie::NoError, call.place(),
                                                       "shadow maps of light shaders are not read under the hider path",
                                                       "lights trace their shadows there", {}});
        return call.each([&](int lane, const ShadePoint&) {
            for (int k = 0; k < t.count; ++k) call.put(k, lane, 0);
        });
    }
    texture::Handle map = t.computed ? nullptr : t.map(world, place);
    call.each([&](int lane, const ShadePoint&) {
        if (t.computed) map = answers.mapOfName(std::bit_cast<int32_t>(call.at(0, lane)), place);
        const SurfaceBinding* binding = call.binding(world, lane);
        const auto bias = biasOf(answers.memo(), binding ? binding->attributes.get() : nullptr);
        const Matrix& toWorld = world.cameraToWorld_;
        const texture::ShadowOptions o = shadowOptions(t, call, lane, bias, toWorld);
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

} // namespace

void answerTextureInfo(Answers& answers, const ServiceCall& call) {
    const auto place = [&] { return call.place(); };
    const rsl::ir::Site& d = call.d;
    const Matrix& fromCurrent = answers.world().cameraToWorld_; // maps hold matrices from the world, shaders ask from "current"
    call.each([&](int lane, const ShadePoint&) {
        int32_t asked[2] = {0, 0}; // the map and the field; each point may have its own
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
        else return;
        call.answer(lane, Told(i));
    });
}

void answerIrradiance(Answers& answers, const ServiceCall& call) {
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

} // namespace alpenglow::transport
