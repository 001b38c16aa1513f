#include "base/installation.h"
#include "base/configured.h"
#include <cstdlib>
#include <sys/auxv.h>

namespace fs = std::filesystem;

namespace alpenglow {

fs::path programFolder() {
    std::error_code e;
    fs::path program = fs::read_symlink("/proc/self/exe", e);
    if (e) { // without /proc: by the name that the program was started with
        const auto* name = reinterpret_cast<const char*>(getauxval(AT_EXECFN));
        program = name ? fs::canonical(name, e) : fs::path();
        if (e) return {};
    }
    return program.parent_path();
}

std::string shippedShaders(const fs::path& folder) {
    if (folder.empty()) return {};
    std::error_code e;
    for (const char* place : {configured::kShaders, "../share/alpenglow/shaders"})
        if (const fs::path found = fs::canonical(folder / place, e); !e && fs::is_directory(found, e)) return found.string();
    return {};
}

std::string moduleFile(const char* name, const char* variable, const fs::path& folder) {
    std::error_code e;
    if (const char* named = std::getenv(variable)) return fs::is_regular_file(named, e) ? named : "";
    if (folder.empty()) return {};
    for (const char* place : {".", configured::kModules, "../lib/alpenglow"})
        if (const fs::path found = (folder / place / name).lexically_normal(); fs::is_regular_file(found, e))
            return found.string();
    return {};
}

} // namespace alpenglow
