#include "rsl/passes/derivatives.h"
#include "rsl/ir/edit.h"
#include "rsl/kernel.h"
#include "rsl/messages/messages.h"
#include <algorithm>
#include <functional>
#include <unordered_map>

namespace alpenglow::rsl::passes {
namespace {

struct Orders {
    Orders(Kernel& kernel, Diagnostics& d) : k(kernel), diagnostics(d), owner(k.pool.size()), stores(k.pool.size()) {
        index(k.body, nullptr);
    }
    Kernel& k;
    Diagnostics& diagnostics;
    std::vector<Inst*> owner;               ///< by id of a region parameter
    std::vector<std::vector<Inst*>> stores; ///< by id of an array
    std::vector<Inst*> work;
    /// What a function wants of its parameters: for itself (a derivative taken inside), and for order 1 and 2 of each result.
    struct Needs {
        std::vector<uint8_t> own;
        std::vector<std::vector<uint8_t>> of[3];
    };
    std::unordered_map<const Inst*, Needs> needs;
    std::unordered_map<const Inst*, std::vector<uint8_t>> calls; ///< orders of the results of calls
    bool quiet = false;
    bool enter = true; ///< a demand on a call goes into the function's body, too

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

    void warn(const Inst* i, const Raised& message) {
        if (quiet) return;
        const size_t f = static_cast<size_t>(i->place.file);
        const SourcePlace at{f < k.files.size() ? k.files[f] : std::string(), i->place.line, i->place.column};
        diagnostics.reportOnce("derivative:" + at.file + std::to_string(at.line) + message.text(),
                               diagnostic(message, Rie::Math, at));
    }

    void demand(Inst* i, uint8_t n) {
        if (n <= i->order || i->kind == Kind::Bool || i->kind == Kind::String) return;
        i->order = n;
        work.push_back(i);
    }

    void construct(Inst* o, size_t n, uint8_t order) {
        switch (o->op) {
        case Op::Call: {
            std::vector<uint8_t>& mine = calls[o];
            mine.resize(std::max(mine.size(), n + 1));
            if (mine[n] >= order) break;
            mine[n] = order;
            const Inst* f = o->args[0];
            const std::vector<uint8_t>& wanted = needs.at(f).of[order][n];
            for (size_t p = 0; p < wanted.size(); ++p) demand(o->args[p + 1], wanted[p]);
            if (enter) demand(f->regions[0].yields[n], order);
            break;
        }
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

    /// What rayinfo() counts is a whole number, so its derivative is 0.
    static bool counts(const Site& s) {
        return s.op == "rayinfo" && !s.strings.empty() &&
               (s.strings[0] == "depth" || s.strings[0] == "speculardepth" || s.strings[0] == "diffusedepth");
    }

    void opaque(const Inst* i) {
        const Site& s = k.sites[static_cast<size_t>(i->site)];
        if (counts(s)) return;
        const DerivativeRule rule = s.shadeop ? s.shadeop->derivative : DerivativeRule::ZeroWarn;
        if (rule == DerivativeRule::ZeroWarn || (rule == DerivativeRule::Gradient && i->op != Op::Service)) // see gradients.h
            warn(i, msg::kZeroDerivative(s.op == "gatherturn" ? "what gather() brings" : s.op + "()"));
    }

    /// Derivatives taken in a region, and by the functions that it calls. The bodies of functions are their own matter.
    void start(Region& r) {
        for (Inst* i : r.body) {
            if (i->op == Op::Du || i->op == Op::Dv) demand(i->args[0], 1);
            if (i->op == Op::Call) {
                const std::vector<uint8_t>& own = needs.at(i->args[0]).own;
                for (size_t p = 0; p < own.size(); ++p) demand(i->args[p + 1], own[p]);
            }
            if (i->op != Op::Function)
                for (Region& sub : i->regions) start(sub);
        }
    }

    void clear(Region& r) {
        for (Inst* p : r.params) p->order = 0;
        for (Inst* i : r.body) {
            i->order = 0;
            for (Region& sub : i->regions) clear(sub);
        }
    }

    /// Demands of all functions, callees before callers. The orders found on the way are reset.
    void study() {
        enter = false;
        quiet = true;
        for (Inst* f : k.body.body) {
            if (f->op != Op::Function) continue;
            Needs& n = needs[f];
            Region& body = f->regions[0];
            const auto ask = [&](std::vector<uint8_t>& out) {
                propagate();
                for (Inst* p : body.params) out.push_back(p->order);
                clear(body);
                for (Inst* i : k.body.body)
                    if (isLeaf(i)) i->order = 0;
                    else break;
                calls.clear();
            };
            start(body);
            ask(n.own);
            for (uint8_t order = 1; order <= 2; ++order)
                for (Inst* y : body.yields) {
                    demand(y, order);
                    ask(n.of[order].emplace_back());
                }
        }
        for (Input& in : k.inputs) in.order = 0;
        quiet = false;
    }

    void run() {
        study();
        enter = true;
        start(k.body);
        for (Inst* f : k.body.body)
            if (f->op == Op::Function) start(f->regions[0]);
        propagate();
    }

    void propagate() {
        while (!work.empty()) {
            Inst* i = work.back();
            work.pop_back();
            const uint8_t n = i->order;
            switch (i->op) {
            case Op::Du:
            case Op::Dv:
                if (n >= 2) warn(i, msg::kThirdDerivative);
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
            case Op::Call:
            case Op::Service:
            case Op::Request:
                construct(i, 0, n);
                break; // short form
            case Op::RegionParam: {
                Inst* o = owner[i->id];
                if (o->op == Op::Function) break;
                const size_t fixed = o->op == Op::LightLoop ? 4 : 0;
                for (Region& r : o->regions)
                    for (size_t p = 0; p < r.params.size(); ++p)
                        if (r.params[p] == i) {
                            if (p >= fixed) construct(o, p - fixed, n);
                            else warn(o, msg::kZeroDerivative("L, Cl and Ol"));
                        }
                break;
            }
            case Op::Input:
            case Op::ArrayInput: {
                Input& in = k.inputs[static_cast<size_t>(i->index)];
                if (!in.constant && in.kind != Kind::Matrix)
                    in.order = std::max(in.order, n); // callers pass matrices without derivatives
                else i->order = 0;                    // and is never asked again for less
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
    Orders o(k, d);
    o.run();
}

CallOrders callOrders(Kernel& k, Inst* function, const std::vector<uint8_t>& results) {
    Diagnostics quiet; // reported by orderDerivatives()
    Orders o(k, quiet);
    if (function) o.index(function->regions[0], function);
    o.study();
    o.enter = false;
    Region& r = function ? function->regions[0] : k.body;
    o.start(r);
    for (size_t n = 0; n < results.size(); ++n) o.demand(r.yields[n], results[n]);
    o.propagate();
    CallOrders list;
    std::function<void(Region&)> walk = [&](Region& region) {
        for (Inst* i : region.body) {
            if (i->op == Op::Function) continue;
            if (i->op == Op::Call) {
                std::vector<uint8_t> orders = o.calls[i];
                orders.resize(i->args[0]->regions[0].yields.size());
                list.emplace_back(i, std::move(orders));
            }
            for (Region& sub : i->regions) walk(sub);
        }
    };
    walk(r);
    return list;
}

} // namespace alpenglow::rsl::passes
