// Where paths lead.
#pragma once
#include <string>

namespace alpenglow {

/// The path without links, absolute. What is missing of it is taken by its letters.
std::string followedPath(const std::string& path);
/// Whether two names are of one file that is there, through links as well, or of one that will be.
bool sameFile(const std::string& a, const std::string& b);

} // namespace alpenglow
