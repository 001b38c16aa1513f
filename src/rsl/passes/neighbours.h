// Which values of a kernel are needed at neighbours of a point, for derivatives by differences (differences.h).
#pragma once
#include "rsl/ir/ir.h"
#include "rsl/passes/names.h"
#include <map>
#include <memory>
#include <set>
#include <unordered_map>
#include <vector>

namespace alpenglow::rsl::passes {

/// Where a value is needed: at the point, or so many steps of du and dv from it. Derivatives of third order are not taken.
enum class Neighbour : uint8_t { Here, U, V, UU, UV, VV };
inline constexpr int kNeighbours = 6;
inline constexpr int kStepsU[kNeighbours] = {0, 1, 0, 2, 1, 0}, kStepsV[kNeighbours] = {0, 0, 1, 0, 1, 2};
/// The neighbour of a number below kNeighbours; its bit in sets.
inline Neighbour neighbour(int n) { return static_cast<Neighbour>(n); }
inline uint8_t bitOf(Neighbour n) { return static_cast<uint8_t>(1 << static_cast<int>(n)); }
/// One step on, along v or u; false where that is too far.
bool stepFrom(Neighbour, bool v, Neighbour& next);
/// Whether `n` lies at `base` or on from it.
inline bool liesOn(Neighbour base, Neighbour n) {
    const auto b = static_cast<size_t>(base), m = static_cast<size_t>(n);
    return kStepsU[m] >= kStepsU[b] && kStepsV[m] >= kStepsV[b];
}

/// What does not depend on where one looks. The kernel is in the long form (edit.h).
class Motion {
public:
    /// Looks at the whole kernel, which must not change afterwards.
    explicit Motion(Kernel&);
    /// The kernel.
    Kernel& kernel() const { return k_; }
    /// Whether a value may differ between the point and its neighbours. Results of rays and lights do not.
    bool moves(const Inst* i) const { return moves_[i->id] != 0; }
    /// Whether the instruction, or the parameter, is within a construct (If, Loop, LightLoop, Function).
    bool inside(const Inst* i, const Inst* construct) const;
    Inst* owner(const Inst* i) const { return owner_[i->id]; } ///< the construct around it; null: none
    /// What writes to an array, in order.
    const std::vector<Inst*>& stores(const Inst* array) const { return stores_[array->id]; }
    /// Whether result `index` of an If or a Loop, or of a Function, can be worked out again elsewhere: what it needs from within
    /// has no effects, asks no rays and no lights, and reads no array that is written both there and outside.
    bool repeatable(const Inst* construct, int index) const;
    int position(const Inst* parameter) const; ///< in the regions of its construct

private:
    struct Slice;
    void index(Region&, Inst* around);
    bool markPlain(const Region&);
    bool grow();
    bool movesNow(const Inst*) const;
    bool resultMoves(const Inst* owner, size_t index) const;
    Kernel& k_;
    std::vector<Inst*> owner_;
    std::vector<std::vector<Inst*>> stores_;
    std::vector<char> moves_;
    std::vector<int> position_;
    std::vector<char> plain_; ///< constructs in which nothing keeps any result from being worked out again
    mutable std::map<std::pair<const Inst*, int>, bool> repeatable_;
};

/// What is wanted at which neighbours. A value within a construct is wanted either there, next to the point, so that its
/// neighbours take the branch that the point takes; or in a repetition of the construct at the neighbour, which takes the
/// neighbour's own branches. `within` names the outermost repeated construct, null for none.
class Demand {
public:
    /// Demands within functions, by function, result and neighbour.
    using Functions = std::map<std::tuple<const Inst*, int, Neighbour>, std::unique_ptr<Demand>>;
    /// Of the whole kernel: of every Du and Dv in it.
    Demand(Motion&, Functions&);
    /// Of a result of a function at a neighbour.
    Demand(Motion&, Functions&, const Inst* function, int result, Neighbour);

    /// Bits of Neighbour: where a value, the effects of a construct, an array, a result of a construct, and any of its results
    /// are wanted.
    uint8_t of(const Inst* i, const Inst* within) const { return get(values_, i, within); }
    uint8_t effects(const Inst* construct, const Inst* within) const { return get(effects_, construct, within); }
    uint8_t array(const Inst* a, const Inst* within) const { return get(arrays_, a, within); }
    uint8_t result(const Inst* owner, size_t index, const Inst* within) const { return get(results_, owner, within, index); }
    uint8_t results(const Inst* owner, const Inst* within) const;
    /// What a Loop, LightLoop or Function carries besides its own values, or what a followed If gives: index and neighbour, in
    /// order.
    using Carried = std::vector<std::pair<int, Neighbour>>;
    /// Of a construct; what is wanted within a function for one result at a neighbour.
    Carried carried(const Inst* construct, const Inst* within) const;
    Demand& function(const Inst* f, int result, Neighbour);

private:
    using Key = std::pair<const Inst*, const Inst*>;
    struct Wanted {
        Inst* inst;
        Neighbour at;
        const Inst* within;
    };
    static uint8_t get(const std::map<Key, uint8_t>& m, const Inst* a, const Inst* b) {
        const auto it = m.find({a, b});
        return it == m.end() ? uint8_t(0) : it->second;
    }
    static uint8_t get(const std::map<Key, std::vector<uint8_t>>& m, const Inst* a, const Inst* b, size_t n) {
        const auto it = m.find({a, b});
        return it == m.end() || n >= it->second.size() ? uint8_t(0) : it->second[n];
    }
    static bool add(std::map<Key, std::vector<uint8_t>>&, const Inst*, const Inst*, size_t index, Neighbour);
    void start(const Region&);
    void want(Inst*, Neighbour, const Inst* within);
    void close();
    void spread(const Wanted&);
    void spreadResult(Inst* owner, int index, Neighbour, const Inst* within);
    void spreadService(Inst*, Neighbour, const Inst* within);
    void carry(Inst* loop, int index, Neighbour, const Inst* within);
    void keep(Inst* array, Neighbour, const Inst* within);
    Motion& motion_;
    Functions& functions_;
    std::map<Key, uint8_t> values_, effects_, arrays_;
    std::map<Key, std::vector<uint8_t>> results_, carried_;
    std::vector<Wanted> work_;
};

} // namespace alpenglow::rsl::passes
