#include "rsl/jit/module.h"
#include "base/installation.h"
#include "rsl/jit/stamp.h"
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <mutex>
#include <new>

namespace alpenglow::rsl::jit {

const char* name(Isa i) {
    switch (i) {
    case Isa::Sse42:
        return "sse4.2";
    case Isa::Sse42Fma:
        return "sse4.2+fma";
    case Isa::Avx2:
        return "avx2";
    case Isa::Avx512:
        return "avx512";
    }
    return "?";
}

Isa isaFor(int lanes) {
    __builtin_cpu_init();
    const bool fma = __builtin_cpu_supports("avx") && __builtin_cpu_supports("fma");
    const bool avx2 = fma && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
    const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                        __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                        __builtin_cpu_supports("avx512vl");
    if (lanes >= 16 && avx512) return Isa::Avx512;
    if (lanes >= 8 && avx2) return Isa::Avx2;
    return fma ? Isa::Sse42Fma : Isa::Sse42;
}

namespace {

constexpr const char* kVariable = "ALPENGLOW_JIT";

struct Module {
    ModuleCompileFn compile = nullptr;
    const char* llvm = ""; ///< version of LLVM
    std::string error;
};

std::mutex mutex;
Module* loaded = nullptr; // never unloaded: LLVM's static data outlives every thread that used it

Module* loadModule() {
    auto* m = new Module;
    const auto fail = [&](const std::string& why) {
        m->error = "the shader compiler's module libalpenglow_jit.so cannot be loaded: " + why;
        return m;
    };
    const std::string file = moduleFile();
    if (file.empty())
        return fail(std::getenv(kVariable) ? std::string(kVariable) + " names no file"
                                           : "it is neither in the folder of the program nor in lib/alpenglow");
    void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!handle) {
        const char* why = dlerror();
        const std::string text = why ? why : file;
        // The dynamic loader's message when memory is exhausted; a later attempt may succeed, so the failure is not kept.
        for (const char* sign : {"failed to map", "cannot allocate", "Cannot allocate", "cannot create shared object descriptor"})
            if (text.find(sign) != std::string::npos) {
                delete m;
                throw std::bad_alloc();
            }
        return fail(text);
    }
    // Types of ours pass between the two: from other headers they would be other types.
    auto stamp = reinterpret_cast<ModuleStampFn>(dlsym(handle, "alpenglow_jit_stamp"));
    auto compile = reinterpret_cast<ModuleCompileFn>(dlsym(handle, "alpenglow_jit_compile"));
    auto llvm = reinterpret_cast<ModuleVersionFn>(dlsym(handle, "alpenglow_jit_llvm_version"));
    if (!stamp || !compile || !llvm || std::strcmp(stamp(), kModuleStamp) != 0)
        return fail(file + " was built from other sources than this program; build and install both together" +
                    (std::getenv(kVariable) ? std::string(", or unset ") + kVariable : ""));
    m->compile = compile;
    m->llvm = llvm();
    return m;
}

} // namespace

std::string moduleFile() { return alpenglow::moduleFile("libalpenglow_jit.so", kVariable); }

bool moduleLoaded() {
    std::lock_guard lock(mutex);
    return loaded && loaded->compile;
}

std::string llvmVersion(std::string& error) {
    std::lock_guard lock(mutex);
    if (!loaded) loaded = loadModule();
    error = loaded->error;
    return loaded->llvm;
}

void compileWithModule(const ModuleRequest& request, ModuleResult& result) {
    ModuleCompileFn compile = nullptr;
    {
        std::lock_guard lock(mutex);
        if (!loaded) loaded = loadModule();
        compile = loaded->compile;
        if (!compile) result.error = loaded->error;
    }
    if (compile) compile(&request, &result);
    if (result.error == kOutOfMemory) throw std::bad_alloc();
}

} // namespace alpenglow::rsl::jit
