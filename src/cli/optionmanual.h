// The manual of options, attributes, hiders, displays and requests, from the tables that the reader uses: as text, as JSON, and
// as the Markdown pages docs/options.md and docs/rib.md.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace alpenglow::cli {

/// What `alpenglow info` lists from tables.
enum class Topic { Options, Attributes, Hiders, Displays, Requests };

/// Everything of a topic, a line each. `name` (may be ""): one entry in full, or those of one category ("trace",
/// "trace:maxdepth", "maxdepth"); "" as the result when there is none of that name.
std::string topicText(Topic, const std::string& name);
nlohmann::ordered_json topicJson(Topic, const std::string& name);
/// The whole page that holds the topic.
std::string topicPage(Topic);
/// All names of a topic, for hints.
std::vector<std::string> topicNames(Topic);

} // namespace alpenglow::cli
