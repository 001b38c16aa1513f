// What `alpenglow info` prints about files that are no shaders: pictures, maps, point clouds, photon maps, parts, models, scenes.
#pragma once
#include "base/diagnostics.h"
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace alpenglow::cli {

/// The file, its kind, and what is in it, by name; the order is that of the text. Returns nothing if it cannot be read, which is
/// reported. Files are recognised by their first bytes; models and scenes by their extension as well.
std::optional<nlohmann::ordered_json> fileFacts(const std::string& file, Diagnostics&);

/// The same as text: a line for each fact, and for each element of a list of facts.
std::string factsText(const nlohmann::ordered_json& facts);

} // namespace alpenglow::cli
