// Control groups of Linux: how containers and batch systems bound memory and processors.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow {

/// The folders whose files bound this process, from its own group up to the root: those of version 2, and those of version 1 for
/// the controller ("memory", "cpu"). Empty where there are no control groups. Source: cgroups(7).
std::vector<std::string> controlGroupFolders(std::string_view controller);

} // namespace alpenglow
