// Option "rib" (PRMan): how a file is written.
#pragma once
#include "ri/writer.h"
#include <ri.h>
#include <string>
#include <string_view>

namespace alpenglow::ri {

/// A parameter of Option "rib": "format" ("ascii", "binary") or "compression" ("none", "gzip"). What is wrong with it, or "".
/// Other names are of other writers, and change nothing.
std::string setRibFormat(RibFormat&, std::string_view name, const std::string& value);
/// Settings made before RiBegin, for the next file.
RibFormat takeRibFormat();
/// Option "rib" without a context. True: it was.
bool noteRibFormat(const char* option, RtInt n, const RtToken* tokens, const RtPointer* values);

} // namespace alpenglow::ri
