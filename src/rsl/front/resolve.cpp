// Top down: the cheapest reading becomes the tree, its conversions explicit nodes.
#include "rsl/front/checker.h"
#include "rsl/front/clone.h"
#include <algorithm>
#include <utility>

namespace alpenglow::rsl::front {

namespace {
constexpr Base kAllBases[] = {Base::Float,  Base::Color,  Base::Point,  Base::Vector, Base::Normal,
                              Base::Matrix, Base::String, Base::Shader, Base::Bool};
} // namespace

/// Type and children are known: `varying` follows from the children.
void Checker::finish(Expr& e) {
    e.varying = false;
    for (const auto& a : e.args) e.varying |= a->varying;
    if (e.space) e.varying |= e.space->varying;
}

void Checker::convert(ExprPtr& e, Type to) {
    if (e->type == to) return;
    auto c = std::make_unique<Expr>();
    c->kind = ExprKind::Cast;
    c->type = to;
    c->place = e->place;
    c->height = e->height + 1;
    c->varying = e->varying;
    c->args.push_back(std::move(e));
    e = std::move(c);
}

void Checker::resolveTypes(ExprPtr& e, Type want) {
    const Info& info = infos_.at(e.get());
    if (isStruct(want)) return resolveStructure(e, want);
    if (info.any || want.base == Base::Void) {
        resolveCheapest(e);
        if (want.base != Base::Void) e->type = want;
        return;
    }
    if (refuseStructure(*e)) {
        e->type = want;
        return;
    }
    if (want.array != 0) return resolveArray(e, want);
    if (info.array.array || info.listLength >= 0) {
        sources_.report(e->place, msg::kTypeMismatch(toString(want), describe(*e)));
        e->type = want;
        return;
    }
    Base best = Base::Void;
    int cost = kNever;
    for (Base b : kAllBases) {
        const int c = info.cost[int(b)] + implicitCost(b, want.base);
        if (c < cost) {
            cost = c;
            best = b;
        }
    }
    if (best == Base::Void) {
        std::string hint;
        if (want.base == Base::Float && Type{cheapest(info), 0}.isTuple()) hint = componentHint(cheapest(info));
        sources_.report(e->place, msg::kTypeMismatch(toString(want), describe(*e)), hint);
        e->type = want;
        return;
    }
    resolveAs(e, best);
    becomesTuple(info, *e, want.base);
    convert(e, want);
}

/// Notes that a call, float because of arithmetic with a number, becomes a tuple of three equal components.
void Checker::becomesTuple(const Info& info, const Expr& settled, Base wanted) {
    if (unit_ != &main_ || !info.number || settled.type != Type{Base::Float, 0} || !Type{wanted, 0}.isTuple()) return;
    const Place& p = info.number->place;
    madeNumbers_.emplace(std::array{p.file, p.line, p.column}, MadeNumber{info.number->text, wanted});
}

void Checker::warnOfNumbers() {
    for (const auto& [place, what] : madeNumbers_) {
        if (place[0] != 0) continue; // headers are others'
        const std::string type = toString(Type{what.wanted, 0});
        sources_.report({place[0], place[1], place[2]}, msg::kNumberCall(what.name, type),
                        "'" + type + " " + what.name + "(...)' has three of its own; 'float " + what.name +
                            "(...)' says that one is meant");
    }
}

void Checker::resolveCheapest(ExprPtr& e) {
    const Info& info = infos_.at(e.get());
    if (info.any) {
        // Children may hold what is worth a look (nothing is reported twice); types no longer matter.
        return;
    }
    if (isStructure(info)) return resolveStructure(e, structureOf(info));
    if (info.array.array) return resolveArray(e, info.array);
    if (info.listLength >= 0) {
        sources_.report(e->place, msg::kListPlace);
        return;
    }
    const Base b = cheapest(info);
    if (b == Base::Void && e->kind == ExprKind::ShadeopCall) return resolveCall(e, {Base::Void, 0});
    resolveAs(e, b);
}

/// What has elements: an array, or what can be a tuple as one, noise(P)[1] too.
void Checker::resolveIndexed(ExprPtr& e) {
    const Info& info = infos_.at(e.get());
    Base best = Base::Void;
    for (Base b : kAllBases)
        if (Type{b, 0}.isTuple() && info.cost[int(b)] < (best == Base::Void ? kNever : info.cost[int(best)])) best = b;
    if (info.any || info.array.array || info.listLength >= 0 || best == Base::Void || e->kind == ExprKind::Member)
        return resolveCheapest(e);
    resolveAs(e, best);
}

void Checker::resolveCondition(ExprPtr& e) {
    const Info& info = infos_.at(e.get());
    if (info.any || refuseStructure(*e)) {
        e->type = {Base::Bool, 0};
        return;
    }
    Base best = Base::Void;
    int cost = kNever;
    for (Base b : kAllBases) {
        const int c = info.cost[int(b)] + conditionCost(b);
        if (c < cost) {
            cost = c;
            best = b;
        }
    }
    if (best == Base::Void) {
        sources_.report(e->place, msg::kBadCondition(describe(*e)));
        e->type = {Base::Bool, 0};
        return;
    }
    resolveAs(e, best);
    if (best == Base::Bool) return;
    // A number is true when it is not zero.
    auto zero = std::make_unique<Expr>();
    zero->kind = ExprKind::Number;
    zero->type = {Base::Float, 0};
    zero->place = e->place;
    zero->varying = false;
    convert(zero, e->type);
    auto test = std::make_unique<Expr>();
    test->kind = ExprKind::Binary;
    test->op = ExprOp::NotEqual;
    test->type = {Base::Bool, 0};
    test->place = e->place;
    test->height = e->height + 1;
    test->args.push_back(std::move(e));
    test->args.push_back(std::move(zero));
    finish(*test);
    e = std::move(test);
}

void Checker::resolveArray(ExprPtr& e, Type want) {
    const Info& info = infos_.at(e.get());
    if (info.any) {
        e->type = want;
        return;
    }
    if (e->kind == ExprKind::ArrayList) {
        const int length = want.array > 0 ? want.array : std::max(1, info.listLength);
        if (int(e->args.size()) > length) {
            sources_.report(e->args[size_t(length)]->place, msg::kTooManyElements(e->args.size(), length));
            e->args.resize(size_t(length));
        }
        for (auto& a : e->args) resolveTypes(a, want.element());
        // The list keeps its written length. Missing elements are the last one again after "...", else zero.
        for (const auto& a : e->args) e->height = std::max(e->height, a->height + 1);
        e->type = {want.base, length};
        finish(*e);
        return;
    }
    if (e->kind == ExprKind::Member) {
        resolveAs(e, want.base);
        e->type = {want.base, -1};
        return;
    }
    const Type have = info.array;
    if (have.base != want.base || have.array == 0 || (want.array > 0 && have.array > 0 && have.array != want.array)) {
        sources_.report(e->place, msg::kTypeMismatchArray(toString(want), describe(*e)));
        e->type = want;
        return;
    }
    if (e->kind == ExprKind::Variable) {
        e->type = have;
        e->varying = e->symbol->storage != Storage::Uniform;
    } else if (e->kind == ExprKind::Part) {
        resolvePart(*e);
    } else if (e->kind == ExprKind::ShadeopCall) {
        resolveCall(e, want.array > 0 ? want : have);
    } else if (e->kind == ExprKind::Assign) {
        resolveAssign(e);
    } else if (e->kind == ExprKind::Cast) {
        ExprPtr inner = std::move(e->args[0]);
        resolveArray(inner, want);
        if (e->space) { // each element is in that space
            resolveTypes(e->space, {Base::String, 0});
            e->type = inner->type;
            e->args[0] = std::move(inner);
            finish(*e);
            return;
        }
        e = std::move(inner);
    }
}

/// An output argument keeps its own type.
void Checker::resolveVariable(ExprPtr& e) {
    const Info& info = infos_.at(e.get());
    if (info.any) return;
    if (isStructure(info)) return resolveStructure(e, structureOf(info));
    if (info.array.array) return resolveArray(e, info.array);
    resolveAs(e, cheapest(info));
}

/// A member or a method of another shader. Its arguments stay as they are: what it takes is known when that is bound.
void Checker::resolveHandle(ExprPtr& e, Base t) {
    resolveTypes(e->args[0], {Base::Shader, 0});
    for (size_t i = 1; i < e->args.size(); ++i) {
        if (isVariable(*e->args[i])) resolveVariable(e->args[i]);
        else resolveCheapest(e->args[i]);
    }
    e->type = {t, 0};
    e->varying = true;
    if (function_) varyingFunctions_.insert(function_);
    program_.handles = true;
}

void Checker::resolveCast(ExprPtr& e, Base t) {
    if (e->space) resolveTypes(e->space, {Base::String, 0});
    const Info& a = infos_.at(e->args[0].get());
    Base best = t;
    int cost = kNever;
    for (Base b : kAllBases) {
        const int c = a.cost[int(b)] + castCost(b, t);
        if (c < cost) {
            cost = c;
            best = b;
        }
    }
    resolveAs(e->args[0], best);
    becomesTuple(a, *e->args[0], t);
    Expr& inner = *e->args[0];
    if (e->space && (inner.kind == ExprKind::Tuple || inner.kind == ExprKind::MatrixTuple) && !inner.space)
        inner.space = std::move(e->space);
    if (e->space || inner.type != Type{t, 0}) {
        e->type = {t, 0};
        return finish(*e);
    }
    // Nothing to convert: the word chose the reading.
    ExprPtr value = std::move(e->args[0]);
    finish(*value);
    if (value->kind == ExprKind::ShadeopCall || value->kind == ExprKind::FunctionCall || value->kind == ExprKind::Variable)
        value->varying = value->varying || inner.varying;
    e = std::move(value);
}

/// What is varying where its parts are.
void Checker::resolveParts(ExprPtr& e, Base t) {
    switch (e->kind) {
    case ExprKind::Unary:
        if (e->op == ExprOp::Not) resolveCondition(e->args[0]);
        else resolveTypes(e->args[0], {t, 0});
        break;
    case ExprKind::Sequence:
        for (size_t i = 0; i + 1 < e->args.size(); ++i) resolveCheapest(e->args[i]);
        resolveAs(e->args.back(), t);
        e->type = e->args.back()->type;
        return finish(*e);
    case ExprKind::Conditional:
        resolveCondition(e->args[0]);
        // Truth values are no values: 0 and 1 where they meet as results.
        if (t == Base::Bool) t = Base::Float;
        resolveTypes(e->args[1], {t, 0});
        resolveTypes(e->args[2], {t, 0});
        break;
    default: // tuples
        for (auto& a : e->args) resolveTypes(a, {Base::Float, 0});
        break;
    }
    e->type = {t, 0};
    finish(*e);
}

void Checker::resolveAs(ExprPtr& e, Base t) {
    const Info& info = infos_.at(e.get());
    if (info.any) {
        e->type = {t, 0};
        return;
    }
    switch (e->kind) {
    case ExprKind::Number:
    case ExprKind::String:
        e->type = {t, 0};
        e->varying = false;
        return;
    case ExprKind::Variable:
        e->type = {t, 0};
        e->varying = e->symbol->storage != Storage::Uniform;
        if (e->varying && e->symbol->origin == Symbol::Origin::Global) readsPoint(*e, "'" + e->symbol->name + "'");
        return;
    case ExprKind::Index:
        if (info.channel) sources_.report(e->place, msg::kNoElementsOfString);
        resolveIndexed(e->args[0]);
        resolveTypes(e->args[1], {Base::Float, 0});
        e->type = {t, 0};
        finish(*e);
        if (e->args[0]->kind == ExprKind::Member) e->varying = true;
        return;
    case ExprKind::Member:
    case ExprKind::Method:
        return resolveHandle(e, t);
    case ExprKind::Part:
        return resolvePart(*e);
    case ExprKind::Binary:
        return resolveBinary(e, t);
    case ExprKind::Assign:
        return resolveAssign(e);
    case ExprKind::Cast:
        return resolveCast(e, t);
    case ExprKind::ShadeopCall:
        return resolveCall(e, {t, 0});
    case ExprKind::Unary:
    case ExprKind::Sequence:
    case ExprKind::Conditional:
    case ExprKind::Tuple:
    case ExprKind::MatrixTuple:
        return resolveParts(e, t);
    case ExprKind::ArrayList:
    case ExprKind::FunctionCall:
    case ExprKind::Construct:
        return;
    }
}

void Checker::resolveBinary(ExprPtr& e, Base t) {
    const Info& l = infos_.at(e->args[0].get());
    const Info& r = infos_.at(e->args[1].get());
    int cost = kNever;
    Base left = Base::Void, right = Base::Void;
    Operation best{};
    for (Base a : kAllBases)
        for (Base b : kAllBases) {
            if (l.cost[int(a)] >= kNever || r.cost[int(b)] >= kNever) continue;
            const auto o = operation(e->op, a, b);
            if (!o || o->result != t) continue;
            const int c = l.cost[int(a)] + r.cost[int(b)] + operandCost(e->op, *o, l, a, r, b);
            if (c < cost) {
                cost = c;
                left = a;
                right = b;
                best = *o;
            }
        }
    if (best.operand == Base::Bool) {
        resolveCondition(e->args[0]);
        resolveCondition(e->args[1]);
    } else {
        const bool scales = (e->op == ExprOp::Mul || e->op == ExprOp::Div) && isPointLike(best.operand);
        resolveAs(e->args[0], left);
        if (!scales) becomesTuple(l, *e->args[0], best.operand);
        convert(e->args[0], {best.operand, 0});
        resolveAs(e->args[1], right);
        if (!scales) becomesTuple(r, *e->args[1], best.operand);
        convert(e->args[1], {best.operand, 0});
    }
    e->type = {best.result, 0};
    finish(*e);
    if (best.result == Base::String) {
        // name + "": old shaders join strings so.
        if (e->args[1]->kind == ExprKind::String && e->args[0]->kind == ExprKind::String) {
            e->args[0]->text += e->args[1]->text;
            e = std::move(e->args[0]);
        } else if (e->args[1]->kind == ExprKind::String && e->args[1]->text.empty()) e = std::move(e->args[0]);
        else if (e->args[0]->kind == ExprKind::String && e->args[0]->text.empty()) e = std::move(e->args[1]);
        else if (const Shadeop* concat = findShadeop("concat"); concat && !concat->signatures.empty()) {
            e->kind = ExprKind::ShadeopCall;
            e->op = ExprOp::None;
            e->shadeop = concat;
            e->signature = &concat->signatures[0];
            e->text = "concat";
        }
    }
}

void Checker::resolveAssign(ExprPtr& e) {
    resolveVariable(e->args[0]);
    const Type target = e->args[0]->type;
    if (e->op == ExprOp::Add && target.base == Base::String && target.array == 0) {
        // a += "y": a = a + "y", which the builder of the IR knows by its text and names the place once.
        const Shadeop* concat = findShadeop("concat");
        resolveAs(e->args[1], Base::String);
        auto joined = std::make_unique<Expr>();
        joined->kind = ExprKind::ShadeopCall;
        joined->place = e->place;
        joined->type = target;
        joined->shadeop = concat;
        joined->signature = &concat->signatures[0];
        joined->text = "concat";
        joined->args.push_back(clone(*e->args[0]));
        joined->args.push_back(std::move(e->args[1]));
        finish(*joined);
        e->args[1] = std::move(joined);
        e->op = ExprOp::Assign;
        e->text = "+=";
    } else if (e->op == ExprOp::Assign || target.array != 0) {
        resolveTypes(e->args[1], target);
    } else {
        const Info& l = infos_.at(e->args[0].get());
        const Info& r = infos_.at(e->args[1].get());
        int cost = kNever;
        Base best = Base::Void, operand = target.base;
        for (Base b : kAllBases) {
            if (r.cost[int(b)] >= kNever) continue;
            const auto o = operation(e->op, target.base, b);
            if (!o || implicitCost(o->result, target.base) >= kNever) continue;
            const int c = r.cost[int(b)] + operandCost(e->op, *o, l, target.base, r, b) + implicitCost(o->result, target.base);
            if (c < cost) {
                cost = c;
                best = b;
                operand = o->operand;
            }
        }
        resolveAs(e->args[1], best);
        if (!isPointLike(target.base) || e->op == ExprOp::Add || e->op == ExprOp::Sub) becomesTuple(r, *e->args[1], target.base);
        convert(e->args[1],
                {operand == Base::Matrix || target.base == Base::Color || target.base == Base::Float ? operand : target.base, 0});
    }
    e->type = target;
    finish(*e);
    written(*e->args[0]);
    const Expr* root = e->args[0].get();
    while (root->kind == ExprKind::Index) root = root->args[0].get();
    if (root->symbol && root->symbol->origin != Symbol::Origin::Global) assignedToUniform(*root->symbol, *e->args[1]);
    if (root == e->args[0].get() && (root->symbol || root->kind == ExprKind::Part)) e->varying = e->args[1]->varying;
}

/// The function being checked needs a point that is shaded. construct() runs before there is any.
/// `differs`: from point to point of one batch too.
void Checker::readsPoint(const Expr& e, const std::string& what, bool differs) {
    if (function_ && differs) varyingFunctions_.insert(function_);
    if (inConstruct()) sources_.report(e.place, msg::kConstructVarying(what));
}

bool Checker::inConstruct() const { return shader_ && shader_->object && function_ && function_->name == "construct"; }

/// Something is stored in this variable: is that allowed?
void Checker::written(const Expr& variable) {
    const Expr* root = &variable;
    while (root->kind == ExprKind::Index || root->kind == ExprKind::Part || root->kind == ExprKind::Cast)
        root = root->args[0].get();
    const Symbol* s = root->symbol;
    if (!s) return;
    const std::string name = pathText(variable);
    const bool constructs = inConstruct();
    if (s->isConstant && s->origin == Symbol::Origin::Local && !constructs) {
        sources_.report(variable.place, msg::kConstantWritten(name),
                        shader_ && shader_->object ? "the members of a class that are constant get theirs in construct()" : "");
        return;
    }
    switch (s->origin) {
    case Symbol::Origin::Local:
        break;
    case Symbol::Origin::Global:
        if (s->writable || (foreignLight_ && (s->name == "Cl" || s->name == "Ol"))) break;
        // Old surfaces move P, as PRMan let them: the renderer displaces the primitive (world/displacement.cpp).
        if (kind_ == ShaderKind::Surface && s->name == "P") break;
        if (s->storage == Storage::Uniform) sources_.report(variable.place, msg::kReadOnly(name));
        else sources_.report(variable.place, kind_ ? msg::kReadOnlyCopyIn(name, toString(*kind_)) : msg::kReadOnlyCopy(name));
        break;
    case Symbol::Origin::ShaderParameter:
        if (!s->output && reportedNotOutput_.insert({s, name}).second) sources_.report(variable.place, msg::kNotOutput(name));
        break;
    case Symbol::Origin::FunctionParameter:
        if (!s->output && reportedNotOutput_.insert({s, name}).second)
            sources_.report(variable.place, msg::kNotOutputOfFunction(name));
        break;
    }
}

} // namespace alpenglow::rsl::front
