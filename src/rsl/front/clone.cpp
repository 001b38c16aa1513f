#include "rsl/front/clone.h"
#include <unordered_map>

namespace alpenglow::rsl::front {

namespace {

struct Cloner {
    std::pair<std::string, std::string> rename;
    std::unordered_map<const Symbol*, Symbol*> symbols;
    std::unordered_map<const Function*, Function*> functions;
    std::vector<Expr*> calls; ///< copies that are bound to functions

    ExprPtr copy(const ExprPtr& e) { return e ? copy(*e) : nullptr; }
    ExprPtr copy(const Expr& e) {
        auto c = std::make_unique<Expr>();
        c->kind = e.kind;
        c->op = e.op;
        c->type = e.type;
        c->varying = e.varying;
        c->handle = e.handle;
        c->place = e.place;
        c->height = e.height;
        c->number = e.number;
        c->text = !rename.first.empty() && e.text == rename.first ? rename.second : e.text;
        const auto own = symbols.find(e.symbol);
        c->symbol = own == symbols.end() ? e.symbol : own->second;
        for (const auto& a : e.args) c->args.push_back(copy(a));
        c->space = copy(e.space);
        c->channel = copy(e.channel);
        copy(e.pairs, c->pairs);
        c->shadeop = e.shadeop;
        c->signature = e.signature;
        c->function = e.function;
        if (c->function) calls.push_back(c.get());
        return c;
    }
    void copy(const std::vector<NamedArg>& from, std::vector<NamedArg>& to) {
        for (const auto& p : from) to.push_back({p.name, copy(p.value), p.output, p.place, p.named});
    }
    StmtPtr copy(const StmtPtr& s) {
        if (!s) return nullptr;
        auto c = std::make_unique<Stmt>();
        c->kind = s->kind;
        c->place = s->place;
        for (const auto& b : s->body) c->body.push_back(copy(b));
        c->elseBody = copy(s->elseBody);
        c->condition = copy(s->condition);
        c->init = copy(s->init);
        c->step = copy(s->step);
        c->value = copy(s->value);
        c->levels = s->levels;
        for (const auto& d : s->declarators) c->declarators.push_back({symbols.at(d.symbol), copy(d.init)});
        for (const auto& e : s->exprs) c->exprs.push_back(copy(e));
        c->category = copy(s->category);
        copy(s->pairs, c->pairs);
        if (s->definition) c->definition = functions.at(s->definition);
        return c;
    }
    std::unique_ptr<Function> copy(const Function& f) {
        auto c = std::make_unique<Function>();
        c->name = f.name;
        c->result = f.result;
        c->anywhere = f.anywhere;
        c->place = f.place;
        copy(f.symbols, c->symbols);
        for (Symbol* p : f.parameters) c->parameters.push_back(symbols.at(p));
        for (const ExprPtr& d : f.defaults) c->defaults.push_back(copy(d));
        for (const auto& n : f.nested) {
            c->nested.push_back(copy(*n));
            functions[n.get()] = c->nested.back().get();
        }
        c->body = copy(f.body);
        return c;
    }
    void copy(const std::vector<std::unique_ptr<Symbol>>& from, std::vector<std::unique_ptr<Symbol>>& to) {
        for (const auto& s : from) {
            to.push_back(std::make_unique<Symbol>(*s));
            symbols[s.get()] = to.back().get();
        }
    }
    StructType copy(const StructType& s) {
        StructType c{s.name, {}, s.methods, s.base, s.text, s.place};
        for (const StructMember& m : s.members) c.members.push_back({m.name, m.type, m.storage, copy(m.init), m.place});
        return c;
    }
    /// A shader with its variables, without what is made of them.
    std::unique_ptr<Shader> head(const Shader& s) {
        auto n = std::make_unique<Shader>();
        n->kind = s.kind;
        n->object = s.object;
        n->publics = s.publics;
        n->name = s.name;
        n->place = s.place;
        n->annotations = s.annotations;
        copy(s.symbols, n->symbols);
        return n;
    }
    void rest(const Shader& s, Shader& n) {
        for (const auto& p : s.parameters) n.parameters.push_back({symbols.at(p.symbol), copy(p.defaultValue), p.defaultText});
        for (const auto& f : s.nested) {
            n.nested.push_back(copy(*f));
            functions[f.get()] = n.nested.back().get();
        }
        n.body = copy(s.body);
    }
};

} // namespace

std::unique_ptr<Shader> clone(const Shader& s) {
    Cloner c;
    auto n = c.head(s);
    c.rest(s, *n);
    return n;
}

std::unique_ptr<Program> clone(const Program& p) {
    Cloner c;
    auto n = std::make_unique<Program>();
    n->primitiveVariables = p.primitiveVariables;
    n->rispecSpecular = p.rispecSpecular;
    n->handles = p.handles;
    n->channels = p.channels;
    n->files = p.files;
    n->preprocessed = p.preprocessed;
    n->dependencies = p.dependencies;
    n->plugins = p.plugins;
    for (const auto& s : p.structs) n->structs.push_back(c.copy(s));
    for (const auto& s : p.shaders) n->shaders.push_back(c.head(*s)); // functions have variables of shaders in them
    for (const auto& f : p.functions) {
        n->functions.push_back(c.copy(*f));
        c.functions[f.get()] = n->functions.back().get();
    }
    for (size_t i = 0; i < p.shaders.size(); ++i) c.rest(*p.shaders[i], *n->shaders[i]);
    for (Expr* e : c.calls)
        if (const auto f = c.functions.find(e->function); f != c.functions.end()) e->function = f->second;
    return n;
}

std::unique_ptr<Function> clone(const Function& f, const std::pair<std::string, std::string>& rename) {
    Cloner c;
    c.rename = rename;
    return c.copy(f);
}

ExprPtr clone(const Expr& e) { return Cloner{}.copy(e); }

} // namespace alpenglow::rsl::front
