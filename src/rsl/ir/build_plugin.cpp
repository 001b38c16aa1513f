// Calls of plug-in functions: all arguments are rows, constant strings too, and outputs have their current values.
#include "rsl/front/plugin.h"
#include "rsl/ir/builder.h"

namespace alpenglow::rsl::ir {

Inst* Builder::pluginCall(const Expr& e) {
    const Signature& sig = *e.signature;
    Site s;
    s.op = sig.symbol;
    s.resultType = storedType(e.type);
    s.pure = true; // the header says so; derivatives are zero: no descriptor, which would not live as long as the kernel
    std::vector<Inst*> args;
    const Kind result = kindOf(sig.result);
    if (result != Kind::None) {
        s.resultKinds.push_back(result);
        s.resultNames.push_back("");
    }
    struct Out {
        const Expr* lvalue;
        int first, count;
    };
    std::vector<Out> outs;
    for (size_t i = 0; i < e.args.size() && i < sig.parameters.size(); ++i) {
        const Parameter& p = sig.parameters[i];
        const Expr& a = *e.args[i];
        const int count = p.type.array ? p.type.array : 1;
        if (p.output) outs.push_back({&a, static_cast<int>(s.resultKinds.size()), count});
        Inst* storage = p.type.array ? array(a) : nullptr;
        Inst* single = storage ? nullptr : coerce(expr(a), p.type);
        for (int n = 0; n < count; ++n) {
            Inst* at = storage ? constant(static_cast<float>(n)) : nullptr;
            addArgument(s, args, storage ? emit(Op::ArrayLoad, storage->element, {storage, at}) : single, p.type.element());
            if (!p.output) continue;
            s.resultKinds.push_back(kindOf(p.type.element()));
            s.resultNames.push_back(p.name + (storage ? "[" + std::to_string(n) + "]" : ""));
        }
    }
    place_ = e.place;
    if (s.resultKinds.empty()) return constant(0); // without results it can have no effect
    const std::vector<Inst*> r = call(Op::Service, std::move(s), std::move(args));
    for (const Out& o : outs) {
        if (!o.lvalue->type.array) {
            assign(*o.lvalue, r[static_cast<size_t>(o.first)]);
            continue;
        }
        Inst* a = array(*o.lvalue);
        for (int n = 0; n < o.count && a->op == Op::ArrayNew; ++n)
            emit(Op::ArrayStore, Kind::None, {a, constant(static_cast<float>(n)), r[static_cast<size_t>(o.first + n)]});
    }
    return result != Kind::None ? r[0] : constant(0);
}

} // namespace alpenglow::rsl::ir
