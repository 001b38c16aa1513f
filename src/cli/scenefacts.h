// The contents of a scene: its frames and what they hold.
#pragma once
#include "base/diagnostics.h"
#include <nlohmann/json.hpp>
#include <string>

namespace alpenglow::cli {

/// Whether a name ends as those of scenes do.
bool namedAsScene(const std::string& file);
/// Adds what is in a scene. Procedurals are not expanded; programs are not run. Returns false if it cannot be read.
bool addScene(nlohmann::ordered_json& facts, const std::string& file, Diagnostics&);

} // namespace alpenglow::cli
