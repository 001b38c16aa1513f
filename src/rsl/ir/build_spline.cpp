// spline(): the segment, its four control points, and the curve through them; solve... the other way about.
#include "rsl/ir/builder.h"

namespace alpenglow::rsl::ir {

Inst* Builder::spline(const Expr& e) {
    size_t at = 0;
    std::string basis = "catmull-rom";
    if (!e.args.empty() && e.args[0]->type.base == Base::String) {
        Inst* b = expr(*e.args[0]);
        if (b->op == Op::ConstString) basis = b->text;
        else warn(e.place, "the basis of this spline is not known at compile time; catmull-rom is taken");
        at = 1;
    }
    const bool solve = basis.rfind("solve", 0) == 0;
    if (solve) basis = basis.substr(5);
    if (basis == "catmull-rom" || basis == "catmullrom" || basis.empty()) basis = "catmullrom";
    else if (basis == "b-spline") basis = "bspline";
    else if (basis != "bezier" && basis != "bspline" && basis != "hermite") basis = "linear";
    const int step = basis == "bezier" ? 3 : basis == "hermite" ? 2 : 1;
    Inst* v = expr(*e.args[at], Kind::Float);
    const Kind k = kindOf(e.signature ? e.signature->result : e.type);
    std::vector<Inst*> points;
    Inst* storage = nullptr;
    if (e.args.size() == at + 2 && e.args[at + 1]->type.array) {
        storage = array(*e.args[at + 1]);
        for (int i = 0; i < arrayLength(storage); ++i)
            points.push_back(emit(Op::ArrayLoad, storage->element, {storage, constant(static_cast<float>(i))}));
    } else {
        for (size_t i = at + 1; i < e.args.size(); ++i) points.push_back(expr(*e.args[i], k));
    }
    place_ = e.place;
    const int n = static_cast<int>(points.size());
    const int segments = (n - 4) / step + 1;
    if (n < 4 || segments < 1) {
        warn(e.place, "a spline needs at least four control points; this one is 0");
        return zero(k);
    }
    const auto point = [&](int s, int j) { return points[static_cast<size_t>(s * step + j)]; };
    const auto less = [&](Inst* a, Inst* b) { return emit(Op::LessEqual, Kind::Bool, {a, b}); };
    if (solve) {
        if (k != Kind::Float) return unavailable(e);
        const auto value = [&](int s, float t) {
            return runtime1("al_spline_" + basis + "_f", {constant(t), point(s, 0), point(s, 1), point(s, 2), point(s, 3)},
                            Kind::Float);
        };
        const auto away = [&](Inst* end) { return runtime1("al_abs", {emit(Op::Sub, Kind::Float, {v, end})}, Kind::Float); };
        Inst* r =
            emit(Op::Select, Kind::Float, {less(away(value(0, 0)), away(value(segments - 1, 1))), constant(0), constant(1)});
        for (int s = segments - 1; s >= 0; --s) {
            Inst *a = value(s, 0), *b = value(s, 1);
            Inst* up = emit(Op::And, Kind::Bool, {less(a, v), less(v, b)});
            Inst* down = emit(Op::And, Kind::Bool, {less(b, v), less(v, a)});
            Inst* t = runtime1("al_splinesolve_" + basis, {v, point(s, 0), point(s, 1), point(s, 2), point(s, 3)}, Kind::Float);
            Inst* x =
                emit(Op::Div, Kind::Float,
                     {emit(Op::Add, Kind::Float, {constant(static_cast<float>(s)), t}), constant(static_cast<float>(segments))});
            r = emit(Op::Select, Kind::Float, {emit(Op::Or, Kind::Bool, {up, down}), x, r});
        }
        return r;
    }
    const std::vector<Inst*> st =
        runtime("al_splinesegment", {v, constant(static_cast<float>(segments))}, {Kind::Float, Kind::Float});
    std::vector<Inst*> args = {st[1]};
    if (!storage && segments > 8) { // long lists by storage, short ones by selects
        storage = newArray(e.signature ? e.signature->result.base : e.type.base, n);
        for (int i = 0; i < n; ++i)
            emit(Op::ArrayStore, Kind::None, {storage, constant(static_cast<float>(i)), points[static_cast<size_t>(i)]});
    }
    for (int j = 0; j < 4; ++j) {
        if (storage && segments > 8) {
            Inst* index = emit(Op::Mul, Kind::Float, {st[0], constant(static_cast<float>(step))});
            args.push_back(emit(Op::ArrayLoad, storage->element,
                                {storage, emit(Op::Add, Kind::Float, {index, constant(static_cast<float>(j))})}));
            continue;
        }
        Inst* p = point(segments - 1, j);
        for (int s = segments - 2; s >= 0; --s)
            p = emit(Op::Select, k,
                     {emit(Op::Less, Kind::Bool, {st[0], constant(static_cast<float>(s) + 0.5f)}), point(s, j), p});
        args.push_back(p);
    }
    return runtime1("al_spline_" + basis + (k == Kind::Float ? "_f" : "_t"), args, k);
}

} // namespace alpenglow::rsl::ir
