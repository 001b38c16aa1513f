#include "cli/ribfilters.h"
#include "ri/c/rif.h"
#include "ri/program.h"
#include <fmt/format.h>
#include <unistd.h>

namespace alpenglow::cli {

namespace {

/// The file of a library: as it is named, with .so, and with lib before it. The loader takes names with a slash as files.
std::string libraryFile(const std::string& name) {
    const size_t slash = name.rfind('/');
    const std::string folder = slash == name.npos ? "./" : name.substr(0, slash + 1),
                      file = name.substr(folder == "./" && slash == name.npos ? 0 : slash + 1);
    for (const std::string& f : {file, file + ".so", "lib" + file + ".so"})
        if (access((folder + f).c_str(), R_OK) == 0) return folder + f;
    return folder + file;
}

} // namespace

std::unique_ptr<RibFilters> RibFilters::make(const std::vector<std::string>& specs, ri::RequestReceiver& to,
                                             Diagnostics& reported, const StopFlag* stop) {
    std::unique_ptr<RibFilters> all(new RibFilters(to));
    for (size_t i = specs.size(); i-- > 0;) {
        std::vector<std::string> words = ri::commandWords(specs[i]);
        const std::string name = words.empty() ? "" : words[0];
        if (!words.empty()) words.erase(words.begin());
        const bool python = name.starts_with("python:") || name.ends_with(".py") || name.find(".py:") != name.npos;
        std::string why = "it has no name";
        std::unique_ptr<ri::RequestReceiver> stage;
        if (python) stage = pythonFilter(name, words, all->first(), reported, stop, why);
        else if (!name.empty()) stage = ri::loadRif(libraryFile(name), words, all->first(), reported, why);
        if (!stage) {
            reported.report(Severity::Error, Rie::System, {}, fmt::format("filter \"{}\": {}", specs[i], why),
                            "a library that defines RifPluginManufacture (include/RifPlugin.h), FILE.py, FILE.py:FUNCTION or "
                            "python:MODULE.FUNCTION");
            return nullptr;
        }
        all->stages_.push_back(std::move(stage));
    }
    return all;
}

} // namespace alpenglow::cli
