#include "rsl/passes/normal_side.h"
#include "rsl/front/protocol.h"
#include "rsl/ir/edit.h"
#include <algorithm>
#include <unordered_map>
#include <unordered_set>

namespace alpenglow::rsl::passes {

namespace {

/// Values that grow with Ng in proportion: what is made of them, and whether that is all that is made of them.
class InProportion {
public:
    explicit InProportion(Kernel& k) {
        forEach(k.body, [&](Inst* i) {
            for (Inst* a : i->args) users_[a].push_back(i);
            for (const Region& r : i->regions)
                for (Inst* y : r.yields) elsewhere_.insert(y);
        });
        for (Inst* y : k.body.yields) elsewhere_.insert(y);
    }
    /// Whether only signs of sums of such values are taken.
    bool onlySigns(Inst* from) {
        std::vector<Inst*> open{from}, sums;
        grown_ = {from};
        while (!open.empty()) {
            Inst* v = open.back();
            open.pop_back();
            if (elsewhere_.count(v)) return false;
            for (Inst* user : users_[v]) {
                if (isSign(user)) continue;
                if (!grows(user)) return false;
                if (user->op == Op::Add || user->op == Op::Sub) sums.push_back(user);
                if (grown_.insert(user).second) open.push_back(user);
            }
        }
        return std::all_of(sums.begin(), sums.end(),
                           [&](Inst* s) { return grown_.count(s->args[0]) && grown_.count(s->args[1]); });
    }

private:
    bool isSign(const Inst* i) const {
        return (i->op == Op::Less || i->op == Op::LessEqual) && (isConst(i->args[0], 0) || isConst(i->args[1], 0));
    }
    bool grows(const Inst* i) const {
        if (i->order != 0) return false;
        if (i->op == Op::Mul) return !(grown_.count(i->args[0]) && grown_.count(i->args[1]));
        return i->op == Op::Extract || i->op == Op::Neg || i->op == Op::Add || i->op == Op::Sub;
    }
    std::unordered_map<const Inst*, std::vector<Inst*>> users_;
    std::unordered_set<const Inst*> elsewhere_, grown_;
};

} // namespace

void readSideOfNormal(Kernel& k) {
    if (k.kind != ShaderKind::Surface) return;
    const auto isNg = [&](const Input& i) { return i.name == "Ng" && i.order == 0 && i.array == 0; };
    const auto input = std::find_if(k.inputs.begin(), k.inputs.end(), isNg);
    if (input == k.inputs.end()) return;
    std::vector<Inst*> reads;
    forEach(k.body, [&](Inst* i) {
        if (i->op == Op::Input && i->index == int(input - k.inputs.begin())) reads.push_back(i);
    });
    InProportion proportion(k);
    if (std::all_of(reads.begin(), reads.end(), [&](Inst* i) { return proportion.onlySigns(i); })) input->name = kSideNormal;
}

} // namespace alpenglow::rsl::passes
