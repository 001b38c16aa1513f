#include "rsl/jit/jit.h"
#include "rsl/jit/loader.h"
#include "rsl/names.h"
#include "shadeops/bitcode.h"
#include <algorithm>

namespace alpenglow::rsl::jit {
namespace {

// Raised whenever the generated code changes for the same IR, or the IR for the same source.
constexpr const char* kVersion = "alpenglow-jit-9";

struct SymbolSets {
    std::set<std::string> zeroDerivative;
    std::map<std::string, int> outOfLine;
};

const SymbolSets& symbolSets() {
    static const SymbolSets sets = [] {
        SymbolSets s;
        for (const Shadeop& op : allShadeops()) {
            if (op.lowering != Lowering::Runtime) continue;
            for (const Signature& sig : op.signatures) {
                if (sig.symbol.empty()) continue;
                if (op.derivative == DerivativeRule::Zero) s.zeroDerivative.insert(sig.symbol);
                if (op.outOfLine) s.outOfLine.emplace(sig.symbol, op.widest);
            }
        }
        return s;
    }();
    return sets;
}

class Kernel final : public CompiledKernel {
public:
    Kernel(const KernelFile& k, std::unique_ptr<LoadedObject> object, bool fromCache) : object_(std::move(object)) {
        inputs_ = k.inputs;
        outputs_ = k.outputs;
        sites_ = k.sites;
        files_ = k.files;
        facts_ = k.facts;
        for (const auto& s : k.strings) strings_.push_back(internString(s));
        lanes_ = k.strip;
        localBytes_ = k.localBytes;
        fromCache_ = fromCache;
        entry_ = reinterpret_cast<decltype(entry_)>(object_->find(kEntryName));
        start_ = reinterpret_cast<decltype(start_)>(object_->find(kStartName));
        resume_ = reinterpret_cast<decltype(resume_)>(object_->find(kResumeName));
        finished_ = reinterpret_cast<decltype(finished_)>(object_->find(kFinishedName));
        destroy_ = reinterpret_cast<decltype(destroy_)>(object_->find(kDestroyName));
    }
    bool complete(bool suspending) const { return suspending ? start_ && resume_ && finished_ && destroy_ : entry_ != nullptr; }

private:
    std::unique_ptr<LoadedObject> object_;
};

BitcodeView bitcode(int lanes) {
    const Bitcode b = runtimeBitcode(lanes);
    return {b.data, b.size};
}

} // namespace

bool generate(const ir::Kernel& kernel, const KernelOptions& options, KernelFile& out, std::string& error,
              std::string* llvmText) {
    ModuleRequest request;
    request.kernel = &kernel;
    request.lanes = options.lanes <= 4 ? 4 : options.lanes <= 8 ? 8 : 16;
    error = runtimeLack(request.lanes);
    if (!error.empty()) return false;
    request.vectors = options.vectors;
    request.mixed = options.mixed;
    request.optimize = options.optimize;
    request.isa = isaFor(request.lanes);
    request.bitcode = bitcode;
    request.zeroDerivative = &symbolSets().zeroDerivative;
    request.outOfLine = &symbolSets().outOfLine;
    request.wantText = llvmText != nullptr;
    ModuleResult result;
    compileWithModule(request, result);
    if (llvmText) *llvmText = result.text;
    if (result.object.empty()) {
        error = result.error.empty() ? "no code was generated" : result.error;
        return false;
    }
    out.inputs = kernel.inputs;
    out.outputs = kernel.outputs;
    out.sites = kernel.sites;
    out.files = kernel.files;
    out.facts = kernel.facts;
    out.facts.suspends = result.suspending;
    out.strings = result.strings;
    out.strip = result.strip;
    out.suspending = result.suspending;
    out.localBytes = result.localBytes;
    out.object = std::move(result.object);
    return true;
}

std::shared_ptr<const CompiledKernel> load(const KernelFile& k, bool fromCache, std::string& error,
                                           const std::function<void*(const std::string&)>& outside) {
    auto object = LoadedObject::load(k.object, error, outside);
    if (!object) return nullptr;
    auto kernel = std::make_shared<Kernel>(k, std::move(object), fromCache);
    if (!kernel->complete(k.suspending)) {
        error = "the object file has no entry";
        return nullptr;
    }
    return kernel;
}

std::string codeKey(const KernelOptions& o) {
    std::string k = std::string(kVersion) + "\n" + std::string(runtimeHash(o.lanes)) + "\n" + name(isaFor(o.lanes)) + "\n";
    for (int n : {o.lanes, o.vectors, int(o.mixed), o.optimize, int(o.suspend), int(o.path), o.outline, int(o.differences)})
        k += std::to_string(n) + ",";
    auto text = [&](const std::string& s) { k += std::to_string(s.size()) + ":" + s; };
    k += "\noutputs ";
    for (const auto& s : o.outputs) text(s);
    k += "\nlight ";
    text(o.light);
    k += "\nstrings ";
    auto strings = o.stringParameters;
    std::sort(strings.begin(), strings.end());
    for (const auto& [name, value] : strings) text(name), text(value);
    if (!o.connections.empty()) text(connectionKey(o.connections));
    k += "\nvarying ";
    auto varying = o.varyingParameters;
    std::sort(varying.begin(), varying.end());
    for (const auto& s : varying) text(s);
    k += "\ncomputed ";
    for (const auto& s : o.computedParameters) text(s);
    if (!o.sentParameters.empty()) k += "\nsent ";
    for (const auto& s : o.sentParameters) text(s.name), k += std::to_string(s.room) + ",";
    k += "\nmessages ";
    for (const auto& s : o.messages) text(s);
    return k + "\n";
}

} // namespace alpenglow::rsl::jit
