#include "rsl/jit/llvm/emitter.h"
#include "rsl/kernel.h"
#include <algorithm>
#include <cstddef>

namespace alpenglow::rsl::jit {

using ir::Inst;
using ir::Kind;
using ir::Op;
using llvm::BasicBlock;
using llvm::Value;

namespace {

int componentsOf(Kind k) {
    switch (k) {
    case Kind::Triple:
        return 3;
    case Kind::Matrix:
        return 16;
    case Kind::Float:
    case Kind::Bool:
    case Kind::String:
        return 1;
    default:
        return 0;
    }
}

} // namespace

Plan plan(const ModuleRequest& r, const Shapes& shapes) {
    const Pressure p = measure(*r.kernel, shapes, r.outOfLine);
    Plan plan;
    // Thirty inlined noises are about 6,000 instructions: 0.3 s of compilation. Beyond that they are called.
    plan.wrapCalls = p.outOfLineCalls > 32;
    if (r.vectors > 0) plan.vectors = r.vectors;
    else if (shapes.hasRequests() || p.effects || plan.wrapCalls || p.wideCalls > 2 || p.instructions > 600) plan.vectors = 1;
    else if (r.lanes >= 8 && p.live <= 7 && p.outOfLineCalls == 0 && !p.loops) plan.vectors = 4;
    else if (p.outOfLineCalls > 0) plan.vectors = 2; // long chains of integer operations: a second one hides half of each
    else if (p.live <= 14) plan.vectors = 2;
    while (r.lanes * plan.vectors > p.widest) plan.vectors /= 2;
    if (plan.vectors == 3) plan.vectors = 2; // the runtime exists for powers of two
    return plan;
}

Emitter::Emitter(const ModuleRequest& request, const Shapes& shapes, int width, llvm::Module& m, llvm::Module& runtime)
    : request_(request), kernel_(*request.kernel), shapes_(shapes), width_(width), module_(m), runtime_(runtime),
      context_(m.getContext()), b_(context_), entry_(context_) {
    f32_ = llvm::Type::getFloatTy(context_);
    i1_ = llvm::Type::getInt1Ty(context_);
    i32_ = llvm::Type::getInt32Ty(context_);
    i64_ = llvm::Type::getInt64Ty(context_);
    ptr_ = llvm::PointerType::get(context_, 0);
    void_ = llvm::Type::getVoidTy(context_);
    vf_ = llvm::FixedVectorType::get(f32_, unsigned(width));
    vi_ = llvm::FixedVectorType::get(i32_, unsigned(width));
    vm_ = llvm::FixedVectorType::get(i1_, unsigned(width));
    wrapCalls_ = plan(request, shapes).wrapCalls;
    shared_ = std::make_shared<Shared>();
}

void Emitter::fail(const std::string& what) { throw CodegenError(what); }

BasicBlock* Emitter::block(const char* name) { return BasicBlock::Create(context_, name, function_); }

Value* Emitter::any(Value* mask) { return b_.CreateOrReduce(mask); }

// Loops test the caller's stop flag, so that while (1) can be interrupted.
Value* Emitter::stopped() {
    auto* l = b_.CreateLoad(i32_, stop_, /*isVolatile=*/true, "stop");
    l->setAtomic(llvm::AtomicOrdering::Monotonic); // StopFlag: another thread sets it
    return b_.CreateICmpNE(l, b_.getInt32(0));
}

const Val& Emitter::value(const Inst* i) {
    auto it = values_.find(i);
    if (it == values_.end() || it->second.empty() || it->second[0].empty())
        fail(std::string("use of an undefined value: ") + ir::name(i->op));
    return it->second[0];
}

void Emitter::define(const Inst* i, int index, Val v) {
    auto& slot = values_[i];
    if (int(slot.size()) <= index) slot.resize(size_t(index) + 1);
    slot[size_t(index)] = std::move(v);
}

Val Emitter::zero(Kind kind, Shape s) {
    llvm::Type* t = kind == Kind::Bool     ? (s.varying ? (llvm::Type*)vm_ : i1_)
                    : kind == Kind::String ? (s.varying ? (llvm::Type*)vi_ : i32_)
                                           : (s.varying ? (llvm::Type*)vf_ : f32_);
    Val v(size_t(componentsOf(kind)));
    for (Jet& j : v) {
        j.v = llvm::Constant::getNullValue(t);
        for (int p = 0; p < 5; p++)
            if (s.parts & (1 << p)) j.d[size_t(p)] = llvm::Constant::getNullValue(t);
    }
    return v;
}

// Makes a value have exactly this shape: lanes where lanes are wanted, explicit zeros for parts that may differ elsewhere.
Val Emitter::conform(Val v, Kind, Shape s) {
    for (Jet& j : v) {
        if (s.varying) j.v = lanes(j.v);
        else if (j.v->getType()->isVectorTy()) fail("lanes where one number was expected");
        for (int p = 0; p < 5; p++) {
            Value*& d = j.d[size_t(p)];
            if (!(s.parts & (1 << p))) d = nullptr;
            else if (!d) d = llvm::Constant::getNullValue(j.v->getType());
            else if (s.varying) d = lanes(d);
        }
    }
    return v;
}

Val Emitter::phis(Kind kind, Shape s) {
    Val v = zero(kind, s);
    for (Jet& j : v) {
        j.v = b_.CreatePHI(j.v->getType(), 2);
        for (Value*& d : j.d)
            if (d) d = b_.CreatePHI(d->getType(), 2);
    }
    return v;
}

void Emitter::addIncoming(Val& phi, const Val& v, BasicBlock* from) {
    for (size_t c = 0; c < phi.size(); c++) {
        llvm::cast<llvm::PHINode>(phi[c].v)->addIncoming(v[c].v, from);
        for (size_t p = 0; p < 5; p++)
            if (phi[c].d[p]) llvm::cast<llvm::PHINode>(phi[c].d[p])->addIncoming(v[c].d[p], from);
    }
}

Val Emitter::selectLanes(Value* mask, const Val& a, const Val& b) {
    Val r(a.size());
    for (size_t c = 0; c < a.size(); c++) r[c] = select(mask, a[c], b[c]);
    return r;
}

// running ? next : old, where next is often itself "old for the lanes of an inner condition": the masks are joined, one select is
// left.
Val Emitter::keepLanes(Value* running, const Val& next, const Val& old) {
    auto one = [&](Value* n, Value* o) -> Value* {
        if (!n) return nullptr;
        Value* mask = running;
        while (auto* s = llvm::dyn_cast<llvm::SelectInst>(n)) {
            if (!s->getCondition()->getType()->isVectorTy()) break;
            if (s->getTrueValue() == o) {
                mask = b_.CreateAnd(mask, b_.CreateNot(s->getCondition()));
                n = s->getFalseValue();
            } else if (s->getFalseValue() == o) {
                mask = b_.CreateAnd(mask, s->getCondition());
                n = s->getTrueValue();
            } else {
                break;
            }
        }
        return n == o ? o : b_.CreateSelect(mask, n, o);
    };
    Val r(next.size());
    for (size_t c = 0; c < next.size(); c++) {
        r[c].v = one(next[c].v, old[c].v);
        for (size_t p = 0; p < 5; p++) r[c].d[p] = one(next[c].d[p], old[c].d[p]);
    }
    return r;
}

// next without the selects that keep `old` in lanes where `leaving` is set. The value of such a lane is not read again.
Val Emitter::dropDead(Val next, const Val& old, Value* leaving) {
    auto isTrue = [](Value* v) {
        auto* c = llvm::dyn_cast<llvm::Constant>(v);
        return c && c->isAllOnesValue();
    };
    auto isNot = [&](Value* a, Value* b) {
        auto* x = llvm::dyn_cast<llvm::BinaryOperator>(a);
        return x && x->getOpcode() == llvm::Instruction::Xor &&
               ((x->getOperand(0) == b && isTrue(x->getOperand(1))) || (x->getOperand(1) == b && isTrue(x->getOperand(0))));
    };
    auto one = [&](Value* n, Value* o) -> Value* {
        Value* flag = leaving;
        while (auto* s = llvm::dyn_cast_or_null<llvm::SelectInst>(n)) {
            Value* c = s->getCondition();
            if (!c->getType()->isVectorTy()) break;
            auto* g = llvm::dyn_cast<llvm::SelectInst>(flag);
            if (g && g->getCondition() != c) g = nullptr;
            if (s->getFalseValue() == o && (isNot(c, flag) || isNot(flag, c) || (g && isTrue(g->getFalseValue())))) {
                n = s->getTrueValue();
                if (!g) break;
                flag = g->getTrueValue();
            } else if (s->getTrueValue() == o && (c == flag || (g && isTrue(g->getTrueValue())))) {
                n = s->getFalseValue();
                if (!g) break;
                flag = g->getFalseValue();
            } else {
                break;
            }
        }
        return n;
    };
    for (size_t c = 0; c < next.size(); c++) {
        next[c].v = one(next[c].v, old[c].v);
        for (size_t p = 0; p < 5; p++) next[c].d[p] = one(next[c].d[p], old[c].d[p]);
    }
    return next;
}

void Emitter::region(const ir::Region& r) {
    for (const Inst* i : r.body) inst(i);
}

void Emitter::inst(const Inst* i) {
    switch (i->op) {
    case Op::Const: {
        Val v;
        if (i->kind == Kind::Bool) v.push_back({llvm::ConstantInt::getBool(context_, !i->numbers.empty() && i->numbers[0] != 0)});
        else
            for (int c = 0; c < componentsOf(i->kind); c++)
                v.push_back({number(size_t(c) < i->numbers.size() ? i->numbers[size_t(c)] : 0.0f)});
        return define(i, 0, std::move(v));
    }
    case Op::ConstString:
        return define(i, 0, {Jet{constantString(i->text)}});
    case Op::Input:
        return input(i);
    case Op::RegionParam:
        return;
    case Op::Result: {
        auto it = values_.find(i->args[0]);
        if (it == values_.end() || size_t(i->index) >= it->second.size()) fail("result of an instruction that has none");
        Val v = it->second[size_t(i->index)]; // a copy: define may move the table
        return define(i, 0, std::move(v));
    }
    case Op::Runtime:
        return runtime(i);
    case Op::Function:
        return; // made when it is called
    case Op::Call:
        return call(i);
    case Op::Service:
    case Op::Request:
    case Op::Emit:
        return service(i);
    case Op::Mark:
    case Op::Rescale:
        return mark(i);
    case Op::ArrayNew:
        return arrayNew(i);
    case Op::ArrayInput:
        return arrayInput(i);
    case Op::ArrayLoad:
        return arrayLoad(i);
    case Op::ArrayStore:
        return arrayStore(i);
    case Op::If:
        return emitIf(i);
    case Op::Loop:
        return emitLoop(i);
    case Op::LightLoop:
        return emitLightLoop(i);
    case Op::Output:
        return output(i);
    default:
        return arithmetic(i);
    }
}

} // namespace alpenglow::rsl::jit
