#include "scene/network.h"
#include <charconv>

namespace alpenglow::scene {
namespace {

constexpr std::string_view kMark = "->"; // stands before the name of a connected parameter
constexpr char kSeparator = '\x1f';      // between who keeps a pattern and its handle: in no text of a file
constexpr std::string_view kKeepers[] = {"surface", "displacement", "interior", "light"};

} // namespace

Param connectionParam(const Connection& c) {
    Param p;
    p.name = std::string(kMark) + c.parameter + (c.element < 0 ? "" : "[" + std::to_string(c.element) + "]");
    p.type = Type::String;
    p.arrayLength = 2;
    p.strings = {c.handle, c.output};
    p.place = c.place;
    return p;
}

std::optional<Connection> connectionOf(const Param& p) {
    if (!p.name.starts_with(kMark) || p.strings.size() != 2) return {};
    Connection c{p.name.substr(kMark.size()), -1, p.strings[0], p.strings[1], p.place};
    if (const size_t bracket = c.parameter.find('['); bracket != std::string::npos) {
        std::from_chars(c.parameter.data() + bracket + 1, c.parameter.data() + c.parameter.size(), c.element);
        c.parameter.resize(bracket);
    }
    return c;
}

std::vector<Connection> connectionsOf(const ShaderCall& call) {
    std::vector<Connection> all;
    for (const Param& p : call.params)
        if (auto c = connectionOf(p)) all.push_back(std::move(*c));
    return all;
}

std::string keptHandle(Keeper k, std::string_view handle) {
    return std::string(kKeepers[size_t(k)]) + kSeparator + std::string(handle);
}

bool isKept(std::string_view key) { return key.find(kSeparator) != key.npos; }

std::string_view plainHandle(std::string_view key) {
    const size_t at = key.find(kSeparator);
    return at == key.npos ? key : key.substr(at + 1);
}

} // namespace alpenglow::scene
