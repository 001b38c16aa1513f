#include "rsl/passes/unroll.h"
#include "rsl/ir/edit.h"
#include "rsl/passes/fold.h"

namespace alpenglow::rsl::passes {
namespace {

struct Unroller {
    Kernel& k;
    Leaves leaves{k};
    Replacements rep;
    int changes = 0;

    /// Copies a region's body, simplifying on the way.
    void copy(const Region& r, CopyMap& map, std::vector<Inst*>& out) {
        for (const Inst* i : r.body) {
            if (!i->regions.empty()) {
                out.push_back(copyInst(k, i, map));
                continue;
            }
            Inst* c = copyInst(k, i, map);
            if (c->op != Op::Runtime)
                if (Inst* simple = simplify(k, leaves, c)) {
                    map[i] = simple;
                    continue;
                }
            out.push_back(c);
        }
    }

    bool unroll(Inst* loop, std::vector<Inst*>& body, std::vector<Inst*>& results) {
        if (loop->args.empty()) return false;
        std::vector<Inst*> values = loop->args, out;
        for (int trip = 0;; ++trip) {
            CopyMap test;
            for (size_t p = 0; p < values.size(); ++p) test[loop->regions[0].params[p]] = values[p];
            const size_t before = out.size();
            copy(loop->regions[0], test, out);
            const Inst* go = mapped(test, loop->regions[0].yields[0]);
            if (!isConst(go)) return false;
            if (go->numbers[0] == 0) {
                out.resize(before);
                break;
            }
            if (trip >= kUnrollTrips) return false;
            CopyMap map;
            for (size_t p = 0; p < values.size(); ++p) map[loop->regions[1].params[p]] = values[p];
            copy(loop->regions[1], map, out);
            size_t size = 0;
            for (const Inst* i : out) {
                ++size;
                for (const Region& r : i->regions) size += instructionCount(r);
            }
            if (size > static_cast<size_t>(kUnrollInstructions)) return false;
            for (size_t p = 0; p < values.size(); ++p) values[p] = mapped(map, loop->regions[1].yields[p]);
        }
        body.insert(body.end(), out.begin(), out.end());
        results = values;
        return true;
    }

    void region(Region& r) {
        std::vector<Inst*> body;
        body.reserve(r.body.size());
        std::unordered_map<const Inst*, std::vector<Inst*>> gone;
        for (Inst* i : r.body) {
            rep.apply(i);
            if (i->op == Op::Result) {
                const auto it = gone.find(i->args[0]);
                if (it != gone.end()) {
                    rep.set(i, rep(it->second[static_cast<size_t>(i->index)]));
                    continue;
                }
            }
            for (Region& sub : i->regions) region(sub);
            std::vector<Inst*> results;
            if (i->op == Op::Loop && unroll(i, body, results)) {
                gone[i] = results;
                ++changes;
                continue;
            }
            body.push_back(i);
        }
        for (Inst*& y : r.yields) y = rep(y);
        r.body = std::move(body);
    }
};

} // namespace

int unrollLoops(Kernel& k) {
    Unroller u{k};
    u.region(k.body);
    return u.changes;
}

} // namespace alpenglow::rsl::passes
