#include "rsl/passes/dce.h"
#include "rsl/ir/edit.h"
#include <cstring>

namespace alpenglow::rsl::passes {
namespace {

/// Marks what is needed, from the effects backwards; what is not marked goes, carried variables one by one.
struct Marker {
    Kernel& k;
    std::vector<char> live;
    std::vector<Inst*> work;
    std::vector<Inst*> owner;               ///< by id of a region parameter: its Loop or LightLoop
    std::vector<Inst*> parent;              ///< by id: the instruction whose region holds it
    std::vector<std::vector<Inst*>> stores; ///< by id of an array

    explicit Marker(Kernel& kernel)
        : k(kernel), live(k.pool.size()), owner(k.pool.size()), parent(k.pool.size()), stores(k.pool.size()) {}

    void index(Region& r, Inst* around) {
        for (Inst* p : r.params) {
            owner[p->id] = around;
            parent[p->id] = around;
        }
        for (Inst* i : r.body) {
            parent[i->id] = around;
            if (i->op == Op::ArrayStore) stores[i->args[0]->id].push_back(i);
            for (Region& sub : i->regions) index(sub, i);
        }
    }

    void mark(Inst* i) {
        if (live[i->id]) return;
        live[i->id] = 1;
        work.push_back(i);
    }

    static size_t fixedArgs(const Inst* i) { return i->op == Op::LightLoop ? 3 : 0; }
    static size_t fixedParams(const Inst* i) { return i->op == Op::LightLoop ? 4 : 0; }

    /// Carried variable or result `n` of a construct is needed.
    void markResult(Inst* o, size_t n) {
        mark(o);
        if (o->op == Op::If) {
            mark(o->regions[0].yields[n]);
            mark(o->regions[1].yields[n]);
        } else if (o->op == Op::Loop || o->op == Op::LightLoop) {
            mark(o->args[fixedArgs(o) + n]);
            for (Region& r : o->regions) mark(r.params[fixedParams(o) + n]);
            mark(o->regions.back().yields[n]);
        }
    }

    void run() {
        const auto roots = [&](auto&& self, Region& r) -> void {
            for (Inst* i : r.body) {
                if (i->op == Op::Output || i->op == Op::Emit || i->op == Op::Rescale || i->op == Op::Service ||
                    i->op == Op::Request) {
                    if (!isPure(k, *i) && !(i->op == Op::Request) && !removableService(i)) mark(i);
                }
                for (Region& sub : i->regions) self(self, sub);
            }
        };
        roots(roots, k.body);
        spread();
    }

    /// Marks what the marked instructions need.
    void spread() {
        while (!work.empty()) {
            Inst* i = work.back();
            work.pop_back();
            if (parent[i->id]) mark(parent[i->id]);
            switch (i->op) {
            case Op::Result:
                markResult(i->args[0], static_cast<size_t>(i->index));
                break;
            case Op::RegionParam: {
                Inst* o = owner[i->id];
                if (o->op == Op::Function) {
                    mark(o);
                    break;
                }
                for (Region& r : o->regions)
                    for (size_t p = fixedParams(o); p < r.params.size(); ++p)
                        if (r.params[p] == i) markResult(o, p - fixedParams(o));
                mark(o);
                break;
            }
            case Op::If:
                mark(i->args[0]);
                break;
            case Op::Function:
                for (Inst* y : i->regions[0].yields) mark(y);
                break;
            case Op::Loop:
                mark(i->regions[0].yields[0]);
                break;
            case Op::LightLoop:
                for (size_t a = 0; a < 3; ++a) mark(i->args[a]);
                break;
            default:
                for (Inst* a : i->args) mark(a);
                if (i->op == Op::ArrayNew)
                    for (Inst* s : stores[i->id]) mark(s);
            }
        }
    }

    /// Queries have no effect of their own: only printing, baking and random numbers are seen from outside; the last not when
    /// unused.
    bool removableService(const Inst* i) const {
        if (i->op != Op::Service) return false;
        const Site& s = k.sites[static_cast<size_t>(i->site)];
        return s.op == "random" ||
               (!s.resultKinds.empty() && s.shadeop && s.shadeop->section == "Messages" && s.op != "outputchannel");
    }
};

struct Sweeper {
    Kernel& k;
    Marker& m;
    int changes = 0;
    std::vector<int> renumber; ///< by id of a Result

    void region(Region& r) {
        std::vector<Inst*> body;
        body.reserve(r.body.size());
        for (Inst* i : r.body) {
            if (!m.live[i->id]) {
                ++changes;
                continue;
            }
            if (i->op == Op::If || i->op == Op::Loop || i->op == Op::LightLoop) construct(i);
            if (i->op == Op::Result) i->index = at(i->args[0], i->index);
            for (Region& sub : i->regions) region(sub);
            body.push_back(i);
        }
        r.body = std::move(body);
    }

    std::unordered_map<const Inst*, std::vector<int>> kept;
    int at(const Inst* owner, int old) {
        const auto it = kept.find(owner);
        return it == kept.end() ? old : it->second[static_cast<size_t>(old)];
    }

    void construct(Inst* i) {
        const size_t n = i->results.size();
        std::vector<char> keep(n);
        // A result is kept when its Result instruction or, in loops, its region parameter is needed.
        for (size_t r = 0; r < n; ++r) {
            keep[r] = used.count({i, static_cast<int>(r)}) != 0;
            if (i->op != Op::If)
                for (Region& sub : i->regions) keep[r] = keep[r] || m.live[sub.params[Marker::fixedParams(i) + r]->id];
        }
        std::vector<int> map(n);
        int next = 0;
        const auto filter = [&](std::vector<Inst*>& v, size_t from) {
            std::vector<Inst*> out(v.begin(), v.begin() + static_cast<long>(from));
            for (size_t r = 0; r < n; ++r)
                if (keep[r]) out.push_back(v[from + r]);
            v = std::move(out);
        };
        std::vector<Kind> kinds;
        for (size_t r = 0; r < n; ++r) {
            map[r] = keep[r] ? next++ : -1;
            if (keep[r]) kinds.push_back(i->results[r]);
            else ++changes;
        }
        if (i->op == Op::If) {
            filter(i->regions[0].yields, 0);
            filter(i->regions[1].yields, 0);
        } else {
            filter(i->args, Marker::fixedArgs(i));
            for (Region& sub : i->regions) {
                filter(sub.params, Marker::fixedParams(i));
                for (size_t p = 0; p < sub.params.size(); ++p) sub.params[p]->index = static_cast<int>(p);
            }
            filter(i->regions.back().yields, 0);
        }
        i->results = kinds;
        kept[i] = map;
    }

    struct Hash {
        size_t operator()(const std::pair<const Inst*, int>& p) const {
            return std::hash<const void*>()(p.first) * 31 + static_cast<size_t>(p.second);
        }
    };
    std::unordered_map<std::pair<const Inst*, int>, char, Hash> used;
};

/// Replaces loop variables that never change by their initial values.
int removeInvariant(Kernel& k) {
    Replacements rep;
    int changes = 0;
    const auto walk = [&](auto&& self, Region& r) -> void {
        for (Inst* i : r.body) {
            rep.apply(i);
            if (i->op == Op::Loop || i->op == Op::LightLoop) {
                const size_t fa = Marker::fixedArgs(i), fp = Marker::fixedParams(i);
                Region& body = i->regions.back();
                for (size_t n = 0; n < i->results.size(); ++n) {
                    Inst* y = body.yields[n];
                    const Inst* first = i->args[fa + n];
                    const bool sameConst =
                        y->op == Op::Const && first->op == Op::Const && y->numbers.size() == first->numbers.size() &&
                        std::memcmp(y->numbers.data(), first->numbers.data(), y->numbers.size() * sizeof(float)) == 0;
                    if (y == body.params[fp + n] || y == i->args[fa + n] || sameConst)
                        for (Region& sub : i->regions)
                            if (!rep.replaced(sub.params[fp + n])) {
                                rep.set(sub.params[fp + n], i->args[fa + n]);
                                ++changes;
                            }
                }
            }
            if (i->op == Op::Result && (i->args[0]->op == Op::Loop || i->args[0]->op == Op::LightLoop)) {
                Inst* o = i->args[0];
                const size_t n = static_cast<size_t>(i->index);
                if (rep.replaced(o->regions.back().params[Marker::fixedParams(o) + n])) {
                    rep.set(i, o->args[Marker::fixedArgs(o) + n]);
                    ++changes;
                }
            }
            for (Region& sub : i->regions) self(self, sub);
        }
        for (Inst*& y : r.yields) y = rep(y);
    };
    walk(walk, k.body);
    rep.apply(k.body);
    return changes;
}

} // namespace

bool needsLight(Kernel& k, Inst* output) {
    Marker m(k);
    m.index(k.body, nullptr);
    m.mark(output);
    m.spread();
    bool light = false;
    forEach(k.body, [&](const Inst* i) { light = light || (i->op == Op::Request && m.live[i->id]); });
    return light;
}

int removeDeadCode(Kernel& k) {
    int changes = removeInvariant(k);
    Marker m(k);
    m.index(k.body, nullptr);
    m.run();
    Sweeper s{k, m, 0, {}, {}, {}};
    forEach(k.body, [&](Inst* i) {
        if (i->op == Op::Result && m.live[i->id]) s.used[{i->args[0], i->index}] = 1;
    });
    s.region(k.body);
    return changes + s.changes;
}

void removeUnusedInputs(Kernel& k) {
    std::vector<int> map(k.inputs.size(), -1);
    std::vector<Input> kept;
    forEach(k.body, [&](Inst* i) {
        if (i->op == Op::Input || i->op == Op::ArrayInput) map[static_cast<size_t>(i->index)] = 0;
    });
    for (size_t n = 0; n < map.size(); ++n)
        if (map[n] == 0) {
            map[n] = static_cast<int>(kept.size());
            kept.push_back(k.inputs[n]);
        }
    k.inputs = std::move(kept);
    forEach(k.body, [&](Inst* i) {
        if (i->op == Op::Input || i->op == Op::ArrayInput) i->index = map[static_cast<size_t>(i->index)];
    });
}

} // namespace alpenglow::rsl::passes
