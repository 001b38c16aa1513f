#include "base/installation.h"
#include "base/configured.h"
#include <cstdlib>
#include <dlfcn.h>
#include <link.h>
#include <sys/auxv.h>

namespace fs = std::filesystem;

namespace alpenglow {

namespace {

/// Its address says which file this code is in.
char placeOfThisCode;

fs::path programFile() {
    std::error_code e;
    fs::path program = fs::read_symlink("/proc/self/exe", e);
    if (!e) return program;
    const auto* name = reinterpret_cast<const char*>(getauxval(AT_EXECFN)); // no /proc here: the name that it was started by
    program = name ? fs::canonical(name, e) : fs::path();
    return e ? fs::path() : program;
}

} // namespace

fs::path codeFile() {
    Dl_info info{};
    void* entry = nullptr;
    if (dladdr1(&placeOfThisCode, &info, &entry, RTLD_DL_LINKMAP) == 0 || !entry) return programFile();
    const char* library = static_cast<const link_map*>(entry)->l_name; // "" for the program itself
    if (!library || !*library) return programFile();
    std::error_code e;
    const fs::path file = fs::canonical(library, e);
    return e ? fs::path() : file;
}

fs::path codeFolder() { return codeFile().parent_path(); }

std::string shippedShaders(const fs::path& folder) {
    if (folder.empty()) return {};
    std::error_code e;
    for (const char* place : {configured::kShaders, configured::kShadersOfLibrary, configured::kShadersOfPython,
                              "../share/alpenglow/shaders", "../../share/alpenglow/shaders"})
        if (const fs::path found = fs::canonical(folder / place, e); !e && fs::is_directory(found, e)) return found.string();
    return {};
}

std::string moduleFile(const char* name, const char* variable, const fs::path& folder) {
    std::error_code e;
    if (const char* named = variable ? std::getenv(variable) : nullptr) return fs::is_regular_file(named, e) ? named : "";
    if (folder.empty()) return {};
    for (const char* place : {".", configured::kModules, "../lib/alpenglow", "alpenglow", "../bin", "../../bin", "../.."})
        if (const fs::path found = (folder / place / name).lexically_normal(); fs::is_regular_file(found, e))
            return found.string();
    return {};
}

} // namespace alpenglow
