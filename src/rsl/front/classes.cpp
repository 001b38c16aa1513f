#include "rsl/front/classes.h"
#include "base/limits.h"
#include "base/printable.h"
#include "rsl/front/clone.h"
#include "rsl/front/nodes.h"
#include "rsl/front/visit.h"
#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <utility>

namespace alpenglow::rsl::front {

namespace {

/// A method that the renderer runs: the kind of shader, and the variables that it passes, in order.
struct Entry {
    ShaderKind kind;
    const char* name;
    std::vector<const char*> variables;
};

/// In the order in which they run.
const std::vector<Entry>& entries() {
    using K = ShaderKind;
    static const std::vector<Entry> all = {{K::Surface, "opacity", {"Oi"}},
                                           {K::Surface, "prelighting", {"Ci", "Oi"}},
                                           {K::Surface, "lighting", {"Ci", "Oi"}},
                                           {K::Surface, "diffuselighting", {"Ci", "Oi"}},
                                           {K::Surface, "specularlighting", {"Ci", "Oi"}},
                                           {K::Surface, "postlighting", {"Ci", "Oi"}},
                                           {K::Surface, "surface", {"Ci", "Oi"}},
                                           {K::Displacement, "displacement", {"P", "N"}},
                                           {K::Light, "light", {"L", "Cl", "Ol"}},
                                           {K::Volume, "volume", {"Ci", "Oi"}},
                                           {K::Imager, "imager", {"Ci", "Oi", "alpha"}}};
    return all;
}

using OfStatement = std::function<void(const Stmt&)>;
using OfExpression = std::function<void(const Expr&)>;

/// Calls `statement` and `expression` for all of a method, functions inside of it too.
void everyPart(const StmtPtr& body, const OfStatement& statement, const OfExpression& expression) {
    if (!body) return;
    const auto inside = [&](const Stmt& s) {
        statement(s);
        if (s.definition) everyPart(s.definition->body, statement, expression);
    };
    everyStmt(*body, inside, expression);
}

class Expansion {
public:
    Expansion(const ClassDefinition& c, Unit& u, SourceSet& s) : class_(c), unit_(u), sources_(s) {
        for (const auto& f : c.shader->nested) {
            const OfExpression call = [&](const Expr& e) {
                // surface("Kd", k) asks the shader of that kind, also where a method has the name.
                const bool asks = isEntry(e.text) && !e.args.empty() && e.args[0]->kind == ExprKind::String;
                if (e.kind == ExprKind::ShadeopCall && !asks) calls_[f->name].insert(e.text);
            };
            everyPart(f->body, [](const Stmt&) {}, call);
            names_.insert(f->name);
        }
    }

    void run() {
        for (const auto& f : class_.shader->nested)
            if (f->result.base != Base::Void && isEntry(f->name) && !isHalf(f->name))
                sources_.report(f->place, msg::kMethodResult(f->name));
        if (recursive()) return;
        std::vector<ShaderKind> kinds;
        for (const Entry& e : entries())
            if (runs(e) && std::find(kinds.begin(), kinds.end(), e.kind) == kinds.end()) kinds.push_back(e.kind);
        if (names_.count("surface"))
            for (const char* part : {"prelighting", "lighting", "postlighting"})
                if (names_.count(part) && !calls_["surface"].count(part) && !calls_["light"].count(part))
                    sources_.report(method(part)->place, msg::kMethodNotRun(part));
        if (kinds.empty()) kinds.push_back(ShaderKind::Surface); // a shader for other shaders
        for (ShaderKind k : kinds) unit_.shaders.push_back(shader(k, k == kinds[0]));
    }

private:
    const Function* method(const std::string& name) const {
        for (const auto& f : class_.shader->nested)
            if (f->name == name) return f.get();
        return nullptr;
    }

    /// Halves of the lighting of PRMan, for caches of what does not change with the view: they run where there is no lighting().
    static bool isHalf(const std::string& name) { return name == "diffuselighting" || name == "specularlighting"; }
    bool runs(const Entry& e) const {
        return names_.count(e.name) && !(isHalf(e.name) && (names_.count("lighting") || names_.count("surface")));
    }

    static bool isEntry(const std::string& name) {
        return std::any_of(entries().begin(), entries().end(), [&](const Entry& e) { return name == e.name; });
    }

    /// Methods may call methods that follow in the text, so recursion is detected here.
    bool recursive() {
        bool found = false;
        std::map<std::string, int> state, height;
        const std::function<void(const std::string&, int)> visit = [&](const std::string& name, int depth) {
            if (found || !names_.count(name) || state[name] == 2) return;
            if (state[name] == 1) {
                if (!found) sources_.report(method(name)->place, msg::kMethodRecursion(name));
                found = true;
                return;
            }
            state[name] = 1;
            int& tall = height[name];
            for (const auto& c : calls_[name]) {
                if (depth < limits::kCallDepth) visit(c, depth + 1);
                tall = std::max(tall, depth < limits::kCallDepth ? height[c] + 1 : limits::kCallDepth + 1);
            }
            if (!found && tall > limits::kCallDepth) {
                sources_.report(method(name)->place, msg::kMethodsTooDeep(limits::kCallDepth));
                found = true;
            }
            state[name] = 2;
            order_.push_back(name);
        };
        for (const auto& f : class_.shader->nested) visit(f->name, 0);
        return found;
    }

    std::set<std::string> reachable(ShaderKind kind) {
        std::set<std::string> all;
        const std::function<void(const std::string&)> visit = [&](const std::string& name) {
            if (!names_.count(name) || !all.insert(name).second) return;
            for (const auto& c : calls_[name]) visit(c);
        };
        visit("construct");
        visit("begin");
        for (const Entry& e : entries())
            if (e.kind == kind && runs(e)) visit(e.name);
        return all;
    }

    std::unique_ptr<Shader> shader(ShaderKind kind, bool first) {
        auto s = clone(*class_.shader);
        s->kind = kind;
        s->object = true;
        s->publics.insert(class_.publics.begin(), class_.publics.end());
        auto wanted = reachable(kind);
        // A method that no entry of any kind calls is checked with the first.
        if (first) {
            std::set<std::string> others = wanted;
            for (int k = 0; k < 6; ++k) others.merge(reachable(ShaderKind(k)));
            for (const auto& n : names_)
                if (!others.count(n)) wanted.insert(n);
            for (const auto& f : s->nested) f->anywhere = !others.count(f->name);
        }
        std::vector<StmtPtr> body, methods;
        for (auto& b : s->body->body) {
            if (!b->definition) body.push_back(std::move(b));
            else if (wanted.count(b->definition->name)) methods.push_back(std::move(b));
        }
        // Callees precede their callers.
        const auto rank = [&](const StmtPtr& m) {
            return std::find(order_.begin(), order_.end(), m->definition->name) - order_.begin();
        };
        std::stable_sort(methods.begin(), methods.end(), [&](const StmtPtr& a, const StmtPtr& b) { return rank(a) < rank(b); });
        for (auto& m : methods) body.push_back(std::move(m));
        s->body->body = std::move(body);
        for (const char* n : {"construct", "begin"})
            if (names_.count(n)) s->body->body.push_back(call(*s, n, {}));
        const bool whole = names_.count("surface") > 0;
        for (const Entry& e : entries()) {
            if (e.kind != kind || !runs(e)) continue;
            const std::string name = e.name;
            if (kind == ShaderKind::Surface && whole && name != "surface" && name != "opacity") continue;
            if (kind == ShaderKind::Light) light(*s);
            else s->body->body.push_back(call(*s, name, e.variables));
        }
        return s;
    }

    /// The renderer's own call of a method. Parameters that it does not know have their default values.
    StmtPtr call(Shader& s, const std::string& name, const std::vector<const char*>& variables) {
        const Function& f = *method(name);
        const auto optional = [&](size_t i) { return i < f.defaults.size() && f.defaults[i]; };
        // The third parameter of a light() for other shaders need not be Ol.
        size_t known = std::min(f.parameters.size(), variables.size());
        while (known > 0 && optional(known - 1)) --known;
        if (name == "light" && known == 3 && f.parameters[2]->type != Type{Base::Color, 0}) known = 2;
        auto e = node(ExprKind::ShadeopCall, f.place);
        e->text = name;
        auto locals = make(StmtKind::Declare, f.place);
        for (size_t i = 0; i < f.parameters.size(); ++i) {
            if (i < known) {
                adopt(*e, variable(variables[i], f.place));
                continue;
            }
            const Symbol& p = *f.parameters[i];
            const bool irradiance = isHalf(name) && i == 2; // Ii, which the renderer ignores
            if (!optional(i) && name != "light" && !irradiance) {
                sources_.report(f.place, msg::kMethodParameters(name, counted(variables.size(), "parameter")));
                return make(StmtKind::Block, f.place);
            }
            if (!optional(i) && !irradiance && locals->declarators.empty())
                sources_.report(p.place, msg::kNoDefault(p.name, !isStringLike(p.type.base)    ? "zero"
                                                                 : p.type.base == Base::Shader ? "null"
                                                                                               : "empty"));
            auto symbol = std::make_unique<Symbol>(p);
            symbol->name = "(" + name + ")->" + p.name;
            symbol->origin = Symbol::Origin::Local;
            symbol->output = false;
            locals->declarators.push_back({symbol.get(), optional(i) ? clone(*f.defaults[i]) : nullptr});
            adopt(*e, variable(symbol->name.c_str(), f.place));
            s.symbols.push_back(std::move(symbol));
        }
        if (!locals->declarators.empty()) s.body->body.push_back(std::move(locals));
        return front::run(std::move(e));
    }

    /// A method light() either has illuminate() or solar() like a light shader, or sets L itself.
    void light(Shader& s) {
        bool blocks = false;
        const OfStatement blocksOf = [&](const Stmt& x) {
            blocks |= x.kind == StmtKind::Illuminate || x.kind == StmtKind::Solar;
        };
        for (const auto& n : reachable(ShaderKind::Light)) everyPart(method(n)->body, blocksOf, [](const Expr&) {});
        const Function& written = *method("light");
        const Place place = written.place;
        if (blocks) {
            // Its parameters are the predefined variables that the blocks set.
            for (auto& f : s.nested) {
                if (f->name != "light") continue;
                std::vector<Symbol*> others;
                std::vector<ExprPtr> values;
                bool reported = false;
                for (size_t i = 0; i < f->parameters.size(); ++i) {
                    Symbol* p = f->parameters[i];
                    if (p->name == "L" || p->name == "Cl" || p->name == "Ol") continue;
                    others.push_back(p);
                    values.push_back(i < f->defaults.size() ? std::move(f->defaults[i]) : nullptr);
                    if (!values.back() && !std::exchange(reported, true)) sources_.report(p->place, msg::kLightMethodParameters);
                }
                f->parameters.clear();
                f->defaults.clear();
                if (others.empty()) continue;
                auto locals = make(StmtKind::Declare, others[0]->place); // that the body uses them is no other fault
                for (size_t i = 0; i < others.size(); ++i) locals->declarators.push_back({others[i], std::move(values[i])});
                f->body->body.insert(f->body->body.begin(), std::move(locals));
            }
            auto e = node(ExprKind::ShadeopCall, place);
            e->text = "light";
            s.body->body.push_back(front::run(std::move(e)));
            return;
        }
        const std::string names[] = {"(light)->L", "(light)->Cl", "(light)->Ol"};
        auto d = make(StmtKind::Declare, place);
        for (int i = 0; i < 3; ++i) {
            auto symbol = std::make_unique<Symbol>();
            symbol->name = names[i];
            symbol->type = {i ? Base::Color : Base::Vector, 0};
            symbol->place = place;
            auto zero = node(ExprKind::Number, place);
            zero->number = i == 2;
            d->declarators.push_back({symbol.get(), std::move(zero)});
            s.symbols.push_back(std::move(symbol));
        }
        s.body->body.push_back(std::move(d));
        s.body->body.push_back(call(s, "light", {names[0].c_str(), names[1].c_str(), names[2].c_str()}));
        const auto assign = [&](const char* to, const std::string& from) {
            auto a = node(ExprKind::Assign, place, ExprOp::Assign);
            adopt(*a, variable(to, place));
            adopt(*a, variable(from, place));
            return front::run(std::move(a));
        };
        auto block = make(StmtKind::Block, place);
        block->body.push_back(assign("Cl", names[1]));
        block->body.push_back(assign("Ol", names[2]));
        bool directed = false; // a light that never sets L is ambient
        const std::string L = written.parameters.empty() ? "L" : written.parameters[0]->name;
        const OfExpression sets = [&](const Expr& e) {
            if (e.kind == ExprKind::Assign && e.args[0]->kind == ExprKind::Variable && e.args[0]->text == L) directed = true;
            if (e.kind == ExprKind::ShadeopCall)
                for (const auto& a : e.args) directed |= a->kind == ExprKind::Variable && a->text == L && names_.count(e.text);
        };
        everyPart(written.body, [](const Stmt&) {}, sets);
        if (!directed) {
            s.body->body.push_back(std::move(block));
            return;
        }
        auto illuminate = make(StmtKind::Illuminate, place);
        auto from = node(ExprKind::Binary, place, ExprOp::Sub);
        adopt(*from, variable("Ps", place));
        adopt(*from, variable(names[0], place));
        illuminate->exprs.push_back(std::move(from));
        illuminate->body.push_back(std::move(block));
        s.body->body.push_back(std::move(illuminate));
    }

    const ClassDefinition& class_;
    Unit& unit_;
    SourceSet& sources_;
    std::map<std::string, std::set<std::string>> calls_;
    std::set<std::string> names_;
    std::vector<std::string> order_;
};

} // namespace

void expandClasses(Unit& u, SourceSet& s) {
    for (const auto& c : u.classes) Expansion(c, u, s).run();
}

} // namespace alpenglow::rsl::front
