// Which program this is.
#pragma once
#include <string>

namespace alpenglow::cli {

/// "Alpenglow 0.2.0 (5f06283)"; a + behind the commit: files were changed since. Without a checkout there is no commit.
std::string softwareName();
/// What --version prints. Its first line is "alpenglow 0.2.0 (5f06283)".
std::string versionReport();
/// The command line, quoted where a shell needs it, for pictures and statistics.
std::string commandText(int argc, const char* const* argv);

} // namespace alpenglow::cli
