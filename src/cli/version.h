// Which program this is.
#pragma once
#include <string>

namespace alpenglow::cli {

/// "Alpenglow 0.1 (5f06283)"; a + behind the commit: files were changed since. Without a checkout there is no commit.
std::string softwareName();
/// The command line, quoted where a shell needs it, for pictures and statistics.
std::string commandText(int argc, const char* const* argv);

} // namespace alpenglow::cli
