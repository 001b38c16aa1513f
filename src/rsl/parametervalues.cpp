// The values of a shader's parameters: those of the instance, and computed defaults.
#include "rsl/compilerstate.h"
#include "rsl/front/protocol.h"
#include "rsl/ir/build.h"
#include "rsl/jit/cache.h"
#include "rsl/jit/identity.h"
#include "rsl/jit/jit.h"
#include "rsl/jit/sha256.h"
#include "rsl/kernelkey.h"
#include "rsl/kernelrunner.h"
#include "rsl/messages/messages.h"
#include "rsl/passes/looplimit.h"
#include "rsl/passes/optimize.h"
#include <algorithm>
#include <bit>
#include <optional>
#include <set>

namespace alpenglow::rsl {
namespace {

/// Runs a kernel whose inputs are spaces and predefined variables for one point.
void runOnce(const CompiledKernel& k, const SpaceFn& spaces, std::vector<std::vector<float>>& out) {
    KernelRunner runner(k, 1);
    for (size_t n = 0; n < k.inputs().size(); ++n) {
        const auto& i = k.inputs()[n];
        if (i.kind != ir::Kind::Matrix) continue;
        float m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
        if (const InputName name = InputName::parse(i.name); spaces && name.kind == InputName::Kind::Space)
            spaces(name.from, name.to, m);
        for (size_t c = 0; c < 16; c++)
            if (i.uniform) runner.input(n)[c] = m[c];
            else std::fill_n(runner.input(n) + c * runner.stride(), runner.stride(), m[c]);
    }
    runner.run(1, {});
    for (size_t o = 0; o < k.outputs().size(); o++) {
        out.emplace_back();
        for (int c = 0; c < ir::components(k.outputs()[o].kind); c++) out.back().push_back(*runner.output(o, c));
    }
}

/// Each parameter as zero, "" or a matrix of zeros.
std::vector<ParameterValue> emptyValues(const CompiledShader& shader) {
    std::vector<ParameterValue> values;
    for (const auto& p : shader.parameters()) {
        ParameterValue v{p.name, p.type, {}, {}};
        const size_t n = size_t(std::max(1, p.type.array));
        if (p.type.base == Base::String) v.strings.resize(n);
        else v.numbers.resize(n * size_t(componentCount(p.type.base)));
        values.push_back(std::move(v));
    }
    return values;
}

/// Those of the given values that defaults read.
std::vector<ParameterValue> readByDefaults(const CompiledShader& shader, const std::vector<ParameterValue>& given) {
    std::vector<ParameterValue> read;
    for (const ParameterValue& g : given)
        for (const auto& p : shader.parameters())
            if (std::find(p.defaultReads.begin(), p.defaultReads.end(), g.name) != p.defaultReads.end()) {
                read.push_back(g);
                break;
            }
    return read;
}

/// What the outputs of a kernel are if all are constants.
std::optional<std::vector<std::vector<float>>> constantOutputs(const ir::Kernel& k) {
    std::vector<const ir::Inst*> results(k.outputs.size(), nullptr);
    for (const ir::Inst* i : k.body.body)
        if (i->op == ir::Op::Output && i->index >= 0 && size_t(i->index) < results.size()) results[size_t(i->index)] = i->args[0];
    std::vector<std::vector<float>> numbers;
    for (const ir::Inst* r : results) {
        if (r && r->op == ir::Op::ConstString) numbers.push_back({std::bit_cast<float>(internString(r->text))});
        else if (r && r->op == ir::Op::Const) numbers.push_back(r->numbers);
        else return {};
    }
    return numbers;
}

std::string keyOfDefaults(const std::string& digest, const KernelOptions& options, const std::vector<ParameterValue>& read) {
    std::string key = digest + "\ndefaults\n" + jit::codeKey(options) + descriptorDigest() + jit::programIdentity();
    for (const ParameterValue& v : read) {
        key += '\1' + v.name + '\2';
        key.append(reinterpret_cast<const char*>(v.numbers.data()), v.numbers.size() * sizeof(float));
        for (const std::string& s : v.strings) key += '\3' + s;
    }
    return jit::sha256(key);
}

/// Code of a kernel of defaults, from the cache or made now. Null with the reason in `error`.
std::shared_ptr<const CompiledKernel> codeOfDefaults(ir::Kernel& k, const KernelOptions& options, const std::string& key,
                                                     jit::KernelCache& cache,
                                                     const std::function<void*(const std::string&)>& outside,
                                                     std::string& error) {
    std::shared_ptr<const CompiledKernel> code;
    passes::limitLoops(k);
    if (auto cached = cache.load(key)) code = jit::load(*cached, true, error, outside);
    jit::KernelFile file;
    if (!code && jit::generate(k, options, file, error)) {
        code = jit::load(file, false, error, outside);
        if (code) cache.store(key, file);
    }
    return code;
}

/// Stores the results of a kernel of defaults in the parameters that its outputs name.
void takeDefaults(const ir::Kernel& k, const std::vector<std::vector<float>>& numbers, std::vector<ParameterValue>& values) {
    for (size_t o = 0; o < numbers.size(); o++) {
        const OutputName output = OutputName::parse(k.outputs[o].name);
        const size_t element = size_t(std::max(output.element, 0));
        for (auto& v : values) {
            if (v.name != output.name) continue;
            if (v.type.base == Base::String) {
                if (element < v.strings.size())
                    v.strings[element] = internedString(std::bit_cast<int32_t>(numbers[o].empty() ? 0.0f : numbers[o][0]));
            } else {
                const size_t n = size_t(componentCount(v.type.base));
                for (size_t c = 0; c < n && c < numbers[o].size() && element * n + c < v.numbers.size(); c++)
                    v.numbers[element * n + c] = numbers[o][c];
            }
        }
    }
}

void takeGiven(const std::vector<ParameterValue>& given, std::vector<ParameterValue>& values) {
    for (const ParameterValue& g : given)
        for (ParameterValue& v : values)
            if (v.name == g.name) {
                v.numbers = g.numbers;
                v.strings.resize(std::max(v.strings.size(), g.strings.size())); // elements that are not given keep their default
                std::copy(g.strings.begin(), g.strings.end(), v.strings.begin());
            }
}

} // namespace

std::vector<std::string> CompiledShader::computedParameters(const std::set<std::string>& given,
                                                            const std::vector<std::string>& varying) const {
    std::set<std::string> differ(varying.begin(), varying.end()); // from sample to sample
    std::vector<std::string> computed;
    for (const ParameterInfo& p : parameters_) {
        if (given.count(p.name) || differ.count(p.name)) continue;
        if (!p.sampleDefault &&
            std::none_of(p.defaultReads.begin(), p.defaultReads.end(), [&](const auto& r) { return differ.count(r) > 0; }))
            continue;
        differ.insert(p.name);
        computed.push_back(p.name);
    }
    return computed;
}

std::vector<ParameterValue> ShaderCompiler::parameterValues(const std::shared_ptr<const CompiledShader>& shader,
                                                            Diagnostics& diagnostics, const SpaceFn& spaces,
                                                            const std::vector<ParameterValue>& given) {
    if (!shader) return {};
    std::vector<ParameterValue> values = emptyValues(*shader);
    if (values.empty()) return values;
    // Given values become constants of the defaults that read them; the others are put in below.
    const std::vector<ParameterValue> read = readByDefaults(*shader, given);
    auto k = buildDefaults(shader->program(), shader->shader(), diagnostics, read);
    if (!k) return values;
    KernelOptions options;
    options.vectors = 1;
    const int errors = diagnostics.errors();
    passes::optimize(*k, options, diagnostics);
    if (diagnostics.errors() > errors) return values;
    // Mostly everything is constant by now, and no code is needed.
    auto numbers = constantOutputs(*k);
    if (!numbers) {
        options.optimize = 0;
        std::string error;
        const auto code =
            codeOfDefaults(*k, options, keyOfDefaults(shader->digest_, options, read), *state_->cache, state_->outside, error);
        if (!code || code->facts().suspends) {
            diagnostics.report(diagnostic(msg::kNoDefaults(error), Rie::Bug, {shader->path(), 0, 0}));
            return values;
        }
        runOnce(*code, spaces, numbers.emplace());
    }
    takeDefaults(*k, *numbers, values);
    takeGiven(given, values);
    return values;
}

} // namespace alpenglow::rsl
