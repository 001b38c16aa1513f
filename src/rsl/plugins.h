// RSL plug-ins (include/alpenglow/rslplugin.h): finding, loading, checking, and the addresses of functions that machine code
// calls by name.
#pragma once
#include "rsl/front/plugin.h"
#include <map>
#include <mutex>

namespace alpenglow::rsl {

/// Thread safe. A library that was loaded stays in the process: machine code may call it as long as there is any.
class PluginLibrary {
public:
    /// NAME as a file, or NAME.so or libNAME.so in one of the folders, loaded. Null with the reason: nothing of that name, no
    /// plug-in, another version of the header, a signature that is empty or does not fit its function. The same file is
    /// loaded once.
    std::shared_ptr<const Plugin> load(const std::string& name, const std::vector<std::string>& folders, Raised& why,
                                       std::string& hint);
    /// The function that a symbol of a loaded plug-in's signature stands for, or null.
    void* address(const std::string& symbol) const;

private:
    mutable std::mutex mutex_;
    std::map<std::string, std::shared_ptr<const Plugin>> byPath_;
    std::map<std::string, void*> addresses_;
};

} // namespace alpenglow::rsl
