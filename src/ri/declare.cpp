#include "ri/declare.h"
#include <charconv>
#include <vector>

namespace alpenglow::ri {
namespace {

using scene::Class;
using scene::Type;

struct Known {
    const char* name;
    const char* declaration;
};

// ri.md 2.3, and the variables and parameters that files use as if they were there.
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

// ri.md 15: names of options and attributes, keyed "class:name". A name that is numbers here and strings there is absent:
// its value decides.
constexpr Known kImplementation[] = {
    {"searchpath:shader", "string"},
    {"searchpath:texture", "string"},
    {"searchpath:archive", "string"},
    {"searchpath:procedural", "string"},
    {"searchpath:display", "string"},
    {"searchpath:resource", "string"},
    {"searchpath:rslplugin", "string"},
    {"limits:bucketsize", "int[2]"},
    {"limits:gridsize", "int"},
    {"limits:eyesplits", "int"},
    {"limits:texturememory", "int"},
    {"limits:texturesample", "int"},
    {"limits:othreshold", "color"},
    {"limits:zthreshold", "color"},
    {"limits:brickmemory", "int"},
    {"limits:numthreads", "int"},
    {"trace:maxdepth", "int"},
    {"shadow:sample", "int"},
    {"shadow:bias", "float"},
    {"shadow:bias0", "float"},
    {"shadow:bias1", "float"},
    {"render:bucketorder", "string"},
    {"render:nthreads", "int"},
    {"shutter:offset", "float"},
    {"shutter:shutteropening", "float[2]"},
    {"statistics:endofframe", "int"},
    {"statistics:filename", "string"},
    {"statistics:progress", "int"},
    {"hider:jitter", "int"},
    {"hider:depthfilter", "string"},
    {"ribparse:varsubst", "string"},
    {"netcache:directory", "string"},
    {"netcache:size", "int"},
    {"photon:emit", "int"},
    {"identifier:name", "string"},
    {"identifier:shadinggroup", "string"},
    {"grouping:membership", "string"},
    {"grouping:tracesubset", "string"},
    {"visibility:camera", "int"},
    {"visibility:trace", "int"},
    {"visibility:diffuse", "int"},
    {"visibility:specular", "int"},
    {"visibility:subset", "string"},
    {"sides:doubleshaded", "int"},
    {"displacementbound:sphere", "float"},
    {"displacementbound:coordinatesystem", "string"},
    {"trace:bias", "float"},
    {"trace:displacements", "int"},
    {"trace:samplemotion", "int"},
    {"trace:maxdiffusedepth", "int"},
    {"trace:maxspeculardepth", "int"},
    {"shade:transmissionhitmode", "string"},
    {"shade:diffusehitmode", "string"},
    {"shade:specularhitmode", "string"},
    {"shade:camerahitmode", "string"},
    {"shade:derivatives", "string"},
    {"shade:strategy", "string"},
    {"shade:specular", "string"},
    {"irradiance:shadingrate", "float"},
    {"irradiance:nsamples", "int"},
    {"irradiance:handle", "string"},
    {"irradiance:filemode", "string"},
    {"irradiance:maxerror", "float"},
    {"irradiance:maxpixeldist", "float"},
    {"photon:globalmap", "string"},
    {"photon:causticmap", "string"},
    {"photon:shadingmodel", "string"},
    {"photon:estimator", "int"},
    {"subsurface:groupname", "string"},
    {"subsurface:scale", "float"},
    {"subsurface:refractionindex", "float"},
    {"subsurface:shadingrate", "float"},
    {"subsurface:absorption", "color"},
    {"subsurface:scattering", "color"},
    {"subsurface:meanfreepath", "color"},
    {"subsurface:reflectance", "color"},
    {"subsurface:samples", "int"},
    {"dice:rasterorient", "int"},
    {"dice:hair", "int"},
    {"dice:referencecamera", "string"},
    {"dice:strategy", "string"},
    {"dice:minlength", "float"},
    {"dice:binary", "int"},
    {"derivatives:smooth", "int"},
    {"derivatives:centered", "int"},
    {"cull:hidden", "int"},
    {"cull:backfacing", "int"},
    {"geometry:backfacing", "int"},
    {"geometry:frontfacing", "int"},
    {"geometry:geometricnormal", "int"},
    {"hider:composite", "int"},
    {"light:samples", "int"},
    {"light:samplingstrategy", "string"},
    {"light:units", "string"},
    {"light:emitphotons", "int"},
    {"trimcurve:sense", "string"},
};

// Numbers in one file, strings in another: the value decides.
constexpr const char* kByValue[] = {"visibility:transmission", "visibility:photon", "photon:estimator", "light:shadows",
                                    "shade:resolution"};

using Table = std::map<std::string, Declaration, std::less<>>;

template <size_t N> Table makeTable(const Known (&rows)[N]) {
    Table t;
    for (const Known& k : rows) t[k.name] = *parseDeclaration(k.declaration);
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

std::optional<Type> typeNamed(std::string_view s) {
    if (s == "float") return Type::Float;
    if (s == "integer" || s == "int") return Type::Integer;
    if (s == "string") return Type::String;
    if (s == "color") return Type::Color;
    if (s == "point") return Type::Point;
    if (s == "vector") return Type::Vector;
    if (s == "normal") return Type::Normal;
    if (s == "hpoint") return Type::HPoint;
    if (s == "matrix" || s == "mpoint") return Type::Matrix; // mpoint: a blob's matrix, also bare numbers
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
    ++i;
    if (i < w.size()) {
        std::string_view n = w[i];
        if (n.size() < 3 || n.front() != '[' || n.back() != ']') return {};
        n = n.substr(1, n.size() - 2);
        while (!n.empty() && space(n.front())) n.remove_prefix(1);
        while (!n.empty() && space(n.back())) n.remove_suffix(1);
        auto r = std::from_chars(n.data(), n.data() + n.size(), d.arrayLength);
        if (r.ec != std::errc() || r.ptr != n.data() + n.size() || d.arrayLength < 1) return {};
        ++i;
    }
    if (i != w.size()) return {};
    return d;
}

} // namespace

std::optional<Declaration> parseDeclaration(std::string_view text) { return fromWords(words(text)); }

Resolved Declarations::resolve(std::string_view token, std::string_view category) const {
    static const Table standard = makeTable(kStandard), implementation = makeTable(kImplementation);
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
        if (auto i = implementation.find(key); i != implementation.end()) r.declaration = i->second;
        for (const char* k : kByValue) r.byValue = r.byValue || key == k;
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
