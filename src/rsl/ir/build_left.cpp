// Members that displacement() of a class leaves to its other methods (rsl/front/leftmembers.h): outputs "param:this->NAME" of the
// one kernel, inputs "displacement:this->NAME" of the other. "#" behind the name: the length of an array that changes it.
#include "rsl/front/leftmembers.h"
#include "rsl/front/protocol.h"
#include "rsl/ir/builder.h"
#include <algorithm>

namespace alpenglow::rsl::ir {

/// The value of an output OutputName::left(); null if `name` is no such output.
Inst* Builder::leftBehind(const std::string& name, Type& type) {
    const OutputName o = OutputName::parse(name);
    const Symbol* s = o.member ? ownMember(shader_, o.name) : nullptr;
    if (!s) return nullptr;
    Inst* v = get(slot(s));
    type = s->type;
    if (o.length) {
        type = {Base::Float, 0};
        return lengths(v) ? get(lengths(v)->length) : nullptr;
    }
    if (o.what == OutputName::What::Value) return v;
    if (v->kind != Kind::Float && v->kind != Kind::Triple) return nullptr;
    return emit(o.what == OutputName::What::Du ? Op::Du : Op::Dv, v->kind, {v});
}

/// KernelOptions::stringParameters, "displacement:this->NAME": the elements of an array, "length" behind them where their number
/// is an input too; else 0.
void Builder::hearMembers() {
    for (const auto& [key, text] : options_.stringParameters) {
        const InputName parsed = InputName::parse(key);
        const Symbol* s = parsed.member ? ownMember(shader_, parsed.name) : nullptr;
        if (!s) continue;
        if (!s->type.array) {
            set(slot(s), input(key, s->type, false));
            continue;
        }
        const QueriedMember queried = QueriedMember::parse(text);
        const int count = queried.count;
        Inst* a = get(slot(s));
        if (count < 1 || a->op != Op::ArrayNew) continue;
        Inst* from = input(key, {s->type.base, count}, false);
        if (const Lengths* known = lengths(a)) {
            const Lengths l = *known;
            Inst* n = limitLength(a, queried.length ? input(InputName::left(parsed.name, true).text(), {Base::Float, 0}, false)
                                                    : constant(static_cast<float>(count)));
            set(l.length, n);
            set(l.reserved, runtime1("al_max_f", {get(l.reserved), n}, Kind::Float));
        }
        for (int n = 0; n < std::min(count, lengths(a) ? a->index : arrayLength(a)); ++n) {
            Inst* at = constant(static_cast<float>(n));
            emit(Op::ArrayStore, Kind::None, {a, at, emit(Op::ArrayLoad, from->element, {from, at})});
        }
    }
}

/// The body of a class: members, methods, construct() and begin(), the methods that the renderer runs. What displacement() left
/// counts from where the last of these begin. `opacityOnly`: what stops shadows is what opacity() gives, before the other methods
/// change it.
void Builder::objectBody(bool opacityOnly) {
    const std::vector<StmtPtr>& all = shader_.body->body;
    const auto calls = [](const Stmt& s, const char* name) {
        return s.kind == StmtKind::Expression && s.value && s.value->text == name;
    };
    size_t first = 0;
    for (size_t n = 0; n < all.size(); ++n)
        if (all[n]->definition || calls(*all[n], "construct") || calls(*all[n], "begin")) first = n + 1;
    for (size_t n = 0; n < all.size(); ++n) {
        if (n == first) hearMembers();
        // A class that displaces and shades prints its messages when it shades, not twice.
        const auto quiet = std::find_if(options_.stringParameters.begin(), options_.stringParameters.end(),
                                        [](const auto& p) { return p.first == kBeginQuiet; }) != options_.stringParameters.end();
        quiet_ += quiet && n < first;
        statement(*all[n]);
        quiet_ -= quiet && n < first;
        if (opacityOnly && calls(*all[n], "opacity")) break;
    }
}

} // namespace alpenglow::rsl::ir
