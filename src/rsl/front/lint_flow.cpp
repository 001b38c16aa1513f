#include "rsl/front/lint_flow.h"
#include "rsl/front/visit.h"
#include "rsl/front/writes.h"
#include <algorithm>
#include <span>
#include <unordered_map>

namespace alpenglow::rsl::front {

namespace {

bool isOutput(const Expr& call, size_t i) { return writesArgument(call, i) == Writes::Yes; }

/// A set of small numbers that is cheap to copy: a state is copied at every branch.
class Bits {
public:
    bool has(size_t n) const { return n / 64 < words_.size() && (words_[n / 64] >> (n % 64) & 1); }
    void insert(size_t n) {
        if (n / 64 >= words_.size()) words_.resize(n / 64 + 1);
        words_[n / 64] |= uint64_t(1) << (n % 64);
    }
    void erase(size_t n) {
        if (n / 64 < words_.size()) words_[n / 64] &= ~(uint64_t(1) << (n % 64));
    }
    static Bits both(const Bits& a, const Bits& b) {
        Bits r;
        r.words_.resize(std::min(a.words_.size(), b.words_.size()));
        for (size_t i = 0; i < r.words_.size(); ++i) r.words_[i] = a.words_[i] & b.words_[i];
        return r;
    }
    static Bits either(const Bits& a, const Bits& b) {
        const Bits& small = a.words_.size() < b.words_.size() ? a : b;
        Bits r = &small == &a ? b : a;
        for (size_t i = 0; i < small.words_.size(); ++i) r.words_[i] |= small.words_[i];
        return r;
    }

private:
    std::vector<uint64_t> words_;
};

/// Follows the statements in the order in which they run, and knows at each which variables have a value on every way there, and
/// which on some way. Members of structures are followed one by one.
class Flow {
public:
    Flow(const FlowRules& rules, const Paths& paths, LightReads& reads, SourceSet& s)
        : rules_(rules), paths_(paths), reads_(reads), sources_(s) {}
    void run(const Stmt* body) { statement(body); }

private:
    struct State {
        Bits always, sometimes; ///< by number in tracked_
        bool dead = false;      ///< no way leads here
    };

    static State merged(const State& a, const State& b) {
        if (a.dead) return b;
        if (b.dead) return a;
        State s;
        s.always = Bits::both(a.always, b.always);
        s.sometimes = Bits::either(a.sometimes, b.sometimes);
        return s;
    }

    /// The numbers of the plain members of a path in the states; kUntracked for those that are not followed.
    std::span<const size_t> numbers(const Path& p) const {
        const auto at = tracked_.find(p.symbol);
        if (at == tracked_.end()) return {};
        return std::span(at->second).subspan(p.first, p.count);
    }

    void given(const Path& p) {
        for (const size_t n : numbers(p)) {
            if (n == kUntracked) continue;
            now_.always.insert(n);
            now_.sometimes.insert(n);
        }
    }

    /// L, Cl and Ol mean something where a light shines on the point.
    void unlit(const Symbol* s, const Place& place, const std::string& where) {
        if (!rules_.lit || lightLoops_ > 0 || now_.dead || !s || s->origin != Symbol::Origin::Global || assigned_.count(s))
            return;
        if (s->name != "L" && s->name != "Cl" && s->name != "Ol") return;
        if (found_ && !*found_) *found_ = s;
        if (found_ || !unlitReported_.insert(s).second) return;
        sources_.report(place, msg::kUnlit(s->name, where),
                        "illuminance (P, N, PI/2) { ... } runs once for each light; " +
                            std::string(s->name == "L" ? "I is the direction of view" : "diffuse(N) adds them all"));
    }

    /// A function means the light of the illuminance() that calls it.
    void unlitCall(const Expr& e) {
        if (!rules_.lit || lightLoops_ > 0 || now_.dead || !e.function || e.shadeop) return;
        const auto [at, fresh] = reads_.emplace(e.function, nullptr);
        if (fresh) {
            const Symbol* found = nullptr;
            Flow inside({rules_.ignored, false, true}, paths_, reads_, sources_);
            inside.found_ = &found;
            inside.run(e.function->body.get());
            at->second = found;
        }
        unlit(at->second, e.place, ", in '" + e.function->name + "'");
    }

    /// Whether one of the members that the text names has a value on some way to here.
    bool anyGiven(const Path& p) const {
        const auto at = tracked_.find(p.symbol);
        return at != tracked_.end() && std::ranges::any_of(std::span(at->second).subspan(p.first, p.named), [&](size_t n) {
                   return n == kUntracked || now_.always.has(n) || now_.sometimes.has(n);
               });
    }

    void read(const Path& p) {
        unlit(p.symbol, p.place, "");
        if (found_ || now_.dead || p.name.starts_with('(')) return; // of the compiler
        const bool structure = isStruct(p.type) && !anyGiven(p);    // one message for all its members
        const auto all = numbers(p);
        for (size_t i = 0; i < all.size(); ++i) {
            const size_t n = all[i];
            if (n == kUntracked || now_.always.has(n) || !reported_.insert(n).second) continue;
            const bool maybe = now_.sometimes.has(n) || loops_ > 0;
            const Base base = paths_.memberType(*p.symbol, p.first + i).base;
            const char* value = structure || !isStringLike(base) ? "zero" : base == Base::Shader ? "null" : "empty";
            const std::string name = structure ? p.name : paths_.memberName(*p.symbol, p.first + i);
            sources_.report(p.place, maybe ? msg::kMaybeUninitialised(name, value) : msg::kUninitialised(name, value));
        }
    }

    /// What chooses elements within a path.
    void indices(const Expr& e) {
        if ((e.kind != ExprKind::Index && e.kind != ExprKind::Part && e.kind != ExprKind::Cast) || e.args.empty()) return;
        indices(*e.args[0]);
        if (e.kind == ExprKind::Index && e.args.size() > 1) expression(*e.args[1]);
    }

    /// The target of an assignment or an output argument: indices are read, the variable is written.
    void target(const Expr& e, bool alsoRead) {
        const auto p = paths_.of(e);
        if (alsoRead || (!p && isStruct(e.type))) expression(e); // a method of a result may change it
        else indices(e);
        if (!p) return;
        if (!found_) uniformHazard(e, *p);
        if (rules_.surface && p->symbol->origin == Symbol::Origin::Global && p->symbol->name == "P")
            sources_.report(e.place, msg::kMovingSurface);
        assigned_.insert(p->symbol);
        given(*p);
    }

    /// f(x, x) with two outputs: what the function does to the one it does to the other.
    void sharedOutputs(const Expr& e) {
        if (!e.function || e.shadeop) return;
        std::vector<Path> outputs;
        for (size_t i = 0; i < e.args.size(); ++i) {
            const auto p = e.args[i] && isOutput(e, i) ? paths_.of(*e.args[i]) : std::nullopt;
            if (!p || !p->whole) continue;
            const auto shared = [&](const Path& o) {
                return o.symbol == p->symbol && o.first < p->first + p->count && p->first < o.first + o.count;
            };
            if (std::ranges::any_of(outputs, shared))
                return sources_.report(p->place, msg::kSharedOutput(p->name, e.function->name));
            outputs.push_back(*p);
        }
    }

    /// An argument of a call that is not bound, as was reported: structures in it have no type.
    void unboundArgument(const Expr& e) {
        const auto p = paths_.of(e);
        if (!p || !isStruct(p->type)) return expression(e);
        read(*p);
        indices(e);
    }

    void expression(const Expr& e) {
        switch (e.kind) {
        case ExprKind::Variable:
        case ExprKind::Index:
        case ExprKind::Part:
        case ExprKind::Cast: {
            const auto p = paths_.of(e);
            if (!p) return eachPart(e, [&](const Expr& x) { expression(x); });
            if (!isStruct(p->type) || isStruct(e.type)) read(*p); // a structure without a type is wrong here, as was reported
            return indices(e);
        }
        case ExprKind::Assign:
            if (e.args.size() > 1) {
                expression(*e.args[1]);
                target(*e.args[0], e.op != ExprOp::Assign);
            }
            return;
        case ExprKind::Conditional:
            if (e.args.size() == 3) {
                expression(*e.args[0]);
                const State before = now_;
                expression(*e.args[1]);
                const State first = now_;
                now_ = before;
                expression(*e.args[2]);
                now_ = merged(first, now_);
            }
            return;
        case ExprKind::ShadeopCall:
        case ExprKind::FunctionCall: {
            unlitCall(e);
            if (!found_) sharedOutputs(e);
            for (size_t i = 0; i < e.args.size(); ++i)
                if (e.args[i] && !isOutput(e, i)) e.shadeop || e.function ? expression(*e.args[i]) : unboundArgument(*e.args[i]);
            if (e.channel) expression(*e.channel);
            for (const NamedArg& p : e.pairs)
                if (p.value && !p.output) expression(*p.value);
            for (size_t i = 0; i < e.args.size(); ++i)
                if (e.args[i] && isOutput(e, i)) target(*e.args[i], false);
            for (const NamedArg& p : e.pairs)
                if (p.value && p.output) target(*p.value, false);
            return;
        }
        case ExprKind::Method: // of another shader: it may write any variable among its arguments
            for (size_t i = 0; i < e.args.size(); ++i) {
                if (!e.args[i]) continue;
                const auto p = i == 0 ? std::nullopt : paths_.of(*e.args[i]);
                if (p) given(*p);
                else unboundArgument(*e.args[i]);
            }
            return;
        default:
            eachPart(e, [&](const Expr& x) { expression(x); });
        }
    }

    void loop(const Stmt& s) {
        if (s.init) expression(*s.init);
        const bool varying = s.condition && s.condition->varying;
        varyingConditions_ += varying;
        if (s.condition) expression(*s.condition);
        for (const auto& e : s.exprs)
            if (e) expression(*e);
        if (s.category) expression(*s.category);
        const State before = now_;
        for (const NamedArg& p : s.pairs) {
            if (!p.value) continue;
            if (p.output) target(*p.value, false);
            else expression(*p.value);
        }
        if (s.kind == StmtKind::Illuminance && lightLoops_ > 0 && !now_.dead && !found_)
            sources_.report(s.place, msg::kNestedIlluminance);
        ++loops_;
        lightLoops_ += s.kind == StmtKind::Illuminance;
        statement(s.body.empty() ? nullptr : s.body[0].get());
        if (s.step && !now_.dead) expression(*s.step);
        --loops_;
        lightLoops_ -= s.kind == StmtKind::Illuminance;
        varyingConditions_ -= varying;
        const bool endless = s.condition && s.condition->kind == ExprKind::Number && s.condition->number != 0;
        now_.dead = false;
        State after = merged(before, now_);
        if (endless) after.always = now_.always; // left from inside only
        now_ = after;
    }

    /// How many varying conditions stand around the declaration: what lives in a block that only some points reach is theirs
    /// alone.
    int declaredUnder(const Symbol* s) const {
        const auto at = under_.find(s);
        return at == under_.end() ? 0 : at->second;
    }

    void uniformHazard(const Expr& target, const Path& p) {
        const Symbol& s = *p.symbol;
        if (varyingConditions_ <= declaredUnder(&s) || s.origin != Symbol::Origin::Local) return;
        const Expr* place = &target;
        while (place->kind == ExprKind::Part || place->kind == ExprKind::Cast) place = place->args[0].get();
        for (size_t i = p.first; i < p.first + p.count; ++i)
            if (paths_.memberStorage(s, i) == Storage::Uniform && !isStringLike(paths_.memberType(s, i).base))
                sources_.report(place->place, msg::kUniformInVarying(paths_.memberName(s, i)));
    }

    void declare(const Stmt::Declarator& d) {
        if (d.init) expression(*d.init);
        const Symbol& s = *d.symbol;
        under_[&s] = varyingConditions_;
        if (d.init || s.type.base == Base::Void || rules_.ignored.count(&s)) return;
        const auto [at, fresh] = tracked_.try_emplace(&s);
        const size_t members = isStruct(s.type) ? paths_.members(s.type).size() : 1;
        for (size_t i = 0; fresh && i < members; ++i) {
            // An array of open length is made by push and resize.
            const bool open = s.resizable || paths_.memberType(s, i).array < 0;
            at->second.push_back(open ? kUntracked : numbers_++);
        }
        for (const size_t n : at->second) {
            if (n == kUntracked) continue;
            now_.always.erase(n);
            if (loops_ == 0) now_.sometimes.erase(n);
        }
    }

    void statement(const Stmt* p) {
        if (!p) return;
        const Stmt& s = *p;
        switch (s.kind) {
        case StmtKind::Block:
            for (const auto& b : s.body) statement(b.get());
            return;
        case StmtKind::Declare:
            for (const auto& d : s.declarators) declare(d);
            return;
        case StmtKind::Expression:
            if (s.value) expression(*s.value);
            return;
        case StmtKind::If: {
            if (s.condition) expression(*s.condition);
            const bool varying = s.condition && s.condition->varying;
            varyingConditions_ += varying;
            const State before = now_;
            statement(s.body.empty() ? nullptr : s.body[0].get());
            const State yes = now_;
            now_ = before;
            statement(s.elseBody.get());
            now_ = merged(yes, now_);
            varyingConditions_ -= varying;
            return;
        }
        case StmtKind::While:
        case StmtKind::For:
        case StmtKind::Illuminance:
        case StmtKind::Gather:
            loop(s);
            return;
        case StmtKind::Illuminate:
        case StmtKind::Solar:
            for (const auto& e : s.exprs)
                if (e) expression(*e);
            for (const auto& b : s.body) statement(b.get());
            return;
        case StmtKind::Break:
        case StmtKind::Continue:
            now_.dead = true;
            return;
        case StmtKind::Return:
            if (s.value) expression(*s.value);
            now_.dead = true;
            return;
        default: {
            everyExpr(s, [&](const Expr& e) {
                if (e.kind != ExprKind::Assign || e.args.empty()) return;
                if (const auto p = paths_.of(*e.args[0])) given(*p);
            });
            return;
        }
        }
    }

    static constexpr size_t kUntracked = size_t(-1);
    const FlowRules rules_;
    const Paths& paths_;
    LightReads& reads_;
    SourceSet& sources_;
    const Symbol** found_ = nullptr;   ///< of a function that is searched: the only result, nothing is reported
    std::set<const Symbol*> assigned_; ///< by the statements so far
    std::unordered_map<const Symbol*, std::vector<size_t>> tracked_; ///< the numbers of plain members, in order
    size_t numbers_ = 0;                                             ///< how many there are
    std::set<size_t> reported_;                                      ///< by number
    std::set<const Symbol*> unlitReported_;
    std::unordered_map<const Symbol*, int> under_;
    State now_;
    int loops_ = 0, lightLoops_ = 0, varyingConditions_ = 0;
};

} // namespace

void lintFlow(const Stmt& body, const FlowRules& rules, const Paths& paths, LightReads& reads, SourceSet& sources) {
    Flow(rules, paths, reads, sources).run(&body);
}

} // namespace alpenglow::rsl::front
