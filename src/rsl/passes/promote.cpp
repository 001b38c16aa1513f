#include "rsl/passes/promote.h"
#include "rsl/ir/edit.h"
#include <algorithm>
#include <map>
#include <set>

namespace alpenglow::rsl::passes {
namespace {

using Key = std::pair<uint32_t, int>; ///< array id, element

struct Promoter {
    Kernel& k;
    Leaves leaves{k};
    Replacements rep;
    std::vector<char> promotable;
    std::map<Key, Inst*> env;
    int changes = 0;

    static int element(const Inst* access) {
        const int n = access->args[0]->index;
        const float f = access->args[1]->numbers[0];
        return std::clamp(f >= 0 && f < static_cast<float>(n) ? static_cast<int>(f) : f > 0 ? n - 1 : 0, 0, n - 1);
    }

    void find() {
        promotable.assign(k.pool.size(), 0);
        forEach(k.body, [&](Inst* i) {
            if (i->op == Op::ArrayNew && i->index <= 4096) promotable[i->id] = 1;
        });
        forEach(k.body, [&](Inst* i) {
            for (size_t a = 0; a < i->args.size(); ++a)
                if (i->args[a]->op == Op::ArrayNew) {
                    const bool access = (i->op == Op::ArrayLoad || i->op == Op::ArrayStore) && a == 0 && isConst(i->args[1]);
                    if (!access) promotable[i->args[a]->id] = 0;
                }
        });
    }

    void stored(const Region& r, std::set<Key>& out) const {
        forEach(r, [&](const Inst* i) {
            if (i->op == Op::ArrayStore && promotable[i->args[0]->id] && env.count({i->args[0]->id, element(i)}))
                out.insert({i->args[0]->id, element(i)});
        });
    }

    void results(Inst* i, const std::set<Key>& keys, size_t first, std::vector<Inst*>& body) {
        size_t n = first;
        for (const Key& key : keys) {
            Inst* r = k.make(Op::Result, i->results[n], {i});
            r->index = static_cast<int>(n++);
            r->place = i->place;
            body.push_back(r);
            env[key] = r;
        }
    }

    void region(Region& r) {
        std::vector<Inst*> body;
        body.reserve(r.body.size());
        for (Inst* i : r.body) {
            rep.apply(i);
            const bool mine = i->id < promotable.size();
            if (mine && i->op == Op::ArrayNew && promotable[i->id]) {
                for (int e = 0; e < i->index; ++e)
                    env[{i->id, e}] = i->element == Kind::String ? leaves.string("") : leaves.constant(i->element, 0.0f);
                ++changes;
                continue;
            }
            if ((i->op == Op::ArrayStore || i->op == Op::ArrayLoad) && i->args[0]->op == Op::ArrayNew &&
                promotable[i->args[0]->id]) {
                const Key key{i->args[0]->id, element(i)};
                if (i->op == Op::ArrayStore) env[key] = i->args[2];
                else rep.set(i, env[key]);
                continue;
            }
            if (i->regions.empty()) {
                body.push_back(i);
                continue;
            }
            std::set<Key> keys;
            for (const Region& sub : i->regions) stored(sub, keys);
            const std::map<Key, Inst*> before = env;
            const size_t first = i->results.size();
            if (i->op != Op::If)
                for (const Key& key : keys) i->args.push_back(env[key]);
            for (const Key& key : keys) i->results.push_back(env[key]->kind);
            for (size_t s = 0; s < i->regions.size(); ++s) {
                Region& sub = i->regions[s];
                env = before;
                if (i->op != Op::If)
                    for (const Key& key : keys) {
                        Inst* p = k.make(Op::RegionParam, env[key]->kind);
                        p->index = static_cast<int>(sub.params.size());
                        sub.params.push_back(p);
                        env[key] = p;
                    }
                region(sub);
                if (i->op == Op::If || s + 1 == i->regions.size())
                    for (const Key& key : keys) sub.yields.push_back(rep(env[key]));
            }
            env = before;
            body.push_back(i);
            results(i, keys, first, body);
        }
        for (Inst*& y : r.yields) y = rep(y);
        r.body = std::move(body);
    }
};

} // namespace

int promoteArrays(Kernel& k) {
    Promoter p{k};
    p.find();
    if (std::find(p.promotable.begin(), p.promotable.end(), 1) == p.promotable.end()) return 0;
    p.region(k.body);
    return p.changes;
}

} // namespace alpenglow::rsl::passes
