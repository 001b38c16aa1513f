// RSL plug-ins as the front end sees them: descriptors like those of shadeops, found by name.
#pragma once
#include "rsl/messages/message.h"
#include "rsl/names.h"
#include "shadeops/descriptor.h"
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace alpenglow::rsl {

/// Section of a plug-in's functions; Signature::symbol is then the name by which machine code knows the function.
inline constexpr const char* kPluginSection = "Plug-ins";

/// The names by which machine code knows the functions of plug-ins begin with this; then come the file and the signature, nothing
/// that changes from run to run.
inline constexpr const char* kPluginSymbol = "rslplugin:";

/// A loaded plug-in and the functions that shaders can call.
struct Plugin {
    std::string name, path;         ///< as shaders name it; the file
    std::vector<Shadeop> functions; ///< Lowering::Service, sorted by name, one for each name
    /// The function of that name; null if there is none.
    const Shadeop* find(const std::string& function) const {
        for (const Shadeop& f : functions)
            if (f.name == function) return &f;
        return nullptr;
    }
};

/// The plug-in that `plugin "name"` in a file of folder `folder` means. Null: the reason in
/// `why`, what may help in `hint`.
using PluginFinder = std::function<std::shared_ptr<const Plugin>(const std::string& name, const std::string& folder, Raised& why,
                                                                 std::string& hint)>;

} // namespace alpenglow::rsl
