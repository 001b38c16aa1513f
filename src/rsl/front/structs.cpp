#include "rsl/front/structs.h"
#include "base/limits.h"
#include "rsl/front/clone.h"
#include "rsl/front/nodes.h"
#include "rsl/front/parser.h"
#include <algorithm>
#include <map>
#include <unordered_map>
#include <utility>

namespace alpenglow::rsl::front {

namespace {

const Type kNone{Base::Void, 0};

/// One plain member of a structure, members of members included.
struct Leaf {
    std::string path; ///< "->origin"
    Type type;
    Storage storage;
    const StructMember* member;
};

ExprPtr assign(ExprPtr left, ExprPtr right, Place place) {
    auto e = node(ExprKind::Assign, place, ExprOp::Assign);
    adopt(*e, std::move(left));
    adopt(*e, std::move(right));
    return e;
}

class Lowering {
public:
    Lowering(Unit& u, SourceSet& s) : unit_(u), sources_(s) {}

    void run() {
        for (size_t i = 0; i < unit_.structs.size(); ++i) checkType(i);
        for (const auto& f : unit_.functions) note(*f);
        for (const auto& s : unit_.shaders)
            for (const auto& f : s->nested) note(*f);
        for (const auto& c : unit_.classes)
            for (const auto& f : c.shader->nested) note(*f);
        for (auto& f : unit_.functions) function(*f);
        for (auto& s : unit_.shaders) shader(*s);
        for (auto& c : unit_.classes) shader(*c.shader);
    }

private:
    struct Result {
        Type type;
        size_t parameters;
    };
    using List = std::vector<ExprPtr>;

    /// Of anything else, after an error, a structure without members.
    const StructType& structOf(Type t) const {
        static const StructType none{};
        return isStruct(t) ? unit_.structs[size_t(int(t.base) - kFirstStruct)] : none;
    }
    std::string shown(Type t) const { return isStruct(t) ? "structure '" + structOf(t).name + "'" : toString(t); }

    /// A structure inside itself would have no end; members that are arrays of structures with arrays have no storage.
    void checkType(size_t index) {
        for (auto& m : unit_.structs[index].members) {
            if (!isStruct(m.type)) continue;
            const size_t inner = size_t(int(m.type.base) - kFirstStruct);
            if (inner >= index) { // the parser knows only earlier ones; it could be itself after a second definition
                sources_.error(m.place, "a structure cannot contain itself");
                m.type = {Base::Float, 0};
            } else if (m.type.array != 0 && hasArrays(m.type)) {
                sources_.error(m.place, "an array of structures with arrays in them is not available");
                m.type.array = 0;
            }
        }
    }

    bool hasArrays(Type t) const {
        for (const auto& m : structOf(t).members)
            if (m.type.array != 0 || (isStruct(m.type) && hasArrays(m.type))) return true;
        return false;
    }

    void note(const Function& f) {
        functions_.emplace(f.name, Result{f.result, f.parameters.size()});
        for (const auto& n : f.nested) note(*n);
    }

    std::vector<Leaf> leaves(Type t) const {
        std::vector<Leaf> all;
        for (const StructMember& m : structOf(t).members) {
            if (!isStruct(m.type)) {
                all.push_back({"->" + m.name, m.type, m.storage, &m});
                continue;
            }
            for (Leaf l : leaves({m.type.base, 0})) {
                l.path = "->" + m.name + l.path;
                if (m.type.array) l.type.array = m.type.array;
                if (l.storage == Storage::Unspecified) l.storage = m.storage;
                all.push_back(l);
            }
        }
        if (t.array)
            for (Leaf& l : all) l.type.array = t.array;
        return all;
    }

    const StructMember* member(Type t, const std::string& name) const {
        for (const StructMember& m : structOf(t).members)
            if (m.name == name) return &m;
        return nullptr;
    }

    int structNamed(const std::string& name) const {
        for (size_t i = 0; i < unit_.structs.size(); ++i)
            if (unit_.structs[i].name == name) return int(i);
        return -1;
    }

    /// The structure that an expression is, or void.
    Type typeOf(const Expr& e) const {
        switch (e.kind) {
        case ExprKind::Variable:
            for (size_t i = scopes_.size(); i-- > 0;)
                if (const auto s = scopes_[i].find(e.text); s != scopes_[i].end()) return s->second;
            return kNone;
        case ExprKind::Index: {
            Type t = typeOf(*e.args[0]);
            if (!isStruct(t) || t.array == 0) return kNone;
            return {t.base, 0};
        }
        case ExprKind::Member: {
            const Type t = typeOf(*e.args[0]);
            if (!isStruct(t) || t.array) return kNone;
            const StructMember* m = member(t, e.text);
            return m && isStruct(m->type) ? m->type : kNone;
        }
        case ExprKind::ShadeopCall: {
            if (const int i = structNamed(e.text); i >= 0) return {structBase(size_t(i)), 0};
            const auto [from, to] = functions_.equal_range(e.text);
            for (auto f = from; f != to; ++f)
                if (f->second.parameters == e.args.size() && isStruct(f->second.type)) return f->second.type;
            if (e.text == "pop" && e.args.size() == 1)
                if (const Type t = typeOf(*e.args[0]); isStruct(t) && t.array) return {t.base, 0};
            return kNone;
        }
        case ExprKind::Conditional: return typeOf(*e.args[1]);
        case ExprKind::Assign: return typeOf(*e.args[0]);
        case ExprKind::Cast: return isStruct(e.type) ? e.type : kNone;
        default: return kNone;
        }
    }

    Symbol* newSymbol(const std::string& name, Type type, Storage storage, Place place) {
        auto s = std::make_unique<Symbol>();
        s->name = name;
        s->type = type;
        s->storage = storage;
        s->place = place;
        owner_->push_back(std::move(s));
        return owner_->back().get();
    }

    /// The variables of one variable of a structure; all that was said about it holds for each.
    std::vector<Symbol*> split(const Symbol& s) {
        std::vector<Symbol*> all;
        if (s.type.array && hasArrays(s.type)) {
            sources_.error(s.place, "an array of structures with arrays in them is not available");
            return all;
        }
        for (const Leaf& l : leaves(s.type)) {
            Symbol* n = newSymbol(s.name + l.path, l.type, s.storage == Storage::Unspecified ? l.storage : s.storage, s.place);
            n->origin = s.origin;
            n->output = s.output;
            n->isExtern = s.isExtern;
            n->isConstant = s.isConstant;
            all.push_back(n);
        }
        return all;
    }

    /// A variable nobody can name; it is declared before the statement.
    std::string temporary(Type type, Place place, Storage storage = Storage::Varying) {
        const std::string name = "(structure " + std::to_string(++temporaries_) + ")";
        auto d = make(StmtKind::Declare, place);
        if (isStruct(type)) {
            for (const Leaf& l : leaves(type)) d->declarators.push_back({newSymbol(name + l.path, l.type, storage, place), nullptr});
        } else {
            d->declarators.push_back({newSymbol(name, type, storage, place), nullptr});
        }
        before_->push_back(std::move(d));
        return name;
    }

    void spill(List& values, Type type, List& pre, Place place) {
        const std::string t = temporary(type, place);
        const auto all = leaves(type);
        for (size_t i = 0; i < values.size() && i < all.size(); ++i) {
            pre.push_back(assign(variable(t + all[i].path, place), std::move(values[i]), place));
            values[i] = variable(t + all[i].path, place);
        }
    }

    ExprPtr zero(const Leaf& l, Place place) {
        ExprPtr z = node(l.type.base == Base::String ? ExprKind::String : ExprKind::Number, place);
        if (l.type.array == 0) return z;
        auto list = node(ExprKind::ArrayList, place);
        adopt(*list, std::move(z));
        return list;
    }

    /// Members that nobody gives a value.
    void defaults(Type t, Place place, List& pre, List& out) {
        for (const StructMember& m : structOf(t).members) {
            if (m.init) {
                ExprPtr e = clone(*m.init);
                valueOf(std::move(e), m.type, pre, out);
            } else if (isStruct(m.type) && m.type.array == 0) {
                defaults(m.type, place, pre, out);
            } else if (isStruct(m.type)) {
                for (const Leaf& l : leaves(m.type)) out.push_back(zero(l, place));
            } else {
                out.push_back(zero({"", m.type, m.storage, &m}, place));
            }
        }
    }

    bool hasDefaults(Type t) const {
        for (const StructMember& m : structOf(t).members)
            if (m.init || (isStruct(m.type) && hasDefaults(m.type))) return true;
        return false;
    }

    /// An expression for a variable of any type, in its parts.
    void valueOf(ExprPtr e, Type want, List& pre, List& out) {
        if (!isStruct(want)) {
            rewrite(e);
            out.push_back(std::move(e));
            return;
        }
        const size_t count = leaves(want).size();
        const Place place = e->place;
        if (want.array && e->kind == ExprKind::ArrayList) {
            std::vector<ExprPtr> lists;
            for (size_t i = 0; i < count; ++i) lists.push_back(node(ExprKind::ArrayList, place));
            for (auto& a : e->args) {
                List parts;
                valueOf(std::move(a), {want.base, 0}, pre, parts);
                for (size_t i = 0; i < count && i < parts.size(); ++i) adopt(*lists[i], std::move(parts[i]));
            }
            for (auto& l : lists) out.push_back(std::move(l));
            return;
        }
        if (!want.array && e->kind == ExprKind::ArrayList) { // {a, b}: like the constructor
            construct(want, *e, pre, out);
            return;
        }
        const Type have = typeOf(*e);
        const bool fits = have.base == want.base && (have.array != 0) == (want.array != 0) &&
                          (have.array == want.array || have.array < 0 || want.array < 0);
        if (!fits) {
            if (isStruct(have)) sources_.error(place, "expected " + shown(want) + ", not " + shown(have));
            else {
                const int errors = sources_.errors();
                rewrite(e);
                if (sources_.errors() == errors) sources_.error(place, "expected a value of " + shown(want));
            }
            for (size_t i = 0; i < count; ++i) out.push_back(variable("", place));
            return;
        }
        flatten(std::move(e), pre, out);
    }

    /// Name(a, b, ...) or {a, b, ...}.
    void construct(Type type, Expr& e, List& pre, List& out) {
        const StructType& s = structOf(type);
        if (e.args.size() > s.members.size())
            sources_.error(e.place, shown(type) + " has " + std::to_string(s.members.size()) + " members, not " +
                                        std::to_string(e.args.size()));
        List rest;
        defaults(type, e.place, pre, rest);
        size_t at = 0;
        for (size_t m = 0; m < s.members.size(); ++m) {
            const size_t parts = isStruct(s.members[m].type) ? leaves(s.members[m].type).size() : 1;
            if (m < e.args.size()) {
                valueOf(std::move(e.args[m]), s.members[m].type, pre, out);
            } else {
                for (size_t i = 0; i < parts && at + i < rest.size(); ++i) out.push_back(std::move(rest[at + i]));
            }
            at += parts;
        }
    }

    /// The parts of an expression that is a structure; what must happen before goes to `pre`.
    void flatten(ExprPtr e, List& pre, List& out) {
        const Type type = typeOf(*e);
        const Place place = e->place;
        if (!isStruct(type)) {
            if (sources_.errors() == 0) sources_.error(place, "expected a structure");
            return;
        }
        switch (e->kind) {
        case ExprKind::Variable:
            for (const Leaf& l : leaves(type)) out.push_back(variable(e->text + l.path, place));
            return;
        case ExprKind::Index: {
            List base;
            flatten(std::move(e->args[0]), pre, base);
            ExprPtr index = std::move(e->args[1]);
            rewrite(index);
            if (base.size() > 1 && index->kind != ExprKind::Number && index->kind != ExprKind::Variable) {
                const std::string t = temporary({Base::Float, 0}, place); // computed once
                pre.push_back(assign(variable(t, place), std::move(index), place));
                index = variable(t, place);
            }
            for (auto& b : base) {
                auto i = node(ExprKind::Index, place);
                adopt(*i, std::move(b));
                adopt(*i, clone(*index));
                out.push_back(std::move(i));
            }
            return;
        }
        case ExprKind::Member: return pick(*e, pre, out);
        case ExprKind::Cast: return flatten(std::move(e->args[0]), pre, out);
        case ExprKind::Conditional: {
            const std::string t = temporary({Base::Float, 0}, place);
            auto choose = node(ExprKind::Conditional, place);
            rewrite(e->args[0]);
            adopt(*choose, std::move(e->args[0]));
            for (double v : {1.0, 0.0}) {
                auto n = node(ExprKind::Number, place);
                n->number = v;
                adopt(*choose, std::move(n));
            }
            pre.push_back(assign(variable(t, place), std::move(choose), place));
            List yes, no;
            valueOf(std::move(e->args[1]), type, pre, yes);
            valueOf(std::move(e->args[2]), type, pre, no);
            for (size_t i = 0; i < yes.size() && i < no.size(); ++i) {
                auto c = node(ExprKind::Conditional, place);
                adopt(*c, variable(t, place));
                adopt(*c, std::move(yes[i]));
                adopt(*c, std::move(no[i]));
                out.push_back(std::move(c));
            }
            return;
        }
        case ExprKind::Assign: {
            List left, again;
            flatten(clone(*e->args[0]), pre, again);
            assignTo(*e, pre);
            for (auto& x : again) out.push_back(std::move(x));
            return;
        }
        case ExprKind::ShadeopCall: {
            if (structNamed(e->text) >= 0) return construct(type, *e, pre, out);
            if (e->text == "pop") {
                const std::string t = temporary(type, place);
                List arrays;
                flatten(std::move(e->args[0]), pre, arrays);
                const auto all = leaves(type);
                for (size_t i = 0; i < all.size() && i < arrays.size(); ++i) {
                    auto call = node(ExprKind::ShadeopCall, place);
                    call->text = "pop";
                    adopt(*call, std::move(arrays[i]));
                    pre.push_back(assign(variable(t + all[i].path, place), std::move(call), place));
                    out.push_back(variable(t + all[i].path, place));
                }
                return;
            }
            const std::string t = temporary(type, place);
            arguments(*e, pre);
            for (const Leaf& l : leaves(type)) {
                adopt(*e, variable(t + l.path, place));
                out.push_back(variable(t + l.path, place));
            }
            pre.push_back(std::move(e));
            return;
        }
        default:
            for (size_t i = 0; i < leaves(type).size(); ++i) out.push_back(variable("", place));
        }
    }

    /// The parts of a member.
    void pick(Expr& e, List& pre, List& out) {
        const Type type = typeOf(*e.args[0]);
        List base;
        flatten(std::move(e.args[0]), pre, base);
        size_t at = 0;
        for (const StructMember& m : structOf(type).members) {
            const size_t parts = isStruct(m.type) ? leaves(m.type).size() : 1;
            if (m.name == e.text)
                for (size_t i = 0; i < parts; ++i) out.push_back(at + i < base.size() ? std::move(base[at + i]) : variable("", e.place));
            at += parts;
        }
    }

    /// left = right, both structures.
    void assignTo(Expr& e, List& pre) {
        const Type type = typeOf(*e.args[0]);
        const Place place = e.place;
        if (e.op != ExprOp::Assign) {
            sources_.error(place, "structures can only be assigned");
            return;
        }
        const bool simple = path(*e.args[1]) || type.array || e.args[1]->kind == ExprKind::ArrayList;
        const bool list = e.args[1]->kind == ExprKind::ArrayList;
        List left, right;
        flatten(std::move(e.args[0]), pre, left);
        valueOf(std::move(e.args[1]), type, pre, right);
        if ((!simple || (list && !type.array)) && right.size() > 1) spill(right, type, pre, place); // a = S(a->y, a->x)
        for (size_t i = 0; i < left.size() && i < right.size(); ++i)
            pre.push_back(assign(std::move(left[i]), std::move(right[i]), place));
    }

    static bool path(const Expr& e) {
        if (e.kind == ExprKind::Variable) return true;
        return (e.kind == ExprKind::Index || e.kind == ExprKind::Member) && path(*e.args[0]);
    }

    void arguments(Expr& call, List& pre) {
        std::vector<ExprPtr> given = std::move(call.args);
        call.args.clear();
        for (auto& a : given) {
            if (!isStruct(typeOf(*a))) {
                rewrite(a);
                adopt(call, std::move(a));
                continue;
            }
            List parts;
            flatten(std::move(a), pre, parts);
            for (auto& p : parts) adopt(call, std::move(p));
        }
    }

    /// What must happen first, and then the expression, as one expression.
    void sequence(ExprPtr& e, List pre) {
        if (pre.empty()) return;
        auto all = node(ExprKind::Sequence, e->place);
        for (auto& p : pre) adopt(*all, std::move(p));
        adopt(*all, std::move(e));
        e = std::move(all);
    }

    /// An expression that is no structure itself.
    void rewrite(ExprPtr& e) {
        if (!e) return;
        if (const Type t = typeOf(*e); isStruct(t)) {
            sources_.error(e->place, shown(t) + " cannot be used here", "a member is read by '->'");
            e = variable("", e->place);
            return;
        }
        List pre;
        if (e->kind == ExprKind::Binary && e->op == ExprOp::Dot && isStruct(typeOf(*e->args[0]))) {
            sources_.error(e->place, "'.' is the dot product", "a member of a structure is read by '->'");
            e = variable("", e->place);
            return;
        }
        if (e->kind == ExprKind::Member) {
            const Type t = typeOf(*e->args[0]);
            if (isStruct(t)) {
                const StructMember* m = t.array ? nullptr : member(t, e->text);
                if (!m) {
                    std::vector<std::string> names;
                    for (const StructMember& x : structOf(t).members) names.push_back(x.name);
                    const std::string near = nearestName(e->text, names);
                    if (t.array) sources_.error(e->place, "this is an array of " + shown(t), "its elements have members: a[i]->" + e->text);
                    else
                        sources_.error(e->place, shown(t) + " has no member '" + e->text + "'",
                                       near.empty() ? "" : "did you mean '" + near + "'?");
                    e = variable("", e->place);
                    return;
                }
                const bool array = m->type.array != 0;
                List out;
                const Place place = e->place;
                pick(*e, pre, out);
                e = std::move(out[0]);
                if (array && !pre.empty()) sources_.error(place, "an array in the result of a call must be stored in a variable first");
                sequence(e, std::move(pre));
                return;
            }
        }
        if (e->kind == ExprKind::ShadeopCall) {
            const bool sizes = e->text == "arraylength" || e->text == "capacity";
            if (sizes && e->args.size() == 1 && isStruct(typeOf(*e->args[0]))) {
                List parts;
                flatten(std::move(e->args[0]), pre, parts);
                e->args[0] = parts.empty() ? variable("", e->place) : std::move(parts[0]);
                sequence(e, std::move(pre));
                return;
            }
            arguments(*e, pre);
        } else {
            for (auto& a : e->args) {
                if (e->kind == ExprKind::Method && isStruct(typeOf(*a))) continue;
                rewrite(a);
            }
        }
        rewrite(e->space);
        rewrite(e->channel);
        for (auto& p : e->pairs) rewrite(p.value);
        for (const auto& a : e->args)
            if (a) e->height = std::max(e->height, a->height + 1);
        sequence(e, std::move(pre));
    }

    // ---- statements

    static void flush(List& pre, std::vector<StmtPtr>& out) {
        for (auto& p : pre) out.push_back(front::run(std::move(p)));
        pre.clear();
    }

    void body(StmtPtr& s) {
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

    void declare(StmtPtr s, std::vector<StmtPtr>& out) {
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
            } else if (!type.array && hasDefaults(type) && !symbol.isExtern) {
                defaults(type, symbol.place, pre, values);
            }
            for (auto& x : *before_) out.push_back(std::move(x)); // what is computed first, between the variables
            before_->clear();
            flush(pre, out);
            const auto symbols = split(symbol);
            for (size_t i = 0; i < symbols.size(); ++i)
                now->declarators.push_back({symbols[i], i < values.size() ? std::move(values[i]) : nullptr});
            if (!now->declarators.empty()) out.push_back(std::exchange(now, fresh()));
            scopes_.back()[symbol.name] = symbols.empty() ? kNone : type;
        }
        if (!now->declarators.empty()) out.push_back(std::move(now));
    }

    void expression(StmtPtr s, std::vector<StmtPtr>& out) {
        List pre;
        Expr& e = *s->value;
        const bool call = e.kind == ExprKind::ShadeopCall;
        if (call && (e.text == "push" || e.text == "resize" || e.text == "reserve") && e.args.size() == 2 &&
            isStruct(typeOf(*e.args[0]))) {
            const Type t = typeOf(*e.args[0]);
            List arrays, values;
            flatten(std::move(e.args[0]), pre, arrays);
            if (e.text == "push") valueOf(std::move(e.args[1]), {t.base, 0}, pre, values);
            else rewrite(e.args[1]);
            for (size_t i = 0; i < arrays.size() && (e.text != "push" || i < values.size()); ++i) {
                auto one = node(ExprKind::ShadeopCall, e.place);
                one->text = e.text;
                adopt(*one, std::move(arrays[i]));
                adopt(*one, e.text == "push" ? std::move(values[i]) : clone(*e.args[1]));
                pre.push_back(std::move(one));
            }
        } else if (e.kind == ExprKind::Assign && isStruct(typeOf(e))) {
            assignTo(e, pre);
        } else if (call && isStruct(typeOf(e)) && structNamed(e.text) < 0) {
            List ignored;
            flatten(std::move(s->value), pre, ignored);
        } else {
            rewrite(s->value);
            out.push_back(std::move(s));
            return;
        }
        flush(pre, out);
    }

    void statement(StmtPtr s, std::vector<StmtPtr>& target) {
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
        case StmtKind::Declare: declare(std::move(s), out); break;
        case StmtKind::Expression: expression(std::move(s), out); break;
        case StmtKind::Return: {
            if (!isStruct(result_) || !s->value) {
                rewrite(s->value);
                out.push_back(std::move(s));
                break;
            }
            List pre, values;
            const Place place = s->value->place;
            valueOf(std::move(s->value), result_, pre, values);
            for (size_t i = 0; i < values.size() && i < results_.size(); ++i)
                pre.push_back(assign(variable(results_[i]->name, place), std::move(values[i]), place));
            flush(pre, out);
            s->value.reset();
            out.push_back(std::move(s));
            break;
        }
        default:
            for (ExprPtr* e : {&s->condition, &s->init, &s->step, &s->value, &s->category}) rewrite(*e);
            for (auto& e : s->exprs) rewrite(e);
            for (auto& p : s->pairs) rewrite(p.value);
            for (auto& b : s->body) body(b);
            body(s->elseBody);
            out.push_back(std::move(s));
        }
        before_ = outer;
        for (auto& t : temporaries) target.push_back(std::move(t));
        for (auto& t : out) target.push_back(std::move(t));
    }

    void function(Function& f) {
        auto* owner = std::exchange(owner_, &f.symbols);
        const Type result = std::exchange(result_, f.result);
        auto results = std::exchange(results_, {});
        scopes_.emplace_back();
        std::vector<Symbol*> parameters;
        for (Symbol* p : f.parameters) {
            scopes_.back()[p->name] = p->type;
            if (!isStruct(p->type)) {
                scopes_.back()[p->name] = kNone;
                parameters.push_back(p);
                continue;
            }
            for (Symbol* part : split(*p)) parameters.push_back(part);
        }
        if (isStruct(f.result)) {
            for (const Leaf& l : leaves(f.result)) {
                Symbol* r = newSymbol("(result)" + l.path, l.type, l.storage, f.place);
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
        scopes_.pop_back();
        owner_ = owner;
        result_ = result;
        results_ = std::move(results);
    }

    void shader(Shader& s) {
        auto* owner = std::exchange(owner_, &s.symbols);
        scopes_.emplace_back();
        std::vector<ShaderParameter> parameters;
        std::vector<StmtPtr> temporaries;
        before_ = &temporaries;
        for (auto& p : s.parameters) {
            Symbol& symbol = *p.symbol;
            if (!isStruct(symbol.type)) {
                rewrite(p.defaultValue);
                scopes_.back()[symbol.name] = kNone;
                parameters.push_back(std::move(p));
                continue;
            }
            List pre, values;
            const Place place = symbol.place;
            if (p.defaultValue) valueOf(std::move(p.defaultValue), symbol.type, pre, values);
            else if (!symbol.type.array) defaults(symbol.type, place, pre, values);
            scopes_.back()[symbol.name] = symbol.type;
            const auto parts = split(symbol);
            for (size_t i = 0; i < parts.size(); ++i)
                parameters.push_back({parts[i], i < values.size() ? std::move(values[i]) : nullptr});
            if (!pre.empty()) sources_.error(place, "the default of a structure is written with its constructor");
        }
        s.parameters = std::move(parameters);
        body(s.body);
        if (!temporaries.empty()) sources_.error(s.place, "a default value of a parameter uses a structure that a function gives");
        before_ = nullptr;
        scopes_.pop_back();
        owner_ = owner;
    }

    Unit& unit_;
    SourceSet& sources_;
    std::vector<std::unordered_map<std::string, Type>> scopes_; ///< void: a variable that is no structure
    std::multimap<std::string, Result> functions_;
    std::vector<std::unique_ptr<Symbol>>* owner_ = nullptr;
    Type result_ = kNone;
    std::vector<Symbol*> results_;
    std::vector<StmtPtr>* before_ = nullptr;
    int temporaries_ = 0;
};

} // namespace

void lowerStructs(Unit& u, SourceSet& s) {
    if (!u.structs.empty()) Lowering(u, s).run();
}

} // namespace alpenglow::rsl::front
