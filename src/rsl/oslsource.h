// Files of OSL as programs of RSL (front/osl.h).
#pragma once
#include "base/diagnostics.h"
#include "rsl/front/ast.h"
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::rsl {

/// The source of an OSL shader, NAME.osl, also where its compiled form (.oso) is named. Nothing: there is none.
std::optional<std::string> findOsl(const std::string& name, const std::vector<std::string>& directories);

/// The shaders of an OSL file; `text` becomes their RSL, which is this program's, so only errors in it are said. Null after one.
std::unique_ptr<Program> compileOsl(const std::string& path, const FrontOptions&, Diagnostics&, std::string& text);

} // namespace alpenglow::rsl
