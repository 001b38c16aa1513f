// Methods of structures: each becomes a function whose first parameter, "this", is the structure. Bare names of members and
// methods in its body mean those of this structure, unless a parameter or a local variable hides them.
#include "rsl/front/clone.h"
#include "rsl/front/nodes.h"
#include "rsl/front/parser.h"
#include "rsl/front/structs.h"
#include "rsl/front/visit.h"
#include "rsl/front/writes.h"
#include <map>
#include <set>
#include <utility>

namespace alpenglow::rsl::front {

namespace {

/// Writes "this->" before the names that mean it, and notes whether the structure may be changed.
class Selfs {
public:
    Selfs(const StructType& type, const std::set<std::string>& changing, const std::set<std::string>& methods,
          const std::map<std::string, std::set<size_t>>& puttingOut)
        : type_(type), changing_(changing), methods_(methods), puttingOut_(puttingOut) {}

    bool changes = false;

    void run(Function& f) {
        hidden_.emplace_back();
        for (const Symbol* p : f.parameters) hidden_.back().insert(p->name);
        statement(f.body);
        hidden_.pop_back();
    }

private:
    bool isHidden(const std::string& name) const {
        for (const auto& h : hidden_)
            if (h.count(name)) return true;
        return false;
    }

    bool isMember(const std::string& name) const {
        for (const StructMember& m : type_.members)
            if (m.name == name) return true;
        return false;
    }

    static bool ofThis(const Expr& e) {
        const Expr* r = &e;
        while ((r->kind == ExprKind::Index || r->kind == ExprKind::Member) && !r->args.empty()) r = r->args[0].get();
        return r->kind == ExprKind::Variable && r->text == "this";
    }

    /// Without "Base::".
    static std::string bare(const std::string& method) {
        const size_t colon = method.find("::");
        return colon == method.npos ? method : method.substr(colon + 2);
    }

    /// May a call of this method, of a structure or of another shader, change its argument `i`?
    bool methodPutsOut(const std::string& name, size_t i) const {
        const auto m = puttingOut_.find(name);
        return m == puttingOut_.end() || m->second.count(i) > 0;
    }

    /// May a call of this function change an argument?
    bool putsOut(const std::string& name) const {
        const Shadeop* op = findShadeop(name);
        return !op || writesAny(*op); // none: the text's own, or a plug-in's
    }

    void expression(ExprPtr& e) {
        if (!e) return;
        if (e->kind == ExprKind::Variable && e->text != "this" && isMember(e->text) && !isHidden(e->text)) {
            auto m = node(ExprKind::Member, e->place);
            m->text = e->text;
            adopt(*m, variable("this", e->place));
            e = std::move(m);
            return;
        }
        const bool own = e->text.find("::") != e->text.npos || (methods_.count(e->text) && !isHidden(e->text));
        if (e->kind == ExprKind::ShadeopCall && own) {
            auto m = node(ExprKind::Method, e->place);
            m->text = e->text;
            adopt(*m, variable("this", e->place));
            for (auto& a : e->args) adopt(*m, std::move(a));
            e = std::move(m);
        }
        eachSlot(*e, [&](ExprPtr& x) { expression(x); });
        for (const auto& a : e->args)
            if (a) e->height = std::max(e->height, a->height + 1);
        const bool call = e->kind == ExprKind::ShadeopCall;
        if (e->kind == ExprKind::Assign) changes |= ofThis(*e->args[0]);
        if (e->kind == ExprKind::Method && ofThis(*e->args[0]))
            changes |= e->args[0]->kind != ExprKind::Variable || changing_.count(bare(e->text));
        if (e->kind == ExprKind::Method)
            for (size_t i = 1; i < e->args.size(); ++i) changes |= ofThis(*e->args[i]) && methodPutsOut(bare(e->text), i - 1);
        if (call && putsOut(e->text))
            for (const auto& a : e->args) changes |= ofThis(*a);
        if (call && !e->args.empty() && e->args[0]->kind == ExprKind::String)
            for (const auto& a : e->args) changes |= ofThis(*a) && a != e->args[0]; // behind a token that may be an output
    }

    void statement(StmtPtr& s) {
        if (!s) return;
        const bool block = s->kind == StmtKind::Block;
        if (block) hidden_.emplace_back();
        for (auto& d : s->declarators) {
            expression(d.init);
            hidden_.back().insert(d.symbol->name);
        }
        if (s->declarators.empty()) eachSlot(*s, [&](ExprPtr& x) { expression(x); });
        if (s->definition) {
            hidden_.back().insert(s->definition->name);
            run(*s->definition);
        }
        eachBody(*s, [&](StmtPtr& b) { statement(b); });
        if (block) hidden_.pop_back();
    }

    const StructType& type_;
    const std::set<std::string>& changing_;
    const std::set<std::string>& methods_;
    const std::map<std::string, std::set<size_t>>& puttingOut_; ///< which parameters of the methods of all structures are output
    std::vector<std::set<std::string>> hidden_;
};

} // namespace

void addStructMethods(Unit& unit, const Program& program) {
    struct Known {
        std::set<std::string> names, changing;
    };
    std::vector<Known> known(program.structs.size()); // what a structure has, those that extend it have, too
    std::map<std::string, std::set<size_t>> puttingOut;
    for (const auto& methods : unit.methods)
        for (const auto& f : methods)
            for (size_t i = 0; i < f->parameters.size(); ++i)
                if (auto& out = puttingOut[f->name]; f->parameters[i]->output) out.insert(i);
    for (size_t i = 0; i < program.structs.size(); ++i) {
        const StructType& type = program.structs[i];
        auto& methods = unit.methods[i];
        if (type.base >= 0 && size_t(type.base) < i) known[i] = known[size_t(type.base)];
        std::set<std::string>&names = known[i].names, &changing = known[i].changing;
        for (const auto& f : methods) names.insert(f->name);
        // A method that calls one that changes the structure changes it, too.
        for (size_t before = size_t(-1); before != changing.size();) {
            before = changing.size();
            for (auto& f : methods) {
                Selfs selfs(type, changing, names, puttingOut);
                selfs.run(*f);
                if (selfs.changes) changing.insert(f->name);
            }
        }
        for (auto& f : methods) {
            auto self = std::make_unique<Symbol>();
            self->name = "this";
            self->type = structType(i);
            self->origin = Symbol::Origin::FunctionParameter;
            self->output = changing.count(f->name) > 0;
            self->place = f->place;
            f->parameters.insert(f->parameters.begin(), self.get());
            f->symbols.push_back(std::move(self));
            f->name = type.name + "->" + f->name;
            unit.functions.push_back(std::move(f));
        }
        methods.clear();
    }
}

} // namespace alpenglow::rsl::front
