#include "cli/shaderlist.h"
#include "base/file.h"
#include "base/limits.h"
#include "rsl/shadersearch.h"
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <set>

namespace fs = std::filesystem;

namespace alpenglow::cli {
namespace {

/// The words of the comment that a file begins with.
std::string topComment(const std::string& text) {
    std::string out;
    size_t i = text.find_first_not_of(" \t\r\n");
    if (i == std::string::npos) return out;
    if (text.compare(i, 2, "/*") == 0) {
        const size_t end = text.find("*/", i + 2);
        out = text.substr(i + 2, end == std::string::npos ? end : end - i - 2);
    } else {
        while (i != std::string::npos && text.compare(i, 2, "//") == 0) {
            const size_t end = text.find('\n', i);
            out += text.substr(i + 2, end == std::string::npos ? end : end - i - 2) + " ";
            i = end == std::string::npos ? end : text.find_first_not_of(" \t\r", end + 1);
        }
    }
    return out;
}

/// On one line, without the ornaments of a block, without "name:" in front, up to the first full stop.
std::string firstSentence(const std::string& comment, const std::string& name) {
    std::string t;
    for (char c : comment) {
        const bool blank = c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '*';
        if (!blank) t += c;
        else if (!t.empty() && t.back() != ' ') t += ' ';
    }
    while (!t.empty() && t.back() == ' ') t.pop_back();
    if (t.starts_with(name + ":")) t.erase(0, std::min(t.size(), name.size() + 2));
    if (const size_t stop = t.find(". "); stop != std::string::npos) t.resize(stop + 1);
    constexpr size_t kLine = 160;
    if (t.size() > kLine) t = t.substr(0, kLine) + "...";
    return t;
}

} // namespace

std::vector<ListedShader> listShaders(const std::vector<std::string>& folders) {
    std::vector<ListedShader> all;
    std::set<std::string> names, seen;
    int left = limits::kShaderFilesLooked;
    for (const std::string& folder : folders) {
        std::error_code ignored;
        const std::string real = fs::weakly_canonical(folder.empty() ? "." : folder, ignored).string();
        if (!seen.insert(real).second) continue;
        std::vector<std::string> files;
        for (fs::directory_iterator i(folder.empty() ? "." : folder, ignored), end; !ignored && i != end; i.increment(ignored))
            if (i->path().extension() == ".sl") files.push_back(i->path().string());
        std::sort(files.begin(), files.end());
        for (const std::string& f : files) {
            if (left-- <= 0) return all;
            Diagnostics quiet;
            const auto bytes = readWholeFile(f, limits::kShaderFileLooked, quiet);
            if (!bytes) continue;
            const std::string text(bytes->begin(), bytes->end());
            for (const rsl::DeclaredShader& d : rsl::shadersDeclared(text)) {
                const bool first = names.insert(d.name).second;
                all.push_back({d.name, d.kind, f, firstSentence(topComment(text), d.name), !first});
            }
        }
    }
    return all;
}

std::string shaderListText(const std::vector<ListedShader>& list) {
    std::string out, folder;
    for (const ListedShader& s : list) {
        if (const std::string of = fs::path(s.file).parent_path().string(); of != folder)
            out += (out.empty() ? "" : "\n") + (folder = of) + "\n";
        out += fmt::format("    {:<20} {:<13} {}{}\n", s.name, s.kind, s.hidden ? "(a folder above has one of that name) " : "",
                           s.doc);
    }
    return out;
}

nlohmann::ordered_json shaderListJson(const std::vector<ListedShader>& list) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const ListedShader& s : list) {
        all.push_back({{"name", s.name}, {"kind", s.kind}, {"file", s.file}, {"doc", s.doc}});
        if (s.hidden) all.back()["hidden"] = true;
    }
    return all;
}

} // namespace alpenglow::cli
