// What every value of a kernel looks like in machine code: one number or lanes, and which derivative parts can differ from zero.
#pragma once
#include "rsl/ir/ir.h"
#include <map>
#include <memory>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

namespace alpenglow::rsl::jit {

/// Derivative parts as bits, in the order of jets: du, dv, duu, duv, dvv.
enum Part : uint8_t { kDu = 1, kDv = 2, kDuu = 4, kDuv = 8, kDvv = 16 };
/// The parts of a jet of that order, 0 to 2.
inline constexpr uint8_t partsOfOrder(int order) { return order <= 0 ? 0 : order == 1 ? 3 : 31; }

/// How much of a value there is: lanes or one number, and which derivatives.
struct Shape {
    bool varying = false; ///< false: one number for all lanes
    uint8_t parts = 0;    ///< a part that is not here is exactly zero
    /// Adds what the other has; true if that made a difference.
    bool join(Shape o) {
        const Shape before = *this;
        varying |= o.varying;
        parts |= o.parts;
        return before.varying != varying || before.parts != parts;
    }
};

/// Shapes of all values of a kernel: the least fixed point over its tree. Sound for any kernel that verify() accepts; relies on
/// Inst::order.
class Shapes {
public:
    /// mixed: inputs of instances vary. zeroDerivative: symbols of the runtime whose derivatives are zero; may be null.
    Shapes(const ir::Kernel&, bool mixed, const std::set<std::string>* zeroDerivative);
    /// Of the body of a Function whose arguments have these shapes.
    const Shapes& function(const ir::Inst*, const std::vector<Shape>& arguments) const;
    /// Of result `index` of an instruction or of a region parameter.
    Shape of(const ir::Inst*, int index = 0) const;
    /// Largest order wanted of result `index` by the instruction itself and its Result instructions.
    int order(const ir::Inst*, int index = 0) const;
    /// Whether result `index` of an instruction with several results has a Result instruction (dead ones are removed by the
    /// passes).
    bool used(const ir::Inst* i, int index) const { return i->results.empty() || used_.count({i, index}) != 0; }
    /// Whether the kernel has requests for rays.
    bool hasRequests() const { return requests_; }
    /// Order that a Runtime instruction is called with, from its arguments' shapes and the wanted orders.
    int callOrder(const ir::Inst*) const;

private:
    using Cache = std::map<std::pair<const ir::Inst*, std::vector<uint16_t>>, std::unique_ptr<Shapes>>;
    Shapes(const ir::Kernel&, bool mixed, const std::set<std::string>* zeroDerivative, Cache* cacheOfAll);
    void collect(const ir::Region&);
    bool region(const ir::Region&, bool varyingControl);
    /// These change the shapes of results; true if any became larger.
    bool inst(const ir::Inst*, bool varyingControl);
    bool input(const ir::Inst*);
    bool everyResult(const ir::Inst*, Shape);
    bool call(const ir::Inst*);
    bool branch(const ir::Inst*, bool varyingControl);
    bool loop(const ir::Inst*, bool varyingControl);
    bool join(const ir::Inst*, int index, Shape);
    std::vector<Shape>& slots(const ir::Inst*);

    const ir::Kernel& kernel_;
    bool mixed_;
    const std::set<std::string>* zero_;
    std::unique_ptr<Cache> own_; ///< of the whole kernel's shapes; those of its functions use it too
    Cache* cache_;
    bool requests_ = false;
    std::set<std::pair<const ir::Inst*, int>> used_;
    std::unordered_map<const ir::Inst*, std::vector<Shape>> shapes_;
    std::unordered_map<const ir::Inst*, std::vector<uint8_t>> orders_;
};

/// Number of values that live at once where most do, counted in components and parts; for the choice of vectors in flight.
struct Pressure {
    int live = 0;
    int instructions = 0;                ///< number
    int runtimeCalls = 0;                ///< calls of the runtime
    int outOfLineCalls = 0;              ///< derivative orders count 3 and 6
    int widest = 64;                     ///< the most lanes that the runtime has all of its functions for
    int wideCalls = 0;                   ///< of those, calls that carry derivatives: few registers are left
    bool effects = false, loops = false; ///< it has calls with effects; it has loops
};
/// outOfLine: calls of the runtime that are not inlined, by symbol, with the widest lanes; may be null.
Pressure measure(const ir::Kernel&, const Shapes&, const std::map<std::string, int>* outOfLine);

} // namespace alpenglow::rsl::jit
