// Limits of this folder, in addition to those of base/limits.h.
#pragma once
#include <cstddef>

namespace alpenglow::limits {

inline constexpr size_t kZipEntries = 1'000'000;                ///< files in one zip archive
inline constexpr size_t kZipDirectoryBytes = size_t(256) << 20; ///< of the list of files in one zip archive

} // namespace alpenglow::limits
