#include "world/fitparameter.h"
#include "base/limits.h"
#include <algorithm>

namespace alpenglow::world {
namespace {

using shadeops::Base;

Base baseOf(scene::Type t) {
    switch (t) {
    case scene::Type::Float:
    case scene::Type::Integer:
        return Base::Float;
    case scene::Type::String:
        return Base::String;
    case scene::Type::Color:
        return Base::Color;
    case scene::Type::Vector:
        return Base::Vector;
    case scene::Type::Normal:
        return Base::Normal;
    case scene::Type::Matrix:
        return Base::Matrix;
    default:
        return Base::Point;
    }
}

/// Types that old files interchange: RISpec had points only, and a matrix is often float[16].
bool alike(Base a, Base b) {
    const auto place = [](Base t) { return t == Base::Point || t == Base::Vector || t == Base::Normal; };
    return a == b || (place(a) && place(b)) || (a == Base::Float && b == Base::Matrix);
}

std::string with(const char* article, const std::string& what) { return std::string(article) + " " + what; }

/// A type in words of a message: "a float", "a color[3]", "an array of strings".
std::string shown(const rsl::ParameterInfo& p) {
    return p.open ? with("an", "array of " + shadeops::toString(p.type.element()) + "s") : with("a", shadeops::toString(p.type));
}

} // namespace

std::optional<rsl::ParameterValue> fitParameter(const scene::Param& given, const rsl::ParameterInfo& p, const std::string& shader,
                                                const SourcePlace& call, Diagnostics& d) {
    const bool text = p.type.base == Base::String, givenText = given.type == scene::Type::String;
    const size_t each = size_t(shadeops::componentCount(p.type.base)),
                 have = givenText ? given.strings.size() : given.numbers.size();
    size_t want = each * size_t(std::max(1, p.type.array));
    if (p.open && have >= each && have % each == 0) want = std::min(have, each * size_t(limits::kShaderArray));
    const shadeops::Type was{baseOf(given.type), given.arrayLength};
    const std::string head = "parameter \"" + given.name + "\" of shader \"" + shader + "\" is " + shown(p);
    const auto say = [&](Severity severity, const std::string& what) {
        d.reportOnce("parameter:" + shader + ":" + given.name + ":" + std::to_string(have) + shadeops::toString(was),
                     {severity, Rie::Consistency, given.place.file.empty() ? call : given.place, head + what, {}, {}});
    };
    const std::string otherType = ", not " + with("a", given.declared ? shadeops::toString(was)
                                                       : givenText    ? "string"
                                                                      : "number");
    if (text != givenText && have > 0) {
        say(Severity::Error, otherType + "; its default is used");
        return std::nullopt;
    }
    rsl::ParameterValue value{given.name, p.type, given.numbers, given.strings};
    const bool sameType = !given.declared || alike(was.base, p.type.base);
    const bool grey = p.type.base == Base::Color && !p.type.array && !p.open && have == 1;
    if (grey) {
        if (!sameType) say(Severity::Warning, otherType + "; a grey is taken");
        value.numbers.assign(3, given.numbers[0]);
        return value;
    }
    const bool tooLong = p.open && have > want && have % each == 0; // the first elements are used
    if (have != want && !tooLong) {
        const std::string unit = text ? (want == 1 ? " string" : " strings") : want == 1 ? " number" : " numbers";
        say(Severity::Error,
            (sameType ? ": it takes " + std::to_string(want) + unit + ", not " + std::to_string(have) : otherType) +
                "; its default is used");
        return std::nullopt;
    }
    if (!sameType) say(Severity::Warning, otherType + "; its numbers are taken");
    if (text) value.strings.resize(want);
    else value.numbers.resize(want);
    return value;
}

} // namespace alpenglow::world
