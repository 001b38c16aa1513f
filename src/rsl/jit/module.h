// The interface of the LLVM module (libalpenglow_jit.so), which is loaded for the first kernel that no cache has. No LLVM types
// here.
#pragma once
#include "rsl/ir/ir.h"
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace alpenglow::rsl::jit {

/// Instruction sets that code is made for. The level is chosen from the lane count and the machine, without LLVM.
enum class Isa : int { Sse42 = 0, Sse42Fma = 1, Avx2 = 2, Avx512 = 3 };
/// As messages and the cache key name it.
const char* name(Isa);
/// What this machine can run of what `lanes` asks for: 16 Avx512, 8 Avx2, 4 Sse42 (with FMA in 128-bit registers where there is
/// FMA).
Isa isaFor(int lanes);

/// LLVM bitcode in memory that the program owns.
struct BitcodeView {
    const unsigned char* data = nullptr; ///< null: there is none
    size_t size = 0;                     ///< bytes
};

/// A kernel to compile, and how. Pointers must outlive the call.
struct ModuleRequest {
    const ir::Kernel* kernel = nullptr;
    int lanes = 16;                                        ///< of a vector
    int vectors = 0;                                       ///< 0: chosen
    bool mixed = false;                                    ///< batches mix instances: uniform inputs vary
    int optimize = 2;                                      ///< LLVM's level, 0 to 3
    Isa isa = Isa::Avx512;                                 ///< level of the processor
    BitcodeView (*bitcode)(int lanes) = nullptr;           ///< the runtime at 4, 8, 16, 32, 64 lanes
    const std::set<std::string>* zeroDerivative = nullptr; ///< runtime symbols whose derivatives are zero
    /// Runtime symbols that are called, not inlined, when there are many calls; with the most lanes that the runtime has them
    /// for.
    const std::map<std::string, int>* outOfLine = nullptr;
    bool wantText = false; ///< fill ModuleResult::text with the optimised LLVM IR
};

/// The compiled kernel, or why there is none.
struct ModuleResult {
    std::string object;               ///< ELF relocatable file; empty on failure
    std::string error;                ///< why there is none
    std::string text;                 ///< LLVM's code as text, if it was asked for
    int strip = 0;                    ///< points per strip: lanes * vectors
    bool suspending = false;          ///< the kernel is a coroutine
    uint64_t localBytes = 0;          ///< of KernelCall::memory
    std::vector<std::string> strings; ///< string constants in the order of KernelCall::strings
};

/// ModuleResult::error when memory was short.
inline constexpr const char* kOutOfMemory = "out of memory";

/// Names of the functions in the object.
inline constexpr const char* kEntryName = "alpenglow_entry";
inline constexpr const char* kStartName = "alpenglow_start";
inline constexpr const char* kResumeName = "alpenglow_resume";
inline constexpr const char* kFinishedName = "alpenglow_finished";
inline constexpr const char* kDestroyName = "alpenglow_destroy";

/// What the module exports: alpenglow_jit_stamp, which gives the kModuleStamp that it was built with, alpenglow_jit_llvm_version,
/// and alpenglow_jit_compile. Thread safe; none throws.
using ModuleCompileFn = void (*)(const ModuleRequest*, ModuleResult*);
using ModuleStampFn = const char* (*)();
using ModuleVersionFn = const char* (*)();

/// The file that is loaded (base/installation.h): $ALPENGLOW_JIT, else libalpenglow_jit.so; "" when there is none.
std::string moduleFile();
/// The version of LLVM, "19.1.7", for which the module is loaded; "" and the error when that fails.
std::string llvmVersion(std::string& error);
/// Compiles through the module, loading it when needed. The error names the places where it was searched. Throws std::bad_alloc
/// when memory is short.
void compileWithModule(const ModuleRequest&, ModuleResult&);
/// True once the module, and with it LLVM, is in the process.
bool moduleLoaded();

} // namespace alpenglow::rsl::jit
