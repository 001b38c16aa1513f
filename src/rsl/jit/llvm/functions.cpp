// Calls of RSL functions that were not inlined. Each becomes a function of the machine code for each way its arguments come: one
// number or lanes, with which derivative parts. What is exactly zero in the caller is so in the body, too: the bits are those of
// inlining.
#include "rsl/jit/llvm/emitter.h"
#include <unordered_set>

namespace alpenglow::rsl::jit {

using ir::Inst;
using ir::Kind;
using ir::Op;
using llvm::Function;
using llvm::FunctionType;
using llvm::Value;

Emitter::Emitter(const Emitter& caller, const Shapes& shapes)
    : request_(caller.request_), kernel_(caller.kernel_), shapes_(shapes), width_(caller.width_), module_(caller.module_),
      runtime_(caller.runtime_), context_(caller.context_), b_(context_), entry_(context_), f32_(caller.f32_), i1_(caller.i1_),
      i32_(caller.i32_), i64_(caller.i64_), ptr_(caller.ptr_), void_(caller.void_), vf_(caller.vf_), vi_(caller.vi_),
      vm_(caller.vm_), shared_(caller.shared_), wrapCalls_(caller.wrapCalls_) {
    loops_ = 1; // the caller may be in a loop
}

Emitter::Slot Emitter::slot(const Jet& j) const {
    uint8_t parts = 0;
    bool varying = j.v->getType()->isVectorTy();
    for (int p = 0; p < 5; p++)
        if (j.d[size_t(p)]) {
            parts |= uint8_t(1 << p);
            varying = varying || j.d[size_t(p)]->getType()->isVectorTy();
        }
    return {varying, parts};
}

// Conditions travel as whole lanes.
llvm::Type* Emitter::slotType(Kind k, bool varying) {
    if (k == Kind::String || k == Kind::Bool) return varying ? (llvm::Type*)vi_ : i32_;
    return varying ? (llvm::Type*)vf_ : f32_;
}

void Emitter::passTypes(Kind k, const Slot& s, std::vector<llvm::Type*>& types) {
    for (int n = 0; n <= __builtin_popcount(s.parts); n++) types.push_back(slotType(k, s.varying));
}

void Emitter::pass(const Jet& j, const Slot& s, std::vector<Value*>& values) {
    Value* v = s.varying ? lanes(j.v) : j.v;
    if (v->getType()->getScalarType() == i1_) v = b_.CreateSExt(v, s.varying ? (llvm::Type*)vi_ : i32_);
    values.push_back(v);
    for (int p = 0; p < 5; p++)
        if (s.parts & (1 << p)) values.push_back(s.varying ? lanes(j.d[size_t(p)]) : j.d[size_t(p)]);
}

Jet Emitter::receive(Kind k, const Slot& s, const std::function<Value*()>& next) {
    Jet j{next()};
    if (k == Kind::Bool) j.v = b_.CreateICmpNE(j.v, llvm::Constant::getNullValue(j.v->getType()));
    for (int p = 0; p < 5; p++)
        if (s.parts & (1 << p)) j.d[size_t(p)] = next();
    return j;
}

/// Constants and inputs that a body uses: written before everything else.
void Emitter::leaves(const ir::Region& body) {
    std::unordered_set<const Inst*> seen;
    const auto leaf = [&](const Inst* i) {
        const bool is = i->op == Op::Const || i->op == Op::ConstString || i->op == Op::Input || i->op == Op::ArrayInput;
        if (is && seen.insert(i).second) inst(i);
    };
    const std::function<void(const ir::Region&)> within = [&](const ir::Region& r) {
        for (const Inst* i : r.body) {
            for (const Inst* a : i->args) leaf(a);
            for (const ir::Region& sub : i->regions) within(sub);
        }
        for (const Inst* y : r.yields) leaf(y);
    };
    within(body);
}

Emitter::Made Emitter::function(const Inst* f, const std::vector<std::vector<Slot>>& arguments) {
    std::string key = std::to_string(f->id);
    std::vector<Shape> shapes;
    std::vector<llvm::Type*> types = {ptr_, i32_, vi_, ptr_,
                                      ptr_}; // the kernel's call, first point of the strip, mask, local memory, turns
    const ir::Region& body = f->regions[0];
    for (size_t a = 0; a < arguments.size(); a++) {
        Shape shape;
        key += ':';
        for (const Slot& s : arguments[a]) {
            shape.join({s.varying, s.parts});
            key += char('0' + s.varying);
            key += char('A' + s.parts);
            passTypes(body.params[a]->kind, s, types);
        }
        shapes.push_back(shape);
    }
    if (const auto it = shared_->made.find(key); it != shared_->made.end()) return it->second;

    // The results' slots are known when the body stands: it is written into a function without results and then moved.
    auto* draft = Function::Create(FunctionType::get(void_, types, false), Function::InternalLinkage, "draft", module_);
    Emitter e(*this, shapes_.function(f, shapes));
    e.beginFunction(draft);
    e.loadCall(draft->getArg(0));
    e.first_ = draft->getArg(1);
    e.first64_ = e.b_.CreateSExt(e.first_, i64_);
    e.mask_ = e.b_.CreateICmpNE(draft->getArg(2), llvm::Constant::getNullValue(vi_), "mask");
    e.rootMask_ = false;
    e.memory_ = draft->getArg(3), e.turns_ = draft->getArg(4);
    e.entryBlock_ = e.b_.GetInsertBlock();
    e.entry_.SetInsertPoint(e.entryBlock_);
    llvm::BasicBlock* start = e.block("body");
    e.b_.SetInsertPoint(start);
    unsigned at = 5;
    const auto next = [&]() -> Value* { return draft->getArg(at++); };
    for (size_t a = 0; a < arguments.size(); a++) {
        Val v;
        for (const Slot& s : arguments[a]) v.push_back(e.receive(body.params[a]->kind, s, next));
        e.define(body.params[a], 0, std::move(v));
    }
    e.leaves(body);
    e.region(body);
    Made made;
    std::vector<llvm::Type*> resultTypes;
    std::vector<Value*> results;
    for (const Inst* y : body.yields) {
        made.results.emplace_back();
        const uint8_t wanted = partsOfOrder(e.shapes_.order(y));
        for (Jet j : e.value(y)) {
            for (int p = 0; p < 5; p++)
                if (!(wanted & (1 << p))) j.d[size_t(p)] = nullptr;
            const Slot s = e.slot(j);
            made.results.back().push_back(s);
            passTypes(y->kind, s, resultTypes);
            e.pass(j, s, results);
        }
    }
    auto* resultType = llvm::StructType::get(context_, resultTypes);
    Value* all = llvm::PoisonValue::get(resultType);
    for (size_t n = 0; n < results.size(); n++) all = e.b_.CreateInsertValue(all, results[n], unsigned(n));
    made.function =
        Function::Create(FunctionType::get(resultType, types, false), Function::InternalLinkage, "rsl_" + f->text, module_);
    made.function->setCallingConv(llvm::CallingConv::Fast);
    made.function->addFnAttr(llvm::Attribute::NoUnwind);
    made.function->addFnAttr(llvm::Attribute::NoInline);
    made.function->splice(made.function->begin(), draft);
    for (unsigned n = 0; n < draft->arg_size(); n++) draft->getArg(n)->replaceAllUsesWith(made.function->getArg(n));
    e.function_ = made.function;
    e.memory_ = made.function->getArg(3);
    e.b_.CreateRet(all);
    e.entry_.CreateBr(start);
    e.finishScratch();
    draft->eraseFromParent();
    return shared_->made[key] = made;
}

void Emitter::call(const Inst* i) {
    const Inst* f = i->args[0];
    const ir::Region& body = f->regions[0];
    std::vector<std::vector<Slot>> arguments;
    Value* mask = b_.CreateSExt(mask_, vi_);
    std::vector<Value*> values = {call_, first_, mask, memory_, turns_};
    for (size_t a = 0; a < body.params.size(); a++) {
        const uint8_t wanted = partsOfOrder(body.params[a]->order);
        arguments.emplace_back();
        for (Jet j : value(i->args[a + 1])) {
            for (int p = 0; p < 5; p++)
                if (!(wanted & (1 << p))) j.d[size_t(p)] = nullptr;
            const Slot s = slot(j);
            arguments.back().push_back(s);
            pass(j, s, values);
        }
    }
    const Made made = function(f, arguments);
    auto* c = b_.CreateCall(made.function, values);
    c->setCallingConv(llvm::CallingConv::Fast);
    unsigned at = 0;
    const auto next = [&]() -> Value* { return b_.CreateExtractValue(c, at++); };
    for (size_t r = 0; r < made.results.size(); r++) {
        Val v;
        for (const Slot& s : made.results[r]) v.push_back(receive(body.yields[r]->kind, s, next));
        define(i, int(r), std::move(v));
    }
}

} // namespace alpenglow::rsl::jit
