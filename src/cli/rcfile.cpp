#include "cli/rcfile.h"
#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace alpenglow::cli {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMostBytes = size_t(1) << 20;

std::string variable(const char* name) {
    const char* v = std::getenv(name);
    return v ? v : "";
}

/// Its lines, one by one: options apart, and empty lines in their place, so that messages about RIB name the right line.
RcFile parsed(const std::string& path, const std::string& text, bool own) {
    RcFile f;
    f.path = path;
    f.own = own;
    std::istringstream lines(text);
    int number = 0;
    for (std::string line; std::getline(lines, line); f.rib += '\n') {
        ++number;
        const size_t first = line.find_first_not_of(" \t");
        if (first == line.npos || line.compare(first, 2, "--") != 0) {
            f.rib += line;
            continue;
        }
        if (line.ends_with('\r')) line.pop_back();
        if (f.optionLine == 0) f.optionLine = number;
        for (std::string& word : CLI::detail::split_up(line.substr(first))) f.options.push_back(std::move(word));
    }
    return f;
}

void read(const std::string& path, bool own, std::vector<RcFile>& files, Diagnostics& diags) {
    std::error_code e;
    if (!fs::is_regular_file(path, e)) return;
    if (fs::file_size(path, e) > kMostBytes || e)
        return diags.report(Severity::Error, Rie::Limit, {path}, "this file is larger than 1 MiB and is not read");
    std::ifstream in(path, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    if (!in) return diags.report(Severity::Error, Rie::NoFile, {path}, "the file cannot be read");
    for (const RcFile& f : files)
        if (fs::equivalent(f.path, path, e)) return; // the current folder is the user's own
    files.push_back(parsed(path, text.str(), own));
}

} // namespace

std::vector<RcFile> rcFiles(Diagnostics& diags) {
    std::vector<RcFile> files;
    if (const std::string named = variable("ALPENGLOW_RC"); !named.empty()) {
        if (named != "off") read(named, true, files, diags);
        if (named != "off" && files.empty())
            diags.report(Severity::Error, Rie::NoFile, {named}, "ALPENGLOW_RC names no file", "off reads none");
        return files;
    }
    const std::string home = variable("HOME"), config = variable("XDG_CONFIG_HOME");
    if (!config.empty() || !home.empty())
        read((config.empty() ? home + "/.config" : config) + "/alpenglow/alpenglowrc", true, files, diags);
    if (!home.empty()) read(home + "/.alpenglowrc", true, files, diags);
    read(".alpenglowrc", false, files, diags);
    return files;
}

std::vector<std::string> rcOptions(const std::vector<RcFile>& files) {
    std::vector<std::string> all;
    for (const RcFile& f : files)
        if (f.own) all.insert(all.end(), f.options.begin(), f.options.end());
    return all;
}

} // namespace alpenglow::cli
