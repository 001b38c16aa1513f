// The checks that let everyone downstream trust a primitive's sizes (scene/primitive.h; docs/design/ri.md).
#include "ri/interpreter.h"
#include "scene/primitivekinds.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace alpenglow::ri {
namespace {

using scene::Class;
using scene::Param;
using scene::Primitive;
using scene::Type;

bool isArgument(const Primitive& p, const Param& v) {
    const scene::PrimitiveKind* kind = scene::primitiveKind(p.kind);
    return kind && std::find(kind->arguments.begin(), kind->arguments.end(), v.name) != kind->arguments.end();
}

/// The last of a name counts (docs/design/ri.md, "Reading").
void dropDuplicates(Primitive& p, Reporter& reporter) {
    const auto later = [&](size_t i) {
        for (size_t k = i + 1; k < p.params.size(); ++k)
            if (p.params[k].name == p.params[i].name) return true;
        return false;
    };
    bool any = false; // nearly never, so that nothing is moved
    for (size_t i = 0; i + 1 < p.params.size() && !any; ++i) any = later(i);
    if (!any) return;
    scene::ParamList kept;
    for (size_t i = 0; i < p.params.size(); ++i) {
        if (later(i))
            reporter.once(fmt::format("ri:twice:{}", p.params[i].name), Severity::Warning, Rie::Consistency, p.params[i].place,
                          fmt::format("{}: \"{}\" is given twice: the last one counts", p.kind, p.params[i].name));
        else kept.push_back(std::move(p.params[i]));
    }
    p.params = std::move(kept);
}

/// Leaves exactly one of P, Pw, Pz, as a vertex variable of its own type. False: there is none that could serve.
Param* position(Primitive& p, Reporter& reporter) {
    static constexpr struct {
        const char* name;
        Type type;
        int per;
    } kForms[] = {{"P", Type::Point, 3}, {"Pw", Type::HPoint, 4}, {"Pz", Type::Float, 1}};
    bool patch = scene::has(p.kind, scene::kPatch);
    const char* use = nullptr;
    for (auto& f : kForms) {
        if (f.type == Type::Float && !patch) continue;
        auto i = std::find_if(p.params.begin(), p.params.end(), [&](const Param& v) { return v.name == f.name; });
        if (i == p.params.end()) continue;
        if (use) {
            reporter.warning(Rie::Consistency, i->place,
                             fmt::format("{}: \"{}\" next to \"{}\" is ignored", p.kind, f.name, use));
            p.params.erase(i);
            continue;
        }
        use = f.name;
        i->cls = Class::Vertex;
        i->arrayLength = 0;
        i->declared = true;
        if (i->type == Type::String) i->numbers.clear();
        i->type = f.type;
        if (i->numbers.size() % size_t(f.per)) {
            reporter.error(Rie::Consistency, i->place,
                           fmt::format("{}: \"{}\" has {} numbers, which is not a multiple of {}", p.kind, f.name,
                                       i->numbers.size(), f.per));
            return nullptr;
        }
    }
    if (!use) {
        reporter.error(Rie::MissingData, p.place, fmt::format("{} needs \"P\"{}", p.kind, patch ? ", \"Pw\" or \"Pz\"" : ""));
        return nullptr;
    }
    return &*std::find_if(p.params.begin(), p.params.end(), [&](const Param& v) { return v.name == use; });
}

/// Values of a variable, in elements of its base type.
size_t size(const Param& v) { return v.type == Type::String ? v.strings.size() : v.numbers.size(); }
void cut(Param& v, size_t n) {
    if (v.type == Type::String) v.strings.resize(n);
    else v.numbers.resize(n);
}

/// Class and array length that an undeclared variable's length fits; vertex first.
bool guessClass(Param& v, const scene::VariableCounts& c) {
    int64_t n = int64_t(size(v));
    if (n == 0) return false;
    for (Class cls : {Class::Vertex, Class::Varying, Class::FaceVarying, Class::Uniform, Class::Constant}) {
        int64_t k = c.of(cls);
        if (k <= 0 || n % k || n / k > 16) continue;
        if (k == 1 && cls != Class::Constant) continue;
        v.cls = cls;
        v.arrayLength = n == k ? 0 : int(n / k);
        return true;
    }
    return false;
}

bool fitOne(Param& v, const Primitive& p, const scene::VariableCounts& c, int64_t givenPoints, Reporter& reporter) {
    if (!v.declared) {
        if (guessClass(v, c)) return true;
        reporter.error(Rie::Consistency, v.place,
                       fmt::format("{}: the {} values of the undeclared \"{}\" fit no class", p.kind, size(v), v.name));
        return false;
    }
    int64_t per = int64_t(scene::componentCount(v.type)) * std::max(v.arrayLength, 1);
    int64_t have = int64_t(size(v)), want = c.of(v.cls);
    if (have % per == 0 && have / per == want) return true;
    if (have % per == 0 && scene::has(p.kind, scene::kMesh) && (v.cls == Class::Vertex || v.cls == Class::Varying) &&
        have / per == givenPoints) {
        cut(v, size_t(want * per)); // as many as P had, some of them unused
        return true;
    }
    if (want > 0 && have / per == want) { // a number too many at the end
        reporter.report(
            Severity::Warning, Rie::Consistency, v.place,
            fmt::format("{}: \"{}\" needs {} x {} values, not {}: the rest is ignored", p.kind, v.name, want, per, have));
        cut(v, size_t(want * per));
        return true;
    }
    if (have == per && v.cls == Class::Uniform) {
        reporter.once(fmt::format("ri:onevalue:{}:{}", p.kind, v.name), Severity::Warning, Rie::Consistency, v.place,
                      fmt::format("{}: \"{}\" is uniform but has one value: it holds for all {} pieces", p.kind, v.name, want));
        v.cls = Class::Constant;
        return true;
    }
    reporter.error(Rie::Consistency, v.place,
                   fmt::format("{}: {} {} \"{}\" needs {} x {} values, not {}: it is ignored", p.kind, toString(v.cls),
                               toString(v.type), v.name, want, per, have));
    return false;
}

} // namespace

bool fitVariables(Primitive& p, Reporter& reporter) {
    for (float f : p.numbers)
        if (!std::isfinite(f)) {
            reporter.error(Rie::Range, p.place, fmt::format("{} has an argument that is not finite", p.kind));
            return false;
        }
    dropDuplicates(p, reporter);
    Param* points = nullptr;
    if (scene::has(p.kind, scene::kHasPoints) && !(points = position(p, reporter))) return false;
    scene::VariableCounts counts;
    std::string why;
    if (!scene::variableCounts(p, &counts, &why)) {
        reporter.error(Rie::Consistency, p.place, fmt::format("{}: {}", p.kind, why));
        return false;
    }
    int64_t given = 0;
    if (points) {
        size_t per = size_t(scene::componentCount(points->type));
        given = int64_t(points->numbers.size() / per);
        if (given < counts.vertex || (given > counts.vertex && !scene::has(p.kind, scene::kMesh))) {
            reporter.error(Rie::Consistency, points->place,
                           fmt::format("{}: \"{}\" needs {} points, not {}", p.kind, points->name, counts.vertex, given));
            return false;
        }
        points->numbers.resize(size_t(counts.vertex) * per);
    }
    size_t kept = 0;
    for (size_t i = 0; i < p.params.size(); ++i) {
        Param& v = p.params[i];
        bool fixed = v.name == "P" || v.name == "Pw" || v.name == "Pz";
        if (isArgument(p, v)) v.cls = Class::Constant;
        else if (!(points && fixed) && !fitOne(v, p, counts, given, reporter)) continue;
        if (kept != i) p.params[kept] = std::move(v);
        ++kept;
    }
    p.params.resize(kept);
    return true;
}

} // namespace alpenglow::ri
