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

/// The shaders of an OSL file, translated to RSL in `text`. Warnings about that RSL are dropped; null after an error.
std::unique_ptr<Program> compileOsl(const std::string& path, const FrontOptions&, Diagnostics&, std::string& text);

} // namespace alpenglow::rsl
