#include "walker_values.h"
#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

namespace alpenglow::rsl {
namespace {

using namespace walking;

constexpr int kMostSteps = 4000000;

struct Variable {
    Walked value;
    std::vector<Walked> elements; ///< of an array
    size_t reserved = 0;
};

enum class Flow { On, Break, Continue, Return };

class Walker {
public:
    Walker(const Shader& s, const WalkerInput& input, const WalkedLights& lights) : shader_(s), input_(input), lights_(lights) {}

    std::map<std::string, Walked> run() {
        for (const ShaderParameter& p : shader_.parameters) {
            Variable& v = fresh(p.symbol);
            if (p.symbol->type.array) v.elements = list(*p.defaultValue);
            else v.value = p.defaultValue ? converted(expr(*p.defaultValue), p.symbol->type.base) : zero(p.symbol->type.base);
        }
        statement(*shader_.body);
        std::map<std::string, Walked> out;
        for (const ShaderParameter& p : shader_.parameters)
            if (p.symbol->output) out[p.symbol->name] = variable(p.symbol).value;
        return out;
    }

private:
    const Shader& shader_;
    const WalkerInput& input_;
    const WalkedLights& lights_;
    const float* light_ = nullptr; ///< of the turn of illuminance
    std::map<const Symbol*, std::shared_ptr<Variable>> variables_;
    Walked result_;
    int levels_ = 0; ///< loops that a jump still has to leave
    int steps_ = 0;
    std::map<const Expr*, Walked> held_; ///< indices of places that are being read and written

    Variable& fresh(const Symbol* s) {
        auto v = std::make_shared<Variable>();
        v->value.base = s->type.base;
        if (s->type.array > 0) v->elements.assign(size_t(s->type.array), zero(s->type.base));
        return *(variables_[s] = v);
    }

    /// L, Cl and Ol are those of the turn, whatever stood there before.
    void beginTurn(const Symbol* s) {
        const int row = s->name == "L" ? 0 : s->name == "Cl" ? 3 : s->name == "Ol" ? 6 : -1;
        if (row < 0 || s->origin != Symbol::Origin::Global) return;
        if (!light_) unknown("a light");
        std::copy_n(light_ + row, 3, fresh(s).value.n.begin());
    }

    Variable& variable(const Symbol* s) {
        beginTurn(s);
        const auto it = variables_.find(s);
        if (it != variables_.end()) return *it->second;
        if (s->origin != Symbol::Origin::Global) unknown("a value of '" + s->name + "'");
        Variable& v = fresh(s);
        for (int c = 0; c < width(s->type.base); c++) v.value.n[size_t(c)] = input_(s->name, c);
        return v;
    }

    // ---- expressions

    Variable& arrayOf(const Expr& e) {
        if (e.kind == ExprKind::Cast) return arrayOf(*e.args[0]);
        if (e.kind != ExprKind::Variable) unknown("this array");
        return variable(e.symbol);
    }

    static bool variableGrows(const Expr& e) { return e.kind == ExprKind::Variable && e.symbol->type.array < 0; }

    std::vector<Walked> list(const Expr& e) {
        if (e.kind != ExprKind::ArrayList) return arrayOf(e).elements;
        std::vector<Walked> v;
        for (const ExprPtr& a : e.args) v.push_back(converted(expr(*a), e.type.base));
        if (e.type.array > int(v.size()))
            v.resize(size_t(e.type.array), e.text == "..." && !v.empty() ? v.back() : converted(Walked{}, e.type.base));
        return v;
    }

    void store(const Expr& l, const Walked& v) {
        if (l.kind == ExprKind::Cast) return store(*l.args[0], v);
        if (l.kind == ExprKind::Variable) {
            variable(l.symbol).value = converted(v, l.symbol->type.base);
            return;
        }
        if (l.kind != ExprKind::Index) unknown("this place to assign to");
        const float at = expr(*l.args[1]).n[0];
        if (l.args[0]->type.array) {
            Variable& a = arrayOf(*l.args[0]);
            a.elements[nearest(at, a.elements.size())] = converted(v, l.type.base);
        } else {
            Walked tuple = expr(*l.args[0]);
            tuple.n[nearest(at, 3)] = v.n[0];
            store(*l.args[0], tuple);
        }
    }

    /// While it lives the indices of a place, and of the same place written a second time, keep their values: they are computed
    /// once.
    struct Held {
        Walker& walker;
        std::vector<const Expr*> indices{};
        ~Held() {
            for (const Expr* e : indices) walker.held_.erase(e);
        }
        void hold(const Expr& place, const Expr* copy = nullptr) {
            if (place.kind != ExprKind::Index) return;
            hold(*place.args[0], copy ? copy->args[0].get() : nullptr);
            const Walked v = walker.expr(*place.args[1]);
            for (const Expr* index : {place.args[1].get(), copy ? copy->args[1].get() : nullptr})
                if (index && walker.held_.emplace(index, v).second) indices.push_back(index);
        }
    };

    Walked assignment(const Expr& e) {
        const Expr& l = *e.args[0];
        Held held{*this};
        if (e.text == "+=") held.hold(l, e.args[1]->args[0].get()); // of strings
        else if (e.op != ExprOp::Assign && e.op != ExprOp::None) held.hold(l);
        if (l.type.array) {
            std::vector<Walked> v = list(*e.args[1]);
            Variable& a = arrayOf(l);
            if (!variableGrows(l)) v.resize(a.elements.size(), zero(l.type.base));
            a.elements = v;
            a.reserved = std::max(a.reserved, v.size());
            return {};
        }
        Walked v;
        if (e.op == ExprOp::Assign || e.op == ExprOp::None) {
            v = expr(*e.args[1]);
        } else {
            const Walked old = expr(l), r = expr(*e.args[1]);
            const Base meet = width(old.base) >= width(r.base) ? old.base : r.base;
            v = binary(e.op, converted(old, meet), converted(r, meet));
        }
        v = converted(v, l.type.base);
        held.hold(l);
        store(l, v);
        return v;
    }

    Walked resizing(const Expr& e, const std::string& name) {
        Variable& a = arrayOf(*e.args[0]);
        const auto grown = [&] { a.reserved = std::max(a.reserved, a.elements.size()); };
        if (name == "arraylength") return number(float(a.elements.size()));
        if (name == "capacity") return number(float(std::max(a.reserved, a.elements.size())));
        if (name == "push") {
            const Walked v = converted(expr(*e.args[1]), e.args[0]->type.base);
            a.elements.push_back(v);
            grown();
            return {};
        }
        if (name == "pop") {
            if (a.elements.empty()) return zero(e.args[0]->type.base);
            const Walked v = a.elements.back();
            a.elements.pop_back();
            return v;
        }
        unknown(name);
    }

    Walked shadeop(const Expr& e) {
        const std::string& name = e.shadeop->name;
        if (name == "arraylength" || name == "capacity" || name == "push" || name == "pop") return resizing(e, name);
        std::vector<Walked> arguments;
        std::vector<std::pair<const Expr*, size_t>> outputs;
        Held held{*this};
        for (size_t i = 0; i < e.args.size(); i++) {
            const auto& p = e.signature->parameters[std::min(i, e.signature->parameters.size() - 1)];
            if (p.output) held.hold(*e.args[i]);
            if (p.output) outputs.push_back({e.args[i].get(), arguments.size()});
            if (e.args[i]->type.array) {
                const std::vector<Walked> all = list(*e.args[i]);
                arguments.insert(arguments.end(), all.begin(), all.end());
                continue;
            }
            const Walked v = expr(*e.args[i]);
            arguments.push_back(p.type.base == Base::Void ? v : converted(v, p.type.base));
        }
        const Walked r = walkShadeop(*e.shadeop, *e.signature, arguments);
        for (const auto& [place, at] : outputs) store(*place, arguments[at]);
        return r;
    }

    Walked call(const Expr& e) {
        const Function& f = *e.function;
        std::vector<std::shared_ptr<Variable>> given;
        Held held{*this};
        for (size_t i = 0; i < f.parameters.size(); i++) {
            const Symbol* p = f.parameters[i];
            auto v = std::make_shared<Variable>();
            if (p->output) held.hold(*e.args[i]);
            if (p->output && !p->type.array) { // when all arguments are known; the caller's own variable, or one element of it
                given.push_back(nullptr);
                continue;
            }
            if (!p->type.array) v->value = converted(expr(*e.args[i]), p->type.base);
            else if (e.args[i]->kind == ExprKind::ArrayList) v->elements = list(*e.args[i]);
            else if (p->output) arrayOf(*e.args[i]), v = variables_.at(e.args[i]->symbol); // the caller's own
            else *v = arrayOf(*e.args[i]);
            given.push_back(v);
        }
        for (size_t i = 0; i < f.parameters.size(); i++) {
            if (given[i]) continue;
            const Expr& a = *e.args[i];
            if (a.kind == ExprKind::Variable) variable(a.symbol), given[i] = variables_.at(a.symbol); // a point as a vector, too
            else given[i] = std::make_shared<Variable>(), given[i]->value = converted(expr(a), f.parameters[i]->type.base);
        }
        for (size_t i = 0; i < f.parameters.size(); i++) variables_[f.parameters[i]] = given[i];
        const Walked around = std::exchange(result_, zero(f.result.base));
        statement(*f.body);
        const Walked r = std::exchange(result_, around);
        for (size_t i = 0; i < f.parameters.size(); i++)
            if (f.parameters[i]->output && !f.parameters[i]->type.array && e.args[i]->kind != ExprKind::Variable)
                store(*e.args[i], given[i]->value);
        return r;
    }

    Walked expr(const Expr& e) {
        if (++steps_ > kMostSteps) throw std::runtime_error("too many steps");
        if (const auto known = held_.find(&e); known != held_.end()) return known->second;
        switch (e.kind) {
        case ExprKind::Number:
            return converted(number(float(e.number)), e.type.base);
        case ExprKind::String: {
            Walked w = zero(Base::String);
            w.s = e.text;
            return w;
        }
        case ExprKind::Variable:
            return variable(e.symbol).value;
        case ExprKind::Index: {
            if (e.args[0]->type.array) {
                const std::vector<Walked>& a = arrayOf(*e.args[0]).elements;
                return a[nearest(expr(*e.args[1]).n[0], a.size())];
            }
            const Walked v = expr(*e.args[0]);
            return number(v.n[nearest(expr(*e.args[1]).n[0], 3)]);
        }
        case ExprKind::Unary: {
            Walked v = expr(*e.args[0]);
            if (e.op == ExprOp::Not) return truth(v.n[0] == 0);
            for (int c = 0; c < width(v.base); c++) v.n[size_t(c)] = -v.n[size_t(c)];
            return v;
        }
        case ExprKind::Binary: {
            const Walked a = expr(*e.args[0]);
            if ((e.op == ExprOp::And && a.n[0] == 0) || (e.op == ExprOp::Or && a.n[0] != 0)) return truth(a.n[0] != 0); // as in C
            const Walked b = expr(*e.args[1]);
            Walked r = binary(e.op, a, b);
            if (e.type.base != Base::Bool && width(r.base) == width(e.type.base)) r.base = e.type.base;
            return r;
        }
        case ExprKind::Assign:
            return assignment(e);
        case ExprKind::Conditional:
            return converted(expr(expr(*e.args[0]).n[0] != 0 ? *e.args[1] : *e.args[2]), e.type.base);
        case ExprKind::Tuple:
        case ExprKind::MatrixTuple: {
            Walked w = zero(e.type.base);
            for (size_t c = 0; c < e.args.size(); c++) w.n[c] = expr(*e.args[c]).n[0];
            return e.space ? inSpace(*e.space, w) : w;
        }
        case ExprKind::Cast: {
            const Walked w = converted(expr(*e.args[0]), e.type.base);
            return e.space ? inSpace(*e.space, w) : w;
        }
        case ExprKind::ShadeopCall:
            return shadeop(e);
        case ExprKind::FunctionCall:
            if (e.shadeop && e.shadeop->name == "filterstep" && !e.pairs.empty()) unknown("filters that are known only now");
            return call(e);
        case ExprKind::Sequence: {
            Walked last;
            for (const ExprPtr& a : e.args) last = expr(*a);
            return last;
        }
        default:
            unknown("this expression");
        }
    }

    Walked inSpace(const Expr& name, const Walked& v) {
        const std::string s = expr(name).s;
        if (s == "current") return v;
        if (v.base != Base::Color) unknown("the space " + s);
        const Shadeop* op = findShadeop("ctransform");
        Walked from = zero(Base::String), to = zero(Base::String);
        from.s = s, to.s = "rgb";
        std::vector<Walked> arguments = {from, to, v};
        return walkShadeop(*op, op->signatures[1], arguments);
    }

    // ---- statements

    Flow jump(Flow f, int levels) {
        levels_ = std::max(1, levels);
        return f;
    }

    /// After a body: whether the loop goes on. `f` is what the loop itself then ends with.
    bool goesOn(Flow& f) {
        if (f == Flow::On) return true;
        if (f == Flow::Return) return false;
        if (--levels_ > 0) return false; // the loop around is meant
        const bool next = f == Flow::Continue;
        f = Flow::On;
        return next;
    }

    Flow loop(const Stmt& s, const Expr* step) {
        while (!s.condition || expr(*s.condition).n[0] != 0) {
            Flow f = s.body.empty() ? Flow::On : statement(*s.body[0]);
            if (!goesOn(f)) return f;
            if (step) expr(*step);
            if (++steps_ > kMostSteps) throw std::runtime_error("too many steps");
        }
        return Flow::On;
    }

    Flow illuminance(const Stmt& s) {
        if (lights_.all.empty() || s.category || !s.pairs.empty()) unknown("these lights");
        float axis[3] = {0, 0, 0}, angle = 4;
        if (s.exprs.size() == 3) {
            expr(*s.exprs[0]);
            const Walked a = expr(*s.exprs[1]);
            std::copy_n(a.n.begin(), 3, axis);
            angle = expr(*s.exprs[2]).n[0];
        }
        const float* around = light_;
        Flow f = Flow::On;
        for (const auto& l : lights_.all) {
            if (s.exprs.size() == 3 && !lights_.lit(l.data(), axis, angle)) continue;
            light_ = l.data();
            f = s.body.empty() ? Flow::On : statement(*s.body[0]);
            if (!goesOn(f)) break;
        }
        light_ = around;
        return f;
    }

    Flow statement(const Stmt& s) {
        switch (s.kind) {
        case StmtKind::Block:
            for (const StmtPtr& b : s.body)
                if (const Flow f = statement(*b); f != Flow::On) return f;
            return Flow::On;
        case StmtKind::Declare:
            for (const Stmt::Declarator& d : s.declarators) declare(d);
            return Flow::On;
        case StmtKind::Expression:
            if (s.value) expr(*s.value);
            return Flow::On;
        case StmtKind::If:
            if (expr(*s.condition).n[0] != 0) return s.body.empty() ? Flow::On : statement(*s.body[0]);
            return s.elseBody ? statement(*s.elseBody) : Flow::On;
        case StmtKind::While:
            return loop(s, nullptr);
        case StmtKind::For:
            if (s.init) expr(*s.init);
            return loop(s, s.step.get());
        case StmtKind::Break:
            return jump(Flow::Break, s.levels);
        case StmtKind::Continue:
            return jump(Flow::Continue, s.levels);
        case StmtKind::Return:
            if (s.value) result_ = converted(expr(*s.value), result_.base);
            return Flow::Return;
        case StmtKind::Illuminance:
            return illuminance(s);
        default:
            unknown("this statement");
        }
    }

    void declare(const Stmt::Declarator& d) {
        Walked v;
        std::vector<Walked> elements;
        const Type t = d.symbol->type;
        const bool spread = t.array && d.init && !d.init->type.array;
        if (d.init && t.array && !spread) elements = list(*d.init);
        else if (d.init) v = converted(expr(*d.init), t.base);
        Variable& to = fresh(d.symbol);
        if (t.array > 0) {
            elements.resize(size_t(t.array), spread ? v : zero(t.base));
            to.elements = elements;
        } else if (t.array) {
            to.elements = elements;
            to.reserved = elements.size();
        } else if (d.init) {
            to.value = v;
        }
    }
};

} // namespace

std::map<std::string, Walked> walk(const Shader& s, const WalkerInput& input, const WalkedLights& lights) {
    return Walker(s, input, lights).run();
}

} // namespace alpenglow::rsl
