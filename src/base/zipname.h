// Names of files inside zip archives, as RIB and command lines write them.
#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace alpenglow {

/// "dir/a.zip!in/b.rib", taken apart; a slash behind the '!' may be there or not.
struct ZipName {
    std::string zip, member; ///< the archive; the file in it
};
/// Nothing: no '!' stands behind ".zip", in whatever case.
std::optional<ZipName> zipName(std::string_view path);

} // namespace alpenglow
