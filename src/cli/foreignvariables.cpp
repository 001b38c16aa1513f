#include "cli/foreignvariables.h"
#include "base/file.h"
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <sstream>

namespace alpenglow::cli {
namespace {

using enum SearchedFor;

constexpr std::string_view kPrman = "PRMan", kDelight = "3Delight", kAqsis = "Aqsis", kPixie = "BMRT, Pixie",
                           kNoDisplays = "display drivers are part of the program",
                           kNoServer = "RiBegin has the name of a RIB file, or draws";

constexpr ForeignVariable kVariables[] = {
    {"AQSISHOME", kAqsis, Installation, "shaders=shaders textures=textures"},
    {"AQSIS_ARCHIVE_PATH", kAqsis, Archives},
    {"AQSIS_DISPLAY_PATH", kAqsis, Nothing, kNoDisplays},
    {"AQSIS_PROCEDURAL_PATH", kAqsis, Procedurals},
    {"AQSIS_SHADER_PATH", kAqsis, Shaders},
    {"AQSIS_TEXTURE_PATH", kAqsis, Textures},
    {"ARCHIVES", kPixie, Archives},
    {"DELIGHT", kDelight, Installation, "shaders=shaders textures=textures"},
    {"DISPLAYS", kPixie, Nothing, kNoDisplays},
    {"DL_ARCHIVES_PATH", kDelight, Archives},
    {"DL_DISPLAYS_PATH", kDelight, Nothing, kNoDisplays},
    {"DL_PROCEDURALS_PATH", kDelight, Procedurals},
    {"DL_RIBS_PATH", kDelight, Archives},
    {"DL_SHADERS_PATH", kDelight, Shaders},
    {"DL_TEXTURES_PATH", kDelight, Textures},
    {"PIXIEHOME", "Pixie", Installation, "shaders=shaders textures=textures"},
    {"PROCEDURALS", kPixie, Procedurals},
    {"RIBS", kPixie, Archives},
    {"RISERVER", kPrman, Nothing, kNoServer},
    {"RMANTREE", kPrman, Installation, "shaders=lib/shaders textures=lib/textures"},
    {"RMAN_ARCHIVEPATH", kPrman, Archives},
    {"RMAN_DISPLAYPATH", kPrman, Nothing, kNoDisplays},
    {"RMAN_PROCEDURALPATH", kPrman, Procedurals},
    {"RMAN_RIXPLUGINPATH", kPrman, Nothing, "there are no plug-ins of RIS here"},
    {"RMAN_SHADERPATH", kPrman, Shaders},
    {"RMAN_TEXTUREPATH", kPrman, Textures},
    {"SHADERS", kPixie, Shaders},
    {"TEXTURES", kPixie, Textures},
};

const char* wordOf(SearchedFor what) {
    return what == Shaders       ? "shaders"
           : what == Textures    ? "textures"
           : what == Archives    ? "archives"
           : what == Procedurals ? "procedurals"
                                 : "";
}

bool isFolder(const std::string& path) {
    std::error_code e;
    return std::filesystem::is_directory(path, e);
}

/// The folders of an installation, by what is searched in them: "shaders=lib/shaders textures=lib/textures".
std::vector<std::pair<SearchedFor, std::string>> below(std::string_view detail, const std::string& root) {
    std::vector<std::pair<SearchedFor, std::string>> all;
    std::istringstream words{std::string(detail)};
    for (std::string word; words >> word;) {
        const size_t equals = word.find('=');
        for (const SearchedFor what : {Shaders, Textures, Archives, Procedurals})
            if (word.substr(0, equals) == wordOf(what)) all.emplace_back(what, root + "/" + word.substr(equals + 1));
    }
    return all;
}

} // namespace

std::span<const ForeignVariable> foreignVariables() { return kVariables; }

std::string textOf(const ForeignVariable& v) {
    if (v.what == Nothing) return fmt::format("Does nothing: {}.", v.detail);
    if (v.what != Installation) return fmt::format("Folders for {}, searched last.", wordOf(v.what));
    std::string text;
    for (const auto& [what, folder] : below(v.detail, "$" + std::string(v.name)))
        text += (text.empty() ? "" : ", ") + fmt::format("{} for {}", folder, wordOf(what));
    return text + ": searched last.";
}

std::string foreignVariablesPage() {
    std::string out = "| variable | of | here |\n|---|---|---|\n";
    for (const ForeignVariable& v : kVariables) out += fmt::format("| {} | {} | {} |\n", v.name, v.of, textOf(v));
    return out;
}

EnvironmentFolders environmentFolders() {
    EnvironmentFolders all;
    for (const ForeignVariable& v : kVariables) {
        const char* value = v.what == Nothing ? nullptr : std::getenv(std::string(v.name).c_str());
        if (!value || !*value) continue;
        std::vector<std::pair<SearchedFor, std::string>> named;
        if (v.what == Installation) named = below(v.detail, value);
        else
            for (std::string& f : splitSearchPath(value)) named.emplace_back(v.what, std::move(f));
        for (auto& [what, folder] : named) {
            if (!isFolder(folder)) continue; // "@" and "&" of PRMan, and what is gone
            all.used[std::string(v.name)] = value;
            std::vector<std::string>& list = all.folders[what];
            if (std::find(list.begin(), list.end(), folder) == list.end()) list.push_back(std::move(folder));
        }
    }
    return all;
}

} // namespace alpenglow::cli
