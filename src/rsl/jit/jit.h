// A kernel of our IR becomes machine code.
#pragma once
#include "rsl/jit/kernelfile.h"
#include "rsl/jit/module.h"
#include "rsl/kernel.h"
#include <functional>
#include <memory>

namespace alpenglow::rsl::jit {

/// Generates code for an optimised kernel through the LLVM module. False with the reason in `error`.
bool generate(const ir::Kernel&, const KernelOptions&, KernelFile& out, std::string& error, std::string* llvmText = nullptr);

/// Brings the code into memory; `outside` knows the functions of plug-ins. Null with the reason in `error`.
std::shared_ptr<const CompiledKernel> load(const KernelFile&, bool fromCache, std::string& error,
                                           const std::function<void*(const std::string&)>& outside = {});

/// What of `options`, the machine and this program decides about the code: for the key.
std::string codeKey(const KernelOptions&);

} // namespace alpenglow::rsl::jit
