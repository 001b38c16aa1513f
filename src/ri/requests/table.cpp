#include "ri/requests/request.h"
#include <algorithm>
#include <charconv>
#include <unordered_map>

namespace alpenglow::ri {
namespace {

int toInt(std::string_view s) {
    int v = 0;
    std::from_chars(s.data(), s.data() + s.size(), v);
    return v;
}

ArgSpec parseArg(std::string_view s) {
    ArgSpec a;
    if (s.ends_with('?')) {
        a.optional = true;
        s.remove_suffix(1);
    }
    size_t space = s.find(' ');
    a.name = std::string(s.substr(space + 1));
    s = s.substr(0, space);
    if (size_t open = s.find('['); open != s.npos) {
        std::string_view n = s.substr(open + 1, s.size() - open - 2);
        s = s.substr(0, open);
        if (n.empty()) a.array = true;
        size_t slash = n.find('/');
        a.count = n.empty() ? 0 : toInt(n.substr(0, slash));
        if (slash != n.npos) a.otherCount = toInt(n.substr(slash + 1));
    }
    using F = ArgSpec::Form;
    a.form = s == "int" ? F::Int : s == "string" ? F::String : s == "handle" ? F::Handle : s == "basis" ? F::Basis : F::Number;
    return a;
}

void parseSignature(Request& r) {
    std::string_view rest = r.signature;
    while (!rest.empty()) {
        size_t semi = rest.find("; ");
        std::string_view item = rest.substr(0, semi);
        rest = semi == rest.npos ? std::string_view() : rest.substr(semi + 2);
        if (item == "..") r.parameters = true;
        else r.args.push_back(parseArg(item));
    }
}

std::vector<Request> build() {
    std::vector<Request> all;
    for (auto group : {structureRequests, optionRequests, attributeRequests, shaderRequests, transformRequests, quadricRequests,
                       primitiveRequests, archiveRequests, textureRequests, foreignRequests, risRequests})
        for (Request& r : group()) {
            parseSignature(r);
            all.push_back(std::move(r));
        }
    std::sort(all.begin(), all.end(), [](const Request& a, const Request& b) { return a.name < b.name; });
    return all;
}

} // namespace

const std::vector<Request>& requestTable() {
    static const std::vector<Request> table = build();
    return table;
}

const Request* findRequest(std::string_view name) {
    static const auto index = [] {
        std::unordered_map<std::string_view, const Request*> m;
        for (const Request& r : requestTable()) m[r.name] = &r;
        return m;
    }();
    auto i = index.find(name);
    return i == index.end() ? nullptr : i->second;
}

const std::vector<std::string>& requestNames() {
    static const auto names = [] {
        std::vector<std::string> n;
        for (const Request& r : requestTable()) n.emplace_back(r.name);
        return n;
    }();
    return names;
}

const char* toString(Kind k) {
    switch (k) {
    case Kind::Structure:
        return "structure";
    case Kind::Option:
        return "option";
    case Kind::Attribute:
        return "attribute";
    case Kind::Shader:
        return "shader";
    case Kind::Light:
        return "light";
    case Kind::Transform:
        return "transform";
    case Kind::Primitive:
        return "primitive";
    case Kind::Archive:
        return "archive";
    case Kind::Texture:
        return "texture";
    case Kind::Other:
        break;
    }
    return "other";
}

} // namespace alpenglow::ri
