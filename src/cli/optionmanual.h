// The manual of options, attributes, hiders, displays and requests, from the tables that the reader uses, and that of messages
// (messagemanual.h): as text, as JSON, and as the Markdown pages docs/options.md, docs/rib.md and docs/messages.md.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace alpenglow::cli {

/// What `alpenglow info` lists from tables.
enum class Topic { Options, Attributes, Hiders, Displays, Requests, Messages };

/// Everything of a topic, a line each. `name` (may be ""): one entry in full, or those of one category ("trace",
/// "trace:maxdepth", "maxdepth"); "" as the result when there is none of that name.
std::string topicText(Topic, const std::string& name);
/// The same for programs; null when there is none of that name.
nlohmann::ordered_json topicJson(Topic, const std::string& name);
/// The whole page that holds the topic.
std::string topicPage(Topic);
/// All names of a topic, for hints.
std::vector<std::string> topicNames(Topic);
/// Prints a topic, or an error that names what is near. The status of the program.
int printTopic(Topic, const std::string& name, bool json);

} // namespace alpenglow::cli
