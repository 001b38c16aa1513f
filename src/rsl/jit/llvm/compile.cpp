// The LLVM side of the interface (rsl/jit/module.h): module set-up, passes, machine code. Everything else of LLVM's size is here
// and nowhere else.
#include "rsl/jit/llvm/allocator.h"
#include "rsl/jit/llvm/emitter.h"
#include "rsl/jit/llvm/masks.h"
#include "rsl/jit/stamp.h"
#include <llvm-c/Core.h>
#include <llvm/Bitcode/BitcodeReader.h>
#include <llvm/IR/LegacyPassManager.h>
#include <llvm/IR/Verifier.h>
#include <llvm/Linker/Linker.h>
#include <llvm/MC/TargetRegistry.h>
#include <llvm/Passes/PassBuilder.h>
#include <llvm/Support/ErrorHandling.h>
#include <llvm/Support/MemoryBuffer.h>
#include <llvm/Support/TargetSelect.h>
#include <llvm/Support/raw_ostream.h>
#include <llvm/Target/TargetMachine.h>
#include <llvm/Transforms/Coroutines/CoroCleanup.h>
#include <llvm/Transforms/Coroutines/CoroEarly.h>
#include <llvm/Transforms/Coroutines/CoroSplit.h>
#include <llvm/Transforms/IPO/AlwaysInliner.h>
#include <llvm/Transforms/IPO/GlobalDCE.h>
#include <llvm/Transforms/InstCombine/InstCombine.h>
#include <llvm/Transforms/Scalar/ADCE.h>
#include <llvm/Transforms/Scalar/EarlyCSE.h>
#include <llvm/Transforms/Scalar/GVN.h>
#include <llvm/Transforms/Scalar/LICM.h>
#include <llvm/Transforms/Scalar/LoopPassManager.h>
#include <llvm/Transforms/Scalar/Reassociate.h>
#include <llvm/Transforms/Scalar/SROA.h>
#include <llvm/Transforms/Scalar/SimplifyCFG.h>
#include <mutex>
#include <new>
#include <unistd.h>

namespace alpenglow::rsl::jit {
namespace {

struct Target {
    const char *cpu, *tune, *features, *preferred;
};

// 128-bit registers with FMA: AVX encodings, no 256-bit integer code.
Target targetOf(Isa isa) {
    switch (isa) {
    case Isa::Sse42:
        return {"x86-64-v2", "generic", "", "128"};
    case Isa::Sse42Fma:
        return {"x86-64-v2", "haswell", "+avx,+fma", "128"};
    case Isa::Avx2:
        return {"x86-64-v3", "haswell", "", "256"};
    case Isa::Avx512:
        return {"x86-64-v4", "skylake-avx512", "", "512"};
    }
    return {"x86-64-v2", "generic", "", "128"};
}

void setAttributes(llvm::Module& m, const Target& t, int width) {
    for (llvm::Function& f : m) {
        for (const char* a : {"target-cpu", "target-features", "tune-cpu", "min-legal-vector-width", "prefer-vector-width",
                              "stack-protector-buffer-size"})
            f.removeFnAttr(a);
        f.removeFnAttr(llvm::Attribute::UWTable);
        if (f.isIntrinsic()) continue;
        f.addFnAttr("target-cpu", t.cpu);
        f.addFnAttr("tune-cpu", t.tune);
        if (*t.features) f.addFnAttr("target-features", t.features);
        f.addFnAttr("prefer-vector-width", t.preferred);
        f.addFnAttr("min-legal-vector-width", std::string(t.preferred) == "512" ? "512" : "256");
        f.addFnAttr(llvm::Attribute::NoUnwind);
        f.addFnAttr("probe-stack", "inline-asm"); // a large frame meets the guard page and never steps over it
        (void)width;
    }
}

// The short list: straight vector code gains nothing from the rest, and compiles two to three times faster.
llvm::FunctionPassManager scalarPasses(bool first) {
    llvm::FunctionPassManager f;
    f.addPass(llvm::SROAPass(llvm::SROAOptions::ModifyCFG));
    f.addPass(llvm::EarlyCSEPass());
    f.addPass(llvm::InstCombinePass());
    f.addPass(llvm::SimplifyCFGPass());
    if (!first) {
        f.addPass(llvm::ReassociatePass());
        f.addPass(llvm::createFunctionToLoopPassAdaptor(llvm::LICMPass(llvm::LICMOptions()), /*UseMemorySSA=*/true));
        f.addPass(llvm::GVNPass());
        f.addPass(llvm::InstCombinePass());
        f.addPass(llvm::SimplifyCFGPass());
        f.addPass(llvm::ADCEPass());
    }
    return f;
}

void optimise(llvm::Module& m, llvm::TargetMachine* tm, int level, bool coroutine) {
    llvm::LoopAnalysisManager lam;
    llvm::FunctionAnalysisManager fam;
    llvm::CGSCCAnalysisManager cgam;
    llvm::ModuleAnalysisManager mam;
    llvm::PassBuilder pb(tm);
    pb.registerModuleAnalyses(mam);
    pb.registerCGSCCAnalyses(cgam);
    pb.registerFunctionAnalyses(fam);
    pb.registerLoopAnalyses(lam);
    pb.crossRegisterProxies(lam, fam, cgam, mam);
    llvm::ModulePassManager p;
    p.addPass(llvm::AlwaysInlinerPass(/*InsertLifetime=*/false));
    p.addPass(llvm::GlobalDCEPass());
    if (coroutine) {
        // Registers first, so that the frame holds live values and not scratch memory.
        if (level > 0) p.addPass(llvm::createModuleToFunctionPassAdaptor(scalarPasses(true)));
        p.addPass(llvm::CoroEarlyPass());
        p.addPass(llvm::createModuleToPostOrderCGSCCPassAdaptor(llvm::CoroSplitPass(level > 0)));
        p.addPass(llvm::CoroCleanupPass());
    }
    if (level > 0) p.addPass(llvm::createModuleToFunctionPassAdaptor(scalarPasses(false)));
    p.addPass(llvm::GlobalDCEPass());
    p.run(m, mam);
}

void initialise() {
    static std::once_flag once;
    std::call_once(once, [] {
        // LLVM would abort; nothing can be unwound through it.
        llvm::install_bad_alloc_error_handler([](void*, const char*, bool) {
            constexpr char text[] = "alpenglow: out of memory\n";
            [[maybe_unused]] ssize_t n = ::write(STDERR_FILENO, text, sizeof text - 1);
            _exit(4); // the status of a limit or memory
        });
        LLVMInitializeX86TargetInfo();
        LLVMInitializeX86Target();
        LLVMInitializeX86TargetMC();
        LLVMInitializeX86AsmPrinter();
    });
}

void compile(const ModuleRequest& request, ModuleResult& result) {
    initialise();
    const Target t = targetOf(request.isa);
    const std::string triple = "x86_64-unknown-linux-gnu";
    std::string error;
    const llvm::Target* target = llvm::TargetRegistry::lookupTarget(triple, error);
    if (!target) throw CodegenError(error);
    llvm::TargetOptions options;
    options.AllowFPOpFusion = llvm::FPOpFusion::Strict;
    std::unique_ptr<llvm::TargetMachine> tm(
        target->createTargetMachine(triple, t.cpu, t.features, options, llvm::Reloc::PIC_, llvm::CodeModel::Small,
                                    request.optimize > 0 ? llvm::CodeGenOptLevel::Default : llvm::CodeGenOptLevel::None));
    if (!tm) throw CodegenError("no machine for " + triple);

    const Shapes shapes(*request.kernel, request.mixed, request.zeroDerivative);
    const int width = request.lanes * plan(request, shapes).vectors;
    llvm::LLVMContext context;
    auto module = std::make_unique<llvm::Module>("kernel", context);
    module->setTargetTriple(triple);
    module->setDataLayout(tm->createDataLayout());
    std::unique_ptr<llvm::Module> runtime;
    const BitcodeView code = request.bitcode ? request.bitcode(width) : BitcodeView{};
    if (code.data) {
        auto m = llvm::getLazyBitcodeModule(
            llvm::MemoryBufferRef({reinterpret_cast<const char*>(code.data), code.size}, "runtime"), context);
        if (!m) throw CodegenError("the runtime's bitcode cannot be read: " + llvm::toString(m.takeError()));
        runtime = std::move(*m);
        runtime->setTargetTriple(triple);
        runtime->setDataLayout(tm->createDataLayout());
    } else {
        runtime = std::make_unique<llvm::Module>("runtime", context);
    }
    Emitter emitter(request, shapes, width, *module, *runtime);
    result.suspending = shapes.hasRequests();
    if (result.suspending) emitter.emitCoroutine();
    else emitter.emitLoopKernel();
    result.strings = emitter.strings();
    result.strip = width;
    if (!result.suspending) result.localBytes = emitter.localBytes();
    if (llvm::Linker::linkModules(*module, std::move(runtime), llvm::Linker::LinkOnlyNeeded))
        throw CodegenError("the runtime does not link");
    for (llvm::Function& f : *module)
        if (!f.isDeclaration() && !f.getName().starts_with("alpenglow_")) f.setLinkage(llvm::GlobalValue::InternalLinkage);
    setAttributes(*module, t, width);
    std::string verifyText;
    llvm::raw_string_ostream verifyOut(verifyText);
    if (llvm::verifyModule(*module, &verifyOut)) throw CodegenError("the generated code is not valid: " + verifyText);
    optimise(*module, tm.get(), request.optimize, result.suspending);
    if (request.optimize > 0 && request.isa != Isa::Avx512) widenMasks(*module, request.isa == Isa::Avx2 ? 8 : 4);
    if (request.wantText) {
        llvm::raw_string_ostream out(result.text);
        module->print(out, nullptr);
    }
    llvm::SmallVector<char, 0> bytes;
    llvm::raw_svector_ostream out(bytes);
    llvm::legacy::PassManager emit;
    const AllocatorFor allocator(*module, request.optimize > 0);
    if (tm->addPassesToEmitFile(emit, out, nullptr, llvm::CodeGenFileType::ObjectFile))
        throw CodegenError("no object file can be emitted");
    emit.run(*module);
    result.object.assign(bytes.begin(), bytes.end());
}

} // namespace
} // namespace alpenglow::rsl::jit

extern "C" __attribute__((visibility("default"))) const char* alpenglow_jit_stamp() { return alpenglow::rsl::jit::kModuleStamp; }

/// Of the library that is loaded, which may be newer than the headers.
extern "C" __attribute__((visibility("default"))) const char* alpenglow_jit_llvm_version() {
    static const std::string version = [] {
        unsigned major = 0, minor = 0, patch = 0;
        LLVMGetVersion(&major, &minor, &patch);
        return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(patch);
    }();
    return version.c_str();
}

extern "C" __attribute__((visibility("default"))) void alpenglow_jit_compile(const alpenglow::rsl::jit::ModuleRequest* request,
                                                                             alpenglow::rsl::jit::ModuleResult* result) {
    try {
        alpenglow::rsl::jit::compile(*request, *result);
    } catch (const std::bad_alloc&) {
        result->object.clear();
        result->error = alpenglow::rsl::jit::kOutOfMemory;
    } catch (const std::exception& e) {
        result->object.clear();
        result->error = e.what();
    }
}
