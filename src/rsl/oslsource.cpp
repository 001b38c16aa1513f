#include "rsl/oslsource.h"
#include "base/file.h"
#include "base/limits.h"
#include "base/realpath.h"
#include "rsl/front/osl.h"
#include <filesystem>

namespace alpenglow::rsl {

std::optional<std::string> findOsl(const std::string& name, const std::vector<std::string>& directories) {
    const std::filesystem::path path = name;
    const bool named = path.extension() == ".osl" || path.extension() == ".oso";
    auto found = findFile((named ? std::filesystem::path(path).replace_extension() : path).string() + ".osl", directories);
    if (!found || !followedPath(found->path).ends_with(".osl")) return {}; // a link could make messages quote any file
    return found->path;
}

std::unique_ptr<Program> compileOsl(const std::string& path, const FrontOptions& options, Diagnostics& diagnostics,
                                    std::string& text) {
    const auto bytes = readWholeFile(path, limits::kShaderFileLooked, diagnostics);
    const auto rsl = bytes ? front::rslFromOsl({bytes->begin(), bytes->end()}, path, diagnostics) : std::nullopt;
    if (!rsl) return nullptr;
    text = *rsl;
    Diagnostics reported;
    auto program = compileText(text, path, options, reported);
    for (const Diagnostic& m : reported.all())
        if (m.severity >= Severity::Error) diagnostics.report(m);
    return program;
}

} // namespace alpenglow::rsl
