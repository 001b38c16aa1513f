// Environment variables of other renderers: what each does here, in one table for the program, its manual page and
// docs/options.md.
#pragma once
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::cli {

/// Which files the folders of a variable are searched for. Installation: folders below the one that it names.
enum class SearchedFor { Shaders, Textures, Archives, Procedurals, Installation, Nothing };

/// An environment variable of another renderer.
struct ForeignVariable {
    std::string_view name, of;               ///< of: whose it is
    SearchedFor what = SearchedFor::Nothing; ///< what its folders are searched for
    /// Installation: "shaders=lib/shaders textures=lib/textures". Nothing: why it does nothing.
    std::string_view detail = {};
};

/// Sorted by name.
std::span<const ForeignVariable> foreignVariables();
/// What it does here, a sentence.
std::string textOf(const ForeignVariable&);
/// The table of docs/options.md.
std::string foreignVariablesPage();

/// Folders that the environment names and that are there. They are searched last of all, so that a picture whose files are found
/// without them is the same with them.
struct EnvironmentFolders {
    std::map<SearchedFor, std::vector<std::string>> folders; ///< by what they are searched for
    std::map<std::string, std::string> used;                 ///< variables in effect, with their values
    /// Empty: no variable names any.
    std::vector<std::string> of(SearchedFor what) const {
        const auto i = folders.find(what);
        return i == folders.end() ? std::vector<std::string>() : i->second;
    }
};
/// Reads the environment of this process.
EnvironmentFolders environmentFolders();

} // namespace alpenglow::cli
