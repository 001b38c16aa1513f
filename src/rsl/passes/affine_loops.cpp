// Weights around loops: how values grow with the turns, what is known before the loop, and sums carried along.
#include "rsl/passes/affine_weights.h"
#include "rsl/passes/fold.h"
#include <algorithm>

namespace alpenglow::rsl::passes {

Growth Weights::growth(Inst* v, Inst* p) {
    const uint64_t key = (static_cast<uint64_t>(v->id) << 32) | p->id;
    const auto it = growths.find(key);
    if (it != growths.end()) return it->second;
    const Growth g = findGrowth(v, p);
    growths[key] = g;
    return g;
}

Growth Weights::findGrowth(Inst* v, Inst* p) {
    if (v == p) return Growth::Identity;
    if (!d.of(v) || v->op == Op::RegionParam || v->op == Op::Request) return Growth::None;
    const auto none = [&](const std::vector<Inst*>& list) {
        return std::all_of(list.begin(), list.end(), [&](Inst* a) { return growth(a, p) == Growth::None; });
    };
    const auto same = [&](Inst* a, Inst* b) {
        const Growth x = growth(a, p);
        return x == growth(b, p) ? x : Growth::Other;
    };
    switch (v->op) {
    case Op::Add:
    case Op::Sub: {
        const Growth a = growth(v->args[0], p), b = growth(v->args[1], p);
        if (b == Growth::None) return a;
        return v->op == Op::Add && a == Growth::None ? b : Growth::Other;
    }
    case Op::Select:
        return same(v->args[1], v->args[2]);
    case Op::Result: {
        Inst* o = v->args[0];
        const size_t n = static_cast<size_t>(v->index);
        if (o->op == Op::If) return same(o->regions[0].yields[n], o->regions[1].yields[n]);
        if (o->op == Op::Loop || o->op == Op::LightLoop) {
            const size_t fa = o->op == Op::LightLoop ? 3 : 0, fp = o->op == Op::LightLoop ? 4 : 0;
            Region& body = o->regions.back();
            for (Inst* y : body.yields)
                if (growth(y, p) != Growth::None) return Growth::Other;
            for (size_t m = 0; m < body.yields.size(); ++m)
                if (m != n && growth(body.yields[n], body.params[fp + m]) != Growth::None) return Growth::Other;
            const Growth start = growth(o->args[fa + n], p);
            if (start == Growth::None || growth(body.yields[n], body.params[fp + n]) == Growth::Identity) return start;
            return Growth::Other;
        }
        return none(o->args) ? Growth::None : Growth::Other;
    }
    default:
        return none(v->args) ? Growth::None : Growth::Other;
    }
}

Inst* Weights::early(Inst* v, Inst* loop, Region* r, Memo& memo) {
    const auto it = memo.find(v);
    if (it != memo.end()) return it->second;
    Inst* e = earlyValue(v, loop, r, memo);
    memo[v] = e;
    return e;
}

Inst* Weights::earlyValue(Inst* v, Inst* loop, Region* r, Memo& memo) {
    if (v->op == Op::Const || v->op == Op::ConstString || v->op == Op::Input || v->op == Op::ArrayInput) return v;
    const Home h = homeOf(v);
    if (h.region) {
        // Original code: known when it stands before the construct that holds the loop, in a region around it.
        size_t limit = homeOf(loop).position;
        for (Region* at = r; at; at = info[at].parent) {
            if (h.region == at && h.position < limit) return v;
            limit = info[at].owner ? homeOf(info[at].owner).position : 0;
        }
    }
    if (v->op == Op::Result && v->args[0]->op == Op::If) {
        Inst* o = v->args[0];
        Inst* c = early(o->args[0], loop, r, memo);
        Inst* a = c ? early(o->regions[0].yields[static_cast<size_t>(v->index)], loop, r, memo) : nullptr;
        Inst* b = a ? early(o->regions[1].yields[static_cast<size_t>(v->index)], loop, r, memo) : nullptr;
        return b ? put(Op::Select, v, {c, a, b}, loop) : nullptr;
    }
    if (v->op == Op::Result && v->args[0]->op == Op::Runtime) {
        Inst* o = v->args[0];
        std::vector<Inst*> args;
        for (Inst* a : o->args) {
            args.push_back(early(a, loop, r, memo));
            if (!args.back()) return nullptr;
        }
        Inst* copy = k.make(Op::Runtime, Kind::None, args);
        copy->text = o->text;
        copy->results = o->results;
        copy->place = o->place;
        before[loop].push_back(copy);
        Inst* res = k.make(Op::Result, v->kind, {copy});
        res->index = v->index;
        before[loop].push_back(res);
        return res;
    }
    if (v->op == Op::Result || !isMovable(k, *v)) return nullptr;
    std::vector<Inst*> args;
    for (Inst* a : v->args) {
        args.push_back(early(a, loop, r, memo));
        if (!args.back()) return nullptr;
    }
    return put(v->op, v, args, loop);
}

Inst* Weights::put(Op op, const Inst* like, std::vector<Inst*> args, Inst* loop) {
    Inst* i = k.make(op, like->kind, std::move(args));
    i->index = op == Op::Select ? 0 : like->index;
    i->place = like->place;
    i->text = like->text;
    i->numbers = like->numbers;
    if (Inst* s = simplify(k, leaves, i)) return s;
    before[loop].push_back(i);
    return i;
}

Inst* Weights::carry(Inst* loop, Inst* init) {
    loop->args.push_back(init);
    loop->results.push_back(Kind::Triple);
    Inst* last = nullptr;
    for (Region& sub : loop->regions) {
        last = k.make(Op::RegionParam, Kind::Triple);
        last->index = static_cast<int>(sub.params.size());
        sub.params.push_back(last);
    }
    return last;
}

Inst* Weights::loopResult(Inst* loop, Region& r) {
    Inst* res = k.make(Op::Result, Kind::Triple, {loop});
    res->index = static_cast<int>(loop->results.size()) - 1;
    after[loop].push_back(res);
    setHome(res, {&r, homeOf(loop).position});
    return res;
}

bool Weights::loop(Inst* i, Region& r) {
    const std::vector<Inst*> w = results[i];
    if (w.empty()) return true;
    const size_t fa = i->op == Op::LightLoop ? 3 : 0, fp = i->op == Op::LightLoop ? 4 : 0;
    Region& body = i->regions.back();
    std::vector<size_t> vars;
    for (size_t n = 0; n < body.yields.size(); ++n)
        if (d.of(body.params[fp + n])) vars.push_back(n);
    bool sums = true; // every variable only has things added to it
    for (size_t a : vars)
        for (size_t b : vars)
            sums = sums && growth(body.yields[a], body.params[fp + b]) == (a == b ? Growth::Identity : Growth::None);
    WeightedValues seeds, outer;
    std::vector<Inst*> code;
    if (sums) {
        Memo memo;
        for (size_t n : vars)
            if (n < w.size() && w[n]) {
                Inst* e = early(w[n], i, &r, memo);
                if (!e) {
                    seeds.clear();
                    break;
                }
                seeds.emplace_back(body.yields[n], e);
            }
    }
    if (!seeds.empty()) {
        if (!scoped(body, code, seeds, outer)) return false;
        for (size_t n : vars)
            if (n < w.size() && w[n]) add(i->args[fa + n], w[n]);
        finishLoop(i, r, body, code, outer, nullptr, nullptr);
        return true;
    }
    size_t var = body.yields.size();
    for (size_t n : vars)
        if (n < w.size() && w[n]) {
            if (var != body.yields.size())
                return fail(i, "its weight is only known after the loop, which sums up more than one such value");
            var = n;
        }
    if (vars.size() != 1 || var == body.yields.size())
        return fail(i, "it is carried around a loop together with another such value");
    // Relative to the loop's result: pairs of earlier turns are rescaled when the variable is, all of them after the loop.
    Inst* start = k.make(Op::Mark, Kind::Float);
    before[i].push_back(start);
    Inst* end = k.make(Op::Mark, Kind::Float);
    after[i].push_back(end);
    setHome(start, {&r, homeOf(i).position - 1});
    setHome(end, {&r, homeOf(i).position});
    Inst* turn = k.make(Op::Mark, Kind::Float);
    seeds.emplace_back(body.yields[var], one());
    if (!scoped(body, code, seeds, outer)) return false;
    Inst* factor = inner.count(body.params[fp + var]) ? inner[body.params[fp + var]] : zero();
    Inst* total = nullptr;
    if (!isConst(factor, 1.0f)) {
        heads[&body].push_back(turn); // at the start: loops inside emit in their places
        code.push_back(k.make(Op::Rescale, Kind::None, {start, factor, turn}));
        total = carry(i, one());
        std::vector<Inst*>* saved = out;
        out = &code;
        body.yields.push_back(emit(Op::Mul, Kind::Triple, {total, factor}));
        out = saved;
        total = loopResult(i, r);
    }
    Inst* scale = w[var];
    if (!isConst(scale, 1.0f)) out->push_back(k.make(Op::Rescale, Kind::None, {use(start, &r), scale, use(end, &r)}));
    add(i->args[fa + var], total ? emit(Op::Mul, Kind::Triple, {scale, use(total, &r)}) : scale);
    finishLoop(i, r, body, code, outer, scale, isConst(factor, 1.0f) ? nullptr : factor);
    return true;
}

void Weights::finishLoop(Inst* i, Region& r, Region& body, std::vector<Inst*>& code, const WeightedValues& outer, Inst* scale,
                         Inst* factor) {
    for (const auto& [v, weight] : outer) {
        Inst* sum = carry(i, zero());
        std::vector<Inst*>* saved = out;
        out = &code;
        Inst* old = factor ? emit(Op::Mul, Kind::Triple, {sum, factor}) : sum;
        body.yields.push_back(emit(Op::Add, Kind::Triple, {old, weight}));
        out = saved;
        Inst* total = use(loopResult(i, r), &r);
        add(v, scale ? emit(Op::Mul, Kind::Triple, {total, scale}) : total);
    }
    tails[&body] = std::move(code);
}

} // namespace alpenglow::rsl::passes
