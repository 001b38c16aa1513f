#include "ri/requests/manual.h"
#include "ri/requests/request.h"
#include <fmt/format.h>

namespace alpenglow::ri {
namespace {

std::string scopes(unsigned s) {
    if (s == kAnywhere) return "anywhere";
    std::string out;
    auto add = [&](unsigned bit, const char* name) {
        if (s & bit) out += (out.empty() ? "" : ", ") + std::string(name);
    };
    add(kBase, "outside frames");
    add(kFrame, "before the world");
    add(kWorld, "world");
    add(kObject, "object");
    return out;
}

/// A bar would end a table's cell.
std::string cell(std::string_view s) {
    std::string out;
    for (char c : s) out += c == '|' ? std::string("\\|") : std::string(1, c);
    return out;
}

} // namespace

std::string requestManual() {
    std::string out = "# RIB requests\n\n[n] is a fixed count, [] any number, ? may be left out, .. a parameter list. Brackets "
                      "around fixed counts are optional.\n";
    for (Kind k : {Kind::Structure, Kind::Option, Kind::Attribute, Kind::Shader, Kind::Light, Kind::Transform, Kind::Primitive,
                   Kind::Archive, Kind::Texture, Kind::Other}) {
        out +=
            fmt::format("\n## {}\n\n| request | arguments | where | in motion blocks | |\n|---|---|---|---|---|\n", toString(k));
        for (const Request& r : requestTable())
            if (r.kind == k)
                out += fmt::format("| {} | {} | {} | {} | {} |\n", r.name, cell(r.signature), scopes(r.scopes),
                                   r.motion ? "yes" : "", cell(r.doc));
    }
    return out;
}

} // namespace alpenglow::ri
