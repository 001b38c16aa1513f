// Variables, statements, functions and shaders with structures in them.
#include "rsl/front/lower.h"
#include "rsl/front/clone.h"
#include "rsl/front/structs.h"
#include "rsl/front/visit.h"
#include <algorithm>
#include <utility>

namespace alpenglow::rsl::front {

const std::vector<Leaf>& Lowering::leaves(Type t) {
    const auto [at, fresh] = leaves_.try_emplace({t.structure, t.array});
    if (fresh) at->second = structures_.leaves(t);
    return at->second;
}

Symbol* Lowering::newSymbol(Owner& owner, const std::string& name, Type type, Storage storage, Place place) {
    auto s = std::make_unique<Symbol>();
    s->name = name;
    s->type = type;
    s->storage = storage;
    s->place = place;
    owner.push_back(std::move(s));
    return owner.back().get();
}

/// What was declared of a structure holds for each of its members.
void Lowering::splitAll(Owner& owner) {
    for (size_t i = 0, n = owner.size(); i < n; ++i) {
        Symbol& s = *owner[i];
        if (!isStruct(s.type)) continue;
        Symbols& parts = parts_[&s];
        for (const Leaf& l : leaves(s.type)) {
            Storage storage = s.storage == Storage::Unspecified ? l.storage : s.storage;
            const bool open = storage == Storage::Unspecified;
            if (open && s.origin == Symbol::Origin::ShaderParameter) storage = Storage::Uniform;
            else if (open) storage = isStringLike(l.type.base) ? Storage::Uniform : Storage::Varying;
            Symbol* part = newSymbol(owner, s.name + l.path, l.type, storage, s.place);
            part->origin = s.origin;
            part->output = s.output;
            part->isExtern = s.isExtern;
            part->isConstant = s.isConstant;
            part->resizable = s.origin == Symbol::Origin::Local && l.type.array == -1;
            members_.insert(part);
            if (open && storage == Storage::Varying && s.origin == Symbol::Origin::FunctionParameter)
                checker_.classOfArgument(*part);
            parts.push_back(part);
        }
    }
}

void Lowering::splitAll(Function& f) {
    splitAll(f.symbols);
    for (const Symbol* p : f.parameters) outputs_[&f].push_back(p->output);
    for (const auto& n : f.nested) splitAll(*n);
}

void Lowering::run() {
    for (const auto& f : program_.functions) splitAll(*f);
    for (const auto& s : program_.shaders) {
        splitAll(s->symbols);
        for (const auto& f : s->nested) splitAll(*f);
    }
    for (size_t i = 0, n = program_.functions.size(); i < n; ++i) function(*program_.functions[i]);
    for (const auto& s : program_.shaders) shader(*s);
    checkAll();
}

Lowering::Symbols Lowering::temporary(Type type, Place place) {
    const std::string name = "(structure " + std::to_string(++temporaries_) + ")";
    auto d = make(StmtKind::Declare, place);
    Symbols all;
    const auto one = [&](const std::string& path, Type t) {
        Symbol* s = newSymbol(*owner_, name + path, t, Storage::Varying, place);
        s->resizable = t.array < 0;
        d->declarators.push_back({s, nullptr});
        all.push_back(s);
    };
    if (isStruct(type))
        for (const Leaf& l : leaves(type)) one(l.path, l.type);
    else one("", type);
    if (!all.empty()) before_->push_back(std::move(d));
    return all;
}

void Lowering::spill(List& values, Type type, List& pre, Place place) {
    const Symbols t = temporary(type, place);
    for (size_t i = 0; i < values.size() && i < t.size(); ++i) {
        const bool varying = values[i]->varying;
        pre.push_back(assign(use(t[i], place), whole(std::move(values[i])), place));
        values[i] = use(t[i], place);
        values[i]->varying = varying;
    }
}

void Lowering::flush(List& pre, std::vector<StmtPtr>& out) {
    for (auto& p : pre) out.push_back(front::run(std::move(p)));
    pre.clear();
}

void Lowering::body(StmtPtr& s) {
    if (!s) return;
    std::vector<StmtPtr> all;
    const Place place = s->place;
    statement(std::move(s), all);
    if (all.size() == 1) {
        s = std::move(all[0]);
        return;
    }
    s = make(StmtKind::Block, place);
    s->body = std::move(all);
}

void Lowering::declare(StmtPtr s, std::vector<StmtPtr>& out) {
    if (s->definition) {
        function(*s->definition);
        out.push_back(std::move(s));
        return;
    }
    std::vector<Stmt::Declarator> given = std::move(s->declarators);
    const auto fresh = [&] { return make(StmtKind::Declare, s->place); };
    StmtPtr now = fresh();
    for (auto& d : given) {
        Symbol& symbol = *d.symbol;
        List pre, values;
        const bool structure = isStruct(symbol.type);
        if (!structure) {
            rewrite(d.init);
            unroll(d.init, pre);
            if (!pre.empty()) {
                if (!now->declarators.empty()) out.push_back(std::exchange(now, fresh()));
                for (auto& x : *before_) out.push_back(std::move(x));
                before_->clear();
                flush(pre, out);
            }
            now->declarators.push_back(std::move(d));
            continue;
        }
        if (!now->declarators.empty()) out.push_back(std::exchange(now, fresh()));
        if (d.init) valueOf(std::move(d.init), symbol.type, pre, values);
        for (auto& x : *before_) out.push_back(std::move(x)); // what is computed first, between the variables
        before_->clear();
        flush(pre, out);
        const Symbols& parts = parts_[&symbol];
        for (size_t i = 0; i < parts.size(); ++i)
            now->declarators.push_back({parts[i], i < values.size() ? whole(std::move(values[i])) : nullptr});
        if (!now->declarators.empty()) out.push_back(std::exchange(now, fresh()));
    }
    if (!now->declarators.empty()) out.push_back(std::move(now));
}

void Lowering::expression(StmtPtr s, std::vector<StmtPtr>& out) {
    List pre;
    Expr& e = *s->value;
    typedAssign(e);
    const bool structure = isStruct(e.type);
    if (e.kind == ExprKind::ShadeopCall && changeLength(e, pre)) {
        flush(pre, out);
    } else if (e.kind == ExprKind::Assign && structure) {
        assignTo(e, pre);
        flush(pre, out);
    } else if (structure) {
        List ignored;
        flatten(std::move(s->value), e.type, pre, ignored);
        flush(pre, out);
    } else {
        rewrite(s->value);
        if (s->value && s->value->kind == ExprKind::Sequence) { // one after the other
            for (auto& part : s->value->args) out.push_back(front::run(std::move(part)));
            return;
        }
        out.push_back(std::move(s));
    }
}

/// return: of a structure, its members go to the last parameters of the function.
void Lowering::result(StmtPtr s, std::vector<StmtPtr>& out) {
    List pre, values;
    if (!isStruct(result_) || !s->value) {
        rewrite(s->value);
        unroll(s->value, pre);
        flush(pre, out);
        out.push_back(std::move(s));
        return;
    }
    const Place place = s->value->place;
    valueOf(std::move(s->value), result_, pre, values);
    for (size_t i = 0; i < values.size() && i < results_.size(); ++i)
        pre.push_back(assign(use(results_[i], place), whole(std::move(values[i])), place));
    flush(pre, out);
    s->value.reset();
    out.push_back(std::move(s));
}

void Lowering::statement(StmtPtr s, std::vector<StmtPtr>& target) {
    if (!s) return;
    std::vector<StmtPtr> temporaries, out;
    auto* outer = std::exchange(before_, &temporaries);
    switch (s->kind) {
    case StmtKind::Block: {
        std::vector<StmtPtr> all;
        for (auto& b : s->body) statement(std::move(b), all);
        s->body = std::move(all);
        out.push_back(std::move(s));
        break;
    }
    case StmtKind::Declare:
        declare(std::move(s), out);
        break;
    case StmtKind::Expression:
        expression(std::move(s), out);
        break;
    case StmtKind::Return:
        result(std::move(s), out);
        break;
    default:
        eachSlot(*s, [&](ExprPtr& e) { rewrite(e); });
        for (auto& b : s->body) body(b);
        body(s->elseBody);
        out.push_back(std::move(s));
    }
    before_ = outer;
    for (auto& t : temporaries) target.push_back(std::move(t));
    for (auto& t : out) target.push_back(std::move(t));
}

void Lowering::function(Function& f) {
    auto* owner = std::exchange(owner_, &f.symbols);
    const Type result = std::exchange(result_, f.result);
    auto results = std::exchange(results_, {});
    std::vector<Symbol*> parameters;
    std::vector<ExprPtr> given = std::move(f.defaults);
    f.defaults.clear();
    for (size_t i = 0; i < f.parameters.size(); ++i) {
        Symbol* p = f.parameters[i];
        if (i < given.size() && given[i]) {
            f.defaults.resize(parameters.size() + 1);
            f.defaults.back() = std::move(defaultParts(std::move(given[i]), *p)[0]); // of no structure
        }
        if (!isStruct(p->type)) {
            parameters.push_back(p);
            continue;
        }
        const Symbols& parts = parts_[p];
        parameters.insert(parameters.end(), parts.begin(), parts.end());
    }
    if (isStruct(f.result)) {
        for (const Leaf& l : leaves(f.result)) {
            const Storage usual = isStringLike(l.type.base) ? Storage::Uniform : Storage::Varying;
            Symbol* r =
                newSymbol(f.symbols, "(result)" + l.path, l.type, l.storage == Storage::Unspecified ? usual : l.storage, f.place);
            r->origin = Symbol::Origin::FunctionParameter;
            r->output = true;
            results_.push_back(r);
            parameters.push_back(r);
        }
        f.result = kNone;
    }
    f.parameters = std::move(parameters);
    body(f.body);
    if (f.body && f.body->kind != StmtKind::Block) {
        auto b = make(StmtKind::Block, f.place);
        b->body.push_back(std::move(f.body));
        f.body = std::move(b);
    }
    owner_ = owner;
    result_ = result;
    results_ = std::move(results);
}

/// A call of a function that takes the steps of `steps` and gives the value: the default of a parameter is one expression.
ExprPtr Lowering::computed(Function& steps, ExprPtr value) {
    const Type type = value->type;
    const Place place = value->place;
    auto e = node(ExprKind::FunctionCall, place);
    e->type = type;
    e->varying = value->varying;
    auto give = make(StmtKind::Return, place);
    give->value = std::move(value);
    steps.result = type;
    steps.body->body.push_back(std::move(give));
    auto f = clone(steps, {});
    steps.body->body.pop_back();
    e->text = f->name;
    e->function = f.get();
    program_.functions.push_back(std::move(f));
    return e;
}

/// The default of a parameter, in its parts.
Lowering::List Lowering::defaultParts(ExprPtr value, const Symbol& parameter) {
    List values, pre;
    if (!value) return values;
    Function steps;
    steps.name = "(default of " + parameter.name + ")";
    steps.place = parameter.place;
    steps.body = make(StmtKind::Block, parameter.place);
    auto* owner = std::exchange(owner_, &steps.symbols);
    auto* before = std::exchange(before_, &steps.body->body);
    valueOf(std::move(value), parameter.type, pre, values);
    if (!isStruct(parameter.type) && values[0]->kind == ExprKind::Sequence) {
        ExprPtr last = std::move(values[0]->args.back());
        values[0]->args.pop_back();
        for (auto& first : values[0]->args) pre.push_back(std::move(first));
        values[0] = std::move(last);
    }
    owner_ = owner;
    before_ = before;
    flush(pre, steps.body->body);
    for (auto& v : values) {
        v = whole(std::move(v));
        if (!steps.body->body.empty()) v = computed(steps, std::move(v));
    }
    return values;
}

/// A parameter, or those that a structure becomes.
void Lowering::parameter(ShaderParameter p, std::vector<ShaderParameter>& out) {
    Symbol& symbol = *p.symbol;
    List values = defaultParts(std::move(p.defaultValue), symbol);
    if (!isStruct(symbol.type)) {
        if (!values.empty()) p.defaultValue = std::move(values[0]);
        out.push_back(std::move(p));
        return;
    }
    const Symbols& parts = parts_[&symbol];
    for (size_t i = 0; i < parts.size(); ++i) {
        ExprPtr value = i < values.size() ? std::move(values[i]) : nullptr;
        if (value && parts[i]->type.array < 0) { // as long as its default
            parts[i]->open = true;
            const bool list = value->kind == ExprKind::ArrayList;
            const int length = list ? std::max(1, int(value->args.size())) : value->type.array;
            if (length > 0) parts[i]->type.array = length;
        }
        out.push_back({parts[i], std::move(value), {}});
    }
}

void Lowering::shader(Shader& s) {
    auto* owner = std::exchange(owner_, &s.symbols);
    std::vector<ShaderParameter> parameters;
    for (auto& p : s.parameters) parameter(std::move(p), parameters);
    s.parameters = std::move(parameters);
    body(s.body);
    owner_ = owner;
}

/// An index that is a number, into members of an array of structures.
void Lowering::checkIndices(Expr& e) {
    eachSlot(e, [&](ExprPtr& x) { checkIndices(*x); });
    if (e.kind != ExprKind::Index || e.text != kElement) return;
    e.text.clear();
    const Expr &array = *e.args[0], &i = *e.args[1];
    const int n = array.type.array;
    if (i.kind == ExprKind::Number && n > 0 && !(array.symbol && array.symbol->open && i.number > -1) &&
        (i.number <= -1 || i.number >= n))
        sources_.report(i.place, msg::kIndexRange(int(std::clamp(i.number, -1e6, 1e6)), n));
}

namespace {
/// Calls f(Expr&) for the expressions of a statement and those below it.
template <class F> void everySlot(Stmt& s, const F& f) {
    eachSlot(s, [&](ExprPtr& e) { f(*e); });
    eachBody(s, [&](StmtPtr& b) { everySlot(*b, f); });
    if (s.definition && s.definition->body) everySlot(*s.definition->body, f);
}
} // namespace

/// What can be said of members only when they are variables.
void Lowering::checkAll() {
    const auto uniform = [&](const Symbol* s, const Expr& value) {
        if (s && members_.count(s)) checker_.assignedToUniform(*s, value);
    };
    const auto statement = [&](const Stmt& s) {
        for (const auto& d : s.declarators)
            if (d.init) uniform(d.symbol, *d.init);
    };
    const auto expression = [&](const Expr& e) {
        if (e.kind != ExprKind::Assign || e.args.size() != 2) return;
        const Expr* root = e.args[0].get();
        while (root->kind == ExprKind::Index) root = root->args[0].get();
        uniform(root->symbol, *e.args[1]);
    };
    everyBody(program_, [&](const Stmt& b) { everyStmt(b, statement, expression); });
    for (const auto& s : program_.shaders) {
        for (const auto& p : s->parameters)
            if (p.defaultValue) uniform(p.symbol, *p.defaultValue);
        if (s->body) everySlot(*s->body, [&](Expr& e) { checkIndices(e); });
    }
    for (const auto& f : program_.functions) {
        sources_.unused = checker_.isUncalled(*f);
        if (f->body) everySlot(*f->body, [&](Expr& e) { checkIndices(e); });
        sources_.unused = false;
    }
}

void lowerStructs(Program& p, SourceSet& s, Checker& c) {
    if (!p.structs.empty()) Lowering(p, s, c).run();
}

} // namespace alpenglow::rsl::front
