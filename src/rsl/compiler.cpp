#include "rsl/compiler.h"
#include "base/file.h"
#include "base/limits.h"
#include "rsl/compilerstate.h"
#include "rsl/defaultreads.h"
#include "rsl/front/protocol.h"
#include "rsl/ir/build.h"
#include "rsl/ir/print.h"
#include "rsl/jit/cache.h"
#include "rsl/jit/identity.h"
#include "rsl/jit/jit.h"
#include "rsl/jit/sha256.h"
#include "rsl/kernelkey.h"
#include "rsl/messages/messages.h"
#include "rsl/oslsource.h"
#include "rsl/passes/looplimit.h"
#include "rsl/passes/optimize.h"
#include "rsl/shadersearch.h"
#include <algorithm>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>

namespace fs = std::filesystem;

namespace alpenglow::rsl {
namespace {

using KernelPtr = std::shared_ptr<const CompiledKernel>;
using ShaderPtr = std::shared_ptr<const CompiledShader>;

std::string readText(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
}

} // namespace

ShaderCompiler::ShaderCompiler() : ShaderCompiler(Settings{}) {}

ShaderCompiler::ShaderCompiler(Settings s) : state_(std::make_unique<State>()) {
    if (s.cacheDirectory.empty() && s.useDefaultCache) s.cacheDirectory = jit::defaultCacheDirectory();
    state_->cache = std::make_unique<jit::KernelCache>(s.cacheDirectory, limits::kKernelCacheBytes);
    state_->settings = std::move(s);
}

ShaderCompiler::~ShaderCompiler() = default;

namespace {
/// A file of functions alone is well formed, but it is no shader.
void sayWithoutShader(const Program* program, const std::string& path, Diagnostics& diagnostics) {
    if (program && program->shaders.empty()) diagnostics.report(diagnostic(msg::kNoShader, Rie::Syntax, {path, 1, 1}));
}
} // namespace

ShaderPtr ShaderCompiler::finish(std::unique_ptr<Program> program, const std::string& path, const std::string& wanted,
                                 const std::string& text) {
    if (!program || program->shaders.empty()) return nullptr;
    const Shader* shader = program->shaders[0].get();
    for (const auto& s : program->shaders)
        if (s->name == wanted) shader = s.get();
    // The texts themselves, so that the places in messages are right too.
    std::string all = text + '\1' + program->preprocessed;
    if (program->rispecSpecular) all += "\1rispec";
    for (const auto& f : program->dependencies) all += '\1' + f + '\1' + readText(f);
    for (const auto& f : program->files) all += '\2' + f;
    for (const auto& p : program->plugins) // which functions there are, and what they are called in the code
        for (const Shadeop& f : p->functions)
            for (const Signature& s : f.signatures) all += '\3' + s.symbol;
    return describe(std::move(program), *shader, path, jit::sha256(all));
}

ShaderPtr ShaderCompiler::describe(std::shared_ptr<const Program> program, const Shader& shader, const std::string& path,
                                   const std::string& source) {
    auto c = std::make_shared<CompiledShader>();
    c->path_ = path;
    c->shader_ = &shader;
    c->source_ = source;
    c->digest_ = jit::sha256(source + '\3' + shader.name + '\1' + toString(shader.kind));
    for (const ShaderParameter& p : c->shader_->parameters) {
        ParameterInfo i{p.symbol->name,   storedType(p.symbol->type), p.symbol->storage,
                        p.symbol->output, p.defaultValue != nullptr,  p.symbol->place};
        i.open = i.type.array < 0 || p.symbol->open;
        i.handle = p.symbol->type.base == Base::Shader;
        if (i.type.array < 0)
            i.type.array = p.defaultValue && p.defaultValue->type.array > 0 ? p.defaultValue->type.array
                           : p.defaultValue && p.defaultValue->kind == ExprKind::ArrayList
                               ? std::max(1, int(p.defaultValue->args.size()))
                               : 1;
        DefaultReads reads = readsOfDefault(p.defaultValue.get());
        const bool onSurface = c->shader_->kind == ShaderKind::Surface || c->shader_->kind == ShaderKind::Displacement;
        i.sampleDefault = (i.storage == Storage::Varying && reads.sample) || (onSurface && reads.object);
        i.defaultReads.assign(reads.parameters.begin(), reads.parameters.end());
        c->parameters_.push_back(std::move(i));
    }
    c->program_ = std::move(program);
    return c;
}

ShaderPtr ShaderCompiler::load(const std::string& name, const std::vector<std::string>& directories, Diagnostics& diagnostics) {
    std::string key = name;
    for (const auto& d : directories) key += '\n' + d;
    std::promise<ShaderPtr> promise;
    {
        std::unique_lock lock(state_->mutex);
        if (auto it = state_->shaders.find(key); it != state_->shaders.end()) {
            auto f = it->second;
            lock.unlock();
            return f.get();
        }
        state_->shaders.emplace(key, promise.get_future().share());
    }
    ShaderPtr result;
    try {
        result = find(name, directories, diagnostics);
    } catch (...) { // threads that wait for the same shader get an answer; the next request tries again
        promise.set_value(nullptr);
        std::lock_guard lock(state_->mutex);
        state_->shaders.erase(key);
        throw;
    }
    promise.set_value(result);
    return result;
}

ShaderPtr ShaderCompiler::find(const std::string& name, const std::vector<std::string>& directories, Diagnostics& diagnostics) {
    ShaderPtr result;
    const std::string stem = fs::path(name).filename().replace_extension().string();
    auto at = [&](const std::string& n) { return findFile(n, directories); };
    constexpr const char* kCompiled[] = {".slo", ".sdl", ".sdr", ".slx", ".slc", ".sdw"};
    std::optional<FoundFile> found;
    if (name.size() > 3 && name.ends_with(".sl")) found = at(name);
    if (!found) found = at(name + ".sl");
    for (const char* e : kCompiled)
        if (!found && name.ends_with(e)) found = at(name.substr(0, name.size() - std::strlen(e)) + ".sl");
    const auto ofOther = [&](const char* e) { return name.ends_with(e) || at(name + e); };
    if (!found && std::none_of(std::begin(kCompiled), std::end(kCompiled), ofOther))
        if (auto shared = fileWithShader(stem, directories)) found = FoundFile{*shared};
    if (!found)
        if (const auto osl = findOsl(name, directories)) {
            std::string text;
            auto program = compileOsl(*osl, state_->front(), diagnostics, text);
            return finish(std::move(program), *osl, {}, text);
        }
    const auto& reads = state_->settings.reads;
    if (reads) found ? reads->add(found->path) : reads->addMissing(stem + ".sl", directories);
    if (found && leadsToNoSource(found->path, diagnostics)) return nullptr;
    if (found) {
        FrontOptions options = state_->front();
        const auto seen = [reads](const std::string& path) { return reads->add(path), std::nullopt; }; // also where there is none
        if (reads) options.openText = seen;
        options.includePaths.push_back(fs::path(found->path).parent_path().string());
        for (const auto& d : directories) options.includePaths.push_back(d);
        auto program = compileFile(found->path, options, diagnostics);
        sayWithoutShader(program.get(), found->path, diagnostics);
        result = finish(std::move(program), found->path, stem, {});
    } else {
        std::string compiled;
        for (const char* e : kCompiled) {
            if (name.ends_with(e)) compiled = name;
            else if (auto f = at(name + e)) compiled = f->path;
        }
        if (!compiled.empty())
            diagnostics.report(diagnostic(msg::kShaderCompiled(compiled, stem), Rie::NoShader, {compiled, 0, 0}));
        else
            diagnostics.report(diagnostic(msg::kShaderNotFound(name), Rie::NoShader, {},
                                          directories.empty() ? "no shader search path is set" : ""));
    }
    return result;
}

ShaderPtr ShaderCompiler::loadText(const std::string& text, const std::string& name, Diagnostics& diagnostics) {
    FrontOptions options = state_->front();
    options.includePaths = state_->settings.pluginPaths; // a text has no folder
    auto program = compileText(text, name, options, diagnostics);
    sayWithoutShader(program.get(), name, diagnostics);
    return finish(std::move(program), name, {}, text);
}

std::unique_ptr<ir::Kernel> ShaderCompiler::analyse(const CompiledShader& s, const KernelOptions& o, Diagnostics& d) const {
    auto k = buildKernel(s.program(), s.shader(), o, d);
    if (k) passes::optimize(*k, o, d);
    return k;
}

ShaderPtr ShaderCompiler::variant(const ShaderPtr& s, ShaderKind kind) {
    if (!s || s->kind() == kind) return s;
    for (const auto& other : s->program().shaders) {
        if (other->kind != kind || !other->object || other->name != s->name()) continue;
        auto c = std::make_shared<CompiledShader>(*s);
        c->shader_ = other.get();
        c->digest_ = jit::sha256(s->digest_ + '\1' + toString(kind));
        return c;
    }
    return nullptr;
}

std::vector<ShaderPtr> ShaderCompiler::allOfFile(const ShaderPtr& shader) {
    std::vector<ShaderPtr> all;
    std::set<std::string> classes;
    if (shader)
        for (const auto& s : shader->program().shaders) {
            if (s->object && !classes.insert(s->name).second) continue;
            const bool same = &shader->shader() == s.get() || (s->object && s->name == shader->name());
            all.push_back(same ? shader : describe(shader->program_, *s, shader->path(), shader->source_));
        }
    return all;
}

ShaderPtr ShaderCompiler::ofKind(const ShaderPtr& shader, ShaderKind kind, const std::string& name) {
    if (!shader) return nullptr;
    const auto& shaders = shader->program().shaders;
    const bool named = std::any_of(shaders.begin(), shaders.end(), [&](const auto& s) { return s->name == name; });
    for (const auto& s : shaders)
        if (s->kind == kind && (!named || s->name == name))
            return describe(shader->program_, *s, shader->path(), shader->source_);
    return nullptr;
}

CoShader ShaderCompiler::coShader(const ShaderPtr& s, const std::string& handle) {
    CoShader c;
    c.handle = handle;
    c.program = &s->program();
    c.shader = &s->shader();
    c.owner = s;
    c.digest = s->digest_;
    return c;
}

KernelPtr ShaderCompiler::kernel(const ShaderPtr& shader, const KernelOptions& options, Diagnostics& diagnostics) {
    if (!shader) return nullptr;
    const std::string key = jit::sha256(shader->digest_ + '\n' + jit::codeKey(options) + descriptorDigest() +
                                        jit::programIdentity() + coShaderKey(options));
    std::promise<KernelPtr> promise;
    {
        std::unique_lock lock(state_->mutex);
        if (auto it = state_->kernels.find(key); it != state_->kernels.end()) {
            auto f = it->second;
            state_->statistics.fromMemory++;
            lock.unlock();
            return f.get();
        }
        state_->kernels.emplace(key, promise.get_future().share());
    }
    const auto start = std::chrono::steady_clock::now();
    KernelPtr result;
    std::string error;
    bool fromDisk = false;
    try {
        if (const std::string why = state_->cache->refusal(); !why.empty() && !state_->cacheRefused.exchange(true))
            diagnostics.report(diagnostic(msg::kKernelCache(why), Rie::System, {}));
        if (auto file = state_->cache->load(key)) {
            result = jit::load(*file, true, error, state_->outside);
            fromDisk = result != nullptr;
            for (const auto& m : file->messages) diagnostics.reportOnce(toString(m), m);
        }
        if (!result) {
            Diagnostics local;
            auto k = analyse(*shader, options, local);
            jit::KernelFile file;
            file.messages = local.all();
            for (const auto& m : file.messages) diagnostics.reportOnce(toString(m), m);
            error.clear();
            if (k) passes::limitLoops(*k);
            if (k && local.errors() == 0 && jit::generate(*k, options, file, error)) {
                result = jit::load(file, false, error, state_->outside);
                if (result) state_->cache->store(key, file);
            }
            if (!error.empty()) {
                const Place& p = shader->shader().place;
                const auto& files = shader->program().files;
                diagnostics.report(diagnostic(
                    msg::kNoCodeForShader(shader->name(), error), Rie::Bug,
                    {p.file >= 0 && size_t(p.file) < files.size() ? files[size_t(p.file)] : shader->path(), p.line, p.column}));
            }
        }
    } catch (const std::bad_alloc&) { // fails the frame: it is not rendered without its shader
        {
            std::lock_guard lock(state_->mutex);
            state_->kernels.erase(key);
        }
        promise.set_value(nullptr);
        throw;
    } catch (const std::exception& e) {
        diagnostics.report(diagnostic(msg::kNoCodeForShader(shader->name(), e.what()), Rie::Bug, {shader->path(), 0, 0}));
        result = nullptr;
    }
    {
        std::lock_guard lock(state_->mutex);
        if (result) (fromDisk ? state_->statistics.fromDisk : state_->statistics.compiled)++;
        state_->statistics.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }
    promise.set_value(result);
    return result;
}

std::string ShaderCompiler::dump(const ShaderPtr& shader, const KernelOptions& options, Diagnostics& diagnostics, bool llvm) {
    if (!shader) return {};
    auto k = analyse(*shader, options, diagnostics);
    if (!k) return {};
    std::string text = ir::print(*k);
    if (llvm) {
        jit::KernelFile file;
        std::string error, code;
        if (jit::generate(*k, options, file, error, &code)) text += "\n" + code;
        else diagnostics.report(diagnostic(msg::kNoCodeListing(error), Rie::Bug, {shader->path(), 0, 0}));
    }
    return text;
}

CompilerStatistics ShaderCompiler::statistics() const {
    std::lock_guard lock(state_->mutex);
    return state_->statistics;
}

} // namespace alpenglow::rsl
