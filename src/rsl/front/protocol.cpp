#include "rsl/front/protocol.h"
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>

namespace alpenglow::rsl {

namespace {

constexpr std::string_view kParameter = "param:", kDisplacementPrefix = "displacement:", kSpace = "space:", kMember = "this->",
                           kDu = "Du:", kDv = "Dv:", kGiven = "given:", kSlope = "slope:", kSent = "sent:",
                           kSurfacePrefix = "surface:", kLength = "length ", kLightHandle = "light#";

/// What stands before the name of a parameter that a value is sent to. The first of a shader is the one that is written.
constexpr std::pair<std::string_view, PairName::To> kSends[] = {{"send:light:", PairName::To::Light},
                                                                {"send:surface:", PairName::To::Surface},
                                                                {"send:displacement:", PairName::To::Displacement},
                                                                {"send:volume:", PairName::To::Volume},
                                                                {"send:atmosphere:", PairName::To::Volume}};

/// Takes a prefix off; false: it is not there.
bool take(std::string_view& s, std::string_view prefix) {
    if (!s.starts_with(prefix)) return false;
    s.remove_prefix(prefix.size());
    return true;
}
bool takeLast(std::string_view& s, char c) {
    if (s.empty() || s.back() != c) return false;
    s.remove_suffix(1);
    return true;
}
/// The number behind `mark`, which with it is taken off; -1: none.
int takeNumber(std::string_view& s, char mark) {
    const size_t at = s.find(mark);
    if (at == std::string_view::npos) return -1;
    int n = -1;
    std::from_chars(s.data() + at + 1, s.data() + s.size(), n);
    if (n >= 0) s = s.substr(0, at);
    return n;
}
std::string elementOf(const std::string& text, int element) {
    return element < 0 ? text : text + "[" + std::to_string(element) + "]";
}

} // namespace

InputName InputName::parse(std::string_view s) {
    if (take(s, kSpace)) {
        const size_t arrow = s.find('>');
        return space(s.substr(0, arrow), arrow == std::string_view::npos ? std::string_view() : s.substr(arrow + 1));
    }
    if (take(s, kParameter)) return parameter(s);
    if (take(s, kSent)) {
        const bool length = takeLast(s, '#');
        return sent(s, length);
    }
    if (!take(s, kDisplacementPrefix)) return {Kind::Variable, std::string(s), false, false, {}, {}};
    if (!take(s, kMember)) return displacement(s);
    const bool length = takeLast(s, '#');
    return left(s, length);
}

std::string InputName::text() const {
    std::string t;
    switch (kind) {
    case Kind::Variable:
        return name;
    case Kind::Parameter:
        t = kParameter;
        break;
    case Kind::Displacement:
        t = kDisplacementPrefix;
        break;
    case Kind::Sent:
        t = kSent;
        break;
    case Kind::Space:
        return std::string(kSpace) + from + ">" + to;
    }
    if (member) t += kMember;
    t += name;
    return length ? t + "#" : t;
}

OutputName OutputName::parse(std::string_view s) {
    OutputName o;
    o.what = take(s, kDu)      ? What::Du
             : take(s, kDv)    ? What::Dv
             : take(s, kGiven) ? What::Given
             : take(s, kSlope) ? What::Slope
                               : What::Value;
    o.parameter = take(s, kParameter);
    o.member = o.parameter && take(s, kMember);
    o.length = o.member && takeLast(s, '#');
    if (!s.empty() && s.back() == ']') o.element = takeNumber(s, '[');
    if (!o.parameter)
        if (const int block = takeNumber(s, '#'); block > 0) o.block = block;
    o.name = s;
    return o;
}

std::string_view OutputName::givenName(std::string_view s) { return take(s, kGiven) ? s : std::string_view(); }

std::string OutputName::text() const {
    std::string t(what == What::Du      ? kDu
                  : what == What::Dv    ? kDv
                  : what == What::Given ? kGiven
                  : what == What::Slope ? kSlope
                                        : std::string_view());
    if (parameter) t += kParameter;
    if (member) t += kMember;
    t += name;
    if (length) t += "#";
    if (block > 0) t += "#" + std::to_string(block);
    return elementOf(t, element);
}

std::optional<QueriedOutput> QueriedOutput::parse(const std::string& text) {
    QueriedOutput h;
    int varying = 0;
    if (std::sscanf(text.c_str(), "%d %d %d", &h.kind, &h.length, &varying) != 3) return std::nullopt;
    h.varying = varying != 0;
    return h;
}
std::string QueriedOutput::text() const {
    return std::to_string(kind) + " " + std::to_string(length) + " " + std::to_string(int(varying));
}

QueriedMember QueriedMember::parse(const std::string& text) {
    return {std::atoi(text.c_str()), text.find("length") != std::string::npos};
}
std::string QueriedMember::text() const { return std::to_string(count) + (length ? " length" : ""); }

std::string lengthParameter(std::string_view array) { return std::string(array) + "[]"; }
bool isLengthParameter(std::string_view name) { return name.ends_with("[]"); }

PairName PairName::parse(std::string_view s) {
    if (take(s, kSurfacePrefix)) return surface(s);
    for (const auto& [prefix, to] : kSends) {
        if (!take(s, prefix)) continue;
        const bool length = takeLast(s, '#');
        const int element = takeNumber(s, '[');
        return send(s, element, to, length);
    }
    return {Kind::Plain, std::string(s), -1, To::Light, false};
}
std::string PairName::text() const {
    std::string t(kind == Kind::Surface ? kSurfacePrefix : std::string_view());
    if (kind == Kind::Send)
        t = std::find_if(std::begin(kSends), std::end(kSends), [&](const auto& s) { return s.second == to; })->first;
    return elementOf(t + name, element) + (length ? "#" : "");
}

std::string lengthResult(std::string_view name) { return std::string(kLength) + std::string(name); }
bool isLengthResult(std::string_view name) { return name.starts_with(kLength); }
bool isElementResult(std::string_view name) { return !name.empty() && name.back() == ']'; }

ChannelName ChannelName::parse(std::string_view s) {
    const bool kept = take(s, kKeptChannels[0]) || take(s, kKeptChannels[1]);
    return {std::string(s), kept};
}

std::optional<LightHandle> LightHandle::parse(std::string_view s) {
    if (!take(s, kLightHandle)) return std::nullopt;
    LightHandle h;
    std::from_chars(s.data(), s.data() + s.size(), h.light);
    const size_t colon = s.find(':');
    h.declared = colon == std::string_view::npos ? std::string(kLightHandle) + std::string(s) : std::string(s.substr(colon + 1));
    return h;
}
std::string LightHandle::text() const { return std::string(kLightHandle) + std::to_string(light) + ":" + declared; }

std::string shownHandle(const std::string& handle) {
    if (handle.empty()) return "<null>";
    const auto light = LightHandle::parse(handle);
    return light ? light->declared : handle;
}

} // namespace alpenglow::rsl
