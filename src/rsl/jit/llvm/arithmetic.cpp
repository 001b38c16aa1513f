// Arithmetic on numbers, lanes and jets. No fast-math flag is ever set: the same bits at every width and level.
#include "rsl/jit/llvm/emitter.h"

namespace alpenglow::rsl::jit {

using ir::Inst;
using ir::Kind;
using ir::Op;
using llvm::Value;

Value* Emitter::number(float f) { return llvm::ConstantFP::get(context_, llvm::APFloat(f)); }

Value* Emitter::lanes(Value* v) { return v->getType()->isVectorTy() ? v : b_.CreateVectorSplat(unsigned(width_), v); }

void Emitter::match(Value*& a, Value*& b) {
    if (a->getType()->isVectorTy() == b->getType()->isVectorTy()) return;
    a = lanes(a);
    b = lanes(b);
}

// Null means an exact zero that is not computed.
Value* Emitter::fadd(Value* a, Value* b) {
    if (!a) return b;
    if (!b) return a;
    match(a, b);
    return b_.CreateFAdd(a, b);
}

Value* Emitter::fsub(Value* a, Value* b) {
    if (!b) return a;
    if (!a) return b_.CreateFNeg(b);
    match(a, b);
    return b_.CreateFSub(a, b);
}

Value* Emitter::fmul(Value* a, Value* b) {
    if (!a || !b) return nullptr;
    match(a, b);
    return b_.CreateFMul(a, b);
}

namespace {
// Second parts as pairs of first ones: duu = (du, du), duv = (du, dv), dvv = (dv, dv).
constexpr size_t kFirst[3] = {0, 0, 1}, kSecond[3] = {0, 1, 1};
} // namespace

Jet Emitter::add(Jet x, Jet y) {
    Jet r{fadd(x.v, y.v)};
    for (size_t p = 0; p < 5; p++) r.d[p] = fadd(x.d[p], y.d[p]);
    return r;
}

Jet Emitter::sub(Jet x, Jet y) {
    Jet r{fsub(x.v, y.v)};
    for (size_t p = 0; p < 5; p++) r.d[p] = fsub(x.d[p], y.d[p]);
    return r;
}

Jet Emitter::neg(Jet x) {
    Jet r{b_.CreateFNeg(x.v)};
    for (size_t p = 0; p < 5; p++) r.d[p] = x.d[p] ? b_.CreateFNeg(x.d[p]) : nullptr;
    return r;
}

Jet Emitter::mul(Jet x, Jet y) {
    Jet r{fmul(x.v, y.v)};
    for (size_t p = 0; p < 2; p++) r.d[p] = fadd(fmul(x.d[p], y.v), fmul(x.v, y.d[p]));
    for (size_t p = 0; p < 3; p++) {
        const size_t a = kFirst[p], b = kSecond[p];
        Value* cross = fadd(fmul(x.d[a], y.d[b]), fmul(x.d[b], y.d[a]));
        r.d[2 + p] = fadd(fadd(fmul(x.d[2 + p], y.v), fmul(x.v, y.d[2 + p])), cross);
    }
    return r;
}

// q = x / y, and 0 where y = 0; q' = (x' - q y') / y; q_ab = (x_ab - q_a y_b - q_b y_a - q y_ab) / y. The derivatives share one
// reciprocal in every build, so that a divisor that is one number and one that comes in lanes give the same bits.
Jet Emitter::div(Jet x, Jet y, const Inst* divisor) {
    bool safe = false;
    if (divisor->op == Op::Const) {
        safe = true;
        for (float f : divisor->numbers) safe &= f != 0;
    }
    Value *isZero = nullptr, *reciprocal = nullptr;
    auto quotient = [&](Value* a) -> Value* {
        Value* d = y.v;
        match(a, d);
        Value* q = b_.CreateFDiv(a, d);
        if (safe) return q;
        if (!isZero) isZero = b_.CreateFCmpOEQ(y.v, llvm::Constant::getNullValue(y.v->getType()));
        return b_.CreateSelect(isZero, llvm::Constant::getNullValue(q->getType()), q);
    };
    auto over = [&](Value* a) -> Value* {
        if (!a) return nullptr;
        if (!reciprocal) reciprocal = quotient(number(1));
        return fmul(a, reciprocal);
    };
    Jet r{quotient(x.v)};
    for (size_t p = 0; p < 2; p++) r.d[p] = over(fsub(x.d[p], fmul(r.v, y.d[p])));
    for (size_t p = 0; p < 3; p++) {
        const size_t a = kFirst[p], b = kSecond[p];
        Value* s = fsub(x.d[2 + p], fmul(r.d[a], y.d[b]));
        s = fsub(s, fmul(r.d[b], y.d[a]));
        r.d[2 + p] = over(fsub(s, fmul(r.v, y.d[2 + p])));
    }
    return r;
}

Jet Emitter::select(Value* c, Jet a, Jet b) {
    auto pick = [&](Value* x, Value* y) -> Value* {
        if (!x && !y) return nullptr;
        if (x == y) return x;
        if (!x) x = llvm::Constant::getNullValue(y->getType());
        if (!y) y = llvm::Constant::getNullValue(x->getType());
        if (c->getType()->isVectorTy()) {
            x = lanes(x);
            y = lanes(y);
        } else {
            match(x, y);
        }
        return b_.CreateSelect(c, x, y);
    };
    Jet r{pick(a.v, b.v)};
    for (size_t p = 0; p < 5; p++) r.d[p] = pick(a.d[p], b.d[p]);
    return r;
}

// d/du of {v, du, dv, duu, duv, dvv} is {du, duu, duv}; d/dv is {dv, duv, dvv}. Third order is zero (the passes have warned).
Jet Emitter::derive(Jet x, bool v) {
    Value* zero = llvm::Constant::getNullValue(x.v->getType());
    Jet r{v ? x.d[1] : x.d[0]};
    if (!r.v) r.v = zero;
    r.d[0] = v ? x.d[3] : x.d[2];
    r.d[1] = v ? x.d[4] : x.d[3];
    return r;
}

/// Comparisons, and what is made of truth values.
Val Emitter::logic(const Inst* i) {
    auto arg = [&](size_t k) -> Value* { return value(i->args[k])[0].v; };
    auto compare = [&](llvm::CmpInst::Predicate f, llvm::CmpInst::Predicate s) -> Val {
        Value *a = arg(0), *b = arg(1);
        match(a, b);
        return {{a->getType()->isFPOrFPVectorTy() ? b_.CreateFCmp(f, a, b) : b_.CreateICmp(s, a, b)}};
    };
    using P = llvm::CmpInst;
    switch (i->op) {
    case Op::Less:
        return compare(P::FCMP_OLT, P::ICMP_SLT);
    case Op::LessEqual:
        return compare(P::FCMP_OLE, P::ICMP_SLE);
    case Op::Equal:
        return compare(P::FCMP_OEQ, P::ICMP_EQ);
    case Op::NotEqual:
        return compare(P::FCMP_UNE, P::ICMP_NE);
    case Op::Not:
        return {{b_.CreateNot(arg(0))}};
    case Op::ToFloat: {
        Value *c = arg(0), *one = number(1), *nought = number(0);
        if (c->getType()->isVectorTy()) {
            one = lanes(one);
            nought = lanes(nought);
        }
        return {{b_.CreateSelect(c, one, nought)}};
    }
    default: { // And, Or
        Value *a = arg(0), *b = arg(1);
        match(a, b);
        return {{i->op == Op::And ? b_.CreateAnd(a, b) : b_.CreateOr(a, b)}};
    }
    }
}

void Emitter::arithmetic(const Inst* i) {
    auto arg = [&](size_t k) -> const Val& { return value(i->args[k]); };
    Val r;
    auto each = [&](auto&& f) {
        const Val &a = arg(0), &b = arg(1);
        if (a.size() != b.size()) fail(std::string("operands of different kinds: ") + ir::name(i->op));
        for (size_t c = 0; c < a.size(); c++) r.push_back(f(a[c], b[c]));
    };
    switch (i->op) {
    case Op::Add:
        each([&](Jet a, Jet b) { return add(a, b); });
        break;
    case Op::Sub:
        each([&](Jet a, Jet b) { return sub(a, b); });
        break;
    case Op::Mul:
        each([&](Jet a, Jet b) { return mul(a, b); });
        break;
    case Op::Div:
        each([&](Jet a, Jet b) { return div(a, b, i->args[1]); });
        break;
    case Op::Neg:
        for (const Jet& j : arg(0)) r.push_back(neg(j));
        break;
    case Op::Splat:
        r.assign(3, arg(0)[0]);
        break;
    case Op::Triple:
    case Op::MatrixOf:
        for (size_t k = 0; k < i->args.size(); k++) r.push_back(arg(k)[0]);
        break;
    case Op::Extract:
        if (i->index < 0 || size_t(i->index) >= arg(0).size()) fail("component out of range");
        r.push_back(arg(0)[size_t(i->index)]);
        break;
    case Op::Less:
    case Op::LessEqual:
    case Op::Equal:
    case Op::NotEqual:
    case Op::And:
    case Op::Or:
    case Op::Not:
    case Op::ToFloat:
        r = logic(i);
        break;
    case Op::Select: {
        const Val &c = arg(0), &a = arg(1), &b = arg(2);
        for (size_t k = 0; k < a.size(); k++) r.push_back(select(c[0].v, a[k], b[k]));
        break;
    }
    case Op::Du:
        for (const Jet& j : arg(0)) r.push_back(derive(j, false));
        break;
    case Op::Dv:
        for (const Jet& j : arg(0)) r.push_back(derive(j, true));
        break;
    default:
        fail(std::string("no code for ") + ir::name(i->op));
    }
    // Only requested orders are computed.
    const uint8_t wanted = partsOfOrder(shapes_.order(i));
    for (Jet& j : r)
        for (size_t p = 0; p < 5; p++)
            if (!(wanted & (1u << p))) j.d[p] = nullptr;
    define(i, 0, std::move(r));
}

} // namespace alpenglow::rsl::jit
