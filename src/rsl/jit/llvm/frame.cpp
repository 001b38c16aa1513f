// The function around a kernel's body: the loop over strips, or the coroutine.
#include "rsl/jit/llvm/emitter.h"
#include "rsl/kernel.h"
#include <cstddef>
#include <llvm/IR/Intrinsics.h>

namespace alpenglow::rsl::jit {

using llvm::BasicBlock;
using llvm::Function;
using llvm::FunctionType;
using llvm::Value;
using llvm::Intrinsic::ID;

Value* Emitter::field(size_t offset, llvm::Type* type, const char* name) {
    return b_.CreateLoad(type, b_.CreateConstInBoundsGEP1_64(llvm::Type::getInt8Ty(context_), call_, offset), name);
}

void Emitter::loadCall(Value* call) {
    call_ = call;
    in_ = field(offsetof(KernelCall, in), ptr_, "in");
    out_ = field(offsetof(KernelCall, out), ptr_, "out");
    n_ = field(offsetof(KernelCall, n), i32_, "n");
    stride_ = b_.CreateSExt(field(offsetof(KernelCall, stride), i32_, "stride"), i64_);
    stringIds_ = field(offsetof(KernelCall, strings), ptr_, "strings");
    Value* stop = field(offsetof(KernelCall, stop), ptr_, "stop");
    // A caller that never stops may leave the pointer null.
    auto* never = new llvm::GlobalVariable(module_, i32_, /*constant=*/true, llvm::GlobalValue::InternalLinkage,
                                           llvm::ConstantInt::get(i32_, 0), "never");
    stop_ = b_.CreateSelect(b_.CreateIsNull(stop), never, stop);
}

void Emitter::beginFunction(Function* f) {
    function_ = f;
    f->addFnAttr(llvm::Attribute::NoUnwind);
    b_.SetInsertPoint(BasicBlock::Create(context_, "entry", f));
    for (auto& s : scratch_) {
        s.place = b_.CreateAlloca(vf_, nullptr, "scratch");
        s.rows = 0;
    }
    turns_ = b_.CreateAlloca(vi_, nullptr, "turns");
}

void Emitter::finishScratch() {
    for (size_t k = 0; k < scratch_.size(); k++) {
        auto& s = scratch_[k];
        if (s.rows > 0) {
            // Rows of runtime calls have the alignment of a whole vector type; those of services are promised 64 bytes.
            const uint64_t align = k < 2 && width_ > 16 ? uint64_t(width_) * 4 : 64;
            Value* rows = localMemory(uint64_t(s.rows) * uint64_t(width_) * 4, align, entryBlock_->getTerminator());
            if (!rows) {
                B at(s.place);
                auto* a = at.CreateAlloca(llvm::ArrayType::get(vf_, uint64_t(s.rows)));
                a->setAlignment(llvm::Align(align));
                rows = a;
            }
            s.place->replaceAllUsesWith(rows);
        }
        s.place->eraseFromParent();
        s.place = nullptr;
    }
}

// The strip's lanes: first + lane < n.
void Emitter::setMask(Value* first) {
    first_ = first;
    first64_ = b_.CreateSExt(first, i64_);
    std::vector<llvm::Constant*> lane;
    for (int i = 0; i < width_; i++) lane.push_back(llvm::ConstantInt::get(i32_, uint64_t(i)));
    Value* left = b_.CreateSub(n_, first);
    mask_ = b_.CreateICmpSLT(llvm::ConstantVector::get(lane), lanes(left), "mask");
    rootMask_ = true;
    b_.CreateStore(llvm::Constant::getNullValue(vi_), turns_);
}

void Emitter::emitLoopKernel() {
    auto* f = Function::Create(FunctionType::get(void_, {ptr_}, false), Function::ExternalLinkage, kEntryName, module_);
    beginFunction(f);
    loadCall(f->getArg(0));
    memory_ = field(offsetof(KernelCall, memory), ptr_, "memory");
    entryBlock_ = b_.GetInsertBlock();
    entry_.SetInsertPoint(entryBlock_);
    BasicBlock *head = block("strips"), *body = block("strip"), *exit = block("done");
    b_.SetInsertPoint(head);
    auto* first = b_.CreatePHI(i32_, 2, "first");
    first->addIncoming(b_.getInt32(0), entryBlock_);
    b_.CreateCondBr(b_.CreateICmpSLT(first, n_), body, exit);
    b_.SetInsertPoint(body);
    setMask(first);
    region(kernel_.body);
    Value* next = b_.CreateAdd(first, b_.getInt32(uint32_t(width_)));
    first->addIncoming(next, b_.GetInsertBlock());
    b_.CreateBr(head);
    b_.SetInsertPoint(exit);
    b_.CreateRetVoid();
    entry_.CreateBr(head);
    finishScratch();
}

void Emitter::suspend() {
    BasicBlock* resumed = block("resumed");
    Value* token = llvm::ConstantTokenNone::get(context_);
    Value* s = b_.CreateIntrinsic(llvm::Intrinsic::coro_suspend, {}, {token, b_.getFalse()});
    auto* sw = b_.CreateSwitch(s, suspendBlock_, 2);
    sw->addCase(b_.getInt8(0), resumed);
    sw->addCase(b_.getInt8(1), cleanupBlock_);
    b_.SetInsertPoint(resumed);
}

void Emitter::emitCoroutine() {
    auto* f = Function::Create(FunctionType::get(ptr_, {ptr_, i32_}, false), Function::ExternalLinkage, kStartName, module_);
    f->setPresplitCoroutine();
    beginFunction(f);
    Value* call = f->getArg(0);
    auto* null = llvm::ConstantPointerNull::get(llvm::cast<llvm::PointerType>(ptr_));
    Value* token = llvm::ConstantTokenNone::get(context_);
    Value* id = b_.CreateIntrinsic(llvm::Intrinsic::coro_id, {}, {b_.getInt32(64), null, null, null});
    // Local memory follows the frame. Its size is known when the body has been emitted.
    auto* local = new llvm::GlobalVariable(module_, i64_, /*constant=*/true, llvm::GlobalValue::InternalLinkage,
                                           llvm::ConstantInt::get(i64_, 0), "local");
    const auto frameBytes = [&] {
        Value* n = b_.CreateIntrinsic(llvm::Intrinsic::coro_size, {i64_}, {});
        return b_.CreateAnd(b_.CreateAdd(n, b_.getInt64(kMemoryAlign - 1)), b_.getInt64(~uint64_t(kMemoryAlign - 1)));
    };
    Value* behind = frameBytes();
    Value* size = b_.CreateAdd(behind, b_.CreateLoad(i64_, local));
    call_ = call;
    Value* alloc = field(offsetof(KernelCall, alloc), ptr_, "alloc");
    Value* memory = b_.CreateCall(FunctionType::get(ptr_, {ptr_, i64_}, false), alloc, {call, size}, "frame");
    BasicBlock *begin = block("begin"), *body = block("strip"), *full = block("nomemory");
    cleanupBlock_ = block("cleanup");
    suspendBlock_ = block("suspend");
    b_.CreateCondBr(b_.CreateIsNull(memory), full, begin);
    b_.SetInsertPoint(full);
    b_.CreateRet(null);
    b_.SetInsertPoint(begin);
    Value* handle = b_.CreateIntrinsic(llvm::Intrinsic::coro_begin, {}, {id, memory});
    memory_ = b_.CreateGEP(llvm::Type::getInt8Ty(context_), memory, behind, "memory");
    loadCall(call);
    entryBlock_ = begin;
    entry_.SetInsertPoint(begin);
    b_.SetInsertPoint(body);
    setMask(f->getArg(1));
    region(kernel_.body);
    Value* last = b_.CreateIntrinsic(llvm::Intrinsic::coro_suspend, {}, {token, b_.getTrue()});
    BasicBlock* never = block("never");
    auto* sw = b_.CreateSwitch(last, suspendBlock_, 2);
    sw->addCase(b_.getInt8(0), never);
    sw->addCase(b_.getInt8(1), cleanupBlock_);
    b_.SetInsertPoint(never);
    b_.CreateUnreachable();
    b_.SetInsertPoint(cleanupBlock_);
    Value* freed = b_.CreateIntrinsic(llvm::Intrinsic::coro_free, {}, {id, handle});
    Value* release = field(offsetof(KernelCall, release), ptr_, "release");
    Value* bytes = b_.CreateAdd(frameBytes(), b_.CreateLoad(i64_, local));
    b_.CreateCall(FunctionType::get(void_, {ptr_, ptr_, i64_}, false), release, {call, freed, bytes});
    b_.CreateBr(suspendBlock_);
    b_.SetInsertPoint(suspendBlock_);
    b_.CreateIntrinsic(llvm::Intrinsic::coro_end, {}, {handle, b_.getFalse(), token});
    b_.CreateRet(handle);
    entry_.CreateBr(body);
    finishScratch();
    local->setInitializer(llvm::ConstantInt::get(i64_, shared_->localBytes));

    auto small = [&](const char* name, llvm::Type* result) {
        auto* g = Function::Create(FunctionType::get(result, {ptr_}, false), Function::ExternalLinkage, name, module_);
        g->addFnAttr(llvm::Attribute::NoUnwind);
        b_.SetInsertPoint(BasicBlock::Create(context_, "entry", g));
        return g;
    };
    auto* resume = small(kResumeName, void_);
    b_.CreateIntrinsic(llvm::Intrinsic::coro_resume, {}, {resume->getArg(0)});
    b_.CreateRetVoid();
    auto* destroy = small(kDestroyName, void_);
    b_.CreateIntrinsic(llvm::Intrinsic::coro_destroy, {}, {destroy->getArg(0)});
    b_.CreateRetVoid();
    auto* finished = small(kFinishedName, i32_);
    b_.CreateRet(b_.CreateZExt(b_.CreateIntrinsic(llvm::Intrinsic::coro_done, {}, {finished->getArg(0)}), i32_));
}

} // namespace alpenglow::rsl::jit
