// What is in a scene: its frames, with what stands in them.
#pragma once
#include "base/diagnostics.h"
#include <nlohmann/json.hpp>
#include <string>

namespace alpenglow::cli {

/// Whether a name ends as those of scenes do.
bool namedAsScene(const std::string& file);
/// Adds what is in a scene. Procedurals are not made; programs are not run. False: it cannot be read.
bool addScene(nlohmann::ordered_json& facts, const std::string& file, Diagnostics&);

} // namespace alpenglow::cli
