// Linux control groups: memory and processor limits of containers and batch systems.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow {

/// The folders whose files limit this process, from its own group up to the root: of version 2, and of version 1 for the
/// controller ("memory", "cpu"). Empty without control groups. Source: cgroups(7).
std::vector<std::string> controlGroupFolders(std::string_view controller);

} // namespace alpenglow
