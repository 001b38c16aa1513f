#include "rsl/front/connections.h"

namespace alpenglow::rsl {
namespace {

constexpr std::string_view kKey = "connected:";
constexpr char kSeparator = '\n'; // in no handle and no name

} // namespace

std::string Connected::key(std::string_view parameter, int element) {
    return std::string(kKey) + std::string(parameter) + (element < 0 ? "" : "[" + std::to_string(element) + "]");
}

bool Connected::isKey(std::string_view name) { return name.starts_with(kKey); }

std::optional<Connected> Connected::parse(std::string_view text) {
    const size_t first = text.find(kSeparator), second = first == text.npos ? first : text.find(kSeparator, first + 1);
    if (second == text.npos) return {};
    return Connected{std::string(text.substr(0, first)), std::string(text.substr(first + 1, second - first - 1)),
                     text.substr(second + 1) == "member"};
}

std::string Connected::text() const { return handle + kSeparator + output + kSeparator + (member ? "member" : ""); }

} // namespace alpenglow::rsl
