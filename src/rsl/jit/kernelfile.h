// A compiled kernel as bytes: what CompiledKernel knows, the messages of its compilation, and the object file. The form of the
// disk cache.
#pragma once
#include "base/diagnostics.h"
#include "rsl/kernel.h"
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::rsl::jit {

/// The contents of a file.
struct KernelFile {
    std::string key; ///< its key in the cache
    /// As of ir::Kernel.
    std::vector<ir::Input> inputs;
    std::vector<ir::OutputSlot> outputs;
    std::vector<ir::Site> sites;
    std::vector<std::string> files;
    ir::KernelFacts facts;
    std::vector<std::string> strings; ///< texts; ids are given when loaded
    int strip = 0;                    ///< points of a strip
    bool suspending = false;          ///< it is a coroutine
    uint64_t localBytes = 0;          ///< of KernelCall::memory
    std::vector<Diagnostic> messages; ///< warnings of the build, repeated when the kernel comes from the cache
    std::string object;               ///< ELF relocatable file
};

/// The bytes of a file, with a digest.
std::string pack(const KernelFile&);
/// Nothing when the bytes are damaged. Shadeops are found again by name.
std::optional<KernelFile> unpack(const std::string& bytes);

} // namespace alpenglow::rsl::jit
