#include "rsl/shadersearch.h"
#include "base/file.h"
#include "base/folder.h"
#include "base/limits.h"
#include "base/realpath.h"
#include "rsl/messages/messages.h"
#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

namespace fs = std::filesystem;

namespace alpenglow::rsl {

namespace {
bool isName(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_'; }

/// The words and signs of a text, without comments and strings.
class Words {
public:
    explicit Words(std::string_view text) : text_(text) {}

    std::string_view next() {
        while (at_ < text_.size()) {
            const std::string_view rest = text_.substr(at_);
            if (rest.starts_with("//")) skipBehind("\n", 2);
            else if (rest.starts_with("/*")) skipBehind("*/", 2);
            else if (rest[0] == '"') skipBehind("\"", 1);
            else if (isName(rest[0])) {
                size_t n = 1;
                while (n < rest.size() && isName(rest[n])) ++n;
                at_ += n;
                return rest.substr(0, n);
            } else if (++at_; static_cast<unsigned char>(rest[0]) > ' ') return rest.substr(0, 1);
        }
        return {};
    }

private:
    void skipBehind(std::string_view end, size_t from) {
        const size_t found = text_.find(end, at_ + from);
        at_ = found == std::string_view::npos ? text_.size() : found + end.size();
    }

    std::string_view text_;
    size_t at_ = 0;
};

constexpr std::array<std::string_view, 7> kKinds{"surface", "displacement",   "light", "volume",
                                                 "imager",  "transformation", "class"};
bool isKind(std::string_view word) { return std::find(kKinds.begin(), kKinds.end(), word) != kKinds.end(); }

bool namedAsSource(const std::string& path) {
    const std::string e = fs::path(path).extension().string();
    return e == ".sl" || e == ".SL" || e == ".Sl" || e == ".sL";
}
} // namespace

bool leadsToNoSource(const std::string& path, Diagnostics& d) {
    const std::string real = followedPath(path);
    if (namedAsSource(real)) return false;
    d.report(diagnostic(msg::kShaderLink(path, real), Rie::NoShader, {}));
    return true;
}

bool declaresShader(const std::string& text, const std::string& name) {
    Words words(text);
    std::string_view before, word = words.next();
    for (; !word.empty(); before = word, word = words.next())
        if (word == name && isKind(before) && words.next() == "(") return true;
    return false;
}

std::vector<DeclaredShader> shadersDeclared(const std::string& text) {
    std::vector<DeclaredShader> found;
    Words words(text);
    int depth = 0; // of braces: methods of a class may be called surface
    std::string_view kind, before;
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
        if (word == "(" && depth == 0 && isKind(kind) && !before.empty())
            found.push_back({std::string(kind), std::string(before)});
        if (word == "{") ++depth;
        if (word == "}" && depth > 0) --depth; // macros may have taken one away
        kind = before;
        before = word;
    }
    return found;
}

std::optional<std::string> fileWithShader(const std::string& name, const std::vector<std::string>& directories) {
    if (name.empty() || !std::all_of(name.begin(), name.end(), isName)) return {};
    int left = limits::kShaderFilesLooked;
    for (const std::string& directory : directories) {
        std::vector<std::string> files;
        for (const std::string& f : namesIn(directory))
            if (const fs::path path = fs::path(directory.empty() ? "." : directory) / f; namedAsSource(path.string()))
                files.push_back(path.string());
        std::sort(files.begin(), files.end());
        for (const std::string& f : files) {
            if (left-- <= 0) return {};
            Diagnostics quiet; // a file that cannot be read holds no shader for us
            if (!namedAsSource(followedPath(f))) continue;
            const auto bytes = readWholeFile(f, limits::kShaderFileLooked, quiet);
            if (bytes && declaresShader({bytes->begin(), bytes->end()}, name)) return f;
        }
    }
    return {};
}

} // namespace alpenglow::rsl
