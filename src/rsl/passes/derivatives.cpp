#include "rsl/passes/derivatives.h"
#include "rsl/ir/edit.h"
#include "rsl/kernel.h"
#include <algorithm>

namespace alpenglow::rsl::ir {
namespace {

struct Orders {
    Kernel& k;
    Diagnostics& diagnostics;
    std::vector<Inst*> owner;               ///< by id of a region parameter
    std::vector<std::vector<Inst*>> stores; ///< by id of an array
    std::vector<Inst*> work;

    void index(Region& r, Inst* around) {
        for (Inst* p : r.params) {
            owner[p->id] = around;
            p->order = 0;
        }
        for (Inst* i : r.body) {
            i->order = 0;
            if (i->op == Op::ArrayStore) stores[i->args[0]->id].push_back(i);
            for (Region& sub : i->regions) index(sub, i);
        }
    }

    void warn(const Inst* i, const std::string& text) {
        const size_t f = static_cast<size_t>(i->place.file);
        const SourcePlace at{f < k.files.size() ? k.files[f] : std::string(), i->place.line, i->place.column};
        diagnostics.reportOnce("derivative:" + at.file + std::to_string(at.line) + text,
                               {Severity::Warning, Rie::Math, at, text, {}, {}});
    }

    void demand(Inst* i, uint8_t n) {
        if (n <= i->order || i->kind == Kind::Bool || i->kind == Kind::String || i->kind == Kind::Matrix) return;
        i->order = n;
        work.push_back(i);
    }

    void construct(Inst* o, size_t n, uint8_t order) {
        switch (o->op) {
        case Op::If:
            demand(o->regions[0].yields[n], order);
            demand(o->regions[1].yields[n], order);
            break;
        case Op::Loop:
        case Op::LightLoop: {
            const bool light = o->op == Op::LightLoop;
            demand(o->args[n + (light ? 3 : 0)], order);
            for (Region& r : o->regions) demand(r.params[n + (light ? 4 : 0)], order);
            demand(o->regions.back().yields[n], order);
            break;
        }
        case Op::Runtime:
            o->order = std::max(o->order, order);
            for (Inst* a : o->args) demand(a, order);
            break;
        default:
            opaque(o);
        }
    }

    void opaque(const Inst* i) {
        const Site& s = k.sites[static_cast<size_t>(i->site)];
        if (!s.shadeop || s.shadeop->derivative == DerivativeRule::ZeroWarn)
            warn(i, "the derivative of " + s.op + "() is taken as zero");
    }

    void run() {
        forEach(k.body, [&](Inst* i) {
            if (i->op == Op::Du || i->op == Op::Dv) demand(i->args[0], 1);
        });
        while (!work.empty()) {
            Inst* i = work.back();
            work.pop_back();
            const uint8_t n = i->order;
            switch (i->op) {
            case Op::Du:
            case Op::Dv:
                if (n >= 2) warn(i, "a derivative of third order is taken as zero");
                demand(i->args[0], static_cast<uint8_t>(std::min<int>(n + 1, 2)));
                break;
            case Op::Select:
                demand(i->args[1], n);
                demand(i->args[2], n);
                break;
            case Op::Result: {
                Inst* o = i->args[0];
                construct(o, static_cast<size_t>(i->index), n);
                break;
            }
            case Op::If:
            case Op::Loop:
            case Op::LightLoop:
            case Op::Runtime:
            case Op::Service:
            case Op::Request:
                construct(i, 0, n);
                break; // short form
            case Op::RegionParam: {
                Inst* o = owner[i->id];
                const size_t fixed = o->op == Op::LightLoop ? 4 : 0;
                for (Region& r : o->regions)
                    for (size_t p = 0; p < r.params.size(); ++p)
                        if (r.params[p] == i) {
                            if (p >= fixed) construct(o, p - fixed, n);
                            else warn(o, "the derivative of L, Cl and Ol is taken as zero");
                        }
                break;
            }
            case Op::Input:
            case Op::ArrayInput: {
                Input& in = k.inputs[static_cast<size_t>(i->index)];
                if (!in.constant) in.order = std::max(in.order, n);
                else i->order = 0; // and is never asked again for less
                break;
            }
            case Op::ArrayLoad:
                demandArray(i->args[0], n);
                break;
            case Op::Less:
            case Op::LessEqual:
            case Op::Equal:
            case Op::NotEqual:
            case Op::ToFloat:
            case Op::Const:
                break;
            default:
                for (Inst* a : i->args) demand(a, n);
            }
        }
    }

    void demandArray(Inst* a, uint8_t n) {
        if (a->op == Op::ArrayInput || n <= a->order) return;
        a->order = n;
        for (Inst* s : stores[a->id]) demand(s->args[2], n);
    }
};

} // namespace

void orderDerivatives(Kernel& k, Diagnostics& d) {
    for (Input& in : k.inputs) in.order = 0;
    Orders o{k, d, std::vector<Inst*>(k.pool.size()), std::vector<std::vector<Inst*>>(k.pool.size()), {}};
    o.index(k.body, nullptr);
    o.run();
}

} // namespace alpenglow::rsl::ir
