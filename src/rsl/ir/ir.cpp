#include "rsl/ir/ir.h"

namespace alpenglow::rsl::ir {

int components(Kind k) {
    switch (k) {
    case Kind::None:
        return 0;
    case Kind::Triple:
        return 3;
    case Kind::Matrix:
        return 16;
    default:
        return 1;
    }
}

const char* name(Op op) {
    static const char* const names[] = {"const",     "string",     "input",   "param",    "result",    "add",      "sub",
                                        "mul",       "div",        "neg",     "splat",    "triple",    "extract",  "matrix",
                                        "less",      "lessequal",  "equal",   "notequal", "and",       "or",       "not",
                                        "select",    "tofloat",    "runtime", "function", "call",      "service",  "request",
                                        "emit",      "mark",       "rescale", "du",       "dv",        "arraynew", "arrayinput",
                                        "arrayload", "arraystore", "if",      "loop",     "lightloop", "output"};
    static_assert(std::size(names) == static_cast<size_t>(Op::Output) + 1);
    return names[static_cast<size_t>(op)];
}

Inst* Kernel::make(Op op, Kind result, std::vector<Inst*> args) {
    auto inst = std::make_unique<Inst>();
    inst->op = op;
    inst->kind = result;
    inst->args = std::move(args);
    inst->id = static_cast<uint32_t>(pool.size());
    pool.push_back(std::move(inst));
    return pool.back().get();
}

} // namespace alpenglow::rsl::ir
