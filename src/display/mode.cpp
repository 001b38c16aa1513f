#include "display/mode.h"
#include <algorithm>
#include <cstdlib>
#include <set>

namespace alpenglow::display {
namespace {

using scene::Type;

constexpr std::pair<const char*, Type> typeNames[] = {
    {"float", Type::Float},   {"integer", Type::Integer}, {"int", Type::Integer},
    {"color", Type::Color},   {"point", Type::Point},     {"vector", Type::Vector},
    {"normal", Type::Normal}, {"hpoint", Type::HPoint},   {"matrix", Type::Matrix}};
constexpr const char* classNames[] = {"constant", "uniform", "varying", "vertex", "facevarying", "facevertex"};

/// Predefined variables of RSL that can be shown (RISpec 3.2, 12.1).
constexpr std::pair<const char*, Type> predefined[] = {
    {"Ci", Type::Color},    {"Oi", Type::Color},       {"Cs", Type::Color},    {"Os", Type::Color}, {"P", Type::Point},
    {"E", Type::Point},     {"N", Type::Normal},       {"Ng", Type::Normal},   {"I", Type::Vector}, {"dPdu", Type::Vector},
    {"dPdv", Type::Vector}, {"dPdtime", Type::Vector}, {"L", Type::Vector},    {"s", Type::Float},  {"t", Type::Float},
    {"u", Type::Float},     {"v", Type::Float},        {"du", Type::Float},    {"dv", Type::Float}, {"time", Type::Float},
    {"dtime", Type::Float}, {"alpha", Type::Float},    {"ncomps", Type::Float}};

std::vector<std::string> words(const std::string& s, const char* separators) {
    std::vector<std::string> out;
    for (size_t i = 0; i < s.size();) {
        size_t j = std::min(s.find_first_of(separators, i), s.size());
        if (j > i) out.push_back(s.substr(i, j - i));
        i = j + 1;
    }
    return out;
}

constexpr const char* kLightPath = "lpe:"; ///< an output by light path (docs/lightpaths.md)

/// The parts of a mode. Commas of a light path expression ("{2,4}", "'a,b'") do not end one.
std::vector<std::string> partsOf(const std::string& mode) {
    std::vector<std::string> out(1);
    bool quoted = false;
    int braces = 0;
    for (const char c : mode) {
        const size_t begin = out.back().find_first_not_of(" \t\r\n");
        const bool path = begin != std::string::npos && out.back().compare(begin, 4, kLightPath) == 0;
        if (path) quoted ^= c == '\'', braces += (c == '{') - (c == '}');
        if (c != ',' || (path && (quoted || braces > 0))) {
            out.back() += c;
        } else {
            out.emplace_back();
            quoted = false;
            braces = 0;
        }
    }
    return out;
}

bool isIdentifier(const std::string& s) {
    if (s.empty() || s.size() > 255) return false;
    for (char c : s)
        if (!(std::isalnum((unsigned char)c) || c == '_' || c == ':' || c == '.' || c == '-')) return false;
    return !std::isdigit((unsigned char)s[0]) && s[0] != '-' && s[0] != '.';
}

/// "[12]", an element of an array.
bool isElement(const std::string& s) {
    return s.size() > 2 && s.size() < 7 && s[0] == '[' && s.back() == ']' &&
           std::all_of(s.begin() + 1, s.end() - 1, [](unsigned char c) { return std::isdigit(c); });
}

/// Removes the index from "list[1]".
std::string withoutElement(const std::string& s) { return s.substr(0, s.find('[')); }

void nameChannels(ModeVariable& v) {
    static constexpr const char* rgb[] = {".r", ".g", ".b"};
    static constexpr const char* xyz[] = {".x", ".y", ".z"};
    v.channels.clear();
    int n = std::max(1, v.arrayLength) * scene::componentCount(v.type);
    if (n == 1) v.channels = {v.name};
    else if (v.arrayLength == 0 && n == 3)
        for (int i = 0; i < 3; ++i) v.channels.push_back(v.name + (v.type == Type::Color ? rgb[i] : xyz[i]));
    else
        for (int i = 0; i < n; ++i) {
            std::string digits = std::to_string(i);
            v.channels.push_back(v.name + "." + std::string(digits.size() < 3 ? 3 - digits.size() : 0, '0') + digits);
        }
}

/// rgb, rgba, rgbz, rgbaz, a, z, az; the first four in capitals, too.
bool standardMode(const std::string& given, std::vector<ModeVariable>& out) {
    static constexpr const char* modes[] = {"rgb", "rgba", "rgbz", "rgbaz", "a", "z", "az"};
    std::string m = given;
    if (given.starts_with("RGB")) // a capital A or Z alone may be a variable
        for (char& c : m) c = char(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    if (std::find(std::begin(modes), std::end(modes), m) == std::end(modes)) return false;
    if (m.rfind("rgb", 0) == 0) out.push_back({"Ci", Type::Color, 0, true, {"r", "g", "b"}});
    if (m.find('a') != std::string::npos) out.push_back({"alpha", Type::Float, 0, true, {"a"}});
    if (m.find('z') != std::string::npos) out.push_back({"z", Type::Float, 0, true, {"z"}});
    return true;
}

} // namespace

bool parseDeclaration(const std::string& text, ModeVariable& v) {
    // Both "color[2] c" and "color [2] c" occur: brackets become separate words.
    std::string spaced;
    for (char c : text) spaced += c == '[' ? std::string(" [") : c == ']' ? std::string("] ") : std::string(1, c);
    std::vector<std::string> w = words(spaced, " \t\r\n");
    size_t i = 0;
    if (i < w.size() && std::find(std::begin(classNames), std::end(classNames), w[i]) != std::end(classNames)) ++i;
    if (i >= w.size()) return false;
    auto type = std::find_if(std::begin(typeNames), std::end(typeNames), [&](auto& t) { return w[i] == t.first; });
    if (type == std::end(typeNames)) return false;
    ++i;
    int length = 0;
    if (i < w.size() && w[i][0] == '[') {
        char* end = nullptr;
        long n = std::strtol(w[i].c_str() + 1, &end, 10);
        if (*end != ']' || n < 1 || n > 1024) return false;
        length = int(n);
        ++i;
    }
    const bool element = i + 2 == w.size() && length == 0 && isElement(w[i + 1]);
    if (i + (element ? 2 : 1) != w.size() || !isIdentifier(w[i])) return false;
    v.name = element ? w[i] + w[i + 1] : w[i];
    v.type = type->second;
    v.arrayLength = length;
    v.declared = true;
    nameChannels(v);
    return true;
}

std::vector<ModeVariable> parseMode(const std::string& mode, Diagnostics& diags, const SourcePlace& place,
                                    const std::map<std::string, scene::Param>& displayChannels) {
    std::vector<ModeVariable> out;
    std::set<std::string> seen;
    auto add = [&](ModeVariable v) {
        // Ci may be "rgb" or a name; channels must be unique.
        for (const std::string& c : v.channels)
            if (!seen.insert(c).second) {
                diags.report(Severity::Warning, Rie::Consistency, place,
                             "display mode \"" + mode + "\" names \"" + c + "\" twice; it is written once");
                return;
            }
        out.push_back(std::move(v));
    };
    for (const std::string& part : partsOf(mode)) {
        std::vector<std::string> w = words(part, " \t\r\n");
        if (w.empty()) continue;
        ModeVariable v;
        if (w[0].starts_with(kLightPath)) {
            v.name = part.substr(part.find(kLightPath));
            v.name.resize(v.name.find_last_not_of(" \t\r\n") + 1);
            v.type = Type::Color;
            v.declared = true;
            nameChannels(v);
            add(v);
            continue;
        }
        std::vector<ModeVariable> standard;
        if (parseDeclaration(part, v)) {
            add(v);
            continue;
        }
        for (const std::string& name : w) {
            standard.clear();
            v = {};
            if (standardMode(name, standard)) {
                for (auto& s : standard) add(s);
                continue;
            }
            const std::string base = withoutElement(name);
            const bool element = base != name;
            const bool type = std::any_of(std::begin(typeNames), std::end(typeNames), [&](auto& t) { return base == t.first; });
            if (!isIdentifier(base) || (element && (type || !isElement(name.substr(base.size()))))) {
                diags.report(
                    Severity::Error, Rie::BadToken, place, "display mode \"" + mode + "\": \"" + part + "\" is not understood",
                    "modes are rgb rgba rgbz rgbaz a z az, names of output variables, \"varying color name\", or a light "
                    "path \"lpe:...\"");
                break;
            }
            v.name = name;
            if (auto c = displayChannels.find(displayChannels.count(name) ? name : base); c != displayChannels.end()) {
                v.type = c->second.type == Type::String ? Type::Color : c->second.type;
                v.arrayLength = element && c->first == base ? 0 : c->second.arrayLength;
                v.declared = true;
            } else {
                auto p = std::find_if(std::begin(predefined), std::end(predefined), [&](auto& q) { return name == q.first; });
                v.declared = p != std::end(predefined);
                v.type = v.declared ? p->second : Type::Color;
            }
            nameChannels(v);
            if (name == "Ci" && v.type == Type::Color) v.channels = {"r", "g", "b"};
            if (name == "alpha") v.channels = {"a"};
            add(v);
        }
    }
    if (out.empty()) {
        if (!words(mode, " ,\t\r\n").empty())
            diags.report(Severity::Error, Rie::BadToken, place, "display mode \"" + mode + "\" names no variable; rgba is used");
        standardMode("rgba", out);
    }
    return out;
}

std::vector<std::string> channelNames(const std::vector<ModeVariable>& mode) {
    std::vector<std::string> names;
    for (auto& v : mode) names.insert(names.end(), v.channels.begin(), v.channels.end());
    return names;
}

} // namespace alpenglow::display
