#include "ri/readahead.h"
#include "base/limits.h"
#include "base/parallel.h"
#include "ri/parser.h"
#include "ri/reporter.h"
#include "ri/source.h"
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <tbb/task_arena.h>

namespace alpenglow::ri {

namespace {

namespace fs = std::filesystem;
constexpr std::string_view kWord = "ReadArchive";
constexpr size_t kName = 4096;                        // bytes of a name and of the text before it
constexpr uintmax_t kHeldBytes = uintmax_t(64) << 20; // of files that are held as requests at a time
constexpr size_t kCalls = 20'000;                     // requests of one of them; a longer one is read as it is executed

/// The string behind ReadArchive or "DelayedReadArchive" [ at `at`; "" when there is something else.
std::string nameAt(std::string_view text, size_t at) {
    if (at < text.size() && text[at] == '"') ++at;
    const size_t quote = text.find_first_not_of(" \t\r\n[", at);
    if (quote == std::string_view::npos || text[quote] != '"') return {};
    const size_t end = text.find_first_of("\"\\\n", quote + 1);
    return end == std::string_view::npos || text[end] != '"' ? std::string()
                                                             : std::string(text.substr(quote + 1, end - quote - 1));
}

} // namespace

std::unique_ptr<ParsedArchive> parseArchive(const std::string& path) {
    std::string why;
    std::error_code ec;
    if (!fs::is_regular_file(path, ec)) return nullptr; // a file in a zip archive is packed
    auto source = fileSource(path, &why, true);
    unsigned char magic[2] = {};
    std::ifstream(path, std::ios::binary).read(reinterpret_cast<char*>(magic), 2);
    if (!source || (magic[0] == 0x1f && magic[1] == 0x8b)) return nullptr; // what is packed may be of any size
    Diagnostics reported;
    Reporter reporter(reported);
    auto out = std::make_unique<ParsedArchive>();
    Parser parser(std::move(source), path, reporter);
    for (Call call; parser.next(call) && reported.all().empty();) {
        if (out->calls.size() >= kCalls) return nullptr;
        out->calls.push_back(std::move(call));
    }
    out->end = parser.here();
    return reported.all().empty() ? std::move(out) : nullptr;
}

void ReadAhead::scan(const std::string& sceneFile) {
    names_.clear();
    parsed_.clear();
    next_ = 0;
    std::error_code ec;
    if (!fs::is_regular_file(sceneFile, ec)) return; // a pipe can be read once
    std::ifstream in(sceneFile, std::ios::binary);
    std::string text;
    std::vector<char> bytes(1 << 20);
    while (in.read(bytes.data(), std::streamsize(bytes.size())), in.gcount() > 0) {
        text.append(bytes.data(), size_t(in.gcount()));
        const bool last = in.gcount() < std::streamsize(bytes.size());
        const size_t whole = last ? text.size() : text.size() - std::min(text.size(), kName); // the rest may be half a name
        size_t seen = 0;
        for (size_t at; (at = text.find(kWord, seen)) < whole; seen = at + kWord.size()) {
            if (std::string name = nameAt(text, at + kWord.size()); !name.empty()) names_.push_back(std::move(name));
            if (names_.size() >= size_t(limits::kArchiveReads)) return;
        }
        text.erase(0, std::max(seen, whole));
    }
}

/// The next ones, as many as keep the threads busy and are not too large together, of those that lie in a folder.
void ReadAhead::parseFrom(size_t first, const std::string& folder) {
    std::vector<size_t> which;
    uintmax_t bytes = 0;
    const size_t most = 4 * size_t(tbb::this_task_arena::max_concurrency());
    for (size_t i = first; i < names_.size() && which.size() < most; ++i) {
        const fs::path name(names_[i]);
        if (name.is_absolute() || std::find(name.begin(), name.end(), "..") != name.end()) continue;
        const std::string path = folder + names_[i];
        std::error_code ec;
        if (!fs::is_regular_file(path, ec)) continue;
        bytes += fs::file_size(path, ec);
        if (ec || bytes > kHeldBytes) break;
        which.push_back(i);
        parsed_[i].path = path;
    }
    if (which.size() < 2) return parsed_.clear(); // nothing is won
    parallelFor(size_t(0), which.size(), [&](size_t k) {
        Ahead& a = parsed_.find(which[k])->second;
        a.archive = parseArchive(a.path);
    });
}

std::unique_ptr<ParsedArchive> ReadAhead::take(const std::string& name, const std::string& path) {
    const auto at = std::find(names_.begin() + std::ptrdiff_t(next_), names_.end(), name);
    if (at == names_.end() || !path.ends_with(name)) return nullptr;
    const size_t i = size_t(at - names_.begin());
    next_ = i + 1;
    parsed_.erase(parsed_.begin(), parsed_.lower_bound(i)); // conditions have passed them over
    if (parsed_.empty()) parseFrom(i, path.substr(0, path.size() - name.size()));
    const auto found = parsed_.find(i);
    if (found == parsed_.end()) return nullptr;
    Ahead a = std::move(found->second);
    parsed_.erase(found);
    return a.path == path ? std::move(a.archive) : nullptr;
}

std::string lineOfFile(const std::string& path, int line) {
    std::ifstream in(path, std::ios::binary);
    std::string text;
    for (int n = 0; n < line; ++n)
        if (!std::getline(in, text)) return {};
    const bool plain =
        std::all_of(text.begin(), text.end(), [](char c) { return c == '\t' || c == '\r' || (c >= ' ' && c != 127); });
    return plain ? text.substr(0, 200) : std::string();
}

} // namespace alpenglow::ri
