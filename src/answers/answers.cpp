#include "answers/answers.h"

namespace alpenglow::transport {

Told::Told(const Information& i) : numbers(i.numbers), texts(i.texts) {}

rsl::ir::Kind Told::kindOf(rsl::Base b) {
    using rsl::ir::Kind;
    return b == rsl::Base::String ? Kind::String : b == rsl::Base::Matrix ? Kind::Matrix : b == rsl::Base::Float ? Kind::Float : Kind::Triple;
}

ServiceCall::ServiceCall(BatchContext& context, int number, int firstPoint, uint64_t points, int width, const float* arguments, float* results)
    : c(context), s(context.bound->sites[size_t(number)]), d(*s.site), site(number), first(firstPoint), lanes(width), mask(points), in(arguments), out(results) {
    for (int r = 0; r < s.resultRowCount; ++r)
        for (int lane = 0; lane < lanes; ++lane)
            if (mask >> lane & 1) put(r, lane, 0);
}

std::string ServiceCall::name(int lane) const {
    if (!d.strings.empty() && !d.strings[0].empty()) return d.strings[0];
    return d.argKinds.empty() || d.argKinds[0] != rsl::ir::Kind::String ? std::string() : rsl::internedString(std::bit_cast<int32_t>(at(0, lane)));
}

int32_t ServiceCall::nameId(int lane) const {
    if (s.nameId) return s.nameId;
    return d.argKinds.empty() || d.argKinds[0] != rsl::ir::Kind::String ? 0 : std::bit_cast<int32_t>(at(0, lane));
}

SourcePlace ServiceCall::place() const {
    const auto& files = c.bound->kernel->files();
    return {d.place.file < int(files.size()) ? files[size_t(d.place.file)] : "", d.place.line, d.place.column};
}

const SurfaceBinding* ServiceCall::binding(const WorldImpl& world, int lane) const {
    if (c.lit) return c.lit->binding(first + lane);
    return c.bindings.empty() ? c.binding : &world.bindings_[size_t(c.bindings[size_t(first + lane)])];
}

void ServiceCall::answer(int lane, const Told& t) const {
    using rsl::ir::Kind;
    if (d.resultKinds.size() < 2) return; // whether there is one was all that was asked
    const std::string& variable = d.resultNames[1];
    const bool open = variable.rfind("length ", 0) == 0, array = open || (!variable.empty() && variable.back() == ']');
    const size_t before = open ? 2 : 1; // rows
    if (open && d.resultKinds.size() == before && t.elements > 0) { // how long it is was all that was asked
        put(1, lane, float(t.elements));
        put(0, lane, 1);
    }
    if (d.resultKinds.size() <= before) return;
    const Kind wanted = d.resultKinds[before];
    if (t.kind && (*t.kind != wanted || (t.elements > 0) != array)) return;
    if (t.varying && wanted != Kind::String && s.text.count("__uniform")) {
        if (c.engine) {
            const SourcePlace at = place();
            c.engine->diagnostics().reportOnce("uniform:" + at.file + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) + ":" + name(lane),
                                               {Severity::Warning, Rie::Consistency, at,
                                                d.op + "(): \"" + name(lane) + "\" is varying and the variable that takes it is uniform: it stays as it is, and the result is 0",
                                                "a varying variable takes it", {}});
        }
        return;
    }
    const size_t size = size_t(rsl::ir::components(wanted)), rows = size_t(s.resultRowCount) - before;
    const size_t have = wanted == Kind::String ? t.texts.size() : t.numbers.size();
    if (!t.kind && (have == 0 || (array ? have % size != 0 : have != rows))) return;
    if (!open && have < rows) return;
    if (open) put(1, lane, float(have / size));
    for (size_t r = 0; r < std::min(rows, have); ++r) {
        if (wanted == Kind::String) putText(int(before + r), lane, t.texts[r]);
        else put(int(before + r), lane, t.numbers[r]);
    }
    put(0, lane, 1);
}

std::optional<Told> toldBy(const ShaderInstance& shader, const std::string& parameter) {
    for (const rsl::ParameterInfo& p : shader.program->parameters()) {
        if (p.name != parameter) continue;
        const auto& texts = shader.parameters.strings;
        int length = std::max(1, p.type.array);
        if (p.open)
            if (const auto given = texts.find(p.name + "[]"); given != texts.end()) length = std::atoi(given->second.c_str());
        Told t(p.type, length);
        t.varying = p.storage == rsl::Storage::Varying;
        if (p.type.base == rsl::Base::String) {
            for (int e = 0; e < length; ++e) {
                const auto text = texts.find(p.type.array ? p.name + "[" + std::to_string(e) + "]" : p.name);
                t.texts.push_back(text == texts.end() ? "" : text->second);
            }
        } else if (const auto n = shader.parameters.numbers.find(p.name); n != shader.parameters.numbers.end()) {
            t.numbers = n->second;
        }
        return t;
    }
    return std::nullopt;
}

std::optional<Told> primitiveVariable(const geometry::Shape& shape, const geometry::SurfacePoint& at, const std::string& name) {
    using rsl::ir::Kind;
    Told t;
    if (const int v = shape.findPrimvar(name); v >= 0) {
        const geometry::PrimVar& variable = shape.primvars()[size_t(v)];
        t.varying = variable.cls != scene::Class::Constant && variable.cls != scene::Class::Uniform;
        t.elements = variable.arrayLength;
        if (variable.type == scene::Type::String) {
            t.kind = Kind::String;
            t.texts = {shape.stringValue(v, at)};
            return t;
        }
        t.kind = variable.type == scene::Type::Matrix ? Kind::Matrix
                 : variable.type == scene::Type::Float || variable.type == scene::Type::Integer ? Kind::Float
                                                                                                 : Kind::Triple;
        t.numbers.resize(size_t(variable.outWidth()));
        shape.interpolate(v, at, t.numbers.data(), nullptr, nullptr);
        return t;
    }
    // What every primitive has.
    const scene::Attributes& a = shape.attributes();
    const auto triple = [&](const Vec3& v, bool varying) {
        t.kind = Kind::Triple;
        t.varying = varying;
        t.numbers = {v.x, v.y, v.z};
        return t;
    };
    if (name == "P") return triple(at.displaced ? shape.evaluate(at.face, at.u, at.v).P : at.P, true);
    if (name == "N") return triple(at.N, true);
    if (name == "Cs") return triple({a.color.x, a.color.y, a.color.z}, false);
    if (name == "Os") return triple({a.opacity.x, a.opacity.y, a.opacity.z}, false);
    if (name != "s" && name != "t" && name != "st") return std::nullopt;
    t.kind = Kind::Float;
    t.varying = true;
    t.elements = name == "st" ? 2 : 0;
    if (name != "t") t.numbers.push_back(at.s);
    if (name != "s") t.numbers.push_back(at.t);
    return t;
}

} // namespace alpenglow::transport
