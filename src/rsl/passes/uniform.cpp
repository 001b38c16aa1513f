#include "rsl/passes/uniform.h"
#include "rsl/ir/edit.h"

namespace alpenglow::rsl::ir {
namespace {

/// Starts with everything uniform and raises to varying until nothing changes.
struct Marker {
    Kernel& k;
    bool mixed;
    bool changed = false;

    void raise(Inst* i, bool varying) {
        if (varying && !i->varying) {
            i->varying = true;
            changed = true;
        }
    }

    /// `control`: the instruction runs under a varying condition.
    void region(Region& r, bool control) {
        for (Inst* i : r.body) inst(i, control);
    }

    void inst(Inst* i, bool control) {
        bool any = false;
        for (const Inst* a : i->args) any = any || a->varying;
        switch (i->op) {
        case Op::Input:
        case Op::ArrayInput:
            raise(i, mixed || !k.inputs[static_cast<size_t>(i->index)].uniform);
            return;
        case Op::Service:
        case Op::Request:
        case Op::Mark:
            raise(i, true);
            return;
        case Op::ArrayNew:
            return; // raised by its stores
        case Op::ArrayStore:
            raise(i->args[0], any || control);
            return;
        case Op::Result: {
            Inst* o = i->args[0];
            const size_t n = static_cast<size_t>(i->index);
            if (o->op == Op::If)
                raise(i, o->args[0]->varying || o->regions[0].yields[n]->varying || o->regions[1].yields[n]->varying);
            else if (o->op == Op::Loop || o->op == Op::LightLoop)
                raise(i, o->regions.back().params[n + (o->op == Op::LightLoop ? 4 : 0)]->varying);
            else if (o->op == Op::Call) raise(i, o->varying || o->args[0]->regions[0].yields[n]->varying);
            else raise(i, o->varying);
            return;
        }
        case Op::If: {
            const bool inside = control || i->args[0]->varying;
            region(i->regions[0], inside);
            region(i->regions[1], inside);
            if (i->kind != Kind::None)
                raise(i, i->args[0]->varying || i->regions[0].yields[0]->varying || i->regions[1].yields[0]->varying);
            else raise(i, i->args[0]->varying);
            return;
        }
        case Op::Loop:
        case Op::LightLoop: {
            const bool light = i->op == Op::LightLoop;
            const size_t fa = light ? 3 : 0, fp = light ? 4 : 0;
            Region& body = i->regions.back();
            // Lights are visited by the lanes they reach: what a turn leaves behind differs between lanes.
            bool exit = light || i->regions[0].yields[0]->varying;
            if (light)
                for (size_t p = 0; p < 3; ++p) raise(body.params[p], true);
            for (size_t n = 0; n < body.yields.size(); ++n) {
                const bool v = exit || i->args[fa + n]->varying || body.yields[n]->varying || body.params[fp + n]->varying;
                for (Region& sub : i->regions) raise(sub.params[fp + n], v);
            }
            for (Region& sub : i->regions) region(sub, control || exit);
            if (i->kind != Kind::None) raise(i, body.params[fp]->varying);
            return;
        }
        case Op::Function:
            region(i->regions[0], false);
            return;
        case Op::Call: { // one body for all calls
            Region& body = i->args[0]->regions[0];
            for (size_t p = 0; p < body.params.size(); ++p) raise(body.params[p], i->args[p + 1]->varying);
            raise(i, any);
            if (i->kind != Kind::None) raise(i, body.yields[0]->varying);
            return;
        }
        default:
            raise(i, any);
        }
    }
};

} // namespace

void markUniform(Kernel& k, bool mixed) {
    const auto clear = [](auto&& self, Region& r) -> void {
        for (Inst* p : r.params) p->varying = false;
        for (Inst* i : r.body) {
            i->varying = false;
            for (Region& sub : i->regions) self(self, sub);
        }
    };
    clear(clear, k.body);
    Marker m{k, mixed};
    do {
        m.changed = false;
        m.region(k.body, false);
    } while (m.changed);
}

} // namespace alpenglow::rsl::ir
