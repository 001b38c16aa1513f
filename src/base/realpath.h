// Where paths lead.
#pragma once
#include <string>

namespace alpenglow {

/// The absolute path with links resolved. Missing components are appended literally.
std::string followedPath(const std::string& path);
/// Whether two names refer to one file, existing (also through links) or not yet existing.
bool sameFile(const std::string& a, const std::string& b);

} // namespace alpenglow
