#include "base/filternames.h"

namespace alpenglow {
namespace {

/// Lower case, letters and digits only, without the frame of the C functions' names.
std::string reduced(std::string_view name) {
    std::string out;
    for (char c : name) {
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
        if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) out += c;
    }
    constexpr std::string_view kBegin = "ri", kEnd = "filter";
    if (out.size() > kBegin.size() + kEnd.size() && out.starts_with(kBegin) && out.ends_with(kEnd))
        out = out.substr(kBegin.size(), out.size() - kBegin.size() - kEnd.size());
    return out;
}

} // namespace

std::string filterNameOf(std::string_view spelled) {
    static constexpr const char* kNames[] = {
        "box",      "triangle", "catmull-rom", "separable-catmull-rom", "b-spline",       "gaussian", "sinc", "bessel", "disk",
        "mitchell", "lanczos",  "point",       "radial-bspline",        "blackman-harris"};
    static constexpr std::pair<const char*, const char*> kOthers[] = {
        {"tent", "triangle"}, {"bartlett", "triangle"}, {"catmull", "catmull-rom"}};
    const std::string plain = reduced(spelled);
    for (const char* name : kNames)
        if (plain == reduced(name)) return name;
    for (const auto& [other, name] : kOthers)
        if (plain == other) return name;
    return std::string(spelled);
}

} // namespace alpenglow
