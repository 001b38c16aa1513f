#include "rsl/passes/neighbours.h"
#include "rsl/ir/edit.h"
#include "rsl/passes/gradients.h"
#include <algorithm>
#include <array>

namespace alpenglow::rsl::passes {

bool stepFrom(Neighbour n, bool v, Neighbour& next) {
    static constexpr Neighbour kNext[3][2] = {
        {Neighbour::U, Neighbour::V}, {Neighbour::UU, Neighbour::UV}, {Neighbour::UV, Neighbour::VV}};
    if (n > Neighbour::V) return false;
    next = kNext[static_cast<size_t>(n)][v];
    return true;
}

// Motion

Motion::Motion(Kernel& k)
    : k_(k), owner_(k.pool.size()), stores_(k.pool.size()), moves_(k.pool.size()), position_(k.pool.size()),
      plain_(k.pool.size()) {
    index(k.body, nullptr);
    markPlain(k.body);
    while (grow()) {}
}

void Motion::index(Region& r, Inst* around) {
    for (size_t n = 0; n < r.params.size(); ++n) {
        owner_[r.params[n]->id] = around;
        position_[r.params[n]->id] = static_cast<int>(n);
    }
    for (Inst* i : r.body) {
        owner_[i->id] = around;
        if (i->op == Op::ArrayStore) stores_[i->args[0]->id].push_back(i);
        for (Region& sub : i->regions) index(sub, i);
    }
}

bool Motion::markPlain(const Region& r) {
    bool plain = true;
    for (const Inst* i : r.body) {
        bool own = true;
        for (const Region& sub : i->regions) own &= markPlain(sub);
        plain_[i->id] = own;
        if (i->op == Op::Function) continue;
        const bool effect = i->op == Op::ArrayStore || i->op == Op::Request || i->op == Op::LightLoop || i->op == Op::Output ||
                            (i->op == Op::Service && !k_.sites[static_cast<size_t>(i->site)].pure) ||
                            (i->op == Op::Call && !plain_[i->args[0]->id]);
        plain = plain && own && !effect;
    }
    return plain;
}

int Motion::position(const Inst* p) const { return position_[p->id]; }

bool Motion::inside(const Inst* i, const Inst* construct) const {
    for (const Inst* o = owner_[i->id]; o; o = owner_[o->id])
        if (o == construct) return true;
    return false;
}

bool Motion::grow() {
    bool changed = false;
    const auto set = [&](const Inst* i) {
        if (moves_[i->id]) return;
        moves_[i->id] = 1;
        changed = true;
    };
    forEach(k_.body, [&](Inst* i) {
        if (!moves_[i->id] && movesNow(i)) set(i);
        if (i->op == Op::ArrayStore && (moves(i->args[1]) || moves(i->args[2]))) set(i->args[0]);
        if (i->op == Op::Loop || i->op == Op::LightLoop) {
            const size_t skip = i->op == Op::LightLoop ? 3 : 0, fixed = i->op == Op::LightLoop ? 4 : 0;
            const Region& body = i->regions.back();
            for (size_t n = 0; n < body.yields.size(); ++n)
                if (moves(i->args[skip + n]) || moves(body.yields[n]))
                    for (const Region& r : i->regions) set(r.params[fixed + n]);
        }
        if (i->op == Op::Call)
            for (size_t a = 1; a < i->args.size(); ++a)
                if (moves(i->args[a])) set(i->args[0]->regions[0].params[a - 1]);
    });
    return changed;
}

bool Motion::movesNow(const Inst* i) const {
    switch (i->op) {
    case Op::Const:
    case Op::ConstString:
    case Op::ArrayInput:
    case Op::RegionParam:
    case Op::ArrayNew:
    case Op::Function:
        return false;
    case Op::Input: {
        const Input& in = k_.inputs[static_cast<size_t>(i->index)];
        const bool number = in.kind == Kind::Float || in.kind == Kind::Triple;
        for (const char* same : {"du", "dv", "E", "time", "ncomps", "alpha"})
            if (in.name == same) return false;
        return number && !in.uniform && !in.constant && in.array == 0;
    }
    case Op::Result:
        return resultMoves(i->args[0], static_cast<size_t>(i->index));
    default:
        return std::any_of(i->args.begin(), i->args.end(), [&](const Inst* a) { return moves(a); });
    }
}

bool Motion::resultMoves(const Inst* o, size_t n) const {
    const auto any = [&] { return std::any_of(o->args.begin(), o->args.end(), [&](const Inst* a) { return moves(a); }); };
    switch (o->op) {
    case Op::Runtime:
        return any();
    case Op::Service: {
        const Site& s = k_.sites[static_cast<size_t>(o->site)];
        return s.pure && s.shadeop && s.shadeop->derivative == DerivativeRule::Gradient && any();
    }
    case Op::If:
        return moves(o->args[0]) || moves(o->regions[0].yields[n]) || moves(o->regions[1].yields[n]);
    case Op::Loop:
        return moves(o->regions[0].yields[0]) || moves(o->args[n]) || moves(o->regions[1].yields[n]);
    case Op::LightLoop:
        return moves(o->args[3 + n]) || moves(o->regions[0].yields[n]);
    case Op::Call:
        return moves(o->args[0]->regions[0].yields[n]) && repeatable(o->args[0], static_cast<int>(n));
    default:
        return false;
    }
}

struct Motion::Slice {
    const Motion& m;
    const Inst* construct;
    std::set<const Inst*> seen;
    std::vector<const Inst*> work;
    bool good = true;

    void need(const Inst* i) {
        if (!isLeaf(i) && m.inside(i, construct) && seen.insert(i).second) work.push_back(i);
    }
    void needLoop(const Inst* loop, size_t n) {
        need(loop->regions[0].yields[0]);
        need(loop->regions[1].yields[n]);
        need(loop->args[n]);
    }
    void array(const Inst* a) {
        if (a->op != Op::ArrayNew) return;
        const bool own = m.inside(a, construct);
        for (const Inst* s : m.stores(a)) {
            if (!m.inside(s, construct)) continue;
            good = good && own;
            need(s->args[1]);
            need(s->args[2]);
            for (const Inst* o = m.owner(s); o && o != construct; o = m.owner(o)) {
                good = good && o->op != Op::LightLoop;
                if (o->op == Op::If) need(o->args[0]);
                if (o->op == Op::Loop) need(o->regions[0].yields[0]);
            }
        }
    }
    void result(const Inst* o, size_t n) {
        switch (o->op) {
        case Op::Service:
            good = good && m.k_.sites[static_cast<size_t>(o->site)].pure;
            [[fallthrough]];
        case Op::Runtime:
            for (const Inst* a : o->args) need(a);
            return;
        case Op::Call:
            good = good && m.repeatable(o->args[0], static_cast<int>(n));
            for (size_t a = 1; a < o->args.size(); ++a) need(o->args[a]);
            return;
        case Op::If:
            need(o->args[0]);
            for (const Region& r : o->regions) need(r.yields[n]);
            return;
        case Op::Loop:
            needLoop(o, n);
            return;
        default:
            good = false;
        }
    }
    void step(const Inst* i) {
        if (i->op == Op::Result) return result(i->args[0], static_cast<size_t>(i->index));
        if (i->op == Op::RegionParam) {
            const Inst* o = m.owner(i);
            if (o->op == Op::Loop) needLoop(o, static_cast<size_t>(m.position(i)));
            else good = good && o->op != Op::LightLoop;
            return;
        }
        if (i->op == Op::ArrayLoad) array(i->args[0]);
        for (const Inst* a : i->args) need(a);
    }
    bool run() {
        while (good && !work.empty()) {
            const Inst* i = work.back();
            work.pop_back();
            step(i);
        }
        return good;
    }
};

bool Motion::repeatable(const Inst* o, int n) const {
    if (plain_[o->id]) return true;
    const auto [it, fresh] = repeatable_.try_emplace({o, n}, true);
    if (!fresh) return it->second;
    Slice s{*this, o, {}, {}, true};
    if (o->op == Op::Function) s.need(o->regions[0].yields[static_cast<size_t>(n)]);
    else s.result(o, static_cast<size_t>(n));
    return repeatable_[{o, n}] = s.run();
}

// Demand

bool Demand::add(std::map<Key, std::vector<uint8_t>>& m, const Inst* a, const Inst* b, size_t index, Neighbour n) {
    std::vector<uint8_t>& v = m[{a, b}];
    if (v.size() <= index) v.resize(index + 1);
    if (v[index] & bitOf(n)) return false;
    v[index] |= bitOf(n);
    return true;
}

uint8_t Demand::results(const Inst* o, const Inst* within) const {
    uint8_t all = 0;
    if (const auto it = results_.find({o, within}); it != results_.end())
        for (const uint8_t bits : it->second) all |= bits;
    return all;
}

Demand::Carried Demand::carried(const Inst* o, const Inst* within) const {
    Carried list;
    if (const auto it = carried_.find({o, within}); it != carried_.end())
        for (size_t k = 0; k < it->second.size(); ++k)
            for (int n = 0; n < kNeighbours; ++n)
                if (it->second[k] & bitOf(neighbour(n))) list.emplace_back(static_cast<int>(k), neighbour(n));
    return list;
}

Demand::Demand(Motion& m, Functions& functions) : motion_(m), functions_(functions) {
    // Callees precede callers: their demands on arguments are known when a call is reached.
    for (Inst* i : m.kernel().body.body) {
        if (i->op != Op::Function) continue;
        start(i->regions[0]);
        close();
    }
    start(m.kernel().body);
    close();
}

Demand::Demand(Motion& m, Functions& functions, const Inst* f, int result, Neighbour n) : motion_(m), functions_(functions) {
    want(f->regions[0].yields[static_cast<size_t>(result)], n, f);
    close();
}

Demand& Demand::function(const Inst* f, int result, Neighbour n) {
    auto& d = functions_[{f, result, n}];
    if (!d) d = std::make_unique<Demand>(motion_, functions_, f, result, n);
    return *d;
}

void Demand::start(const Region& r) {
    for (const Inst* i : r.body) {
        if (i->op == Op::Du) want(i->args[0], Neighbour::U, nullptr);
        if (i->op == Op::Dv) want(i->args[0], Neighbour::V, nullptr);
        if (i->op == Op::Call)
            for (const auto& [p, n] : carried(i->args[0], nullptr)) want(i->args[static_cast<size_t>(p) + 1], n, nullptr);
        if (i->op != Op::Function)
            for (const Region& sub : i->regions) start(sub);
    }
}

void Demand::want(Inst* i, Neighbour n, const Inst* within) {
    if (isLeaf(i)) return;
    if (within && !motion_.inside(i, within)) within = nullptr;
    if (!within && (n == Neighbour::Here || !motion_.moves(i))) return;
    uint8_t& bits = values_[{i, within}];
    if (bits & bitOf(n)) return;
    bits |= bitOf(n);
    work_.push_back({i, n, within});
}

void Demand::close() {
    while (!work_.empty()) {
        const Wanted w = work_.back();
        work_.pop_back();
        spread(w);
    }
}

void Demand::spread(const Wanted& w) {
    Inst* i = w.inst;
    switch (i->op) {
    case Op::Du:
    case Op::Dv: {
        Neighbour next{};
        want(i->args[0], w.at, w.within);
        if (stepFrom(w.at, i->op == Op::Dv, next)) want(i->args[0], next, w.within);
        return;
    }
    case Op::Result:
        return spreadResult(i->args[0], i->index, w.at, w.within);
    case Op::RegionParam: {
        Inst* o = motion_.owner(i);
        const int at = motion_.position(i);
        if (o->op == Op::Function) add(carried_, o, w.within, static_cast<size_t>(at), w.at);
        else carry(o, at - (o->op == Op::LightLoop ? 4 : 0), w.at, w.within);
        return;
    }
    case Op::ArrayLoad:
        want(i->args[1], w.at, w.within);
        return keep(i->args[0], w.at, w.within);
    default:
        for (Inst* a : i->args) want(a, w.at, w.within);
    }
}

void Demand::spreadResult(Inst* o, int index, Neighbour n, const Inst* within) {
    const auto k = static_cast<size_t>(index);
    add(results_, o, within, k, n);
    switch (o->op) {
    case Op::Runtime:
        for (Inst* a : o->args) want(a, n, within);
        return;
    case Op::Service:
        return spreadService(o, n, within);
    case Op::Call:
        for (const auto& [p, m] : function(o->args[0], index, n).carried(o->args[0], o->args[0]))
            want(o->args[static_cast<size_t>(p) + 1], m, within);
        return;
    case Op::If: {
        const bool repeat = within || motion_.repeatable(o, index);
        if (repeat) want(o->args[0], n, within);
        else add(carried_, o, nullptr, k, n);
        for (Region& r : o->regions) want(r.yields[k], n, within ? within : repeat ? o : nullptr);
        return;
    }
    case Op::Loop:
        return carry(o, index, n, within ? within : motion_.repeatable(o, index) ? o : nullptr);
    case Op::LightLoop:
        return carry(o, index, n, nullptr);
    default:
        return;
    }
}

void Demand::spreadService(Inst* o, Neighbour n, const Inst* within) {
    // A neighbour's lookup has the filter of the point.
    const std::vector<size_t> moving = lookupCoordinates(motion_.kernel(), o);
    for (size_t a = 0; a < o->args.size(); ++a) {
        const bool coordinate = within || std::find(moving.begin(), moving.end(), a) != moving.end();
        want(o->args[a], coordinate ? n : Neighbour::Here, within);
    }
}

void Demand::carry(Inst* loop, int index, Neighbour n, const Inst* within) {
    const auto k = static_cast<size_t>(index);
    if (!add(carried_, loop, within, k, n)) return;
    const bool light = loop->op == Op::LightLoop;
    want(loop->args[k + (light ? 3 : 0)], n, within);
    want(loop->regions.back().yields[k], n, within);
    if (within) want(loop->regions[0].yields[0], n, within);
}

void Demand::keep(Inst* a, Neighbour n, const Inst* within) {
    if (a->op != Op::ArrayNew) return;
    if (within && !motion_.inside(a, within)) within = nullptr;
    if (!within && (n == Neighbour::Here || !motion_.moves(a))) return;
    uint8_t& bits = arrays_[{a, within}];
    if (bits & bitOf(n)) return;
    bits |= bitOf(n);
    for (Inst* s : motion_.stores(a)) {
        want(s->args[1], n, within);
        want(s->args[2], n, within);
        if (!within) continue;
        for (Inst* o = motion_.owner(s); o && o != within; o = motion_.owner(o)) {
            effects_[{o, within}] |= bitOf(n);
            want(o->op == Op::If ? o->args[0] : o->regions[0].yields[0], n, within);
        }
    }
}

} // namespace alpenglow::rsl::passes
