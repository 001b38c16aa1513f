// From shader files to kernels: finding, checking, building, compiling, caching. What the renderer and the command line use of
// rsl.
#pragma once
#include "base/diagnostics.h"
#include "base/readlog.h"
#include "rsl/front/ast.h"
#include "rsl/kernel.h"
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace alpenglow::rsl {

/// A shader parameter as declared.
struct ParameterInfo {
    std::string name;                   ///< as declared
    Type type;                          ///< arrays of open length: the length of their default
    Storage storage = Storage::Uniform; ///< uniform or varying
    bool output = false;                ///< an output
    bool hasDefault = false;            ///< the shader says one
    Place place;                        ///< of the declaration
    bool open = false;                  ///< an array of open length, `float w[]`: as long as its value
    bool handle = false;                ///< of type `shader`
    bool sampleDefault = false; ///< varying, with a default that differs from sample to sample: computed where the shader begins
    std::vector<std::string> defaultReads; ///< parameters before it that its default reads
};

/// A checked shader. Immutable, shared.
class CompiledShader {
public:
    const std::string& path() const { return path_; } ///< the file; or the name given to loadText
    /// What the shader declares.
    const std::string& name() const { return shader_->name; }
    ShaderKind kind() const { return shader_->kind; }
    const std::vector<ParameterInfo>& parameters() const { return parameters_; }
    const Program& program() const { return *program_; }
    const Shader& shader() const { return *shader_; }
    /// KernelOptions::computedParameters: those that are not `given` and whose default is not one value for all samples.
    /// `varying`: overridden by primitive variables.
    std::vector<std::string> computedParameters(const std::set<std::string>& given,
                                                const std::vector<std::string>& varying) const;

private:
    friend class ShaderCompiler;
    std::string path_;
    std::string source_; ///< digest of the source
    std::string digest_; ///< of that and of which of its shaders this is
    std::shared_ptr<const Program> program_;
    const Shader* shader_ = nullptr;
    std::vector<ParameterInfo> parameters_;
};

/// Sixteen numbers, row by row, of the matrix of an input "space:FROM>TO". False: unknown (identity is taken).
using SpaceFn = std::function<bool(const std::string& from, const std::string& to, float matrix[16])>;

/// Counters of a compiler since its construction.
struct CompilerStatistics {
    int compiled = 0;   ///< kernels for which code was generated
    int fromDisk = 0;   ///< kernels from the disk cache
    int fromMemory = 0; ///< kernels compiled before by this compiler
    double seconds = 0; ///< of building, optimising and code generation, summed over threads
};

/// Loads shaders and compiles them into kernels, with a cache in memory and on disk. Thread safe. Kernels live as long as the
/// compiler or a pointer to them.
class ShaderCompiler {
public:
    /// What is the same for all shaders of a compiler.
    struct Settings {
        std::string cacheDirectory;  ///< "": none
        bool useDefaultCache = true; ///< take jit::defaultCacheDirectory() when cacheDirectory is empty
        std::vector<std::pair<std::string, std::string>> defines; ///< macros: name and text
        std::string dialect;                                      ///< whose macros are predefined: FrontOptions::dialect
        bool rispecSpecular = false;                              ///< FrontOptions::rispecSpecular
        bool lint = false;                                        ///< warnings for authors of shaders (front/lint.h)
        bool keepWritten = false;                                 ///< FrontOptions::keepWritten
        bool allowExec = false;               ///< `plugin "name"` loads code (rsl/plugins.h); else it is an error that says so
        std::vector<std::string> pluginPaths; ///< where plug-ins are searched, after the folder of the shader
        std::shared_ptr<ReadLog> reads;       ///< gets every source that is read or missed; may be null
    };
    /// With default settings, or with these.
    ShaderCompiler();
    explicit ShaderCompiler(Settings);
    ~ShaderCompiler();

    /// Finds NAME or NAME.sl in the directories, in order; includes are searched in the folder of the file, then in the
    /// directories. The shader of that name in the file, else the first. Null after an error; an error is reported the first time
    /// a name is asked for. A compiled shader of another renderer (.slo, .sdl, .sdr, .slx, .sdw) without its source is an error
    /// that names the missing source. What memory and file system throw passes through; the next request for the name then tries
    /// again.
    std::shared_ptr<const CompiledShader> load(const std::string& name, const std::vector<std::string>& directories,
                                               Diagnostics&);
    /// The first shader of a text. Not kept.
    std::shared_ptr<const CompiledShader> loadText(const std::string& text, const std::string& name, Diagnostics&);

    /// A class can be shaders of several kinds: the same class as one of another kind. Null when it is none.
    static std::shared_ptr<const CompiledShader> variant(const std::shared_ptr<const CompiledShader>&, ShaderKind);
    /// All shaders of the file, in the order of its text; a class once, as the first of its kinds.
    static std::vector<std::shared_ptr<const CompiledShader>> allOfFile(const std::shared_ptr<const CompiledShader>&);
    /// The shader of a file that a request for one of this kind and name means, where the file has several: the one of that name
    /// and kind, else, when none has the name, the first of the kind. Null when there is none.
    static std::shared_ptr<const CompiledShader> ofKind(const std::shared_ptr<const CompiledShader>&, ShaderKind,
                                                        const std::string& name);
    /// For KernelOptions::coShaders; parameters are left to the caller.
    static CoShader coShader(const std::shared_ptr<const CompiledShader>&, const std::string& handle);

    /// Machine code; from memory, from disk, or compiled now. Requests for the same kernel at the same time compile once. Null
    /// after an error (reported the first time).
    std::shared_ptr<const CompiledKernel> kernel(const std::shared_ptr<const CompiledShader>&, const KernelOptions&,
                                                 Diagnostics&);

    /// The values of all parameters, in order: what is `given` (as the shader sees it, in "current"), else the default, which may
    /// read parameters before it. Those without either are zero, "" or for matrices zero. `spaces` resolves named spaces.
    std::vector<ParameterValue> parameterValues(const std::shared_ptr<const CompiledShader>&, Diagnostics&,
                                                const SpaceFn& spaces = {}, const std::vector<ParameterValue>& given = {});

    /// The IR after the passes, as text; with `llvm` also the optimised LLVM IR. Empty after an error.
    std::string dump(const std::shared_ptr<const CompiledShader>&, const KernelOptions&, Diagnostics&, bool llvm = false);
    /// What the passes find out about a shader under these options, without generating code.
    std::unique_ptr<ir::Kernel> analyse(const CompiledShader&, const KernelOptions&, Diagnostics&) const;

    CompilerStatistics statistics() const; ///< so far, of all threads

private:
    std::shared_ptr<const CompiledShader> find(const std::string& name, const std::vector<std::string>& directories,
                                               Diagnostics&);
    static std::shared_ptr<const CompiledShader> finish(std::unique_ptr<Program>, const std::string& path,
                                                        const std::string& wanted, const std::string& text);
    static std::shared_ptr<const CompiledShader> describe(std::shared_ptr<const Program>, const Shader&, const std::string& path,
                                                          const std::string& source);
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace alpenglow::rsl
