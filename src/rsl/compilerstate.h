// What a ShaderCompiler holds. Not for other files than those of the compiler.
#pragma once
#include "rsl/compiler.h"
#include "rsl/jit/cache.h"
#include "rsl/plugins.h"
#include <atomic>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace alpenglow::rsl {

/// The members of ShaderCompiler: its caches, and what they share.
struct ShaderCompiler::State {
    Settings settings;                       ///< of the constructor
    std::unique_ptr<jit::KernelCache> cache; ///< of compiled kernels on disk; null: none
    std::atomic<bool> cacheRefused = false;  ///< which was reported
    mutable std::mutex mutex;                ///< guards the members below
    std::map<std::string, std::shared_future<std::shared_ptr<const CompiledShader>>> shaders; ///< by path or text, with options
    std::map<std::string, std::shared_future<std::shared_ptr<const CompiledKernel>>> kernels; ///< by key
    CompilerStatistics statistics;                                                            ///< counters so far
    PluginLibrary plugins;                                                                    ///< plug-ins that were loaded
    /// Address of a plug-in's function, for linking; null: there is none.
    std::function<void*(const std::string&)> outside = [this](const std::string& name) { return plugins.address(name); };

    /// The options of the front end that the settings mean.
    FrontOptions front() {
        FrontOptions o;
        o.defines = settings.defines;
        o.dialect = settings.dialect;
        o.rispecSpecular = settings.rispecSpecular;
        o.lint = settings.lint;
        o.keepWritten = settings.keepWritten;
        if (settings.allowExec)
            o.plugin = [this](const std::string& name, const std::string& folder, Raised& why, std::string& hint) {
                std::vector<std::string> folders{folder};
                folders.insert(folders.end(), settings.pluginPaths.begin(), settings.pluginPaths.end());
                return plugins.load(name, folders, why, hint);
            };
        return o;
    }
};

} // namespace alpenglow::rsl
