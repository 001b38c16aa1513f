// Second half: weights, by walking backwards from Ci. Independent instructions stay where they are; the weights of a region are
// computed behind them, where everything they need is known. Loops keep their place: their weights are computed before them where
// possible, else pairs are emitted relative to the loop's result and rescaled afterwards.
#include "rsl/passes/affine.h"
#include "rsl/ir/edit.h"
#include "rsl/passes/affine_analysis.h"
#include "rsl/passes/fold.h"
#include <algorithm>

namespace alpenglow::rsl::ir {
namespace {

enum class Growth : uint8_t { None, Identity, Other }; ///< how a value depends on a loop variable

struct Weights {
    Kernel& k;
    const Dependence& d;
    Leaves leaves{k};
    std::string why;
    int stuckSite = -1;

    struct Home {
        Region* region = nullptr;
        size_t position = 0;
    };
    struct RegionInfo {
        Inst* owner = nullptr;
        Region* parent = nullptr;
        bool inPlace = true;
    };
    std::vector<Home> home; ///< by id of the original instructions
    std::unordered_map<const Region*, RegionInfo> info;
    std::unordered_map<const Inst*, std::vector<Inst*>> after; ///< original instruction: what is inserted behind it
    std::unordered_map<const Inst*, std::vector<Inst*>> before;
    std::unordered_map<const Inst*, Inst*> exported;
    std::vector<Inst*>* out = nullptr;
    std::unordered_map<const Inst*, Inst*> adjoint;
    std::vector<const Inst*> order; ///< of first touch, for outer values of branches and loops

    explicit Weights(Kernel& kernel, const Dependence& dep) : k(kernel), d(dep) {}

    Inst* one() { return leaves.constant(Kind::Triple, 1.0f); }
    Inst* zero() { return leaves.constant(Kind::Triple, 0.0f); }

    void index(Region& r, Inst* owner, Region* parent) {
        info[&r] = {owner, parent, !owner || owner->op != Op::If};
        for (Inst* p : r.params) home[p->id] = {&r, 0};
        for (size_t n = 0; n < r.body.size(); ++n) {
            home[r.body[n]->id] = {&r, n + 1};
            for (Region& sub : r.body[n]->regions) index(sub, r.body[n], &r);
        }
    }

    Home homeOf(const Inst* i) const { return i->id < home.size() ? home[i->id] : Home{}; }

    Inst* emit(Op op, Kind kind, std::vector<Inst*> args, int idx = 0) {
        Inst* i = k.make(op, kind, std::move(args));
        i->index = idx;
        if (Inst* s = simplify(k, leaves, i)) return s;
        out->push_back(i);
        return i;
    }

    /// The value as seen by the weight code of region r: what a branch knows goes out through its If.
    Inst* use(Inst* v, Region* r) {
        const Home h = homeOf(v);
        if (!h.region || isConst(v) || v->op == Op::Input) return v;
        for (Region* at = r; at; at = info[at].parent) {
            if (info[at].inPlace) return v;
            if (h.region == at) return use(exportFrom(v, at), info[at].parent);
        }
        return v;
    }

    Inst* exportFrom(Inst* v, Region* branch) {
        Inst*& e = exported[v];
        if (e) return e;
        Inst* owner = info[branch].owner;
        for (Region& side : owner->regions)
            side.yields.push_back(&side == branch           ? v
                                  : v->kind == Kind::String ? leaves.string("")
                                                            : leaves.constant(v->kind, 0.0f));
        owner->results.push_back(v->kind);
        e = k.make(Op::Result, v->kind, {owner});
        e->index = static_cast<int>(owner->results.size()) - 1;
        after[owner].push_back(e);
        home.resize(std::max(home.size(), static_cast<size_t>(e->id) + 1));
        home[e->id] = {info[branch].parent, homeOf(owner).position};
        return e;
    }

    void add(Inst* to, Inst* weight) {
        if (!d.of(to) || !weight) return;
        Inst*& a = adjoint[to];
        if (!a) order.push_back(to);
        a = a ? emit(Op::Add, Kind::Triple, {a, weight}) : weight;
    }

    Inst* take(const Inst* i) {
        const auto it = adjoint.find(i);
        return it == adjoint.end() ? nullptr : it->second;
    }

    bool fail(const Inst* at, const std::string& text) {
        if (why.empty()) {
            why = text + (at->place.line ? " (line " + std::to_string(at->place.line) + ")" : "");
            forEach(Region{{}, {const_cast<Inst*>(at)}, {}}, [&](const Inst* i) {
                if (i->op == Op::Request && stuckSite < 0) stuckSite = i->site;
            });
        }
        return false;
    }

    Inst* splat(Inst* v, Region* r) {
        v = use(v, r);
        return v->kind == Kind::Float ? emit(Op::Splat, Kind::Triple, {v}) : v;
    }

    bool reverse(Region& r) {
        for (size_t n = r.body.size(); n-- > 0;)
            if (!reverse(r.body[n], r)) return false;
        return true;
    }

    bool reverse(Inst* i, Region& r) {
        if (i->op == Op::If || i->op == Op::Loop || i->op == Op::LightLoop) return i->op == Op::If ? branch(i, r) : loop(i, r);
        if (i->op == Op::Request) {
            Inst* w = results[i].empty() ? nullptr : results[i][0];
            if (!w) return true;
            std::vector<Inst*> args = {w};
            for (Inst* a : i->args) args.push_back(use(a, &r));
            Inst* e = k.make(Op::Emit, Kind::None, std::move(args));
            e->site = i->site;
            e->place = i->place;
            out->push_back(e);
            return true;
        }
        if (!d.of(i)) return true;
        Inst* w = take(i);
        if (!w) return true;
        const auto arg = [&](size_t a) { return i->args[a]; };
        switch (i->op) {
        case Op::Result: {
            Inst* o = arg(0);
            if (isMix(o)) {
                Inst* alpha = splat(o->args[2], &r);
                add(o->args[0], emit(Op::Mul, Kind::Triple, {w, emit(Op::Sub, Kind::Triple, {one(), alpha})}));
                add(o->args[1], emit(Op::Mul, Kind::Triple, {w, alpha}));
                return true;
            }
            std::vector<Inst*>& list = results[o];
            list.resize(std::max<size_t>(o->results.size(), list.size()));
            Inst*& slot = list[static_cast<size_t>(i->index)];
            slot = slot ? emit(Op::Add, Kind::Triple, {slot, w}) : w;
            return true;
        }
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

    std::unordered_map<const Inst*, std::vector<Inst*>> results; ///< weights of the results of constructs and requests

    bool holdsRequest(const Inst* i) const {
        bool any = false;
        for (const Region& r : i->regions) forEach(r, [&](const Inst* x) { any = any || x->op == Op::Request; });
        return any;
    }

    /// Runs `code` with fresh weights; gives the weights of values from outside region r, in order of first touch.
    bool scoped(Region& r, std::vector<Inst*>& code, const std::vector<std::pair<Inst*, Inst*>>& seeds,
                std::vector<std::pair<Inst*, Inst*>>& outer) {
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
    std::unordered_map<const Inst*, Inst*> inner; ///< weights of the last scope

    bool inside(const Region* r, const Region* around) {
        for (; r; r = info[r].parent)
            if (r == around) return true;
        return false;
    }

    bool branch(Inst* i, Region& r) {
        const std::vector<Inst*> w = results[i];
        if (w.empty()) return true;
        Inst* mirror = k.make(Op::If, Kind::None, {use(i->args[0], &r)});
        mirror->place = i->place;
        mirror->regions.resize(2);
        std::vector<std::pair<Inst*, Inst*>> outer[2];
        for (size_t s = 0; s < 2; ++s) {
            std::vector<std::pair<Inst*, Inst*>> seeds;
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

    /// How v depends on the loop variable p. Remembered: the values form a graph with many paths.
    Growth growth(Inst* v, Inst* p) {
        const uint64_t key = (static_cast<uint64_t>(v->id) << 32) | p->id;
        const auto it = growths.find(key);
        if (it != growths.end()) return it->second;
        const Growth g = findGrowth(v, p);
        growths[key] = g;
        return g;
    }
    std::unordered_map<uint64_t, Growth> growths;

    Growth findGrowth(Inst* v, Inst* p) {
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

    /// The value computed anew in front of `loop` (in region r), or null when it is not known there.
    Inst* early(Inst* v, Inst* loop, Region* r, std::unordered_map<Inst*, Inst*>& memo) {
        const auto it = memo.find(v);
        if (it != memo.end()) return it->second;
        Inst* e = earlyValue(v, loop, r, memo);
        memo[v] = e;
        return e;
    }

    Inst* earlyValue(Inst* v, Inst* loop, Region* r, std::unordered_map<Inst*, Inst*>& memo) {
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

    Inst* put(Op op, const Inst* like, std::vector<Inst*> args, Inst* loop) {
        Inst* i = k.make(op, like->kind, std::move(args));
        i->index = op == Op::Select ? 0 : like->index;
        i->place = like->place;
        i->text = like->text;
        i->numbers = like->numbers;
        if (Inst* s = simplify(k, leaves, i)) return s;
        before[loop].push_back(i);
        return i;
    }

    /// A further carried variable of a loop.
    Inst* carry(Inst* loop, Inst* init) {
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

    Inst* loopResult(Inst* loop, Region& r) {
        Inst* res = k.make(Op::Result, Kind::Triple, {loop});
        res->index = static_cast<int>(loop->results.size()) - 1;
        after[loop].push_back(res);
        home.resize(std::max(home.size(), static_cast<size_t>(res->id) + 1));
        home[res->id] = {&r, homeOf(loop).position};
        return res;
    }

    bool loop(Inst* i, Region& r) {
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
        std::vector<std::pair<Inst*, Inst*>> seeds, outer;
        std::vector<Inst*> code;
        if (sums) {
            std::unordered_map<Inst*, Inst*> memo;
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
        home.resize(std::max(home.size(), static_cast<size_t>(end->id) + 1));
        home[start->id] = {&r, homeOf(i).position - 1};
        home[end->id] = {&r, homeOf(i).position};
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

    /// Sums the weights that the turns give to values from outside, and puts the code at the end of the body.
    void finishLoop(Inst* i, Region& r, Region& body, std::vector<Inst*>& code, const std::vector<std::pair<Inst*, Inst*>>& outer,
                    Inst* scale, Inst* factor) {
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
    std::unordered_map<const Region*, std::vector<Inst*>> tails, heads; ///< put behind and in front of a region's body

    void assemble(Region& r) {
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
};

/// The constant part a of Ci: results become zero, and what is only zero because of that disappears.
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

} // namespace

std::vector<std::pair<int, std::string>> nonAffineSites(const Kernel& k) {
    std::map<int, std::string> all = analyseDependence(k).bad;
    for (const auto& s : k.facts.stuck) all.insert(s);
    return {all.begin(), all.end()};
}

void makeAffine(Kernel& k) {
    k.facts.affine = true;
    k.facts.suspends = false;
    k.facts.whyNot.clear();
    k.facts.stuck.clear();
    bool any = false;
    Inst* ci = nullptr;
    forEach(k.body, [&](Inst* i) {
        any = any || i->op == Op::Request;
        if (i->op == Op::Output && k.outputs[static_cast<size_t>(i->index)].name == "Ci") ci = i;
    });
    if (!any) return;
    const auto refuse = [&](int site, const std::string& why) {
        const Site& s = k.sites[static_cast<size_t>(site)];
        k.facts.affine = false;
        k.facts.suspends = true;
        k.facts.whyNot = s.op + "()" + (s.place.line ? ", line " + std::to_string(s.place.line) : "") + ": " + why;
    };
    Dependence d = analyseDependence(k);
    if (!d.bad.empty()) return refuse(d.bad.begin()->first, d.bad.begin()->second);
    // Work on a copy, so that a failure leaves the kernel as it was.
    Region original = k.body;
    CopyMap map;
    Region copy;
    copyBody(k, original, map, copy.body);
    k.body = copy;
    d = analyseDependence(k);
    forEach(k.body, [&](Inst* i) {
        if (i->op == Op::Output && ci && i->index == ci->index) ci = i;
    });
    bool good = true;
    std::string why;
    int site = -1;
    {
        Weights w(k, d);
        w.home.resize(k.pool.size());
        w.index(k.body, nullptr, nullptr);
        std::vector<std::pair<Inst*, Inst*>> seeds, outer;
        std::vector<Inst*> code;
        if (ci) seeds.emplace_back(ci->args[0], w.one());
        good = w.scoped(k.body, code, seeds, outer);
        if (good) {
            w.tails[&k.body] = std::move(code);
            w.assemble(k.body);
        } else {
            why = w.why;
            site = w.stuckSite;
            k.body = original;
        }
    }
    if (!good) {
        if (site < 0) forEach(k.body, [&](Inst* i) { site = site < 0 && i->op == Op::Request ? i->site : site; });
        k.facts.stuck.emplace_back(site, why);
        return refuse(site, why);
    }
    dropResults(k, d);
    // The Requests are gone in spirit; now in fact.
    const auto sweep = [&](auto&& self, Region& r) -> void {
        std::erase_if(
            r.body, [](const Inst* i) { return i->op == Op::Request || (i->op == Op::Result && i->args[0]->op == Op::Request); });
        for (Inst* i : r.body)
            for (Region& sub : i->regions) self(self, sub);
    };
    sweep(sweep, k.body);
}

} // namespace alpenglow::rsl::ir
