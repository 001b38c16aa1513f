// Which register allocator a module gets.
#pragma once

namespace llvm {
class Module;
}

namespace alpenglow::rsl::jit {

/// While it lives, passes that this thread makes for the module have the allocator that suits it: LLVM's greedy one grows faster
/// than a function does (half a minute at 100,000 instructions), its basic one does not, and spills more.
class AllocatorFor {
public:
    /// `optimised`: machine code for speed.
    AllocatorFor(const llvm::Module&, bool optimised);
    ~AllocatorFor();
    AllocatorFor(const AllocatorFor&) = delete;
    AllocatorFor& operator=(const AllocatorFor&) = delete;
};

} // namespace alpenglow::rsl::jit
