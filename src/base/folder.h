// Contents of a folder.
#pragma once
#include <limits>
#include <string>
#include <vector>

namespace alpenglow {

/// At most `most` names in a folder ("" = the current folder), in disk order, without "." and "..". Empty if it cannot be read.
/// Throws if memory is short, whereas the non-throwing iterators of std::filesystem would end the program.
std::vector<std::string> namesIn(const std::string& folder, int most = std::numeric_limits<int>::max());

} // namespace alpenglow
