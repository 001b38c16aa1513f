// What expressions, calls and statements write: the one place that reads from descriptors and functions which of their parameters
// are outputs.
#pragma once
#include "rsl/front/ast.h"

namespace alpenglow::rsl::front {

/// Whether a call writes an argument.
enum class Writes : uint8_t {
    No,
    Perhaps, ///< of a method of another shader: which it is, and so its parameters, is known when that is bound
    Yes
};

/// Whether a checked call writes its argument `i`, counted from 0 (of a method 0 is the shader that has it). No for what is no
/// call.
Writes writesArgument(const Expr& call, size_t i);

/// Whether the shadeop has an output parameter in any of its forms, tokens aside.
bool writesAny(const Shadeop&);

/// The variable that a place belongs to, x of x, x[1] and conversions of them; null for what is no place.
const Symbol* rootOf(const Expr& place);

/// Calls f(const Expr&) for every place that the expression itself writes, or may write: what stands left of an assignment, and
/// outputs of a call, its tokens' too. Not for what its parts write.
template <class F> void eachWritten(const Expr& e, F&& f) {
    if (e.kind == ExprKind::Assign) f(*e.args[0]);
    for (size_t i = 0; i < e.args.size(); ++i)
        if (e.args[i] && writesArgument(e, i) != Writes::No) f(*e.args[i]);
    for (const NamedArg& p : e.pairs)
        if (p.output && p.value) f(*p.value);
}

/// The same for the tokens of a statement: illuminance and gather.
template <class F> void eachWritten(const Stmt& s, F&& f) {
    for (const NamedArg& p : s.pairs)
        if (p.output && p.value) f(*p.value);
}

} // namespace alpenglow::rsl::front
