// The shaders that a handle can mean, and calls that return handles: getshader(), getshaders(), arrays of handles.
#include "base/category.h"
#include "base/limits.h"
#include "rsl/front/protocol.h"
#include "rsl/front/visit.h"
#include "rsl/front/writes.h"
#include "rsl/ir/builder.h"
#include <algorithm>

namespace alpenglow::rsl::ir {

/// Does anything of these programs write to the variable, or to an element of it?
bool Builder::everWritten(const Symbol& s) {
    if (!written_) {
        written_.emplace();
        const auto add = [&](const Expr& place) {
            if (const Symbol* root = front::rootOf(place)) written_->insert(root);
        };
        const auto body = [&](const Stmt& b) {
            front::everyStmt(
                b, [&](const Stmt& x) { front::eachWritten(x, add); }, [&](const Expr& e) { front::eachWritten(e, add); });
        };
        const auto program = [&](const Program& p) { front::everyBody(p, body); };
        program(program_);
        for (const CoShader& c : options_.coShaders) program(*c.program);
    }
    return written_->count(&s) > 0;
}

/// Elements of parameters that only read are known, also where the index is not.
void Builder::noteTexts(const Inst* array, const Symbol& s, int length,
                        std::span<const std::pair<std::string, std::string>> given) {
    if (array->op != Op::ArrayNew || array->element != Kind::String || everWritten(s)) return;
    std::vector<std::string> all(static_cast<size_t>(std::max(0, length)));
    for (int n = 0; n < length; ++n)
        for (const auto& [name, text] : given)
            if (name == s.name + "[" + std::to_string(n) + "]") all[static_cast<size_t>(n)] = text;
    texts_[array] = std::move(all);
}

/// Whether all that the string can be is known, and what that is.
bool Builder::possibleTexts(const Inst* v, std::set<std::string>& out, int depth) const {
    if (depth > 16) return false;
    if (v->op == Op::ConstString) {
        out.insert(v->text);
        return true;
    }
    if (v->op == Op::Select && v->args.size() == 3)
        return possibleTexts(v->args[1], out, depth + 1) && possibleTexts(v->args[2], out, depth + 1);
    if (v->op == Op::Result && v->args[0]->op == Op::If)
        return std::all_of(v->args[0]->regions.begin(), v->args[0]->regions.end(), [&](const Region& r) {
            return possibleTexts(r.yields[static_cast<size_t>(v->index)], out, depth + 1);
        });
    const auto known = v->op == Op::ArrayLoad ? texts_.find(v->args[0]) : texts_.end();
    if (known == texts_.end()) return false;
    out.insert(known->second.begin(), known->second.end());
    return true;
}

Inst* Builder::getShader(const Expr& e) {
    Inst* h = expr(*e.args[0], Kind::String);
    if (h->op == Op::ConstString) {
        for (const Instance& i : instances_)
            if (i.binding->handle == h->text) return h;
        return leaves_.string("");
    }
    Inst* found = leaves_.string("");
    for (const Instance& i : instances_) {
        Inst* name = leaves_.string(i.binding->handle);
        found = emit(Op::Select, Kind::String, {emit(Op::Equal, Kind::Bool, {h, name}), name, found});
    }
    return found;
}

/// The handles that getshaders() gives, in the order of their names. `when`: where the category is known only when the shader
/// runs, whether each is among them; else empty.
std::vector<Inst*> Builder::handlesOf(const Expr& e, std::vector<Inst*>* when) {
    std::string wanted;
    Inst* asked = nullptr;
    for (const NamedArg& p : e.pairs) {
        if (p.name != "category") continue;
        Inst* v = expr(*p.value);
        if (v->op == Op::ConstString) wanted = v->text;
        else asked = v;
    }
    std::vector<Inst*> all;
    for (const Instance& i : instances_) {
        if (i.binding == &selfBinding_) continue;
        const auto& strings = i.binding->strings;
        const auto own = strings.find(kCategory);
        const std::string category = own == strings.end() ? std::string() : own->second;
        if (!inCategory(wanted, category)) continue;
        all.push_back(leaves_.string(i.binding->handle));
        if (!asked || !when) continue;
        Site s;
        s.op = "incategory";
        s.strings = {"", category};
        s.resultKinds = {Kind::Float};
        s.resultNames = {""};
        s.resultType = {Base::Float, 0};
        place_ = e.place;
        std::vector<Inst*> args;
        addArgument(s, args, asked, {Base::String, 0});
        when->push_back(emit(Op::NotEqual, Kind::Bool, {call(Op::Service, std::move(s), std::move(args))[0], constant(0)}));
    }
    return all;
}

/// Stores the handles of getshaders() in the array and returns their number.
Inst* Builder::storeHandles(Inst* to, const Expr& e) {
    std::vector<Inst*> when;
    const std::vector<Inst*> all = handlesOf(e, &when);
    const size_t room = static_cast<size_t>(lengths(to) ? to->index : arrayLength(to));
    const auto full = [&] { complain(e.place, msg::kShadersRoom(room)); };
    if (when.empty()) {
        if (all.size() > room) full();
        for (size_t n = 0; n < std::min(all.size(), room); ++n)
            emit(Op::ArrayStore, Kind::None, {to, constant(static_cast<float>(n)), all[n]});
        return constant(static_cast<float>(std::min(all.size(), room)));
    }
    Inst* next = constant(0);
    const auto same = [&] { return std::vector<Inst*>{next}; };
    for (size_t n = 0; n < all.size(); ++n) {
        const auto store = [&] {
            emit(Op::ArrayStore, Kind::None, {to, next, all[n]});
            return std::vector<Inst*>{emit(Op::Add, Kind::Float, {next, constant(1)})};
        };
        const auto storeOrSay = [&] {
            Inst* fits = emit(Op::Less, Kind::Bool, {next, constant(static_cast<float>(room))});
            return branch(fits, store, [&] {
                full();
                return same();
            });
        };
        if (n < room) next = branch(when[n], store, same)[0];
        else next = branch(when[n], storeOrSay, same)[0];
    }
    return next;
}

} // namespace alpenglow::rsl::ir
