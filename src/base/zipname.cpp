#include "base/zipname.h"
#include <algorithm>
#include <cctype>

namespace alpenglow {

std::optional<ZipName> zipName(std::string_view path) {
    constexpr std::string_view kEnding = ".zip";
    for (size_t at = 0; (at = path.find('!', at)) != path.npos; ++at) {
        if (at < kEnding.size()) continue;
        const std::string_view ending = path.substr(at - kEnding.size(), kEnding.size());
        if (!std::equal(ending.begin(), ending.end(), kEnding.begin(),
                        [](unsigned char a, char b) { return std::tolower(a) == b; }))
            continue;
        std::string_view member = path.substr(at + 1);
        while (member.starts_with('/') || member.starts_with('\\')) member.remove_prefix(1);
        return ZipName{std::string(path.substr(0, at)), std::string(member)};
    }
    return {};
}

} // namespace alpenglow
