// Queries between shaders: parameters and outputs of a primitive's shaders, of lights and volumes; attributes.
#include "scene/filterlink.h"
#include "scene/scene.h"
#include "services/services.h"
#include "world/arealight.h"
#include "world/objectbox.h"

namespace alpenglow::services {

namespace {

/// Value of a shader's output in a completed run. `t`: of the parameter's type.
bool writtenBy(const shading::Batch& run, int point, const std::string& parameter, ShaderValue& t) {
    rsl::OutputName name = rsl::OutputName::parameterOf(parameter);
    const auto& outputs = run.kernel().outputs();
    std::vector<float> numbers;
    for (int e = 0; e < std::max(1, t.elements); ++e) {
        if (t.elements) name.element = e;
        const int o = run.output(name);
        if (o < 0) return false;
        for (int k = 0; k < rsl::ir::components(outputs[size_t(o)].kind); ++k) numbers.push_back(run.value(o, k, point));
    }
    if (t.kind == rsl::ir::Kind::String) {
        t.texts.clear();
        for (float id : numbers) t.texts.push_back(rsl::internedString(std::bit_cast<int32_t>(id)));
    } else {
        t.numbers = std::move(numbers);
    }
    return true;
}

/// Value of a primitive variable that overrides a parameter of one of its shaders.
void overridden(const ShadePoint& p, const std::string& parameter, ShaderValue& t) {
    const int v = p.shape ? p.shape->findPrimvar(parameter) : -1;
    if (v < 0) return;
    const std::optional<ShaderValue> of = primitiveVariable(*p.shape, p.surface, parameter);
    if (of && of->kind == t.kind && of->elements == t.elements && of->kind != rsl::ir::Kind::String) t.numbers = of->numbers;
}

enum class Asks { Surface, Displacement, Atmosphere, Incident, Opposite, Nobody };

Asks asked(const std::string& op) {
    static const std::map<std::string, Asks> names = {{"surface", Asks::Surface},
                                                      {"displacement", Asks::Displacement},
                                                      {"atmosphere", Asks::Atmosphere},
                                                      {"incident", Asks::Incident},
                                                      {"opposite", Asks::Opposite}};
    const auto i = names.find(op);
    return i == names.end() ? Asks::Nobody : i->second;
}

const InstanceRef& shaderOf(const SurfaceBinding& b, Asks who, const ShadePoint& p) {
    static const InstanceRef none;
    // A ray that hits the back comes from inside. For a light: seen from the lit surface.
    const bool back = p.lit ? dot(p.lit->n, p.viewI) > 0 : dot(p.surface.n, p.I) > 0;
    switch (who) {
    case Asks::Surface:
        return b.surface;
    case Asks::Displacement:
        return b.displacement;
    case Asks::Atmosphere:
        return b.atmosphere.shader;
    case Asks::Incident:
        return back ? b.interior : b.exterior;
    case Asks::Opposite:
        return back ? b.exterior : b.interior;
    default:
        return none;
    }
}

/// Whether a filter of a light acts on the surface that it lights; nothing: the name is that of a parameter.
const std::optional<ShaderValue>& filterActs(Services& answers, int32_t id, const SurfaceBinding* b) {
    const scene::Attributes* a = b ? b->attributes.get() : nullptr;
    const auto [known, fresh] = answers.memo().filterLinks.try_emplace({id, a});
    if (fresh)
        if (const auto link = scene::FilterLink::of(rsl::internedString(id)))
            known->second = ShaderValue(Information{{link->acts(a) ? 1.f : 0.f}, {}, false});
    return known->second;
}

} // namespace

void answerMessage(Services& answers, const ServiceCall& q) {
    const Asks who = asked(q.d.op);
    const KernelRun& c = q.c;
    q.each([&](int lane, const ShadePoint& p) {
        const SurfaceBinding* b = q.binding(answers.world(), lane);
        if (who == Asks::Surface && (c.lit || !b)) // a light; one of a sky's table lights nothing
            if (const auto& acts = filterActs(answers, q.nameId(lane), b)) return q.answer(lane, *acts);
        if (!b) return;
        const InstanceRef& shader = shaderOf(*b, who, p);
        if (!shader) return;
        const auto [known, fresh] = answers.memo().ofShaders.try_emplace({q.nameId(lane), shader.get()});
        if (fresh) known->second = shaderParameter(*shader, rsl::internedString(q.nameId(lane)));
        if (!known->second) return;
        std::optional<ShaderValue> t = known->second;
        const std::string& name = rsl::internedString(q.nameId(lane));
        const int point = q.first + lane;
        if (c.lit) { // a light queries: its point is not on the surface
            if (std::vector<float> now; who == Asks::Surface && c.lit->output(point, name, now)) t->numbers = now;
            int there = -1;
            const KernelRun* displaced = who == Asks::Displacement ? c.lit->displaced(point, there) : nullptr;
            if (displaced) writtenBy(*displaced->batch, there, name, *t);
            return q.answer(lane, *t);
        }
        if (who == Asks::Surface || who == Asks::Displacement || who == Asks::Atmosphere) overridden(p, name, *t);
        // The atmosphere runs after the surface, the displacement before both.
        const KernelRun& run = c.surface ? *c.surface : c;
        const int there = c.surface ? c.surfacePoint[size_t(point)] : point;
        if (who == Asks::Surface && c.surface && run.batch) writtenBy(*run.batch, there, name, *t);
        if (who == Asks::Displacement && run.displaced) writtenBy(*run.displaced->batch, there, name, *t);
        q.answer(lane, *t);
    });
}

std::optional<ShaderValue> valueAtHit(Services& answers, const ShadePoint& p, const InstanceRef& shader, int32_t id,
                                      const shading::Batch* run, int point) {
    const std::string& name = rsl::internedString(id);
    if (shader) {
        const auto [known, fresh] = answers.memo().ofShaders.try_emplace({id, shader.get()});
        if (fresh) known->second = shaderParameter(*shader, name);
        if (std::optional<ShaderValue> t = known->second) {
            overridden(p, name, *t);
            if (run) writtenBy(*run, point, name, *t);
            return t;
        }
    }
    // Variables of the primitive as the shader sees them. Other variables of a point are known only if a kernel reads them.
    if (!p.shape || !run || (name != "P" && name != "N" && name != "Cs" && name != "Os" && p.shape->findPrimvar(name) < 0))
        return {};
    std::optional<ShaderValue> t = primitiveVariable(*p.shape, p.surface, name);
    if (t && name == "P") t->numbers = {p.P.x, p.P.y, p.P.z};
    if (t && name == "N") t->numbers = {p.N.x, p.N.y, p.N.z};
    return t;
}

namespace {

const LightParameter& lightParameter(Services& answers, int32_t id, int light) {
    const auto [known, fresh] = answers.memo().ofLights.try_emplace({id, light});
    if (!fresh) return known->second;
    LightParameter* made = &known->second;
    const BoundLight& l = answers.world().lights()[size_t(light)];
    const std::string& name = rsl::internedString(id);
    made->value = shaderParameter(*l.instance, name);
    int offset = 0;
    for (const BoundLight::Value& v : l.values) {
        const bool written = made->value && v.name.what == rsl::OutputName::What::Value && v.name.name == name;
        const bool element = written && made->value->elements > 0 && v.name.element >= 0;
        if (written && (v.name.element < 0 || element)) {
            const size_t size = made->value->numbers.size() / size_t(std::max(1, made->value->elements));
            made->written.push_back({offset, v.components, element ? size * size_t(v.name.element) : 0});
        }
        offset += v.components;
    }
    return *made;
}

/// Value that a surface sends to a parameter of a light.
void tellSent(const ServiceCall& q, const LightLoop& loop, const SiteInfo& setup, int lane, const std::string& name,
              ShaderValue& t) {
    if (t.kind == rsl::ir::Kind::String) {
        for (const auto& [parameter, text] : setup.sentStrings)
            if (parameter == name) t.texts = {text};
        return;
    }
    size_t to = 0;
    const auto sent = [&](int row, int size) {
        for (int r = 0; r < size && to < t.numbers.size(); ++r)
            t.numbers[to++] = loop.given[size_t(row + r) * size_t(q.lanes) + size_t(lane)];
    };
    const size_t size = t.numbers.size() / size_t(std::max(1, t.elements));
    const auto find = [&](int element) {
        return std::find_if(setup.sent.begin(), setup.sent.end(),
                            [&](const SiteInfo::Sent& v) { return v.element == element && v.parameter == name; });
    };
    if (const auto whole = find(-1); whole != setup.sent.end()) sent(whole->row, whole->size);
    for (int n = 0; t.elements > 0; ++n) { // a sent array: elements beyond its length are unchanged
        const auto element = find(n);
        if (element == setup.sent.end() || size_t(element->size) != size) break;
        sent(element->row, int(size));
    }
}

} // namespace

void answerLightSource(Services& answers, const ServiceCall& q) {
    const LightLoop& loop = answers.lightLoop(q.c, q.first, q.lanes);
    if (loop.light < 0 || q.s.outside) return;
    const int width = answers.world().lights()[size_t(loop.light)].valueWidth;
    const SiteInfo* setup = loop.setup >= 0 ? &q.c.bound->sites[size_t(loop.setup)] : nullptr;
    const LightParameter* same = q.s.nameId ? &lightParameter(answers, q.s.nameId, loop.light) : nullptr;
    if (same && !same->value) return;
    q.each([&](int lane, const ShadePoint&) {
        // In this order: written by the light's shader; sent to it; set by the scene.
        const int32_t name = q.nameId(lane);
        const LightParameter& p = same ? *same : lightParameter(answers, name, loop.light);
        if (!p.value) return;
        if (p.written.empty() && !setup) return q.answer(lane, *p.value);
        ShaderValue t = *p.value;
        for (const LightParameter::Part& part : p.written)
            for (int r = 0; r < part.components && part.to + size_t(r) < t.numbers.size(); ++r)
                t.numbers[part.to + size_t(r)] = loop.values[size_t(lane * width + part.from + r)];
        if (p.written.empty()) tellSent(q, loop, *setup, lane, rsl::internedString(name), t);
        q.answer(lane, t);
    });
}

namespace {

constexpr char kLight[] = "light:", kOfLight[] = "attribute:light:";

/// The area of an area light's geometry, in camera space; nothing for other lights.
std::optional<Information> areaOf(const WorldImpl& w, const scene::Light& light) {
    const auto index = size_t(&light - w.frame().lights.data());
    const Emitter* e = index < w.lights().size() ? w.lights()[index].emitter.get() : nullptr;
    if (!e || e->empty()) return std::nullopt;
    return Information{{float(e->area())}, {}, false};
}

/// In a light's shader all attributes are the light's; prefix "light:" is optional.
std::optional<Information> ofTheLightItself(const WorldImpl& w, const scene::Light& light, const std::string& name) {
    if (name == "light:area") return areaOf(w, light);
    if (!light.attributes) return std::nullopt;
    std::optional<Information> i = attributeOf(w, *light.attributes, name, nullptr, nullptr);
    if (!i && name.rfind(kLight, 0) == 0) i = attributeOf(w, *light.attributes, name.substr(sizeof kLight - 1), nullptr, nullptr);
    return i;
}

/// In a light loop names with prefix "light:" refer to the current light; other names, and those that it does not have, do not.
std::optional<Information> ofTheLightOfTheTurn(const WorldImpl& w, const scene::Light& light, const std::string& name) {
    if (!light.attributes) return std::nullopt;
    if (name.rfind(kLight, 0) == 0) return attributeOf(w, *light.attributes, name.substr(sizeof kLight - 1), nullptr, nullptr);
    if (name.rfind(kOfLight, 0) == 0) return attributeOf(w, *light.attributes, name, nullptr, nullptr);
    return std::nullopt;
}

/// Whether an imager runs: it has neither primitive nor light.
bool runsImager(const KernelRun& c) { return !c.light && !c.binding && c.bindings.empty(); }

/// An imager sees the attributes at the start of the world (RISpec 3.2, section 4).
std::optional<Information> ofTheFrame(const WorldImpl& w, const std::string& name) {
    const scene::AttributesRef& a = w.frame().options.attributes;
    return a ? attributeOf(w, *a, name, nullptr, nullptr) : std::nullopt;
}

std::optional<Information> ofThePrimitive(const WorldImpl& w, const ShadePoint& p, const std::string& name,
                                          const SurfaceBinding* b) {
    return p.shape ? attributeOf(w, p.shape->attributes(), name, &p, b) : std::nullopt;
}

} // namespace

constexpr size_t kMostAttributes = 1 << 14; // limit of cached answers: scenes have attributes by the million

void answerAttribute(Services& answers, const ServiceCall& q) {
    const WorldImpl& w = answers.world();
    const scene::Light* self = q.c.light ? q.c.light->source : nullptr;
    const int turn = self || q.s.outside ? -1 : answers.lightLoop(q.c, q.first, q.lanes).light;
    const scene::Light* other = turn >= 0 ? w.lights()[size_t(turn)].source : nullptr;
    const bool imager = runsImager(q.c);
    ServiceMemo& memo = answers.memo();
    const auto samePoints = [&](int32_t id) {
        const auto [known, fresh] = memo.pointAttributes.try_emplace(id);
        if (fresh) known->second = ofPoint(rsl::internedString(id));
        return !known->second;
    };
    q.each([&](int lane, const ShadePoint& p) {
        const int32_t id = q.nameId(lane);
        const std::string& name = rsl::internedString(id);
        if (!self && !imager && !answers.building() && p.shape && samePoints(id)) {
            const SurfaceBinding* b = q.binding(w, lane);
            if (memo.attributes.size() > kMostAttributes) memo.attributes.clear();
            const auto [known, fresh] = memo.attributes.try_emplace({id, turn, &p.shape->attributes(), b});
            if (fresh) {
                std::optional<Information> i = other ? ofTheLightOfTheTurn(w, *other, name) : std::nullopt;
                if (!i) i = ofThePrimitive(w, p, name, b);
                if (i) known->second = ShaderValue(*i);
            }
            if (known->second) q.answer(lane, *known->second);
            return;
        }
        if (!self && !imager && p.shape && name == kObjectBox) { // cached by primitive: constant time for each query
            const auto [known, fresh] = memo.boxes.try_emplace(p.shape->source().primitive.get());
            if (fresh)
                if (const auto box = ofThePrimitive(w, p, name, nullptr)) known->second = ShaderValue(*box);
            if (known->second) q.answer(lane, *known->second);
            return;
        }
        std::optional<Information> i;
        if (self) i = ofTheLightItself(w, *self, name);
        else if (other) i = ofTheLightOfTheTurn(w, *other, name);
        if (!i && imager) i = ofTheFrame(w, name);
        else if (!i && !self) i = ofThePrimitive(w, p, name, q.binding(w, lane));
        if (i) q.answer(lane, ShaderValue(*i));
    });
}

void answerShaderName(Services& answers, const ServiceCall& q) {
    const WorldImpl& w = answers.world();
    KernelRun& c = q.c;
    const bool own = q.d.strings.empty() && q.d.argKinds.empty(); // of the querying shader
    q.each([&](int lane, const ShadePoint& p) {
        const SurfaceBinding* b = c.light && own ? nullptr : q.binding(w, lane);
        const std::string kind = own ? "" : q.name(lane);
        InstanceRef of;
        if (own && c.light) of = c.light->instance;
        else if (kind == "lightsource") {
            const int turn = c.light || q.s.outside ? -1 : answers.lightLoop(c, q.first, q.lanes).light;
            of = c.light ? c.light->instance : turn >= 0 ? w.lights()[size_t(turn)].instance : nullptr;
        } else if (b && own) of = c.bound == &b->displacementS ? b->displacement : c.volume ? c.volume->shader : b->surface;
        else if (b) of = shaderOf(*b, asked(kind), p);
        std::string name = of ? of->name : "";
        if (!of && runsImager(c) && (own || kind == "imager") && w.frame().options.imager) name = w.frame().options.imager->name;
        q.putText(0, lane, name);
    });
}

void answerPrimitiveVariable(const ServiceCall& q) {
    q.each([&](int lane, const ShadePoint& p) { // for a light: its own geometry
        if (!p.shape) return;
        const std::optional<ShaderValue> t = primitiveVariable(*p.shape, p.surface, q.name(lane));
        if (!t) return;
        if (q.d.resultKinds.size() < 2) q.put(0, lane, 1);
        else q.answer(lane, *t);
    });
}

} // namespace alpenglow::services
