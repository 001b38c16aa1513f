// The constant part a of Ci = a + sum of w_i x_i.
#include "rsl/passes/affine_constant.h"
#include "rsl/ir/edit.h"

namespace alpenglow::rsl::passes {

void dropResults(Kernel& k, const Dependence& d) {
    std::vector<char> zero(k.pool.size(), 1);
    const auto z = [&](const Inst* i) {
        return d.of(i) ? zero[i->id] != 0 : isConst(i) && (i->kind == Kind::Float || i->kind == Kind::Triple) && [&] {
            for (float f : i->numbers)
                if (f != 0) return false;
            return true;
        }();
    };
    const auto value = [&](const Inst* i) {
        switch (i->op) {
        case Op::Result: {
            const Inst* o = i->args[0];
            const size_t n = static_cast<size_t>(i->index);
            if (o->op == Op::If) return z(o->regions[0].yields[n]) && z(o->regions[1].yields[n]);
            if (o->op == Op::Loop || o->op == Op::LightLoop)
                return z(o->args[n + (o->op == Op::LightLoop ? 3 : 0)]) && z(o->regions.back().yields[n]);
            if (o->op == Op::Runtime) return z(o->args[0]) && z(o->args[1]);
            return true;
        }
        case Op::Mul:
            return z(i->args[d.of(i->args[0]) ? 0 : 1]);
        case Op::Div:
        case Op::Neg:
        case Op::Splat:
        case Op::Extract:
            return z(i->args[0]);
        case Op::Add:
        case Op::Sub:
            return z(i->args[0]) && z(i->args[1]);
        case Op::Select:
            return z(i->args[1]) && z(i->args[2]);
        case Op::Triple:
            return z(i->args[0]) && z(i->args[1]) && z(i->args[2]);
        default:
            return false;
        }
    };
    for (bool changed = true; changed;) {
        changed = false;
        const auto lower = [&](const Inst* i, bool is) {
            if (zero[i->id] && !is) {
                zero[i->id] = 0;
                changed = true;
            }
        };
        forEach(static_cast<const Region&>(k.body), [&](const Inst* i) {
            if (d.of(i)) lower(i, value(i));
            if (i->op == Op::Loop || i->op == Op::LightLoop) {
                const size_t fa = i->op == Op::LightLoop ? 3 : 0, fp = i->op == Op::LightLoop ? 4 : 0;
                const Region& body = i->regions.back();
                for (size_t n = 0; n < body.yields.size(); ++n)
                    if (d.of(body.params[fp + n]))
                        for (const Region& sub : i->regions) lower(sub.params[fp + n], z(i->args[fa + n]) && z(body.yields[n]));
            }
        });
    }
    Leaves leaves(k);
    Replacements rep;
    forEach(k.body, [&](Inst* i) {
        if (!d.of(i) || (i->kind != Kind::Float && i->kind != Kind::Triple)) return;
        if (zero[i->id]) rep.set(i, leaves.constant(i->kind, 0.0f));
        else if (i->op == Op::Add && z(i->args[0])) rep.set(i, i->args[1]);
        else if ((i->op == Op::Add || i->op == Op::Sub) && z(i->args[1])) rep.set(i, i->args[0]);
    });
    rep.apply(k.body);
}

} // namespace alpenglow::rsl::passes
