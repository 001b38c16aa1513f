// Second half of the affine proof: weights, by walking backwards from Ci. Independent instructions stay where they are; the
// weights of a region are computed behind them, where everything they need is known. Loops keep their place: their weights are
// computed before them where possible, else pairs are emitted relative to the loop's result and rescaled afterwards.
#pragma once
#include "rsl/ir/edit.h"
#include "rsl/passes/affine_analysis.h"
#include "rsl/passes/names.h"
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace alpenglow::rsl::passes {

/// How a value depends on a loop variable: not, by adding to it only, or otherwise.
enum class Growth : uint8_t { None, Identity, Other };

/// One walk over a kernel in long form. When a step fails the kernel is half changed: run it on a copy of the body.
class Weights {
public:
    /// Both outlive this.
    Weights(Kernel& kernel, const Dependence& dependence) : k(kernel), d(dependence) {}

    /// Puts an Emit in place of every Request that reaches `ci` (an Output of Kernel::light, or null for none). The Requests
    /// stay. Returns false if a weight cannot be computed; why() and stuckSite() have the reason.
    bool run(Inst* ci);
    /// Adds Output number `output`, the weight of the inputs together in `ci`. Dependence on them: analyseInput. False as above.
    bool runToInputs(Inst* ci, const std::vector<Inst*>& inputs, int output);
    /// Why the last step failed.
    const std::string& why() const { return reason; }
    int stuckSite() const { return site; } ///< -1: not known

private:
    using WeightedValues = std::vector<std::pair<Inst*, Inst*>>; ///< value, its weight
    using Memo = std::unordered_map<Inst*, Inst*>;
    struct Home {
        Region* region = nullptr;
        size_t position = 0; ///< of the original instruction in its region, from 1; 0 for parameters
    };
    struct RegionInfo {
        Inst* owner = nullptr;
        Region* parent = nullptr;
        bool inPlace = true; ///< its weight code stands in the region itself, not in a mirror behind it
    };

    // affine_weights.cpp: places, and the rule of every instruction
    void index(Region& r, Inst* owner, Region* parent);
    Home homeOf(const Inst* i) const { return i->id < home.size() ? home[i->id] : Home{}; }
    void setHome(const Inst* i, Home h);
    bool inside(const Region* r, const Region* around);
    Inst* one() { return leaves.constant(Kind::Triple, 1.0f); }
    Inst* zero() { return leaves.constant(Kind::Triple, 0.0f); }
    Inst* emit(Op op, Kind kind, std::vector<Inst*> args, int idx = 0);
    /// The value as seen by the weight code of region r: what a branch knows goes out through its If.
    Inst* use(Inst* v, Region* r);
    Inst* exportFrom(Inst* v, Region* branch);
    Inst* splat(Inst* v, Region* r);
    void add(Inst* to, Inst* weight);
    Inst* take(const Inst* i);
    bool fail(const Inst* at, const std::string& text);
    bool reverse(Region& r);
    bool reverse(Inst* i, Region& r);
    void emitRequest(Inst* i, Region& r);
    void reverseResult(Inst* i, Inst* weight, Region& r);
    bool branch(Inst* i, Region& r);
    /// Runs `code` with fresh weights; gives the weights of values from outside region r, in order of first touch.
    bool scoped(Region& r, std::vector<Inst*>& code, const WeightedValues& seeds, WeightedValues& outer);
    void assemble(Region& r);

    // affine_loops.cpp
    bool loop(Inst* i, Region& r);
    /// How v depends on the loop variable p. Remembered: the values form a graph with many paths.
    Growth growth(Inst* v, Inst* p);
    Growth findGrowth(Inst* v, Inst* p);
    /// The value computed anew in front of `loop` (in region r), or null when it is not known there.
    Inst* early(Inst* v, Inst* loop, Region* r, Memo& memo);
    Inst* earlyValue(Inst* v, Inst* loop, Region* r, Memo& memo);
    Inst* put(Op op, const Inst* like, std::vector<Inst*> args, Inst* loop);
    /// A further carried variable of a loop.
    Inst* carry(Inst* loop, Inst* init);
    Inst* loopResult(Inst* loop, Region& r);
    /// Sums the weights that the turns give to values from outside, and puts the code at the end of the body.
    void finishLoop(Inst* i, Region& r, Region& body, std::vector<Inst*>& code, const WeightedValues& outer, Inst* scale,
                    Inst* factor);

    Kernel& k;
    const Dependence& d;
    Leaves leaves{k};
    std::string reason;
    int site = -1;
    std::vector<Home> home; ///< by id of the original instructions
    std::unordered_map<const Region*, RegionInfo> info;
    std::unordered_map<const Inst*, std::vector<Inst*>> after; ///< original instruction: what is inserted behind it
    std::unordered_map<const Inst*, std::vector<Inst*>> before;
    std::unordered_map<const Region*, std::vector<Inst*>> tails, heads; ///< put behind and in front of a region's body
    std::unordered_map<const Inst*, Inst*> exported;
    std::unordered_map<uint64_t, Growth> growths;
    std::unordered_map<const Inst*, std::vector<Inst*>> results; ///< weights of the results of constructs and requests
    std::unordered_map<const Inst*, Inst*> adjoint;              ///< the weights of the scope being walked
    std::unordered_map<const Inst*, Inst*> inner;                ///< weights of the last scope
    std::vector<const Inst*> order;                              ///< of first touch, for outer values of branches and loops
    std::vector<Inst*>* out = nullptr;
};

} // namespace alpenglow::rsl::passes
