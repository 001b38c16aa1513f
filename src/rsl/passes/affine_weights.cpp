#include "rsl/passes/affine_weights.h"
#include "rsl/passes/fold.h"
#include <algorithm>

namespace alpenglow::rsl::passes {

bool Weights::run(Inst* ci) {
    home.resize(k.pool.size());
    index(k.body, nullptr, nullptr);
    WeightedValues seeds, outer;
    std::vector<Inst*> code;
    if (ci) { // a float is the sum of its components; a float result is the same in all three
        const Inst* v = ci->args[0];
        const bool grey = v->kind == Kind::Float && v->id < d.channels.size() && (d.channels[v->id] & Dependence::kGrey);
        Inst* w = one();
        if (grey) {
            w = k.make(
                Op::Triple, Kind::Triple,
                {leaves.constant(Kind::Float, 1.0f), leaves.constant(Kind::Float, 0.0f), leaves.constant(Kind::Float, 0.0f)});
            code.push_back(w);
        }
        seeds.emplace_back(ci->args[0], w);
    }
    if (!scoped(k.body, code, seeds, outer)) return false;
    tails[&k.body] = std::move(code);
    assemble(k.body);
    return true;
}

void Weights::index(Region& r, Inst* owner, Region* parent) {
    info[&r] = {owner, parent, !owner || owner->op != Op::If};
    for (Inst* p : r.params) home[p->id] = {&r, 0};
    for (size_t n = 0; n < r.body.size(); ++n) {
        home[r.body[n]->id] = {&r, n + 1};
        for (Region& sub : r.body[n]->regions) index(sub, r.body[n], &r);
    }
}

void Weights::setHome(const Inst* i, Home h) {
    home.resize(std::max(home.size(), static_cast<size_t>(i->id) + 1));
    home[i->id] = h;
}

Inst* Weights::emit(Op op, Kind kind, std::vector<Inst*> args, int idx) {
    Inst* i = k.make(op, kind, std::move(args));
    i->index = idx;
    if (Inst* s = simplify(k, leaves, i)) return s;
    out->push_back(i);
    return i;
}

Inst* Weights::use(Inst* v, Region* r) {
    const Home h = homeOf(v);
    if (!h.region || isConst(v) || v->op == Op::Input) return v;
    for (Region* at = r; at; at = info[at].parent) {
        if (info[at].inPlace) return v;
        if (h.region == at) return use(exportFrom(v, at), info[at].parent);
    }
    return v;
}

Inst* Weights::exportFrom(Inst* v, Region* branch) {
    Inst*& e = exported[v];
    if (e) return e;
    Inst* owner = info[branch].owner;
    for (Region& side : owner->regions)
        side.yields.push_back(&side == branch ? v : v->kind == Kind::String ? leaves.string("") : leaves.constant(v->kind, 0.0f));
    owner->results.push_back(v->kind);
    e = k.make(Op::Result, v->kind, {owner});
    e->index = static_cast<int>(owner->results.size()) - 1;
    after[owner].push_back(e);
    setHome(e, {info[branch].parent, homeOf(owner).position});
    return e;
}

void Weights::add(Inst* to, Inst* weight) {
    if (!d.of(to) || !weight) return;
    Inst*& a = adjoint[to];
    if (!a) order.push_back(to);
    a = a ? emit(Op::Add, Kind::Triple, {a, weight}) : weight;
}

Inst* Weights::take(const Inst* i) {
    const auto it = adjoint.find(i);
    return it == adjoint.end() ? nullptr : it->second;
}

bool Weights::fail(const Inst* at, const std::string& text) {
    if (reason.empty()) {
        reason = text + (at->place.line ? " (line " + std::to_string(at->place.line) + ")" : "");
        forEach(Region{{}, {const_cast<Inst*>(at)}, {}}, [&](const Inst* i) {
            if (i->op == Op::Request && site < 0) site = i->site;
        });
    }
    return false;
}

Inst* Weights::splat(Inst* v, Region* r) {
    v = use(v, r);
    return v->kind == Kind::Float ? emit(Op::Splat, Kind::Triple, {v}) : v;
}

bool Weights::reverse(Region& r) {
    for (size_t n = r.body.size(); n-- > 0;)
        if (!reverse(r.body[n], r)) return false;
    return true;
}

void Weights::emitRequest(Inst* i, Region& r) {
    Inst* w = results[i].empty() ? nullptr : results[i][0];
    if (!w) return;
    std::vector<Inst*> args = {w};
    for (Inst* a : i->args) args.push_back(use(a, &r));
    Inst* e = k.make(Op::Emit, Kind::None, std::move(args));
    e->site = i->site;
    e->place = i->place;
    out->push_back(e);
}

void Weights::reverseResult(Inst* i, Inst* w, Region& r) {
    Inst* o = i->args[0];
    if (isMix(o)) {
        Inst* alpha = splat(o->args[2], &r);
        add(o->args[0], emit(Op::Mul, Kind::Triple, {w, emit(Op::Sub, Kind::Triple, {one(), alpha})}));
        add(o->args[1], emit(Op::Mul, Kind::Triple, {w, alpha}));
        return;
    }
    std::vector<Inst*>& list = results[o];
    list.resize(std::max<size_t>(o->results.size(), list.size()));
    Inst*& slot = list[static_cast<size_t>(i->index)];
    slot = slot ? emit(Op::Add, Kind::Triple, {slot, w}) : w;
}

bool Weights::reverse(Inst* i, Region& r) {
    if (i->op == Op::If || i->op == Op::Loop || i->op == Op::LightLoop) return i->op == Op::If ? branch(i, r) : loop(i, r);
    if (i->op == Op::Request) {
        emitRequest(i, r);
        return true;
    }
    if (!d.of(i)) return true;
    Inst* w = take(i);
    if (!w) return true;
    const auto arg = [&](size_t a) { return i->args[a]; };
    switch (i->op) {
    case Op::Result:
        reverseResult(i, w, r);
        return true;
    case Op::Add:
        add(arg(0), w);
        add(arg(1), w);
        return true;
    case Op::Sub:
        add(arg(0), w);
        if (d.of(arg(1))) add(arg(1), emit(Op::Neg, Kind::Triple, {w}));
        return true;
    case Op::Neg:
        add(arg(0), emit(Op::Neg, Kind::Triple, {w}));
        return true;
    case Op::Mul: {
        const size_t x = d.of(arg(0)) ? 0 : 1;
        add(arg(x), emit(Op::Mul, Kind::Triple, {w, splat(arg(1 - x), &r)}));
        return true;
    }
    case Op::Div:
        add(arg(0), emit(Op::Div, Kind::Triple, {w, splat(arg(1), &r)}));
        return true;
    case Op::Input: // runToInputs: its weight is what is asked for
        return true;
    case Op::Splat:
        add(arg(0), w);
        return true;
    case Op::Triple:
        for (size_t c = 0; c < 3; ++c)
            if (d.of(arg(c))) {
                std::vector<Inst*> part(3, leaves.constant(Kind::Float, 0.0f));
                part[c] = emit(Op::Extract, Kind::Float, {w}, static_cast<int>(c));
                add(arg(c), emit(Op::Triple, Kind::Triple, part));
            }
        return true;
    case Op::Extract: {
        std::vector<Inst*> part(3, leaves.constant(Kind::Float, 0.0f));
        part[static_cast<size_t>(i->index)] = emit(Op::Extract, Kind::Float, {w}, i->index);
        add(arg(0), emit(Op::Triple, Kind::Triple, part));
        return true;
    }
    case Op::Select: {
        Inst* c = use(arg(0), &r);
        if (d.of(arg(1))) add(arg(1), emit(Op::Select, Kind::Triple, {c, w, zero()}));
        if (d.of(arg(2))) add(arg(2), emit(Op::Select, Kind::Triple, {c, zero(), w}));
        return true;
    }
    default:
        return fail(i, std::string("no rule for ") + name(i->op));
    }
}

bool Weights::scoped(Region& r, std::vector<Inst*>& code, const WeightedValues& seeds, WeightedValues& outer) {
    auto savedAdjoint = std::move(adjoint);
    auto savedOrder = std::move(order);
    std::vector<Inst*>* savedOut = out;
    adjoint.clear();
    order.clear();
    out = &code;
    for (const auto& [v, w] : seeds) add(v, w);
    const bool good = reverse(r);
    for (const Inst* v : order)
        if (homeOf(v).region != &r && !inside(homeOf(v).region, &r)) outer.emplace_back(const_cast<Inst*>(v), adjoint[v]);
    inner = std::move(adjoint);
    out = savedOut;
    adjoint = std::move(savedAdjoint);
    order = std::move(savedOrder);
    return good;
}

bool Weights::inside(const Region* r, const Region* around) {
    for (; r; r = info[r].parent)
        if (r == around) return true;
    return false;
}

bool Weights::branch(Inst* i, Region& r) {
    const std::vector<Inst*> w = results[i];
    if (w.empty()) return true;
    Inst* mirror = k.make(Op::If, Kind::None, {use(i->args[0], &r)});
    mirror->place = i->place;
    mirror->regions.resize(2);
    WeightedValues outer[2];
    for (size_t s = 0; s < 2; ++s) {
        WeightedValues seeds;
        for (size_t n = 0; n < w.size(); ++n)
            if (w[n]) seeds.emplace_back(i->regions[s].yields[n], w[n]);
        if (!scoped(i->regions[s], mirror->regions[s].body, seeds, outer[s])) return false;
    }
    std::vector<Inst*> touched;
    for (const auto& side : outer)
        for (const auto& [v, weight] : side)
            if (std::find(touched.begin(), touched.end(), v) == touched.end()) touched.push_back(v);
    if (mirror->regions[0].body.empty() && mirror->regions[1].body.empty()) { // weights only: no need for control flow
        for (Inst* v : touched) {
            Inst* side[2] = {zero(), zero()};
            for (size_t s = 0; s < 2; ++s)
                for (const auto& [x, weight] : outer[s])
                    if (x == v) side[s] = weight;
            add(v, emit(Op::Select, Kind::Triple, {mirror->args[0], side[0], side[1]}));
        }
        return true;
    }
    out->push_back(mirror);
    for (Inst* v : touched) {
        for (size_t s = 0; s < 2; ++s) {
            Inst* y = zero();
            for (const auto& [x, weight] : outer[s])
                if (x == v) y = weight;
            mirror->regions[s].yields.push_back(y);
        }
        mirror->results.push_back(Kind::Triple);
        Inst* res = k.make(Op::Result, Kind::Triple, {mirror});
        res->index = static_cast<int>(mirror->results.size()) - 1;
        out->push_back(res);
        add(v, res);
    }
    return true;
}

void Weights::assemble(Region& r) {
    std::vector<Inst*> body = heads[&r];
    for (Inst* i : r.body) {
        for (Inst* b : before[i]) body.push_back(b);
        body.push_back(i);
        for (Region& sub : i->regions)
            if (info.count(&sub)) assemble(sub);
        for (Inst* a : after[i]) body.push_back(a);
    }
    const auto it = tails.find(&r);
    if (it != tails.end()) body.insert(body.end(), it->second.begin(), it->second.end());
    r.body = std::move(body);
}

} // namespace alpenglow::rsl::passes
