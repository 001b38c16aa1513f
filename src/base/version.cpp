#include "base/version.h"
#include "base/configured.h"

namespace alpenglow {

const char* versionText() { return configured::kVersion; }

const int (&versionNumbers())[3] { return configured::kVersionNumbers; }

} // namespace alpenglow
