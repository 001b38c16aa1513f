#include "rsl/passes/ifconvert.h"
#include "rsl/ir/edit.h"

namespace alpenglow::rsl::passes {
namespace {

/// Instructions the branch would cost when always run; a large number when it must not be.
int cost(const Kernel& k, const Region& r) {
    int c = 0;
    for (const Inst* i : r.body) {
        if (!isMovable(k, *i) || i->op == Op::Service) return 1 << 20;
        switch (i->op) {
        case Op::Const:
        case Op::ConstString:
        case Op::Result:
        case Op::Extract:
        case Op::Triple:
        case Op::Splat:
            break;
        case Op::Call:
            return 1 << 20;
        case Op::Div:
            c += 4;
            break;
        case Op::Runtime:
            c += i->text == "al_abs" || i->text == "al_min_f" || i->text == "al_max_f" || i->text == "al_sqrt"
                     ? 4
                     : kIfConvertCost + 1;
            break;
        default:
            c += i->kind == Kind::Triple ? 2 : 1;
        }
    }
    return c;
}

struct Converter {
    Kernel& k;
    Replacements rep;
    int changes = 0;

    Inst* add(std::vector<Inst*>& body, Inst* i, Place place) {
        i->place = place;
        body.push_back(i);
        return i;
    }

    /// c ? a : b. Of two calls of one function that differ in one argument, the argument is chosen, and one call is left.
    Inst* choose(Inst* c, Inst* a, Inst* b, Kind kind, const Place& place, std::vector<Inst*>& body) {
        if (a->op == Op::Result && b->op == Op::Result && a != b && a->index == b->index) {
            const Inst *f = a->args[0], *g = b->args[0];
            if (f->op == Op::Runtime && g->op == Op::Runtime && f->text == g->text && f->args.size() == g->args.size()) {
                size_t differ = 0, where = 0;
                for (size_t n = 0; n < f->args.size(); ++n)
                    if (f->args[n] != g->args[n]) ++differ, where = n;
                if (differ == 1 && f->args[where]->kind == g->args[where]->kind) {
                    Inst* chosen =
                        add(body, k.make(Op::Select, f->args[where]->kind, {c, f->args[where], g->args[where]}), place);
                    CopyMap none;
                    Inst* call = add(body, copyInst(k, f, none), f->place);
                    call->args[where] = chosen;
                    Inst* result = add(body, k.make(Op::Result, kind, {call}), place);
                    result->index = a->index;
                    return result;
                }
            }
        }
        return add(body, k.make(Op::Select, kind, {c, a, b}), place);
    }

    void region(Region& r) {
        std::vector<Inst*> body;
        body.reserve(r.body.size());
        for (Inst* i : r.body) {
            rep.apply(i);
            for (Region& sub : i->regions) region(sub);
            if (i->op == Op::Result && converted.count(i->args[0])) {
                Inst* o = i->args[0];
                const size_t n = static_cast<size_t>(i->index);
                Inst* s =
                    choose(rep(o->args[0]), rep(o->regions[0].yields[n]), rep(o->regions[1].yields[n]), i->kind, o->place, body);
                rep.set(i, s);
                continue;
            }
            if (i->op == Op::If && cost(k, i->regions[0]) + cost(k, i->regions[1]) <= kIfConvertCost) {
                for (Region& sub : i->regions)
                    for (Inst* x : sub.body) body.push_back(x);
                converted.insert({i, 1});
                ++changes;
                continue;
            }
            body.push_back(i);
        }
        for (Inst*& y : r.yields) y = rep(y);
        r.body = std::move(body);
    }
    std::unordered_map<const Inst*, char> converted;
};

} // namespace

int convertIfs(Kernel& k) {
    Converter c{k, {}, 0, {}};
    c.region(k.body);
    return c.changes;
}

} // namespace alpenglow::rsl::passes
