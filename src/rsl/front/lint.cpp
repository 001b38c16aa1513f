#include "rsl/front/lint.h"
#include "rsl/front/lint_calls.h"
#include "rsl/front/visit.h"
#include "rsl/front/writes.h"
#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <unordered_map>

namespace alpenglow::rsl::front {

namespace {

/// The variable that an assignment or an output argument writes; null if the expression is none.
const Symbol* root(const Expr& e) {
    const Expr* r = &e;
    while (r->kind == ExprKind::Index && !r->args.empty() && r->args[0]) r = r->args[0].get();
    return r->kind == ExprKind::Variable ? r->symbol : nullptr;
}

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
/// which on some way.
class Flow {
public:
    /// What functions read of the light that shines where they are called: the first such variable; null: none.
    using LightReads = std::map<const Function*, const Symbol*>;

    /// `lit`: the body of a shader that meets light in illuminance() only; a function may be called from there.
    Flow(SourceSet& s, const std::set<const Symbol*>& ignored, bool surface, bool lit, LightReads& reads)
        : sources_(s), ignored_(ignored), surface_(surface), lit_(lit), reads_(reads) {}
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

    void given(const Symbol* s) {
        const auto at = tracked_.find(s);
        if (at == tracked_.end()) return;
        now_.always.insert(at->second);
        now_.sometimes.insert(at->second);
    }

    /// L, Cl and Ol mean something where a light shines on the point.
    void unlit(const Symbol* s, const Place& place, const std::string& where) {
        if (!lit_ || lightLoops_ > 0 || now_.dead || !s || s->origin != Symbol::Origin::Global || assigned_.count(s)) return;
        if (s->name != "L" && s->name != "Cl" && s->name != "Ol") return;
        if (found_ && !*found_) *found_ = s;
        if (found_ || !reported_.insert(s).second) return;
        sources_.report(place, msg::kUnlit(s->name, where),
                        "illuminance (P, N, PI/2) { ... } runs once for each light; " +
                            std::string(s->name == "L" ? "I is the direction of view" : "diffuse(N) adds them all"));
    }

    /// A function means the light of the illuminance() that calls it.
    void unlitCall(const Expr& e) {
        if (!lit_ || lightLoops_ > 0 || now_.dead || !e.function || e.shadeop) return;
        const auto [at, fresh] = reads_.emplace(e.function, nullptr);
        if (fresh) {
            const Symbol* found = nullptr;
            Flow inside(sources_, ignored_, false, true, reads_);
            inside.found_ = &found;
            inside.run(e.function->body.get());
            at->second = found;
        }
        unlit(at->second, e.place, ", in '" + e.function->name + "'");
    }

    /// Whether a member of the structure has a value on some way to here.
    bool anyMember(const StructVariable& v) const {
        const auto at = members_.find(&v);
        return at != members_.end() &&
               std::ranges::any_of(at->second, [&](size_t n) { return now_.always.has(n) || now_.sometimes.has(n); });
    }

    void read(const Expr& e) {
        const Symbol* s = e.symbol;
        unlit(s, e.place, "");
        const auto at = tracked_.find(s);
        if (found_ || !s || s->name.rfind('(', 0) == 0 || now_.dead || at == tracked_.end() || now_.always.has(at->second) ||
            !reported_.insert(s).second)
            return;
        const bool maybe = now_.sometimes.has(at->second) || loops_ > 0;
        const char* value = !isStringLike(s->type.base) ? "zero" : s->type.base == Base::Shader ? "null" : "empty";
        std::string name = s->name;
        if (e.part && s->of && !anyMember(*s->of)) { // one message for the structure
            name = s->of->name;
            value = "zero";
        }
        sources_.report(e.place, maybe ? msg::kMaybeUninitialised(name, value) : msg::kUninitialised(name, value));
    }

    /// The target of an assignment or an output argument: indices are read, the variable is written.
    void target(const Expr& e, bool alsoRead) {
        if (alsoRead) expression(e);
        else
            for (const Expr* x = &e; x->kind == ExprKind::Index && x->args.size() > 1; x = x->args[0].get())
                expression(*x->args[1]);
        const Symbol* s = root(e);
        if (!found_) uniformHazard(e, s);
        if (surface_ && s && s->origin == Symbol::Origin::Global && s->name == "P") sources_.report(e.place, msg::kMovingSurface);
        if (s) assigned_.insert(s);
        given(s);
    }

    /// f(x, x) with two outputs: what the function does to the one it does to the other.
    void sharedOutputs(const Expr& e) {
        if (!e.function || e.shadeop) return;
        std::set<const Symbol*> outputs;
        for (size_t i = 0; i < e.args.size(); ++i) {
            if (!e.args[i] || e.args[i]->kind != ExprKind::Variable || !isOutput(e, i)) continue;
            if (outputs.insert(e.args[i]->symbol).second) continue;
            sources_.report(e.args[i]->place, msg::kSharedOutput(e.args[i]->text, e.function->name));
            return;
        }
    }

    void expression(const Expr& e) {
        switch (e.kind) {
        case ExprKind::Variable:
            read(e);
            return;
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
                if (e.args[i] && !isOutput(e, i)) expression(*e.args[i]);
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
                if (i == 0 || !root(*e.args[i])) expression(*e.args[i]);
                else given(root(*e.args[i]));
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

    void uniformHazard(const Expr& target, const Symbol* u) {
        if (!u || varyingConditions_ <= declaredUnder(u) || u->storage != Storage::Uniform ||
            u->origin != Symbol::Origin::Local || isStringLike(u->type.base))
            return;
        sources_.report(target.place, msg::kUniformInVarying(u->name));
    }

    void statement(const Stmt* p) {
        if (!p) return;
        const Stmt& s = *p;
        switch (s.kind) {
        case StmtKind::Block:
            for (const auto& b : s.body) statement(b.get());
            return;
        case StmtKind::Declare:
            for (const auto& d : s.declarators) {
                if (d.init) expression(*d.init);
                under_[d.symbol] = varyingConditions_;
                // An array of open length is made by push and resize.
                const bool open = d.symbol->resizable || d.symbol->type.array < 0;
                if (!d.init && !open && d.symbol->type.base != Base::Void && !ignored_.count(d.symbol)) {
                    const size_t n = tracked_.emplace(d.symbol, tracked_.size()).first->second;
                    if (d.symbol->of) members_[d.symbol->of.get()].push_back(n);
                    now_.always.erase(n);
                    if (loops_ == 0) now_.sometimes.erase(n);
                }
            }
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
                if (e.kind == ExprKind::Assign && !e.args.empty()) given(root(*e.args[0]));
            });
            return;
        }
        }
    }

    SourceSet& sources_;
    const std::set<const Symbol*>& ignored_;
    const bool surface_, lit_;
    LightReads& reads_;
    const Symbol** found_ = nullptr;   ///< of a function that is searched: the only result, nothing is reported
    std::set<const Symbol*> assigned_; ///< by the statements so far
    std::unordered_map<const Symbol*, size_t> tracked_;
    std::unordered_map<const StructVariable*, std::vector<size_t>> members_; ///< those in tracked_
    std::set<const Symbol*> reported_;
    std::unordered_map<const Symbol*, int> under_;
    State now_;
    int loops_ = 0, lightLoops_ = 0, varyingConditions_ = 0;
};

} // namespace

void lint(const Program& program, const std::vector<Token>& tokens, const std::unordered_set<std::string>& skipped,
          SourceSet& sources) {
    // Who is mentioned where: a variable that a nested function reaches for may be read at any time.
    std::set<const Symbol*> used, reached;
    const auto mention = [&](std::set<const Symbol*>& set) {
        return [&set](const Expr& e) {
            if (e.symbol) set.insert(e.symbol);
        };
    };
    for (const auto& s : program.shaders) {
        if (s->body) everyExpr(*s->body, mention(used));
        for (const auto& p : s->parameters)
            if (p.defaultValue) everyExpr(*p.defaultValue, mention(used));
        everyFunctionBody(*s, [&](const Stmt& b) { everyExpr(b, mention(reached)); });
    }
    for (const auto& g : program.functions)
        everyFunction(*g, [&](const Function& f) {
            if (f.body) everyExpr(*f.body, mention(&f == g.get() ? used : reached));
        });
    used.insert(reached.begin(), reached.end());
    // A function is there once for each shader that calls it, a class once for each kind of shader it can be: what one of them
    // uses is used.
    std::set<std::array<int, 3>> usedPlaces;
    for (const Symbol* s : used) usedPlaces.insert({s->place.file, s->place.line, s->place.column});

    const std::string& main = sources.name(0);
    const auto ours = [&](const Place& p) { return p.file >= 0 && p.line > 0 && sources.name(p.file) == main; };
    const auto unused = [&](const Symbol& s, bool parameter) {
        const std::string& name = s.of ? s.of->name : s.name; // the members of a structure have one place, so one message
        if (name.starts_with('(') || skipped.count(name) || usedPlaces.count({s.place.file, s.place.line, s.place.column}) ||
            !ours(s.place) || s.type.base == Base::Void || s.isExtern || name.starts_with("__") || name == "this")
            return;
        sources.report(s.place, parameter ? msg::kUnusedParameter(name) : msg::kUnusedVariable(name));
    };
    lintCommas(tokens, sources);
    Flow::LightReads reads;
    bool surface = false, lit = false;
    const auto body = [&](const Stmt* b, Place where) {
        if (!b || !ours(where)) return;
        everyStmt(
            *b,
            [&](const Stmt& s) {
                for (const auto& d : s.declarators)
                    if (d.symbol) unused(*d.symbol, false);
                if (s.condition) lintCondition(*s.condition, sources);
                lintPairs(s, sources);
            },
            [&](const Expr& e) { lintCall(e, sources), lintMessage(e, program, sources); });
        Flow(sources, reached, surface, lit, reads).run(b);
    };
    for (const auto& s : program.shaders) {
        for (const auto& p : s->parameters) {
            if (!p.symbol->output) unused(*p.symbol, true);
            if (p.defaultValue && ours(s->place)) everyExpr(*p.defaultValue, [&](const Expr& e) { lintCall(e, sources); });
        }
        surface = s->kind == ShaderKind::Surface;
        lit = s->kind != ShaderKind::Light;
        body(s->body.get(), s->place);
    }
    lit = false;
    // A method that is not public, of a name that the renderer does not know, and that no other calls.
    const std::vector<std::string> entries = {
        "construct",        "begin",        "displacement", "opacity", "prelighting", "lighting", "diffuselighting",
        "specularlighting", "postlighting", "surface",      "volume",  "light",       "imager"};
    for (const auto& s : program.shaders)
        for (const auto& f : s->nested)
            if (s->object && f->anywhere && !s->publics.count(f->name) && ours(f->place)) {
                const std::string near = nearestName(f->name, entries);
                sources.report(f->place, msg::kUnknownMethod(f->name), near.empty() ? "" : "did you mean '" + near + "'?");
            }
    everyFunction(program, [&](const Function& f) {
        if (ours(f.place))
            for (const Symbol* p : f.parameters) unused(*p, true);
        body(f.body.get(), f.place);
    });
}

} // namespace alpenglow::rsl::front
