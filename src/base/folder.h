// What lies in a folder.
#pragma once
#include <limits>
#include <string>
#include <vector>

namespace alpenglow {

/// The names in a folder ("" = the working directory) in the order of the disk, at most so many, without "." and "..". None when
/// it cannot be read. Runs out of memory by an exception: std::filesystem's iterators without exceptions end the program there.
std::vector<std::string> namesIn(const std::string& folder, int most = std::numeric_limits<int>::max());

} // namespace alpenglow
