// What every pass needs: walks over the tree of regions, results of instructions, effects, copies.
#pragma once
#include "rsl/ir/ir.h"
#include <functional>
#include <unordered_map>
#include <vector>

namespace alpenglow::rsl::ir {

/// Kinds of the results of an instruction, one or several; empty for none.
std::vector<Kind> resultKinds(const Inst&);

/// While passes work, If, Loop, LightLoop, Runtime, Call, Service and Request always give their results through Result
/// instructions
/// ("long form"): a pass then treats one result like several. Outside the passes a single result is the instruction itself.
void toLongForm(Kernel&);
/// Undoes toLongForm().
void toShortForm(Kernel&);

/// Visits every instruction in order, regions after their instruction.
void forEach(Region&, const std::function<void(Inst*)>&);
void forEach(const Region&, const std::function<void(const Inst*)>&);
/// Of the region and all below it.
size_t instructionCount(const Region&);

/// True for instructions whose execution cannot be seen except through their results. Looks into regions.
bool isPure(const Kernel&, const Inst&);
/// Pure, without regions, and independent of array storage: may be moved anywhere its arguments are known.
bool isMovable(const Kernel&, const Inst&);

/// True when `inst` is Const and every component equals `value`, signs of zero included.
bool isConst(const Inst* inst, float value);
/// Whether it is a number.
inline bool isConst(const Inst* inst) { return inst->op == Op::Const; }

/// Constants and inputs: they are at the front of the kernel and visible everywhere, also in functions.
inline bool isLeaf(const Inst* i) {
    return i->op == Op::Const || i->op == Op::ConstString || i->op == Op::Input || i->op == Op::ArrayInput;
}

/// Number of uses of each instruction, by id (arguments and yields).
std::vector<uint32_t> countUses(const Kernel&);

/// Replacements by id, with path compression; null entries are not replaced.
class Replacements {
public:
    /// What stands for the instruction now; itself if it is not replaced.
    Inst* operator()(Inst* inst) {
        while (inst->id < map_.size() && map_[inst->id]) inst = map_[inst->id];
        return inst;
    }
    /// Replaces `from` from now on. Circles are not allowed.
    void set(const Inst* from, Inst* to) {
        if (from->id >= map_.size()) map_.resize(from->id + 1024);
        map_[from->id] = to;
    }
    /// True when the instruction is replaced.
    bool replaced(const Inst* inst) const { return inst->id < map_.size() && map_[inst->id] != nullptr; }
    /// Replaces the arguments of an instruction.
    void apply(Inst* inst) {
        for (Inst*& a : inst->args) a = (*this)(a);
    }
    /// Every argument and yield of the region and below.
    void apply(Region&);

private:
    std::vector<Inst*> map_;
};

using CopyMap = std::unordered_map<const Inst*, Inst*>; ///< from original to copy
/// A copy of one instruction with its regions; operands are looked up in `map`, absent ones stay. The copies are added to `map`.
Inst* copyInst(Kernel&, const Inst*, CopyMap& map);
/// Copies the body of a region into `out`; parameters must be in `map` already.
void copyBody(Kernel&, const Region&, CopyMap& map, std::vector<Inst*>& out);
/// The copy of an instruction; itself if there is none.
inline Inst* mapped(const CopyMap& map, Inst* inst) {
    const auto it = map.find(inst);
    return it == map.end() ? inst : it->second;
}

/// Constants and inputs collected by a pass; they go to the front of the kernel, where they dominate everything.
class Leaves {
public:
    /// Flushes when it ends.
    explicit Leaves(Kernel& k) : kernel_(k) {}
    ~Leaves() { flush(); }
    Inst* constant(Kind, float value); ///< every component `value`
    /// A constant by components, and a text.
    Inst* constant(Kind, const std::vector<float>&);
    Inst* string(const std::string&);
    /// Adds a leaf that the caller has made.
    void add(Inst* leaf) { front_.push_back(leaf); }
    /// Inserts what was made before the body of the kernel.
    void flush();

private:
    Kernel& kernel_;
    std::vector<Inst*> front_;
    std::unordered_map<std::string, Inst*> known_;
};

} // namespace alpenglow::rsl::ir
