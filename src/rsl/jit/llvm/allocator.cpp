#include "rsl/jit/llvm/allocator.h"
#include <llvm/CodeGen/Passes.h>
#include <llvm/IR/Module.h>
#include <mutex>
// The registry is LLVM's, not a copy in this module.
#pragma GCC visibility push(default)
#include <llvm/CodeGen/RegAllocRegistry.h>
#pragma GCC visibility pop
extern template class llvm::RegisterRegAllocBase<llvm::RegisterRegAlloc>;

namespace alpenglow::rsl::jit {

namespace {

/// Instructions of one function from which on time to compile counts for more than spills: the largest published shaders have
/// a quarter of them.
constexpr size_t kLarge = 40000;

/// LLVM calls a function without arguments, on the thread that creates the passes.
thread_local llvm::FunctionPass* (*chosen)() = nullptr;

llvm::FunctionPass* choose() { return chosen ? chosen() : llvm::createGreedyRegisterAllocator(); }

} // namespace

AllocatorFor::AllocatorFor(const llvm::Module& m, bool optimised) {
    static std::once_flag once;
    std::call_once(once, [] { llvm::RegisterRegAlloc::setDefault(choose); });
    size_t largest = 0;
    for (const llvm::Function& f : m) largest = std::max(largest, size_t(f.getInstructionCount()));
    if (!optimised) chosen = llvm::createFastRegisterAllocator;
    else if (largest > kLarge) chosen = llvm::createBasicRegisterAllocator;
    else chosen = llvm::createGreedyRegisterAllocator;
}

AllocatorFor::~AllocatorFor() { chosen = nullptr; }

} // namespace alpenglow::rsl::jit
