#include "rsl/passes/differences.h"
#include "rsl/passes/gradients.h"
#include "rsl/passes/neighbourvalues.h"
#include <algorithm>

namespace alpenglow::rsl::passes {
namespace {

/// Sums deeper than this are not looked through for inputs.
constexpr int kSumDepth = 24;

class Differences : NeighbourValues {
public:
    explicit Differences(Kernel& k) : NeighbourValues(k), main_(motion_, functions_), demand_(&main_) {}

    void run() {
        std::vector<Inst*> leaves, functions;
        Region rest;
        for (Inst* i : k_.body.body) (isLeaf(i) ? leaves : i->op == Op::Function ? functions : rest.body).push_back(i);
        rest.yields = k_.body.yields;
        // Those that call first: a function is copied as it was.
        Scope s;
        scopes_ = {&s};
        for (Inst* i : rest.body) mainInst(i);
        rest.body = std::move(s.out);
        for (auto f = functions.rbegin(); f != functions.rend(); ++f) mainFunction(*f);
        k_.body.body = std::move(leaves);
        for (Inst* f : functions) {
            const std::vector<Inst*>& copies = copies_[f];
            k_.body.body.insert(k_.body.body.end(), copies.begin(), copies.end());
            k_.body.body.push_back(f);
        }
        k_.body.body.insert(k_.body.body.end(), rest.body.begin(), rest.body.end());
        k_.body.yields = rest.yields;
        leaves_.flush();
        done_.apply(k_.body); // until here instructions have the arguments that they had
    }

private:
    // Differences

    /// The difference of x along v or u, per unit of it, at n; null for zero.
    Inst* difference(Inst* x, bool v, Neighbour n, int depth = 0) {
        if (!motion_.moves(x)) return nullptr;
        for (auto s = scopes_.rbegin(); s != scopes_.rend(); ++s)
            if (const auto it = (*s)->slopes.find({x, n, v}); it != (*s)->slopes.end()) return it->second;
        return scopes_.back()->slopes[{x, n, v}] = newDifference(x, v, n, depth);
    }
    Inst* newDifference(Inst* x, bool v, Neighbour n, int depth) {
        if (x->op == Op::Input) return slopeAt(x, v, n);
        if (depth < kSumDepth) switch (x->op) {
            case Op::Add:
            case Op::Sub: {
                Inst *a = difference(x->args[0], v, n, depth + 1), *b = difference(x->args[1], v, n, depth + 1);
                if (!b) return a;
                if (!a) return x->op == Op::Add ? b : make(Op::Neg, x->kind, {b});
                return make(x->op, x->kind, {a, b});
            }
            case Op::Neg:
            case Op::Splat:
            case Op::Extract: {
                Inst* a = difference(x->args[0], v, n, depth + 1);
                return a ? put(like(x, {a})) : nullptr;
            }
            case Op::Triple: {
                std::vector<Inst*> parts;
                for (Inst* a : x->args) {
                    Inst* d = difference(a, v, n, depth + 1);
                    parts.push_back(d ? d : constant(Kind::Float, 0));
                }
                return make(Op::Triple, Kind::Triple, std::move(parts));
            }
            case Op::Mul:
            case Op::Div:
                for (size_t k = 0; k < (x->op == Op::Mul ? 2u : 1u); ++k) {
                    if (motion_.moves(x->args[1 - k])) continue;
                    Inst* a = difference(x->args[k], v, n, depth + 1);
                    return a ? make(x->op, x->kind, {a, value(x->args[1 - k], n)}) : nullptr;
                }
                break;
            default:
                break;
            }
        Neighbour next{};
        if (!stepFrom(n, v, next)) return nullptr; // reported by orderDerivatives()
        Inst *a = value(x, next), *b = value(x, n);
        if (a == b) return nullptr;
        Inst* per = perStep(v);
        if (x->kind == Kind::Triple) per = make(Op::Splat, Kind::Triple, {per});
        return make(Op::Mul, x->kind, {make(Op::Sub, x->kind, {a, b}), per});
    }
    Inst* differenceOf(const Inst* i, Neighbour n) {
        Inst* d = difference(i->args[0], i->op == Op::Dv, n);
        return d ? d : constant(i->kind, 0);
    }

    // Instructions at neighbours of the point

    void copyAt(Inst* i, Neighbour n) {
        if (i->op == Op::Du || i->op == Op::Dv) return set(i, n, differenceOf(i, n));
        if (i->op == Op::Result) {
            const Results* r = resultsAt(i->args[0], n);
            const auto k = static_cast<size_t>(i->index);
            if (!r || k >= r->size() || !(*r)[k].first) return;
            Inst* c = like(i, {(*r)[k].first});
            c->index = (*r)[k].second;
            return set(i, n, put(c));
        }
        if (i->op != Op::RegionParam) set(i, n, put(like(i, values(i->args, n))));
    }
    const Results* resultsAt(const Inst* owner, Neighbour n) {
        for (auto s = scopes_.rbegin(); s != scopes_.rend(); ++s)
            if (const auto it = (*s)->results.find({owner, n}); it != (*s)->results.end()) return &it->second;
        return nullptr;
    }
    bool repeated(const Inst* owner, Neighbour n, size_t k) {
        const Results* r = resultsAt(owner, n);
        return r && k < r->size() && (*r)[k].first;
    }
    void setResult(const Inst* owner, Neighbour n, size_t k, Inst* by, int as) {
        Results& r = scopes_.back()->results[{owner, n}];
        if (r.size() <= k) r.resize(k + 1);
        r[k] = {by, as};
    }

    bool wanted(const Inst* o, size_t k, Neighbour n, const Inst* within) const {
        return (demand_->result(o, k, within) & bitOf(n)) != 0;
    }

    void repeat(Inst* o, Neighbour n, const Inst* within) {
        switch (o->op) {
        case Op::Runtime:
        case Op::Service: {
            std::vector<Inst*> args = values(o->args, n);
            if (o->op == Op::Service && !within) { // a neighbour's lookup has the filter of the point
                const std::vector<size_t> moving = lookupCoordinates(k_, o);
                for (size_t a = 0; a < args.size(); ++a)
                    if (std::find(moving.begin(), moving.end(), a) == moving.end()) args[a] = value(o->args[a], Neighbour::Here);
            }
            Inst* c = put(like(o, std::move(args)));
            for (size_t k = 0; k < o->results.size(); ++k) setResult(o, n, k, c, static_cast<int>(k));
            return;
        }
        case Op::Call:
            for (size_t k = 0; k < o->results.size(); ++k)
                if (wanted(o, k, n, within)) callAt(o, k, n);
            return;
        case Op::If:
            return ifAt(o, n, within);
        case Op::Loop:
            return loopAt(o, n, within);
        default:
            return;
        }
    }

    void callAt(Inst* o, size_t k, Neighbour n) {
        Inst* f = o->args[0];
        std::vector<Inst*> args{functionAt(f, static_cast<int>(k), n)};
        for (const auto& [p, m] : demand_->function(f, static_cast<int>(k), n).carried(f, f))
            args.push_back(value(o->args[static_cast<size_t>(p) + 1], m));
        Inst* c = put(like(o, std::move(args)));
        c->results = {o->results[k]};
        setResult(o, n, k, c, 0);
    }

    void ifAt(Inst* o, Neighbour n, const Inst* within) {
        Inst* c = like(o, {value(o->args[0], n)});
        std::vector<Inst*> which[2];
        c->results.clear();
        for (size_t k = 0; k < o->results.size(); ++k) {
            if (!wanted(o, k, n, within) || (!within && !motion_.repeatable(o, static_cast<int>(k)))) continue;
            setResult(o, n, k, c, static_cast<int>(c->results.size()));
            c->results.push_back(o->results[k]);
            for (int r = 0; r < 2; ++r) which[r].push_back(o->regions[static_cast<size_t>(r)].yields[k]);
        }
        if (c->results.empty() && !(demand_->effects(o, within) && n == base_)) return;
        repeating(n, within, [&] {
            for (size_t r = 0; r < 2; ++r)
                c->regions.push_back(repeatedRegion(
                    o->regions[r], n, within ? within : o, [](Region&) {}, [&](Region& to) { to.yields = values(which[r], n); }));
        });
        put(c);
    }

    void loopAt(Inst* o, Neighbour n, const Inst* within) {
        const Inst* in = within ? within : o;
        Demand::Carried carried;
        for (const auto& c : demand_->carried(o, in))
            if (liesOn(n, c.second)) carried.push_back(c);
        const bool effects = demand_->effects(o, in) && n == base_ && within;
        if (carried.empty() && !effects) return;
        Inst* c = like(o, {});
        c->results.clear();
        for (const auto& [k, m] : carried) {
            c->args.push_back(value(o->args[static_cast<size_t>(k)], m));
            if (m == n) setResult(o, n, static_cast<size_t>(k), c, static_cast<int>(c->results.size()));
            c->results.push_back(o->results[static_cast<size_t>(k)]);
        }
        repeating(n, within, [&] {
            for (size_t r = 0; r < 2; ++r) {
                const Region& from = o->regions[r];
                const auto begin = [&](Region& to) {
                    for (const auto& [k, m] : carried)
                        to.params.push_back(parameter(from.params[static_cast<size_t>(k)], m, to.params.size()));
                };
                const auto end = [&](Region& to) {
                    if (r == 0) to.yields = values(from.yields, n);
                    else
                        for (const auto& [k, m] : carried) to.yields.push_back(value(from.yields[static_cast<size_t>(k)], m));
                };
                c->regions.push_back(repeatedRegion(from, n, in, begin, end));
            }
        });
        put(c);
    }

    Inst* parameter(const Inst* like, Neighbour n, size_t index) {
        Inst* p = k_.make(Op::RegionParam, like->kind);
        p->index = static_cast<int>(index);
        p->place = like->place;
        set(like, n, p);
        return p;
    }

    void repeating(Neighbour n, const Inst* within, const std::function<void()>& f) {
        const Neighbour before = base_;
        if (!within) base_ = n;
        f();
        base_ = before;
    }

    Region repeatedRegion(const Region& from, Neighbour n, const Inst* within, const std::function<void(Region&)>& begin,
                          const std::function<void(Region&)>& end) {
        Region to;
        Scope s;
        scopes_.push_back(&s);
        begin(to);
        for (Inst* i : from.body) repeatInst(i, n, within);
        end(to);
        to.body = std::move(s.out);
        scopes_.pop_back();
        return to;
    }

    void repeatInst(Inst* i, Neighbour base, const Inst* within) {
        const auto each = [&](uint8_t bits, const auto& f) {
            for (int m = 0; m < kNeighbours; ++m)
                if ((bits & bitOf(neighbour(m))) && liesOn(base, neighbour(m))) f(neighbour(m));
        };
        switch (i->op) {
        case Op::ArrayNew:
            if (base == base_) each(demand_->array(i, within), [&](Neighbour m) { set(i, m, put(like(i, {}))); });
            return;
        case Op::ArrayStore:
            if (base == base_) storeAt(i, within, each);
            return;
        case Op::If:
        case Op::Loop:
        case Op::Runtime:
        case Op::Service:
        case Op::Call: {
            const uint8_t effects = base == base_ && demand_->effects(i, within) ? bitOf(base) : uint8_t(0);
            return each(static_cast<uint8_t>(demand_->results(i, within) | effects), [&](Neighbour m) { repeat(i, m, within); });
        }
        default:
            each(demand_->of(i, within), [&](Neighbour m) { copyAt(i, m); });
        }
    }

    template <class Each> void storeAt(Inst* i, const Inst* within, const Each& each) {
        if (within && !motion_.inside(i->args[0], within)) return;
        each(demand_->array(i->args[0], within), [&](Neighbour m) { put(like(i, values(i->args, m))); });
    }

    Inst* functionAt(Inst* f, int result, Neighbour n) {
        Inst*& made = made_[{f, result, n}];
        if (made) return made;
        made = k_.make(Op::Function, Kind::None);
        Inst* mine = made;
        mine->text = f->text;
        mine->place = f->place;
        Demand* const outer = demand_;
        Demand& own = demand_->function(f, result, n);
        std::vector<Scope*> scopes;
        scopes.swap(scopes_);
        const Neighbour before = base_;
        base_ = n;
        demand_ = &own;
        Inst* yield = f->regions[0].yields[static_cast<size_t>(result)];
        const auto begin = [&](Region& to) {
            for (const auto& [p, m] : own.carried(f, f))
                to.params.push_back(parameter(f->regions[0].params[static_cast<size_t>(p)], m, to.params.size()));
        };
        mine->regions.push_back(repeatedRegion(f->regions[0], n, f, begin, [&](Region& to) { to.yields = {value(yield, n)}; }));
        demand_ = outer;
        base_ = before;
        scopes.swap(scopes_);
        copies_[f].push_back(mine);
        return mine;
    }

    // The kernel itself

    void mainFunction(Inst* f) {
        Region& r = f->regions[0];
        Scope s;
        scopes_ = {&s};
        for (const auto& [p, n] : demand_->carried(f, nullptr))
            r.params.push_back(parameter(r.params[static_cast<size_t>(p)], n, r.params.size()));
        for (Inst* i : r.body) mainInst(i);
        r.body = std::move(s.out);
        scopes_.clear();
    }

    void eachNeighbour(uint8_t bits, const std::function<void(Neighbour)>& f) {
        for (int n = 1; n < kNeighbours; ++n)
            if (bits & bitOf(neighbour(n))) f(neighbour(n));
    }

    void mainInst(Inst* i) {
        const auto each = [&](uint8_t bits, const auto& f) { eachNeighbour(bits, f); };
        switch (i->op) {
        case Op::Du:
        case Op::Dv:
            done_.set(i, differenceOf(i, Neighbour::Here));
            break;
        case Op::ArrayStore:
            storeAt(i, nullptr, each);
            put(i);
            return;
        case Op::ArrayNew:
            put(i);
            return eachNeighbour(demand_->array(i, nullptr), [&](Neighbour n) { set(i, n, put(like(i, {}))); });
        case Op::If:
        case Op::Loop:
        case Op::LightLoop:
            eachNeighbour(demand_->results(i, nullptr), [&](Neighbour n) { repeat(i, n, nullptr); });
            return mainConstruct(i);
        case Op::Runtime:
        case Op::Service:
        case Op::Call: {
            eachNeighbour(demand_->results(i, nullptr), [&](Neighbour n) { repeat(i, n, nullptr); });
            std::vector<Inst*> more;
            if (i->op == Op::Call)
                for (const auto& [p, n] : demand_->carried(i->args[0], nullptr))
                    more.push_back(value(i->args[static_cast<size_t>(p) + 1], n));
            i->args.insert(i->args.end(), more.begin(), more.end());
            put(i);
            return;
        }
        default:
            break;
        }
        eachNeighbour(demand_->of(i, nullptr), [&](Neighbour n) { copyAt(i, n); });
        if (i->op != Op::Du && i->op != Op::Dv) put(i);
    }

    /// The neighbours of what is carried, and of results that cannot be worked out elsewhere, follow the point.
    void mainConstruct(Inst* o) {
        const bool branch = o->op == Op::If, light = o->op == Op::LightLoop;
        const Demand::Carried carried = demand_->carried(o, nullptr);
        std::vector<Inst*> more;
        for (const auto& [k, n] : carried) {
            if (!repeated(o, n, static_cast<size_t>(k)))
                setResult(o, n, static_cast<size_t>(k), o, static_cast<int>(o->results.size()));
            const size_t at = static_cast<size_t>(k) + (light ? 3 : 0);
            o->results.push_back(o->results[static_cast<size_t>(k)]);
            if (!branch) more.push_back(value(o->args[at], n));
        }
        o->args.insert(o->args.end(), more.begin(), more.end());
        for (size_t r = 0; r < o->regions.size(); ++r) {
            Region& region = o->regions[r];
            Scope s;
            scopes_.push_back(&s);
            if (!branch)
                for (const auto& [k, n] : carried)
                    region.params.push_back(
                        parameter(region.params[static_cast<size_t>(k) + (light ? 4 : 0)], n, region.params.size()));
            for (Inst* i : region.body) mainInst(i);
            if (branch || r + 1 == o->regions.size()) // not the condition of a loop
                for (const auto& [k, n] : carried) region.yields.push_back(value(region.yields[static_cast<size_t>(k)], n));
            region.body = std::move(s.out);
            scopes_.pop_back();
        }
        put(o);
    }

    Demand::Functions functions_;
    Demand main_;
    Demand* demand_;
    Neighbour base_ = Neighbour::Here; ///< of the repetition that is being made: it alone stores
    std::map<const Inst*, std::vector<Inst*>> copies_;
    std::map<std::tuple<const Inst*, int, Neighbour>, Inst*> made_;
};

} // namespace

void takeDifferences(Kernel& k) {
    bool any = false;
    forEach(k.body, [&](Inst* i) { any = any || i->op == Op::Du || i->op == Op::Dv; });
    if (any) Differences(k).run();
}

} // namespace alpenglow::rsl::passes
