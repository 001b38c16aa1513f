#include "rsl/moves.h"
#include "rsl/ir/build.h"
#include "rsl/ir/edit.h"
#include "rsl/passes/optimize.h"
#include "rsl/zerodivisors.h"
#include <algorithm>
#include <set>
#include <tuple>

namespace alpenglow::rsl {

namespace {

using ir::Inst;
using ir::Op;

/// Proves of values of a kernel that they are 0, or the P that came in. What is carried through loops is taken to be so while the
/// loop is looked at; where that was wrong all is proved anew without it.
class Unmoved {
public:
    explicit Unmoved(const ir::Kernel& k) : kernel_(k) {
        ir::forEach(k.body, [&](const Inst* i) {
            for (size_t r = 0; r < i->regions.size(); ++r)
                for (size_t p = 0; p < i->regions[r].params.size(); ++p) paramOf_[i->regions[r].params[p]] = {i, p};
        });
    }
    bool point(const Inst* v) {
        for (;;) {
            const size_t wrong = refuted_.size();
            known_.clear();
            assumed_.clear();
            const bool good = prove(v, What::Point);
            if (refuted_.size() == wrong) return good;
        }
    }

private:
    enum class What { Zero, Point, X, Y, Z }; ///< 0; P; a coordinate of P
    static constexpr char kAxes[] = "xyz";
    static What coordinate(int index) { return What(int(What::X) + index); }

    bool prove(const Inst* v, What w) {
        if (const auto at = known_.find({v, w}); at != known_.end()) return at->second;
        return known_[{v, w}] = look(v, w);
    }
    bool all(const Inst* v, size_t from, What w) {
        return std::all_of(v->args.begin() + std::ptrdiff_t(from), v->args.end(), [&](const Inst* a) { return prove(a, w); });
    }
    bool look(const Inst* v, What w) {
        switch (v->op) {
        case Op::Select:
            return all(v, 1, w);
        case Op::Result:
            return result(v->args[0], size_t(v->index), w);
        case Op::If:
        case Op::Loop:
            return result(v, 0, w);
        case Op::RegionParam:
            return param(v, w);
        case Op::Add:
            return w == What::Zero ? all(v, 0, w)
                                   : (prove(v->args[0], w) && prove(v->args[1], What::Zero)) ||
                                         (prove(v->args[0], What::Zero) && prove(v->args[1], w));
        case Op::Sub:
            return prove(v->args[0], w) && prove(v->args[1], What::Zero);
        default:
            return w == What::Zero ? zero(v) : w == What::Point ? isPoint(v) : isCoordinate(v, w);
        }
    }
    bool zero(const Inst* v) {
        switch (v->op) {
        case Op::Const:
            return std::all_of(v->numbers.begin(), v->numbers.end(), [](float f) { return f == 0; });
        case Op::Mul: // 0 times what is not finite is no number, and points that are none stay where they are
            return prove(v->args[0], What::Zero) || prove(v->args[1], What::Zero);
        case Op::Div:
        case Op::Extract:
            return prove(v->args[0], What::Zero);
        case Op::Neg:
        case Op::Splat:
        case Op::Triple:
            return all(v, 0, What::Zero);
        default:
            return false;
        }
    }
    bool isPoint(const Inst* v) {
        if (v->op == Op::Input) return kernel_.inputs[size_t(v->index)].name == "P";
        if (v->op == Op::Runtime)
            for (const int i : {0, 1, 2})
                if (v->text == std::string("al_set") + kAxes[i] + "comp_t")
                    return prove(v->args[0], What::Point) && prove(v->args[1], coordinate(i));
        if (v->op != Op::Triple) return false;
        return prove(v->args[0], What::X) && prove(v->args[1], What::Y) && prove(v->args[2], What::Z);
    }
    bool isCoordinate(const Inst* v, What w) {
        if (v->op == Op::Runtime)
            return v->text == std::string("al_") + kAxes[int(w) - int(What::X)] + "comp_t" && prove(v->args[0], What::Point);
        return v->op == Op::Extract && coordinate(v->index) == w && prove(v->args[0], What::Point);
    }
    /// A result of an instruction.
    bool result(const Inst* of, size_t index, What w) {
        if (of->op == Op::Runtime) return look(of, w);
        if (of->op == Op::If) return prove(of->regions[0].yields.at(index), w) && prove(of->regions[1].yields.at(index), w);
        if (of->op == Op::Loop) return carried(of, index, w);
        return false;
    }
    bool param(const Inst* v, What w) {
        const auto at = paramOf_.find(v);
        if (at == paramOf_.end()) return false;
        const auto& [of, index] = at->second;
        return of->op == Op::Loop && carried(of, index, w);
    }
    bool carried(const Inst* loop, size_t index, What w) {
        const Carried key(loop, index, w);
        if (refuted_.count(key)) return false;
        if (!assumed_.insert(key).second) return true;
        if (prove(loop->args.at(index), w) && prove(loop->regions[1].yields.at(index), w)) return true;
        refuted_.insert(key);
        return false;
    }

    using Carried = std::tuple<const Inst*, size_t, What>;
    const ir::Kernel& kernel_;
    std::map<const Inst*, std::pair<const Inst*, size_t>> paramOf_; ///< instruction, number
    std::map<std::pair<const Inst*, What>, bool> known_;
    std::set<Carried> assumed_, refuted_;
};

} // namespace

bool movesPoints(const Program& program, const Shader& shader, KernelOptions options,
                 const std::map<std::string, std::vector<float>>& numbers) {
    options.outputs = {"P"};
    fixParameters(options, numbers);
    Diagnostics quiet; // compiling the kernel has reported it
    const auto kernel = buildKernel(program, shader, options, quiet);
    if (!kernel) return true;
    passes::simplify(*kernel, options);
    Unmoved unmoved(*kernel);
    bool moves = false;
    ir::forEach(kernel->body, [&](const Inst* i) {
        if (i->op == Op::Output && kernel->outputs[size_t(i->index)].name == "P") moves |= !unmoved.point(i->args[0]);
    });
    return moves;
}

} // namespace alpenglow::rsl
