// The manual of the messages of the compiler, from their table: as text, as JSON, and as the Markdown page docs/messages.md.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace alpenglow::cli {

/// The message of this id in full; "" if there is none. All in a line each for the id "".
std::string messageText(const std::string& id);
/// The same as a list with an entry a message.
nlohmann::ordered_json messageJson(const std::string& id);
/// The whole page docs/messages.md.
std::string messagesPage();
/// All ids, for hints.
std::vector<std::string> messageIds();

} // namespace alpenglow::cli
