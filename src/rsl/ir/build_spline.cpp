// spline(): the segment, its four control points, and the curve through them; solve... the other way about.
#include "base/limits.h"
#include "rsl/ir/builder.h"

namespace alpenglow::rsl::ir {

namespace {
/// As the runtime spells it; an unknown name means linear.
std::string spelled(const std::string& basis) {
    if (basis == "catmull-rom" || basis == "catmullrom" || basis.empty()) return "catmullrom";
    if (basis == "b-spline") return "bspline";
    return basis == "bezier" || basis == "bspline" || basis == "hermite" ? basis : "linear";
}

int stepOf(const std::string& basis) { return basis == "bezier" ? 3 : basis == "hermite" ? 2 : 1; }

constexpr int kSelected = 8; ///< more segments than this are looked up in storage, fewer by selects
} // namespace

Inst* Builder::spline(const Expr& e) {
    const bool named = !e.args.empty() && e.args[0]->type.base == Base::String;
    Inst* name = named ? expr(*e.args[0]) : leaves_.string("");
    const size_t at = named ? 1 : 0;
    SplineCall c;
    c.value = expr(*e.args[at], Kind::Float);
    c.kind = kindOf(e.signature ? e.signature->result : e.type);
    c.base = e.signature ? e.signature->result.base : e.type.base;
    if (e.args.size() == at + 2 && e.args[at + 1]->type.array) {
        c.storage = array(*e.args[at + 1]);
        c.most = arrayLength(c.storage);
        c.length = lengthOf(c.storage);
        if (isConst(c.length)) c.most = std::min(c.most, static_cast<int>(c.length->numbers[0]));
    } else {
        for (size_t i = at + 1; i < e.args.size(); ++i) c.points.push_back(expr(*e.args[i], c.kind));
        c.most = static_cast<int>(c.points.size());
        c.length = constant(static_cast<float>(c.most));
    }
    place_ = e.place;
    const bool solved = name->op != Op::ConstString || name->text.rfind("solve", 0) == 0;
    const int limit = solved && c.kind == Kind::Float ? limits::kSolvedSplinePoints
                      : c.storage                     ? limits::kShaderArray
                                                      : limits::kSplinePoints;
    if (c.most > limit) {
        report(e.place, msg::kSplinePointsMost(c.most, limit));
        return zero(c.kind);
    }
    if (c.most < 4) {
        report(e.place, msg::kSplinePoints);
        return zero(c.kind);
    }
    if (name->op == Op::ConstString) {
        const bool solve = name->text.rfind("solve", 0) == 0;
        if (solve && c.kind != Kind::Float) return unavailable(e);
        return splineOf(c, spelled(solve ? name->text.substr(5) : name->text), solve);
    }
    // A name that is known when the shader runs: whichever it is.
    Inst* r = splineOf(c, "linear", false);
    for (const char* solve : {"", "solve"}) {
        if (*solve && c.kind != Kind::Float) break;
        for (const char* basis : {"", "catmull-rom", "catmullrom", "bezier", "bspline", "b-spline", "hermite", "linear"}) {
            const std::string text = std::string(solve) + basis;
            Inst* is = emit(Op::Equal, Kind::Bool, {name, leaves_.string(text)});
            r = branch(
                is, [&] { return std::vector<Inst*>{splineOf(c, spelled(basis), *solve != 0)}; },
                [&] { return std::vector<Inst*>{r}; })[0];
        }
    }
    return r;
}

Inst* Builder::splineOf(SplineCall c, const std::string& basis, bool solve) {
    const int step = stepOf(basis), most = (c.most - 4) / step + 1;
    const bool fixed = isConst(c.length);
    Inst* segments = constant(static_cast<float>(most)); // (n - 4) / step + 1
    if (!fixed) {
        Inst* steps =
            emit(Op::Div, Kind::Float, {emit(Op::Sub, Kind::Float, {c.length, constant(4)}), constant(static_cast<float>(step))});
        segments = runtime1("al_max_f",
                            {emit(Op::Add, Kind::Float, {runtime1("al_floor", {steps}, Kind::Float), constant(1)}), constant(1)},
                            Kind::Float);
    }
    const bool lookUp = !fixed || most > kSelected;
    if (lookUp && !c.storage) {
        c.storage = newArray(c.base, c.most);
        for (int i = 0; i < c.most; ++i)
            emit(Op::ArrayStore, Kind::None, {c.storage, constant(static_cast<float>(i)), c.points[static_cast<size_t>(i)]});
    }
    if (!lookUp && c.points.empty())
        for (int i = 0; i < c.most; ++i)
            c.points.push_back(emit(Op::ArrayLoad, c.storage->element, {c.storage, constant(static_cast<float>(i))}));
    const auto point = [&](int s, int j) { return c.points[static_cast<size_t>(s * step + j)]; };
    const auto pointAt = [&](Inst* s, int j) {
        if (lookUp) {
            Inst* index = emit(Op::Mul, Kind::Float, {s, constant(static_cast<float>(step))});
            return loadElement(c.storage, emit(Op::Add, Kind::Float, {index, constant(static_cast<float>(j))}));
        }
        Inst* p = point(most - 1, j);
        for (int k = most - 2; k >= 0; --k)
            p = emit(Op::Select, c.kind,
                     {emit(Op::Less, Kind::Bool, {s, constant(static_cast<float>(k) + 0.5f)}), point(k, j), p});
        return p;
    };
    const auto pointsAt = [&](Inst* first, Inst* s) {
        return std::vector<Inst*>{first, pointAt(s, 0), pointAt(s, 1), pointAt(s, 2), pointAt(s, 3)};
    };
    Inst* r = nullptr;
    if (solve) {
        Inst *v = c.value, *last = emit(Op::Sub, Kind::Float, {segments, constant(1)});
        const auto less = [&](Inst* a, Inst* b) { return emit(Op::LessEqual, Kind::Bool, {a, b}); };
        const auto value = [&](Inst* s, float t) {
            return runtime1("al_spline_" + basis + "_f", pointsAt(constant(t), s), Kind::Float);
        };
        const auto away = [&](Inst* end) { return runtime1("al_abs", {emit(Op::Sub, Kind::Float, {v, end})}, Kind::Float); };
        Inst* end =
            emit(Op::Select, Kind::Float, {less(away(value(constant(0), 0)), away(value(last, 1))), constant(0), constant(1)});
        Inst* found = constant(-1); // the first segment that takes the value
        for (int s = most - 1; s >= 0; --s) {
            Inst* segment = constant(static_cast<float>(s));
            Inst *a = value(segment, 0), *b = value(segment, 1);
            Inst* within =
                emit(Op::Or, Kind::Bool,
                     {emit(Op::And, Kind::Bool, {less(a, v), less(v, b)}), emit(Op::And, Kind::Bool, {less(b, v), less(v, a)})});
            if (!fixed) within = emit(Op::And, Kind::Bool, {within, less(segment, last)});
            found = emit(Op::Select, Kind::Float, {within, segment, found});
        }
        Inst* t = runtime1("al_splinesolve_" + basis, pointsAt(v, runtime1("al_max_f", {found, constant(0)}, Kind::Float)),
                           Kind::Float);
        Inst* x = emit(Op::Div, Kind::Float, {emit(Op::Add, Kind::Float, {found, t}), segments});
        r = emit(Op::Select, Kind::Float, {emit(Op::Less, Kind::Bool, {found, constant(0)}), end, x});
    } else {
        const std::vector<Inst*> st = runtime("al_splinesegment", {c.value, segments}, {Kind::Float, Kind::Float});
        r = runtime1("al_spline_" + basis + (c.kind == Kind::Float ? "_f" : "_t"), pointsAt(st[1], st[0]), c.kind);
    }
    if (fixed) return r;
    // The number of points is known at run time: too few give 0, as for constant numbers.
    return emit(Op::Select, c.kind, {emit(Op::Less, Kind::Bool, {c.length, constant(4)}), zero(c.kind), r});
}

} // namespace alpenglow::rsl::ir
