// Statements, functions and shaders with structures in them.
#include "rsl/front/clone.h"
#include "rsl/front/structs_lowering.h"
#include "rsl/front/visit.h"
#include <utility>

namespace alpenglow::rsl::front {

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
        if (!isStruct(symbol.type)) {
            rewrite(d.init);
            scopes_.back()[symbol.name] = kNone;
            now->declarators.push_back(std::move(d));
            continue;
        }
        if (!now->declarators.empty()) out.push_back(std::exchange(now, fresh()));
        List pre, values;
        const Type type = symbol.type;
        if (d.init) {
            valueOf(std::move(d.init), type, pre, values);
        } else if (type.array >= 0 && hasDefaults(type) && !symbol.isExtern) {
            defaults(type, symbol.place, pre, values);
        }
        for (auto& x : *before_) out.push_back(std::move(x)); // what is computed first, between the variables
        before_->clear();
        flush(pre, out);
        const auto symbols = split(symbol);
        for (size_t i = 0; i < symbols.size(); ++i)
            now->declarators.push_back({symbols[i], i < values.size() ? whole(std::move(values[i])) : nullptr});
        if (!now->declarators.empty()) out.push_back(std::exchange(now, fresh()));
        scopes_.back()[symbol.name] = symbols.empty() && !leaves(type).empty() ? kNone : type; // some have methods only
    }
    if (!now->declarators.empty()) out.push_back(std::move(now));
}

void Lowering::expression(StmtPtr s, std::vector<StmtPtr>& out) {
    List pre;
    Expr& e = *s->value;
    methodCall(e);
    const bool call = e.kind == ExprKind::ShadeopCall;
    if (call && (e.text == "push" || e.text == "resize" || e.text == "reserve") && e.args.size() == 2 &&
        isStruct(typeOf(*e.args[0]))) {
        changeLength(e, pre);
    } else if (e.kind == ExprKind::Assign && isStruct(typeOf(e))) {
        assignTo(e, pre);
    } else if (call && isStruct(typeOf(e)) && structNamed(e.text) < 0) {
        List ignored;
        flatten(std::move(s->value), pre, ignored);
    } else {
        rewrite(s->value);
        if (s->value && s->value->kind == ExprKind::Sequence) { // one after the other
            for (auto& part : s->value->args) out.push_back(front::run(std::move(part)));
            return;
        }
        out.push_back(std::move(s));
        return;
    }
    flush(pre, out);
}

void Lowering::statement(StmtPtr s, std::vector<StmtPtr>& target) {
    if (!s) return;
    std::vector<StmtPtr> temporaries, out;
    auto* outer = std::exchange(before_, &temporaries);
    switch (s->kind) {
    case StmtKind::Block: {
        scopes_.emplace_back();
        std::vector<StmtPtr> all;
        for (auto& b : s->body) statement(std::move(b), all);
        s->body = std::move(all);
        scopes_.pop_back();
        out.push_back(std::move(s));
        break;
    }
    case StmtKind::Declare:
        declare(std::move(s), out);
        break;
    case StmtKind::Expression:
        expression(std::move(s), out);
        break;
    case StmtKind::Return: {
        if (isStruct(result_) && !s->value) sources_.report(s->place, msg::kReturnEmpty(function_, shown(result_)));
        if (!isStruct(result_) || !s->value) {
            rewrite(s->value);
            out.push_back(std::move(s));
            break;
        }
        List pre, values;
        const Place place = s->value->place;
        valueOf(std::move(s->value), result_, pre, values);
        for (size_t i = 0; i < values.size() && i < results_.size(); ++i)
            pre.push_back(assign(variable(results_[i]->name, place), whole(std::move(values[i])), place));
        flush(pre, out);
        s->value.reset();
        out.push_back(std::move(s));
        break;
    }
    default:
        if (s->kind == StmtKind::Gather) gatherRegion(*s);
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
    const std::string outer = std::exchange(function_, f.name);
    auto results = std::exchange(results_, {});
    scopes_.emplace_back();
    std::vector<Symbol*> parameters;
    std::vector<ExprPtr> given = std::move(f.defaults);
    f.defaults.clear();
    for (size_t i = 0; i < f.parameters.size(); ++i) {
        Symbol* p = f.parameters[i];
        scopes_.back()[p->name] = p->type;
        if (i < given.size() && given[i]) {
            f.defaults.resize(parameters.size() + 1);
            f.defaults.back() = std::move(given[i]);
        }
        if (!isStruct(p->type)) {
            scopes_.back()[p->name] = kNone;
            parameters.push_back(p);
            continue;
        }
        const size_t first = parameters.size();
        for (Symbol* part : split(*p)) parameters.push_back(part);
        if (first < parameters.size()) parameters[first]->whole = wholeOf(p->type, parameters.size() - first, p->name == "this");
    }
    if (isStruct(f.result)) {
        for (const Leaf& l : leaves(f.result)) {
            Symbol* r = newSymbol("(result)" + l.path, l.type, l.storage, f.place);
            r->origin = Symbol::Origin::FunctionParameter;
            r->output = true;
            results_.push_back(r);
            parameters.push_back(r);
        }
        if (!results_.empty()) results_[0]->whole = wholeOf(f.result, results_.size(), true);
        f.result = kNone;
    }
    f.parameters = std::move(parameters);
    body(f.body);
    if (f.body && f.body->kind != StmtKind::Block) {
        auto b = make(StmtKind::Block, f.place);
        b->body.push_back(std::move(f.body));
        f.body = std::move(b);
    }
    scopes_.pop_back();
    owner_ = owner;
    result_ = result;
    function_ = outer;
    results_ = std::move(results);
}

void Lowering::shader(Shader& s) {
    auto* owner = std::exchange(owner_, &s.symbols);
    scopes_.emplace_back();
    std::vector<ShaderParameter> parameters;
    std::vector<StmtPtr> temporaries;
    before_ = &temporaries;
    for (auto& p : s.parameters) {
        Symbol& symbol = *p.symbol;
        if (!isStruct(symbol.type)) {
            const Place place = p.defaultValue ? p.defaultValue->place : symbol.place;
            rewrite(p.defaultValue);
            if (!temporaries.empty()) {
                sources_.report(place, msg::kStructDefaultCall);
                p.defaultValue.reset();
                temporaries.clear();
            }
            scopes_.back()[symbol.name] = kNone;
            parameters.push_back(std::move(p));
            continue;
        }
        List pre, values;
        Place place = symbol.place;
        if (p.defaultValue) place = p.defaultValue->place;
        if (p.defaultValue) valueOf(std::move(p.defaultValue), symbol.type, pre, values);
        else if (!symbol.type.array) defaults(symbol.type, place, pre, values);
        if (!pre.empty() || !temporaries.empty()) {
            sources_.report(place, msg::kStructDefault);
            values.clear();
            temporaries.clear();
        }
        scopes_.back()[symbol.name] = symbol.type;
        const auto parts = split(symbol);
        for (size_t i = 0; i < parts.size(); ++i)
            parameters.push_back({parts[i], i < values.size() ? whole(std::move(values[i])) : nullptr, {}});
    }
    s.parameters = std::move(parameters);
    body(s.body);
    before_ = nullptr;
    scopes_.pop_back();
    owner_ = owner;
}

} // namespace alpenglow::rsl::front
