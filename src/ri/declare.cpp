#include "ri/declare.h"
#include "base/diagnostics.h"
#include "base/knownoptions.h"
#include <algorithm>
#include <charconv>
#include <limits>
#include <vector>

namespace alpenglow::ri {
namespace {

using scene::Class;
using scene::Type;

struct Known {
    const char* name;
    const char* declaration;
};

// RISpec 3.2, section 3, and the variables and parameters that files use as if they were there.
constexpr Known kStandard[] = {
    {"P", "vertex point"},
    {"Pz", "vertex float"},
    {"Pw", "vertex hpoint"},
    {"N", "varying normal"},
    {"Np", "uniform normal"},
    {"Cs", "varying color"},
    {"Os", "varying color"},
    {"s", "varying float"},
    {"t", "varying float"},
    {"st", "varying float[2]"},
    {"u", "varying float"},
    {"v", "varying float"},
    {"width", "varying float"},
    {"constantwidth", "constant float"},
    {"Ka", "float"},
    {"Kd", "float"},
    {"Ks", "float"},
    {"Kr", "float"},
    {"Km", "float"},
    {"roughness", "float"},
    {"intensity", "float"},
    {"coneangle", "float"},
    {"conedeltaangle", "float"},
    {"beamdistribution", "float"},
    {"mindistance", "float"},
    {"maxdistance", "float"},
    {"distance", "float"},
    {"fov", "float"},
    {"amplitude", "float"},
    {"texturename", "string"},
    {"specularcolor", "color"},
    {"lightcolor", "color"},
    {"background", "color"},
    {"bgcolor", "color"},
    {"from", "point"},
    {"to", "point"},
    // Display, Hider and archive parameters
    {"jitter", "int"},
    {"aaSamples", "int"},
    {"aaThreshold", "float"},
    {"depthfilter", "string"},
    {"quantize", "float[4]"},
    {"dither", "float"},
    {"filter", "string"},
    {"filterwidth", "float[2]"},
    {"exposure", "float[2]"},
    {"colorprofile", "string"},
    {"compression", "string"},
    {"subset", "string"},
    {"operation", "string"},
    {"emit", "int"},
};

using Table = std::map<std::string, Declaration, std::less<>>;

template <size_t N> Table makeTable(const Known (&rows)[N]) {
    Table t;
    for (const Known& k : rows) t[k.name] = *parseDeclaration(k.declaration);
    return t;
}

/// Types of options and attributes, keyed "class:name"; empty: numbers in one file, strings in another, so the value decides.
/// Names of other renderers without a type are not here: they are noted at -v.
using KnownTypes = std::map<std::string, std::optional<Declaration>, std::less<>>;

KnownTypes implementationTypes() {
    KnownTypes t;
    for (auto table : {known::knownOptions(), known::knownAttributes()})
        for (const known::OptionDescription& d : table)
            if (!d.type.empty() || d.settable()) t[std::string(d.name)] = parseDeclaration(d.type);
    return t;
}

bool space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f'; }

/// Words; a bracketed length, spaced or not, is a word of its own.
std::vector<std::string_view> words(std::string_view s) {
    std::vector<std::string_view> w;
    size_t i = 0;
    while (i < s.size()) {
        if (space(s[i])) {
            ++i;
            continue;
        }
        size_t from = i;
        if (s[i] == '[') {
            while (i < s.size() && s[i] != ']') ++i;
            if (i < s.size()) ++i;
        } else {
            while (i < s.size() && !space(s[i]) && s[i] != '[') ++i;
        }
        w.push_back(s.substr(from, i - from));
    }
    return w;
}

std::optional<Class> classNamed(std::string_view s) {
    if (s == "constant") return Class::Constant;
    if (s == "uniform") return Class::Uniform;
    if (s == "varying") return Class::Varying;
    if (s == "vertex") return Class::Vertex;
    if (s == "facevarying") return Class::FaceVarying;
    if (s == "facevertex") return Class::FaceVertex;
    return {};
}

constexpr OtherType kOtherTypes[] = {
    {"double", "float", "declare the variable as float"}, // of exporters that name the numbers of their program
    {"shader", "string", "a parameter of type shader takes the handle of a co-shader, which is a string"},
};

std::optional<Type> typeNamed(std::string_view s) {
    for (const OtherType& o : kOtherTypes)
        if (s == o.written) return typeNamed(o.meant);
    if (s == "float") return Type::Float;
    if (s == "integer" || s == "int") return Type::Integer;
    if (s == "string") return Type::String;
    if (s == "color") return Type::Color;
    if (s == "point") return Type::Point;
    if (s == "vector") return Type::Vector;
    if (s == "normal") return Type::Normal;
    if (s == "hpoint") return Type::HPoint;
    if (s == "mpoint") return Type::HPoint; // a blob's matrix as its rows: an array of four hpoints (fromWords)
    if (s == "matrix") return Type::Matrix;
    return {};
}

std::optional<Declaration> fromWords(const std::vector<std::string_view>& w) {
    Declaration d;
    size_t i = 0;
    if (i < w.size())
        if (auto c = classNamed(w[i])) {
            d.cls = *c;
            ++i;
        }
    if (i >= w.size()) return {};
    auto t = typeNamed(w[i]);
    if (!t) return {};
    d.type = *t;
    const int each = w[i] == "mpoint" ? 4 : 1;
    ++i;
    if (i < w.size()) {
        std::string_view n = w[i];
        if (n.size() < 3 || n.front() != '[' || n.back() != ']') return {};
        n = n.substr(1, n.size() - 2);
        while (!n.empty() && space(n.front())) n.remove_prefix(1);
        while (!n.empty() && space(n.back())) n.remove_suffix(1);
        auto r = std::from_chars(n.data(), n.data() + n.size(), d.arrayLength);
        if (r.ec != std::errc() || r.ptr != n.data() + n.size() || d.arrayLength < 1) return {};
        if (d.arrayLength > std::numeric_limits<int>::max() / each) return {};
        ++i;
    }
    if (each > 1) d.arrayLength = each * std::max(1, d.arrayLength);
    if (i != w.size()) return {};
    return d;
}

} // namespace

std::optional<Declaration> parseDeclaration(std::string_view text) { return fromWords(words(text)); }

const OtherType* otherTypeIn(std::string_view text) {
    for (const std::string_view w : words(text))
        for (const OtherType& o : kOtherTypes)
            if (w == o.written) return &o;
    return nullptr;
}

std::string declarationHint(std::string_view text, bool named, std::string_view form) {
    static const std::vector<std::string> kWords = {"constant",   "uniform", "varying", "vertex", "facevarying",
                                                    "facevertex", "float",   "integer", "string", "color",
                                                    "point",      "vector",  "normal",  "hpoint", "matrix"};
    std::vector<std::string_view> all = words(text);
    if (named && !all.empty()) all.pop_back();
    for (const std::string_view w : all)
        if (!classNamed(w) && !typeNamed(w) && w.front() != '[')
            if (const std::string near = nearestName(w, kWords); !near.empty()) return "did you mean " + near + "?";
    return std::string(form);
}

const Resolved& Declarations::resolve(std::string_view token, std::string_view category) const {
    constexpr size_t kMost = 1024; // of a hostile file
    if (!category.empty()) return last_ = found(token, category);
    if (const auto i = seen_.find(token); i != seen_.end()) return i->second;
    if (seen_.size() >= kMost) seen_.clear();
    return seen_.emplace(token, found(token, category)).first->second;
}

Resolved Declarations::found(std::string_view token, std::string_view category) const {
    static const Table standard = makeTable(kStandard);
    static const KnownTypes implementation = implementationTypes();
    Resolved r;
    std::vector<std::string_view> w = words(token);
    if (w.size() > 1) {
        r.inlineForm = true;
        // The name is last; a length behind it ("float x[2]") is read as the type's.
        size_t nameAt = w.size() - 1;
        if (w[nameAt].front() == '[' && nameAt > 0) --nameAt;
        r.name = std::string(w[nameAt]);
        w.erase(w.begin() + std::ptrdiff_t(nameAt));
        r.declaration = fromWords(w);
        for (const std::string_view word : w)
            if (!r.otherType) r.otherType = otherTypeIn(word);
        r.malformed = !r.declaration;
        return r;
    }
    r.name = w.empty() ? std::string() : std::string(w[0]);
    if (r.name.empty()) {
        r.malformed = true;
        return r;
    }
    if (auto i = user_.find(r.name); i != user_.end()) {
        r.declaration = i->second;
        return r;
    }
    if (!category.empty()) {
        std::string key = std::string(category) + ":" + r.name;
        if (auto i = implementation.find(key); i != implementation.end()) {
            r.declaration = i->second;
            r.byValue = !r.declaration;
        }
        return r;
    }
    if (auto i = standard.find(r.name); i != standard.end()) r.declaration = i->second;
    return r;
}

const char* toString(scene::Class c) {
    switch (c) {
    case Class::Constant:
        return "constant";
    case Class::Uniform:
        return "uniform";
    case Class::Varying:
        return "varying";
    case Class::Vertex:
        return "vertex";
    case Class::FaceVarying:
        return "facevarying";
    case Class::FaceVertex:
        break;
    }
    return "facevertex";
}

const char* toString(scene::Type t) {
    switch (t) {
    case Type::Float:
        return "float";
    case Type::Integer:
        return "integer";
    case Type::String:
        return "string";
    case Type::Color:
        return "color";
    case Type::Point:
        return "point";
    case Type::Vector:
        return "vector";
    case Type::Normal:
        return "normal";
    case Type::HPoint:
        return "hpoint";
    case Type::Matrix:
        break;
    }
    return "matrix";
}

} // namespace alpenglow::ri
