// Bottom up: which types can this expression have, and what would each cost?
#include "rsl/front/checker.h"
#include <algorithm>
#include <utility>

namespace alpenglow::rsl::front {

namespace {
constexpr Base kAll[] = {Base::Float,  Base::Color,  Base::Point,  Base::Vector, Base::Normal,
                         Base::Matrix, Base::String, Base::Shader, Base::Bool};
constexpr Base kTuples[] = {Base::Color, Base::Point, Base::Vector, Base::Normal};
int sum(int a, int b) { return std::min(a + b, kNever); }
} // namespace

Base Checker::cheapest(const Info& info) {
    Base best = Base::Void;
    int cost = info.cost[0];
    for (Base b : kAll)
        if (info.cost[int(b)] < cost) {
            cost = info.cost[int(b)];
            best = b;
        }
    return best;
}

int Checker::costTo(const Info& info, Base to) {
    if (info.any) return 0;
    int best = kNever;
    for (Base b : kAll) best = std::min(best, sum(info.cost[int(b)], implicitCost(b, to)));
    return best;
}

bool Checker::isVariable(const Expr& e) const {
    if (e.kind == ExprKind::Variable) return true;
    return (e.kind == ExprKind::Index || e.kind == ExprKind::Part) && !e.args.empty() && isVariable(*e.args[0]);
}

void Checker::poison(Expr&, Info& info) { info.any = true; }

/// The types of an expression, in words.
std::string Checker::describe(Expr& e) {
    const Info& info = infos_.at(&e);
    if (info.any) return "an error";
    if (isStructure(info)) return structures_.text(structureOf(info));
    if (info.array.array) return toString(info.array);
    if (info.listLength >= 0) return "an array of " + std::to_string(info.listLength);
    if (e.kind == ExprKind::Tuple) return "a triple";
    const Base b = cheapest(info);
    return b == Base::Bool ? "a truth value" : b == Base::Void ? "nothing" : toString(Type{b, 0});
}

std::string Checker::componentHint(Base b) {
    return std::string("a component is read by x[0] or ") + (b == Base::Color ? "comp(x, 0)" : "xcomp(x)");
}

void Checker::inferUnary(Expr& e, Info& info) {
    const Info& a = inferPlain(*e.args[0]);
    if (a.any) {
        info.any = true;
        return;
    }
    if (e.op == ExprOp::Not) {
        int c = kNever;
        for (Base b : kAll) c = std::min(c, sum(a.cost[int(b)], conditionCost(b)));
        info.cost[int(Base::Bool)] = c;
    } else {
        info.cost[int(Base::Float)] = std::min(a.cost[int(Base::Float)], sum(a.cost[int(Base::Bool)], 4));
        for (Base b : kTuples) info.cost[int(b)] = a.cost[int(b)];
        info.either = a.either;
        info.number = a.number;
    }
    if (cheapest(info) != Base::Void) return;
    sources_.report(e.place, msg::kBadOperand(spelling(e.op), describe(*e.args[0])));
    poison(e, info);
}

/// (a, b, c), or sixteen numbers of a matrix.
void Checker::inferTuple(Expr& e, Info& info) {
    int cost = 0;
    if (e.kind == ExprKind::Tuple && e.args.size() != 3) info.any = true; // the parser has reported it
    for (auto& a : e.args) {
        const Info& i = inferPlain(*a);
        const int c = costTo(i, Base::Float);
        if (c >= kNever) {
            sources_.report(a->place, msg::kBadComponent(describe(*a)));
            poison(e, info);
        }
        cost = sum(cost, c);
    }
    if (info.any) return;
    if (e.kind == ExprKind::MatrixTuple) info.cost[int(Base::Matrix)] = cost;
    else
        for (Base b : kTuples) info.cost[int(b)] = cost;
}

Checker::Info& Checker::infer(Expr& e) {
    Info& info = infos_[&e]; // references into the map stay valid
    info = Info();
    switch (e.kind) {
    case ExprKind::Number:
        info.cost[int(Base::Float)] = 0;
        break;
    case ExprKind::String:
        info.cost[int(e.handle ? Base::Shader : Base::String)] = 0;
        break;
    case ExprKind::Variable:
        inferVariable(e, info);
        break;
    case ExprKind::Index:
        inferIndex(e, info);
        break;
    case ExprKind::Unary:
        inferUnary(e, info);
        break;
    case ExprKind::Binary:
        inferBinary(e, info);
        break;
    case ExprKind::Assign:
        inferAssign(e, info);
        break;
    case ExprKind::Conditional:
        inferConditional(e, info);
        break;
    case ExprKind::Tuple:
    case ExprKind::MatrixTuple:
        inferTuple(e, info);
        break;
    case ExprKind::ArrayList:
        info.listLength = int(e.args.size());
        for (auto& a : e.args) infer(*a);
        break;
    case ExprKind::Cast:
        inferCast(e, info);
        break;
    case ExprKind::ShadeopCall:
        inferCall(e, info);
        break;
    case ExprKind::FunctionCall:
        info.any = true;
        break;
    case ExprKind::Sequence:
        for (auto& a : e.args) infer(*a);
        info = infos_.at(e.args.back().get());
        info.choices.clear();
        break;
    case ExprKind::Member:
    case ExprKind::Method:
    case ExprKind::Part:
        inferMember(e, info);
        break;
    case ExprKind::Construct:
        for (auto& a : e.args) infer(*a);
        info.structure = e.type.structure;
        break;
    }
    return info;
}

/// x->name, x->name(...) of a structure or of another shader.
void Checker::inferMember(Expr& e, Info& info) {
    const Info& left = infer(*e.args[0]);
    if (const Type s = structureOf(left); isStruct(s) && !left.any)
        return e.kind == ExprKind::Method ? inferMethod(e, s, info) : inferPart(e, s, info);
    for (size_t i = 1; i < e.args.size(); ++i) infer(*e.args[i]);
    for (auto& a : e.args) info.any |= infos_.at(a.get()).any;
    if (info.any) return;
    const Info& of = infos_.at(e.args[0].get());
    if (of.array.array || costTo(of, Base::Shader) >= kNever) {
        sources_.report(e.place, msg::kMemberOfNothing(describe(*e.args[0])));
        info.any = true;
        return;
    }
    info.ofHandle = true;
    // Its type is known when the shader is bound. Until then it has the expected type.
    for (Base b : kAll) info.cost[int(b)] = b == Base::Float ? 0 : b == Base::Bool ? kNever : 1;
}

void Checker::inferVariable(Expr& e, Info& info) {
    if (e.text.empty()) {
        info.any = true;
        return;
    }
    Symbol* s = e.symbol ? e.symbol : lookup(e.text);
    if (!s && e.text == "PI") {
        e.kind = ExprKind::Number;
        e.number = 3.14159265358979323846;
        info.cost[int(Base::Float)] = 0;
        return;
    }
    if (!s) s = tolerated(e);
    if (!s && e.text == "null") { // the handle of no shader
        e.kind = ExprKind::String;
        e.text.clear();
        e.handle = true;
        info.cost[int(Base::Shader)] = 0;
        return;
    }
    if (!s && (e.text == "surface" || e.text == "caller" || e.text == "light")) { // handles that RSL 2 has names for
        e.kind = ExprKind::String;
        e.text = "(" + e.text + ")";
        e.handle = true;
        program_.handles = true;
        info.cost[int(Base::Shader)] = 0;
        return;
    }
    if (!s) {
        unknownVariable(e);
        info.any = true;
        return;
    }
    e.symbol = s;
    if (s->type.base == Base::Void) info.any = true;
    else if (s->type.array != 0) info.array = s->type;
    else if (isStruct(s->type)) info.structure = s->type.structure;
    else info.cost[int(s->type.base)] = 0;
}

void Checker::inferIndex(Expr& e, Info& info) {
    const Info& base = infer(*e.args[0]);
    const Info& index = inferPlain(*e.args[1]);
    if (!base.array.array) refuseStructure(*e.args[0]);
    if (base.any || index.any) {
        info.any = true;
        return;
    }
    const bool ofHandle = e.args[0]->kind == ExprKind::Member; // an element or a component, of the expected type
    if (costTo(index, Base::Float) >= kNever) {
        sources_.report(e.args[1]->place, msg::kBadIndex(describe(*e.args[1])));
        info.any = true;
        return;
    }
    if (ofHandle) {
        info.cost = base.cost;
        return;
    }
    if (isStruct(base.array)) {
        info.structure = base.array.structure;
        return;
    }
    if (base.array.array) {
        info.cost[int(base.array.base)] = 0;
        if (isBounded(*e.args[0])) return;
        const Expr& i = *e.args[1];
        const Symbol* array = e.args[0]->symbol; // one of open length may be longer than its default
        if (i.kind == ExprKind::Number && base.array.array > 0 && !(array && array->open && i.number > -1) &&
            (i.number <= -1 || i.number >= base.array.array))
            sources_.report(i.place, msg::kIndexRange(int(std::clamp(i.number, -1e6, 1e6)), base.array.array));
        return;
    }
    int tuple = kNever;
    for (Base b : kTuples) tuple = std::min(tuple, base.cost[int(b)]);
    if (tuple < kNever) {
        info.cost[int(Base::Float)] = tuple;
        const Expr& i = *e.args[1];
        if (i.kind == ExprKind::Number && (i.number <= -1 || i.number >= 3)) sources_.report(i.place, msg::kComponentRange);
        return;
    }
    if (base.cost[int(Base::String)] < kNever) {
        info.cost[int(Base::String)] = base.cost[int(Base::String)];
        info.channel = true;
        return;
    }
    sources_.report(e.place, msg::kNoElements(describe(*e.args[0])),
                    cheapest(base) == Base::Matrix ? "comp(m, row, column) reads a matrix" : "");
    info.any = true;
}

bool Checker::isNumber(const Info& i) {
    if (i.number) return true;
    for (Base b : kAll)
        if (b != Base::Float && b != Base::Bool && i.cost[int(b)] < kNever) return false;
    return i.cost[int(Base::Float)] < kNever;
}

/// What it costs to read the operands `l` and `r` as `a` and `b`. What is wanted reaches through arithmetic: in a color .5 + .5 *
/// texture(m) is colored, so that what could be a tuple is no number next to one; numbers that are nothing else cost next to
/// nothing. But what is multiplied by a point, vector or normal scales it: P + noise(P) * N goes along N. docs/language.md has
/// the rule.
int Checker::operandCost(ExprOp op, const Operation& o, const Info& l, Base a, const Info& r, Base b) {
    const bool scales = op == ExprOp::Mul || op == ExprOp::Div;
    const auto canBe = [](const Info& i, Base as) {
        if (i.number) return as == Base::Float;
        return i.cost[int(as)] < kNever ||
               (isPointLike(as) && (i.cost[int(Base::Point)] < kNever || i.cost[int(Base::Vector)] < kNever));
    };
    const bool left = canBe(l, Base::Float), right = canBe(r, Base::Float);
    if (!o.promotes) return o.cost + (scales && isPointLike(a) && isPointLike(b) && left != right ? kBroadcast : 0);
    if (o.result == Base::Bool) return o.cost + kCompared;
    const bool leftIsNumber = !Type{a, 0}.isTuple();
    const bool other = leftIsNumber ? right : left; // may be a number, too
    const bool choice = canBe(leftIsNumber ? l : r, o.operand);
    return o.cost + (choice && (other || !scales || !isPointLike(o.operand)) ? kBroadcast : kPromotion);
}

void Checker::inferBinary(Expr& e, Info& info) {
    const Info& l = infer(*e.args[0]);
    if (e.op == ExprOp::Dot && isStructure(l)) { // what is right of it is no variable
        sources_.report(e.place, msg::kMemberDot);
        info.any = true;
        return;
    }
    const Info& r = infer(*e.args[1]);
    for (const auto& a : e.args) refuseStructure(*a);
    if (l.any || r.any) {
        info.any = true;
        return;
    }
    const bool arithmetic = e.op == ExprOp::Add || e.op == ExprOp::Sub || e.op == ExprOp::Mul || e.op == ExprOp::Div;
    if (arithmetic && isNumber(l) && isNumber(r)) info.number = l.number ? l.number : r.number;
    else if (arithmetic && isNumber(r)) info.number = l.either;
    else if (arithmetic && isNumber(l)) info.number = r.either;
    else if (arithmetic && l.either && r.either) info.either = l.either;
    for (Base a : kAll) {
        if (l.cost[int(a)] >= kNever) continue;
        for (Base b : kAll) {
            if (r.cost[int(b)] >= kNever) continue;
            if (const auto o = operation(e.op, a, b)) {
                int& c = info.cost[int(o->result)];
                // The cost of operands does not influence what surrounds a truth value.
                c = o->result == Base::Bool
                        ? 0
                        : std::min(c, sum(sum(l.cost[int(a)], r.cost[int(b)]), operandCost(e.op, *o, l, a, r, b)));
            }
        }
    }
    if (info.number)
        for (Base b : kTuples) info.cost[int(b)] = sum(info.cost[int(b)], kLastResort);
    if (cheapest(info) != Base::Void) return;
    std::string hint;
    const Base a = cheapest(l), b = cheapest(r);
    if (e.op == ExprOp::Mul && (a == Base::Matrix || b == Base::Matrix)) hint = "transform(m, p) multiplies a point by a matrix";
    else if ((a == Base::Color) != (b == Base::Color) && (Type{a, 0}.isTuple() && Type{b, 0}.isTuple()))
        hint = "a written conversion, as in color x, makes them alike";
    else if (e.op == ExprOp::Cross && (a == Base::Float || b == Base::Float))
        hint = "'^' is the cross product; pow(x, y) is the power";
    sources_.report(e.place, msg::kBadOperands(spelling(e.op), describe(*e.args[0]), describe(*e.args[1])), hint);
    poison(e, info);
}

void Checker::inferAssign(Expr& e, Info& info) {
    const Info& l = infer(*e.args[0]);
    const Info& r = infer(*e.args[1]);
    if (isStructure(l)) return inferStructureAssign(e, info);
    refuseStructure(*e.args[1]);
    if (!isVariable(*e.args[0])) {
        if (!l.any) sources_.report(e.place, msg::kNotAssignable);
        info.any = true;
        return;
    }
    if (l.any || r.any) {
        info.any = true;
        return;
    }
    if (l.array.array) {
        preferArray(*e.args[1], l.array);
        const bool fits = r.listLength >= 0 ? l.array.array < 0 || r.listLength <= l.array.array
                                            : r.array.base == l.array.base && r.array.array != 0 &&
                                                  (r.array.array == l.array.array || r.array.array < 0 || l.array.array < 0);
        if (!fits || e.op != ExprOp::Assign) {
            sources_.report(e.place, msg::kBadAssignment(describe(*e.args[1]), describe(*e.args[0])));
            info.any = true;
        } else info.array = l.array;
        return;
    }
    const Base target = cheapest(l);
    int cost = kNever;
    if (e.op == ExprOp::Assign) {
        cost = costTo(r, target);
    } else {
        for (Base b : kAll) {
            const auto o = r.cost[int(b)] < kNever ? operation(e.op, target, b) : std::nullopt;
            if (o && implicitCost(o->result, target) < kNever)
                cost = std::min(cost, r.cost[int(b)] + operandCost(e.op, *o, l, target, r, b) + implicitCost(o->result, target));
        }
    }
    if (cost >= kNever || l.channel) {
        const bool toFloat = target == Base::Float && Type{cheapest(r), 0}.isTuple();
        const std::string to = describe(*e.args[0]), from = describe(*e.args[1]);
        sources_.report(e.place,
                        e.op == ExprOp::Assign ? msg::kBadAssignment(from, to)
                                               : msg::kBadOperands(std::string(spelling(e.op)) + "=", to, from),
                        toFloat ? componentHint(cheapest(r)) : "");
        info.any = true;
        return;
    }
    info.cost[int(target)] = cost;
}

void Checker::inferConditional(Expr& e, Info& info) {
    const Info& c = inferPlain(*e.args[0]);
    const Info& a = infer(*e.args[1]);
    const Info& b = infer(*e.args[2]);
    int cost = kNever;
    for (Base t : kAll) cost = std::min(cost, sum(c.cost[int(t)], conditionCost(t)));
    if (!c.any && cost >= kNever) {
        sources_.report(e.args[0]->place, msg::kBadCondition(describe(*e.args[0])));
        info.any = true;
    }
    if (!isStructure(a)) refuseStructure(*e.args[2]);
    if (c.any || a.any || b.any) info.any = true;
    if (info.any) return;
    if (isStructure(a)) {
        info.structure = a.structure;
        info.array = a.array;
        return;
    }
    for (Base t : kAll)
        if (a.cost[int(t)] < kNever || b.cost[int(t)] < kNever) info.cost[int(t)] = sum(cost, sum(costTo(a, t), costTo(b, t)));
    if (isNumber(a) && isNumber(b)) info.number = a.number ? a.number : b.number;
    else if ((a.either || isNumber(a)) && (b.either || isNumber(b))) info.either = a.either ? a.either : b.either;
    if (cheapest(info) == Base::Void) {
        sources_.report(e.place, msg::kBadAlternatives(describe(*e.args[1]), describe(*e.args[2])));
        info.any = true;
    }
}

void Checker::inferCast(Expr& e, Info& info) {
    Expr& operand = *e.args[0];
    // point space (x, y, z) with the space in a variable reads like a call.
    if (!e.space && operand.kind == ExprKind::ShadeopCall && (operand.args.size() == 3 || operand.args.size() == 16)) {
        const Symbol* s = nullptr;
        for (size_t i = scopes_.size(); i-- > 0 && !s;)
            if (const auto f = scopes_[i].names.find(operand.text); f != scopes_[i].names.end()) s = f->second;
        if (s && storedType(s->type) == Type{Base::String, 0} && !findShadeop(operand.text)) {
            e.space = std::make_unique<Expr>();
            e.space->kind = ExprKind::Variable;
            e.space->text = operand.text;
            e.space->place = operand.place;
            operand.kind = operand.args.size() == 3 ? ExprKind::Tuple : ExprKind::MatrixTuple;
        }
    }
    if (e.space) {
        const Info& s = inferPlain(*e.space);
        if (!s.any && (costTo(s, Base::String) >= kNever)) {
            sources_.report(e.space->place, msg::kSpaceName);
            info.any = true;
        }
        if (!Type{e.type.base, 0}.isTuple() && e.type.base != Base::Matrix) {
            sources_.report(e.space->place, msg::kNoSpace(toString(e.type)));
            info.any = true;
        }
    }
    const Info& a = infer(operand);
    if (!isStruct(e.type)) refuseStructure(operand);
    if (a.any) {
        // The type is as written, whatever went wrong inside.
        if (e.type.array == 0 && !isStruct(e.type)) info.cost[int(e.type.base)] = 0;
        info.any = true;
        return;
    }
    if (isStruct(e.type)) {
        if (e.type.array) info.array = e.type;
        else info.structure = e.type.structure;
        return;
    }
    if (e.type.array != 0 || a.array.array != 0) {
        bool fits = a.array.base == e.type.base && a.array.array != 0 && e.type.array != 0;
        if (fits) info.array = a.array;
        else info.any = true;
        if (!fits) sources_.report(e.place, msg::kBadConversion(describe(operand), toString(e.type)));
        return;
    }
    int cost = kNever;
    for (Base b : kAll) cost = std::min(cost, sum(a.cost[int(b)], castCost(b, e.type.base)));
    if (cost >= kNever) {
        const bool toFloat = e.type.base == Base::Float && Type{cheapest(a), 0}.isTuple();
        sources_.report(e.place, msg::kBadConversion(describe(operand), toString(e.type)),
                        toFloat ? componentHint(cheapest(a)) : "");
        info.any = true;
        return;
    }
    info.cost[int(e.type.base)] = cost;
}

} // namespace alpenglow::rsl::front
