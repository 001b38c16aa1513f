#include "ri/lookahead.h"
#include "ri/source.h"
#include <algorithm>
#include <filesystem>
#include <string_view>

namespace alpenglow::ri {
namespace {

/// Keeps names and drops everything else.
struct Names final : scene::FrameConsumer {
    std::set<std::string> pictures;
    void render(std::shared_ptr<const scene::Frame>) override {}
    void makeTexture(const std::string& kind, const std::vector<std::string>& files, const scene::ParamList&,
                     const SourcePlace&) override {
        const size_t count = kind == "MakeCubeFaceEnvironment" ? 6 : 1;
        for (size_t i = 0; i < std::min(count, files.size()); ++i) pictures.insert(files[i]);
    }
};

bool contains(ByteSource& source, std::string_view word) {
    std::string text;
    char bytes[1 << 16];
    while (size_t n = source.read(bytes, sizeof bytes)) {
        text.append(bytes, n);
        if (text.find(word) != std::string::npos) return true;
        text.erase(0, text.size() - std::min(text.size(), word.size() - 1)); // the word may begin here
    }
    return false;
}

} // namespace

std::set<std::string> picturesOfMakeRequests(const std::string& path, const ReaderOptions& options) {
    std::error_code e;
    if (!std::filesystem::is_regular_file(path, e)) return {}; // a pipe can be read once
    std::string why;
    auto source = fileSource(path, &why);
    if (!source || !contains(*inflating(std::move(source)), "Make")) return {};
    ReaderOptions all;
    all.searchPaths = options.searchPaths;
    all.lastArchivePaths = options.lastArchivePaths;
    all.allowRead = options.allowRead;
    all.stop = options.stop;
    Names names;
    Diagnostics unheard; // the reading that renders has the messages
    RibReader(all, names, unheard).readFile(path);
    return std::move(names.pictures);
}

} // namespace alpenglow::ri
