#include "cli/version.h"
#include "alpenglow_commit.h"
#include "base/version.h"

namespace alpenglow::cli {

std::string softwareName() {
    const std::string commit = ALPENGLOW_COMMIT;
    return std::string("Alpenglow ") + versionText() + (commit.empty() ? "" : " (" + commit + ")");
}

std::string commandText(int argc, const char* const* argv) {
    std::string text;
    for (int i = 0; i < argc; ++i) {
        const std::string word = argv[i];
        const bool plain = !word.empty() && word.find_first_of(" \t\n'\"\\$`*?[]{}();&|<>~#!") == word.npos;
        std::string quoted;
        for (char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
        text += (i ? " " : "") + (plain ? word : "'" + quoted + "'");
    }
    return text;
}

} // namespace alpenglow::cli
