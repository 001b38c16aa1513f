#include "ri/c/ribformat.h"
#include "ri/c/client.h"
#include "ri/c/errors.h"
#include "ri/c/strings.h"
#include <fmt/format.h>
#include <utility>

namespace alpenglow::ri {

namespace {

/// Of the next file. As RiLastError it belongs to the process: there is no context yet.
RibFormat gNextFormat;

} // namespace

std::string setRibFormat(RibFormat& format, std::string_view name, const std::string& value) {
    if (name != "format" && name != "compression") return {};
    const bool known = name == "format" ? value == "ascii" || value == "binary" : value == "none" || value == "gzip";
    if (!known)
        return fmt::format("Option \"rib\" \"{}\": \"{}\" is not known; it is {}", name, value,
                           name == "format" ? "ascii or binary" : "none or gzip");
    (name == "format" ? format.binary : format.gzip) = value == "binary" || value == "gzip";
    return {};
}

RibFormat takeRibFormat() {
    const Boundary boundary;
    return std::exchange(gNextFormat, {});
}

bool noteRibFormat(const char* option, RtInt n, const RtToken* tokens, const RtPointer* values) {
    const Boundary boundary;
    if (Client::current() || !option || std::string_view(option) != "rib" || !tokens || !values) return false;
    for (RtInt i = 0; i < n; ++i) {
        if (!tokens[i] || !values[i]) continue;
        const std::string_view token = tokens[i], name = token.substr(token.find_last_of(' ') + 1);
        if (name != "format" && name != "compression") continue;
        const auto text = textInsteadOfAddress(values[i]);
        const RtToken value = text ? text->c_str() : *static_cast<const RtToken*>(values[i]);
        Diagnostic d;
        d.code = Rie::BadToken;
        d.message = setRibFormat(gNextFormat, name, value ? value : "");
        if (!d.message.empty()) noteError(d);
    }
    return true;
}

} // namespace alpenglow::ri
