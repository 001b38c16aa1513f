// The version of the program, which the project() line of CMakeLists.txt says.
#pragma once

namespace alpenglow {

/// "0.2.0".
const char* versionText();
/// Major, minor and patch number.
const int (&versionNumbers())[3];

} // namespace alpenglow
