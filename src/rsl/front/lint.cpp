#include "rsl/front/lint.h"
#include "rsl/front/lint_calls.h"
#include "rsl/front/lint_flow.h"
#include "rsl/front/structs.h"
#include "rsl/front/visit.h"
#include <array>
#include <set>
#include <tuple>

namespace alpenglow::rsl::front {

namespace {

using Position = std::array<int, 3>;
Position positionOf(const Place& p) { return {p.file, p.line, p.column}; }

/// Members of structures that variables and values have, and what reads or sets them by name.
class Members {
public:
    explicit Members(const Program& p) : program_(p), structures_(p.structs) {}

    /// There is a value of this type.
    void value(Type t) {
        if (!isStruct(t) || !there_.insert(t.structure).second) return;
        for (const StructMember& m : structures_.of(t).members) value(m.type);
        if (const int base = structures_.of(t).base; base >= 0) value(structType(size_t(base)));
    }
    /// Somebody else sees a value of this type, and may use every member.
    void shown(Type t) {
        if (!isStruct(t) || !shown_.insert(t.structure).second) return;
        for (const StructMember& m : structures_.of(t).members) {
            named_.insert(positionOf(m.place));
            shown(m.type);
        }
    }
    void expression(const Expr& e) {
        value(e.type);
        if (e.kind == ExprKind::Part)
            if (const StructMember* m = structures_.member(e.args[0]->type, e.text)) named_.insert(positionOf(m->place));
        if (e.kind != ExprKind::Method) return;
        shown(e.type); // it goes to another shader, or comes from one
        for (const auto& a : e.args) shown(a->type);
    }
    /// Those that nothing names, with the structures that declare them.
    std::vector<std::pair<const StructMember*, const StructType*>> unused() const {
        std::vector<std::pair<const StructMember*, const StructType*>> all;
        for (size_t i = 0; i < program_.structs.size(); ++i) {
            const StructType& s = program_.structs[i];
            const size_t inherited = s.base < 0 ? 0 : program_.structs[size_t(s.base)].members.size();
            for (size_t k = inherited; there_.count(int(i)) && k < s.members.size(); ++k)
                if (!named_.count(positionOf(s.members[k].place))) all.emplace_back(&s.members[k], &s);
        }
        return all;
    }

private:
    const Program& program_;
    const Structures structures_;
    std::set<int> there_, shown_; ///< structures, by number
    std::set<Position> named_;    ///< members, by their places: structures that extend others have them, too
};

std::vector<std::pair<const StructMember*, const StructType*>> unusedMembers(const Program& program,
                                                                             const std::set<const Symbol*>& used) {
    Members members(program);
    if (program.structs.empty()) return {};
    for (const Symbol* s : used) members.value(s->type);
    const auto expression = [&](const Expr& e) { members.expression(e); };
    for (const auto& s : program.shaders) {
        for (const auto& x : s->symbols)
            if (x->output || s->publics.count(x->name)) members.shown(x->type);
        for (const auto& p : s->parameters)
            if (p.defaultValue) everyExpr(*p.defaultValue, expression);
        for (const auto& f : s->nested) { // methods that other shaders call
            if (s->publics.count(f->name)) members.shown(f->result);
            for (const Symbol* p : f->parameters)
                if (s->publics.count(f->name)) members.shown(p->type);
        }
    }
    everyBody(program, [&](const Stmt& b) { everyExpr(b, expression); });
    return members.unused();
}

bool isOurs(const Place& p, const SourceSet& sources) {
    return p.file >= 0 && p.line > 0 && sources.name(p.file) == sources.name(0);
}

/// Methods that are not public, of names that the renderer does not know, and that no other calls.
void unknownMethods(const Program& program, SourceSet& sources) {
    const std::vector<std::string> entries = {
        "construct",        "begin",        "displacement", "opacity", "prelighting", "lighting", "diffuselighting",
        "specularlighting", "postlighting", "surface",      "volume",  "light",       "imager"};
    for (const auto& s : program.shaders)
        for (const auto& f : s->nested)
            if (s->object && f->anywhere && !s->publics.count(f->name) && isOurs(f->place, sources)) {
                const std::string near = nearestName(f->name, entries);
                sources.report(f->place, msg::kUnknownMethod(f->name), near.empty() ? "" : "did you mean '" + near + "'?");
            }
}

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

    const auto ours = [&](const Place& p) { return isOurs(p, sources); };
    const auto unused = [&](const Symbol& s, bool parameter) {
        const std::string& name = s.name;
        if (name.starts_with('(') || skipped.count(name) || usedPlaces.count({s.place.file, s.place.line, s.place.column}) ||
            !ours(s.place) || s.type.base == Base::Void || s.isExtern || name.starts_with("__") || name == "this")
            return;
        sources.report(s.place, parameter ? msg::kUnusedParameter(name) : msg::kUnusedVariable(name));
    };
    lintCommas(tokens, sources);
    const Paths paths(program);
    LightReads reads;
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
            [&](const Expr& e) { lintCall(e, sources), lintMessage(e, program, paths, sources); });
        lintFlow(*b, {reached, surface, lit}, paths, reads, sources);
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
    unknownMethods(program, sources);
    everyFunction(program, [&](const Function& f) {
        if (ours(f.place))
            for (const Symbol* p : f.parameters) unused(*p, true);
        body(f.body.get(), f.place);
    });
    // What could not be read may use a member.
    if (sources.errors() == 0)
        for (const auto& [member, structure] : unusedMembers(program, used))
            if (ours(member->place) && !skipped.count(member->name) && !member->name.starts_with("__"))
                sources.report(member->place, msg::kUnusedMember(member->name, structure->name));
}

} // namespace alpenglow::rsl::front
