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

const char* titleOf(Kind k) {
    switch (k) {
    case Kind::Structure:
        return "Structure";
    case Kind::Option:
        return "Camera, display and other options";
    case Kind::Attribute:
        return "Attributes";
    case Kind::Shader:
        return "Shaders";
    case Kind::Light:
        return "Lights";
    case Kind::Transform:
        return "Transformations";
    case Kind::Primitive:
        return "Primitives";
    case Kind::Archive:
        return "Archives";
    case Kind::Texture:
        return "Maps";
    case Kind::Other:
        break;
    }
    return "Other";
}

namespace {

std::string example(const Request& r) { return "`" + std::string(r.name) + (r.sample.empty() ? "" : " ") + cell(r.sample) + "`"; }

} // namespace

std::string requestText(const Request& r) {
    return fmt::format("{} {}\n\n{}\n\nWhere: {}{}.\nExample: {} {}\n", r.name, r.signature, r.doc, scopes(r.scopes),
                       r.motion ? "; also in motion blocks" : "", r.name, r.sample);
}

std::string requestManual() {
    std::string out =
        "# RIB requests\n\n"
        "Every request that is read, from the table that the reader itself uses, with what it does here. Made by\n"
        "`alpenglow info --requests --markdown`; a test holds this page to the table. Names and values of `Option`,\n"
        "`Attribute`, `Hider` and `Display` are in [options.md](options.md); a first scene is in [tutorial.md](tutorial.md).\n\n"
        "[n] is a fixed count, [] any number, ? may be left out, .. is a list of parameters: \"type name\" value. Brackets\n"
        "around fixed counts are optional.\n";
    for (const Kind k : kManualOrder) {
        out += fmt::format(
            "\n## {}\n\n| request | arguments | where | in motion blocks | what it does | example |\n|---|---|---|---|---|---|\n",
            titleOf(k));
        for (const Request& r : requestTable())
            if (r.kind == k)
                out += fmt::format("| {} | {} | {} | {} | {} | {} |\n", r.name, cell(r.signature), scopes(r.scopes),
                                   r.motion ? "yes" : "", cell(r.doc), example(r));
    }
    return out;
}

} // namespace alpenglow::ri
