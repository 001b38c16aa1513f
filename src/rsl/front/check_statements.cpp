#include "base/printable.h"
#include "rsl/front/checker.h"
#include "rsl/front/clone.h"
#include "rsl/front/structs.h"
#include "rsl/front/visit.h"
#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace alpenglow::rsl::front {

/// One whole expression, of any type.
void Checker::whole(ExprPtr& e) {
    infos_.clear();
    infer(*e);
    const bool acts = e->kind == ExprKind::Assign || e->kind == ExprKind::ShadeopCall || e->kind == ExprKind::Method;
    if (!acts) refuseStructure(*e);
    resolveCheapest(e);
    infos_.clear();
}

bool Checker::isPossible(Symbol& s) {
    if (arrayPossible(structures_, s.type, s.place, sources_)) return true;
    s.type = {};
    return false;
}

void Checker::valueOf(ExprPtr& e, Type t) {
    infos_.clear();
    infer(*e);
    resolveTypes(e, t);
    infos_.clear();
}

void Checker::condition(ExprPtr& e) {
    infos_.clear();
    infer(*e);
    resolveCondition(e);
    infos_.clear();
}

namespace {

/// The value of a function that ends in its only return; null for others.
const Expr* onlyResult(const Function& f) {
    const Stmt* body = f.body.get();
    if (!body || body->body.empty() || !body->body.back() || body->body.back()->kind != StmtKind::Return) return nullptr;
    int returns = 0;
    everyStmt(*body, [&](const Stmt& s) { returns += s.kind == StmtKind::Return; }, [](const Expr&) {});
    return returns == 1 ? body->body.back()->value.get() : nullptr;
}

struct Known {
    struct Result {
        bool same = false;
        std::set<const Symbol*> needs; ///< if these parameters are the same, too
    };
    const std::set<const Symbol*>& unclassed;
    std::set<const Symbol*> met{};                 ///< of those, in the current expression
    std::map<const Function*, Result> functions{}; ///< that were examined: calls of calls would be examined many times
};

/// Is it the same for all points of a batch? That is what gridmin() and gridmax() give, what is made of it, and what functions
/// make of it. Of a parameter that is neither uniform nor varying each call decides.
bool sameForAll(const Expr& e, Known& known) {
    if (!e.varying) return true;
    if (e.shadeop) return e.shadeop->name == "gridmin" || e.shadeop->name == "gridmax";
    const auto all = [&] {
        return std::all_of(e.args.begin(), e.args.end(), [&](const ExprPtr& a) { return sameForAll(*a, known); });
    };
    switch (e.kind) {
    case ExprKind::Variable:
        return known.unclassed.count(e.symbol) > 0 && (known.met.insert(e.symbol), true);
    case ExprKind::Part: { // of a parameter that is neither uniform nor varying
        const Expr* root = &e;
        for (; root->kind == ExprKind::Part; root = root->args[0].get()) {}
        if (root->kind != ExprKind::Variable || !root->symbol || root->symbol->storage != Storage::Unspecified ||
            root->symbol->origin != Symbol::Origin::FunctionParameter)
            return false;
        known.met.insert(root->symbol);
        return true;
    }
    case ExprKind::Cast:
    case ExprKind::Unary:
    case ExprKind::Binary:
    case ExprKind::Conditional:
    case ExprKind::Tuple:
        return all();
    case ExprKind::FunctionCall: {
        if (!e.function) return false;
        auto answer = known.functions.find(e.function);
        if (answer == known.functions.end()) {
            const Expr* result = onlyResult(*e.function);
            auto outer = std::exchange(known.met, {});
            const bool same = result && sameForAll(*result, known);
            answer = known.functions.emplace(e.function, Known::Result{same, std::exchange(known.met, std::move(outer))}).first;
        }
        if (!answer->second.same) return false;
        const auto& parameters = e.function->parameters;
        for (size_t i = 0; i < std::min(e.args.size(), parameters.size()); ++i) // parameters of the class of their argument
            if ((parameters[i]->storage == Storage::Uniform || answer->second.needs.count(parameters[i])) &&
                !sameForAll(*e.args[i], known))
                return false;
        return true;
    }
    default:
        return false;
    }
}

} // namespace

void Checker::assignedToUniform(const Symbol& s, const Expr& value) {
    if (s.storage != Storage::Uniform || !value.varying || isStringLike(s.type.base)) return;
    if (value.kind == ExprKind::Variable && !value.symbol) return; // in the place of an error
    const Expr& whole = value.kind == ExprKind::Index ? *value.args[0] : value;
    if (whole.kind == ExprKind::Member || whole.kind == ExprKind::Method)
        return; // members of other shaders take the expected class
    if (Known known{unclassed_}; sameForAll(value, known)) return;
    sources_.report(value.place, msg::kVaryingToUniform(s.name));
}

/// The value of what has that type. A number for an array is one for each element.
void Checker::resolveInitial(ExprPtr& value, Type& type) {
    const Info& info = infos_.at(value.get());
    if (isStruct(type)) return resolveStructure(value, type);
    if (isStructure(info)) return resolveTypes(value, type); // reported
    if (type.array) preferArray(*value, type);
    if (type.array == -1 && info.listLength >= 0) type.array = std::max(1, info.listLength);
    if (type.array == -1 && info.array.array > 0) type.array = info.array.array;
    if (type.array == -1 && info.listLength < 0 && info.array.array == 0 && !info.any &&
        (value->kind == ExprKind::Number || value->kind == ExprKind::String))
        type.array = 1; // float a[] = 0: an array of one
    const bool scalar = type.array > 0 && info.listLength < 0 && info.array.array == 0 && !info.any;
    if (!scalar) return resolveTypes(value, type);
    // float a[42] = 0: {0, ...}.
    resolveTypes(value, type.element());
    auto list = std::make_unique<Expr>();
    list->kind = ExprKind::ArrayList;
    list->place = value->place;
    list->type = type;
    list->height = value->height + 1;
    list->varying = value->varying;
    list->text = "...";
    list->args.push_back(std::move(value));
    value = std::move(list);
}

/// `T x = value`, where x may be an array that takes its length from the value.
void Checker::initialise(Symbol& s, ExprPtr& value) {
    if (s.type.base == Base::Void) {
        value.reset();
        return;
    }
    if (s.origin == Symbol::Origin::ShaderParameter && s.type.array < 0) s.open = true;
    const int errors = sources_.errors();
    infos_.clear();
    infer(*value);
    resolveInitial(value, s.type);
    infos_.clear();
    if (sources_.errors() == errors && !isStruct(s.type)) assignedToUniform(s, *value); // of structures: each member, later
}

void Checker::checkDeclare(Stmt& s) {
    if (s.definition) {
        scopes_.back().functions.emplace(s.definition->name, s.definition);
        checking_.insert(s.definition);
        checkBody(*s.definition);
        checking_.erase(s.definition);
        return;
    }
    std::vector<Stmt::Declarator> kept;
    for (auto& d : s.declarators) {
        if (d.symbol->isExtern) {
            bindExtern(*d.symbol);
            continue;
        }
        Type& type = d.symbol->type;
        if (isStruct(type)) isPossible(*d.symbol);
        const bool open = type.array == -1 && type.base != Base::Void;
        if (!d.init && isStruct(type) && type.array >= 0 && structures_.hasDefaults(type))
            d.init = defaultOf(type, d.symbol->place);
        if (d.init) initialise(*d.symbol, d.init);
        if (open) {
            d.symbol->resizable = true;
            d.symbol->type.array = -1;
        }
        declareLocal(*d.symbol);
        if (d.symbol->type.base != Base::Void) kept.push_back(std::move(d));
    }
    s.declarators = std::move(kept);
}

void Checker::checkLoopBody(Stmt& s) {
    ++loops_;
    check(s.body[0]);
    --loops_;
}

void Checker::checkReturn(Stmt& s) {
    if (function_ && function_->result.base != Base::Void) {
        if (s.value) valueOf(s.value, function_->result);
        else sources_.report(s.place, msg::kReturnEmpty(function_->name, structures_.shown(function_->result)));
        return;
    }
    if (!s.value) return;
    whole(s.value);
    if (function_) sources_.report(s.value->place, msg::kVoidReturnValue(function_->name));
    else sources_.report(s.place, msg::kShaderReturnValue);
}

void Checker::check(StmtPtr& s) {
    if (!s) {
        s = std::make_unique<Stmt>();
        s->kind = StmtKind::Block;
        return;
    }
    switch (s->kind) {
    case StmtKind::Block:
        scopes_.emplace_back();
        for (auto& b : s->body) check(b);
        scopes_.pop_back();
        break;
    case StmtKind::Declare:
        checkDeclare(*s);
        break;
    case StmtKind::Expression:
        whole(s->value);
        if (s->value->kind != ExprKind::Assign && s->value->kind != ExprKind::ShadeopCall &&
            s->value->kind != ExprKind::FunctionCall && s->value->kind != ExprKind::Method && s->value->kind != ExprKind::Cast &&
            !(s->value->kind == ExprKind::Variable && !s->value->symbol) && s->value->type.base != Base::Void)
            sources_.report(s->place, msg::kNoEffect);
        break;
    case StmtKind::If:
        condition(s->condition);
        check(s->body[0]);
        if (s->elseBody) check(s->elseBody);
        break;
    case StmtKind::While:
        condition(s->condition);
        checkLoopBody(*s);
        break;
    case StmtKind::For:
        if (s->init) whole(s->init);
        if (s->condition) condition(s->condition);
        if (s->step) whole(s->step);
        checkLoopBody(*s);
        break;
    case StmtKind::Break:
    case StmtKind::Continue: {
        const char* word = s->kind == StmtKind::Break ? "break" : "continue";
        if (loops_ == 0) sources_.report(s->place, msg::kOutsideLoop(word));
        else if (s->levels > loops_)
            sources_.report(s->place, msg::kOutsideLoops(word, s->levels, counted(size_t(loops_), "loop")));
        break;
    }
    case StmtKind::Return:
        checkReturn(*s);
        break;
    case StmtKind::Illuminance:
    case StmtKind::Illuminate:
    case StmtKind::Solar:
    case StmtKind::Gather:
        checkLight(*s);
        break;
    }
}

/// A pair of illuminance or gather. A name that is no literal becomes a pair of its own; the kernel's builder looks what it says.
void Checker::statementPair(Stmt& s, ExprPtr token, ExprPtr value) {
    NamedArg pair;
    pair.place = token->place;
    pair.value = std::move(value);
    refuseStructure(*pair.value);
    const bool variable = isVariable(*pair.value), unknown = infos_.at(pair.value.get()).any;
    if (token->kind != ExprKind::String) {
        NamedArg naming;
        naming.named = NamedArg::Name::Made;
        naming.place = token->place;
        resolveTypes(token, {Base::String, 0});
        naming.value = std::move(token);
        s.pairs.push_back(std::move(naming));
        pair.named = NamedArg::Name::ByMade;
        pair.output = variable && !unknown;
    } else {
        pair.name = token->text;
        pair.output = pair.name.find(':') != std::string::npos && pair.name.rfind("send:", 0) != 0;
        if (pair.output && !variable && !unknown) sources_.report(pair.value->place, msg::kOutputPairValue(pair.name));
    }
    if (pair.output && variable) {
        resolveVariable(pair.value);
        if (pair.named == NamedArg::Name::Written) written(*pair.value);
    } else {
        resolveCheapest(pair.value);
    }
    s.pairs.push_back(std::move(pair));
}

namespace {

/// A statement about light: its name, the kinds of shaders that allow it, its arguments before the pairs.
struct LightForm {
    StmtKind kind;
    const char* name;
    uint32_t contexts;
    bool rays; ///< it takes a category and pairs
    std::vector<std::vector<Base>> forms;
    const char* text; ///< of the forms, for messages
};

const LightForm& lightForm(StmtKind kind) {
    static const std::vector<Base> kNothing, kPoint = {Base::Point}, kAxis = {Base::Vector, Base::Float},
                                             kCone = {Base::Point, Base::Vector, Base::Float},
                                             kRays = {Base::Point, Base::Vector, Base::Float, Base::Float};
    static const LightForm kForms[] = {
        {StmtKind::Illuminance,
         "illuminance",
         kSurface | kVolume,
         true,
         {kPoint, kCone},
         "illuminance([category,] P [, axis, angle] [, pairs])"},
        {StmtKind::Illuminate, "illuminate", kLight, false, {kPoint, kCone}, "illuminate(from [, axis, angle])"},
        {StmtKind::Solar, "solar", kLight, false, {kNothing, kAxis}, "solar() or solar(axis, angle)"},
        {StmtKind::Gather,
         "gather",
         kSurface | kVolume | kLight,
         true,
         {kRays},
         "gather(category, P, dir, angle, samples [, pairs]) statement [else statement]"}};
    return *std::ranges::find(kForms, kind, &LightForm::kind);
}

} // namespace

bool Checker::isGivenString(const std::vector<ExprPtr>& given, size_t i) const {
    return i < given.size() && infos_.at(given[i].get()).cost[int(Base::String)] < kNever;
}

/// The arguments of a statement before its pairs. Returns where the pairs begin.
size_t Checker::lightPositions(Stmt& s, std::vector<ExprPtr>& given) {
    const LightForm& form = lightForm(s.kind);
    size_t next = 0;
    if (form.rays && isGivenString(given, 0)) {
        resolveTypes(given[0], {Base::String, 0});
        s.category = std::move(given[next++]);
    } else if (s.kind == StmtKind::Gather) {
        sources_.report(s.place, msg::kGatherCategory);
    }
    size_t positions = 0;
    while (next + positions < given.size() && !isGivenString(given, next + positions)) ++positions;
    const bool rest = !form.rays && next + positions < given.size();
    const auto types = std::ranges::find(form.forms, positions, &std::vector<Base>::size);
    if (rest || types == form.forms.end()) {
        sources_.report(s.place, msg::kLightArguments(form.name), form.text);
        return given.size(); // one message for all of them
    }
    for (const Base b : *types) {
        resolveTypes(given[next], {b, 0});
        s.exprs.push_back(std::move(given[next++]));
    }
    return next;
}

void Checker::checkLight(Stmt& s) {
    const LightForm& form = lightForm(s.kind);
    const bool foreign = kind_ && !(form.contexts & contextOf(*kind_));
    if (foreign) sources_.report(s.place, msg::kWrongShaderKind(form.name, toString(*kind_)));
    std::vector<ExprPtr> given = std::move(s.exprs);
    s.exprs.clear();
    infos_.clear();
    for (auto& e : given) infer(*e);
    if (s.kind == StmtKind::Gather) gatherRegion(given);
    size_t next = lightPositions(s, given);
    // Pairs: the value behind "light:x" or "surface:x" is a variable to be filled; "send:..." goes the other way.
    while (next < given.size()) {
        ExprPtr token = std::move(given[next++]);
        if (!token) continue;
        if ((token->kind != ExprKind::String && !isText(*token)) || next == given.size()) {
            if (!infos_.at(token.get()).any) sources_.report(token->place, msg::kExpectedPair);
            break;
        }
        if (!given[next]) break;
        statementPair(s, std::move(token), std::move(given[next++]));
    }
    infos_.clear();
    const bool outerForeign = std::exchange(foreignLight_, foreignLight_ || foreign);
    checkLightBody(s);
    foreignLight_ = outerForeign;
    if (!s.elseBody) return;
    ++loops_; // it is a turn of the loop, too
    check(s.elseBody);
    --loops_;
}

void Checker::checkLightBody(Stmt& s) {
    scopes_.emplace_back();
    if (lightForm(s.kind).rays) checkLoopBody(s);
    else {
        // The block of a light is no loop: leaving one from inside it has no meaning.
        const int loops = std::exchange(loops_, 0);
        check(s.body[0]);
        loops_ = loops;
    }
    scopes_.pop_back();
}

bool Checker::endsInReturn(const Stmt& s) {
    switch (s.kind) {
    case StmtKind::Return:
        return true;
    case StmtKind::Block:
        for (const auto& b : s.body)
            if (b && endsInReturn(*b)) return true;
        return false;
    case StmtKind::If:
        return s.elseBody && s.body[0] && endsInReturn(*s.body[0]) && endsInReturn(*s.elseBody);
    default:
        return false;
    }
}

} // namespace alpenglow::rsl::front
