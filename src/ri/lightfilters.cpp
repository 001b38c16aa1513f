#include "ri/lightfilters.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <sstream>

namespace alpenglow::ri {
namespace {

enum Kind { IntMult = 1, Barn, Gobo, Rod, Ramp };

/// The place of a parameter in the row: `count` numbers from `at` on. `size` above 0: an array of so many, at most kFilterKnots.
struct FilterParameter {
    const char* name;
    size_t at, count;
    float fallback;
};
constexpr size_t kCombine = 1, kMatrix = 2, kDensity = 18, kIntensity = 20, kRadius = 26, kRampCount = 56, kRampKnots = 57,
                 kRampColors = 73;
constexpr FilterParameter kAll[] = {{"density", kDensity, 1, 1}, {"invert", 19, 1, 0},     {"intensity", kIntensity, 1, 1},
                                    {"exposure", 21, 1, 0},      {"saturation", 22, 1, 1}, {"width", 23, 1, 1},
                                    {"height", 24, 1, 1},        {"depth", 25, 1, 1},      {"radius", kRadius, 1, .5f},
                                    {"edge", 27, 1, 0},          {"left", 28, 1, 0},       {"right", 29, 1, 0},
                                    {"bottom", 30, 1, 0},        {"top", 31, 1, 0},        {"back", 32, 1, 0},
                                    {"front", 33, 1, 0},         {"barnMode", 34, 1, 0},   {"cookieMode", 34, 1, 0},
                                    {"directional", 35, 1, 0},   {"shearX", 36, 1, 0},     {"shearY", 37, 1, 0},
                                    {"apex", 38, 1, 25},         {"preBarn", 39, 1, 0},    {"invertU", 40, 1, 0},
                                    {"invertV", 41, 1, 0},       {"fillColor", 42, 3, 1},  {"scaleU", 45, 1, 1},
                                    {"scaleV", 46, 1, 1},        {"offsetU", 47, 1, 0},    {"offsetV", 48, 1, 0},
                                    {"tileMode", 49, 1, 0},      {"tint", 50, 3, 1},       {"rampType", 53, 1, 0},
                                    {"beginDist", 54, 1, 0},     {"endDist", 55, 1, 10}};
constexpr std::pair<const char*, Kind> kKinds[] = {{"PxrIntMultLightFilter", IntMult}, {"PxrBarnLightFilter", Barn},
                                                   {"PxrGoboLightFilter", Gobo},       {"PxrCookieLightFilter", Gobo},
                                                   {"PxrRodLightFilter", Rod},         {"PxrBlockerLightFilter", Rod},
                                                   {"PxrRampLightFilter", Ramp}};

float combineMode(const scene::Param* p) {
    static constexpr const char* kModes[] = {"mult", "max", "min", "screen"};
    if (!p) return 0;
    if (!p->numbers.empty()) return p->numbers[0];
    for (size_t i = 0; i < std::size(kModes); ++i)
        if (!p->strings.empty() && p->strings[0] == kModes[i]) return float(i);
    return 0;
}

/// The knots of a ramp: colours, or numbers as greys; without any from 1 to 0.
void putRamp(std::vector<float>& row, const scene::ParamList& given) {
    const auto array = [&](const char* a, const char* b) {
        const scene::Param* p = scene::find(given, a);
        return p ? p : scene::find(given, b);
    };
    const scene::Param* knots = array("ramp_Knots", "colorRamp_Knots");
    const scene::Param* colors = array("ramp_Colors", "colorRamp_Colors");
    const scene::Param* floats = array("ramp_Floats", "falloff_Floats");
    const size_t have = colors ? colors->numbers.size() / 3 : floats ? floats->numbers.size() : 0;
    const size_t n = knots ? std::min({knots->numbers.size(), have, kFilterKnots}) : 0;
    row[kRampCount] = n ? float(n) : 2;
    if (n == 0) {
        row[kRampKnots + 1] = 1;
        std::fill_n(row.begin() + kRampColors, 3, 1.f);
    }
    for (size_t i = 0; i < n; ++i) {
        row[kRampKnots + i] = knots->numbers[i];
        for (size_t k = 0; k < 3; ++k) row[kRampColors + 3 * i + k] = colors ? colors->numbers[3 * i + k] : floats->numbers[i];
    }
}

} // namespace

std::optional<LightFilter> lightFilter(const std::string& name, const scene::ParamList& given, const Matrix& toFilter) {
    const auto kind = std::find_if(std::begin(kKinds), std::end(kKinds), [&](const auto& k) { return name == k.first; });
    if (kind == std::end(kKinds)) return {};
    LightFilter f;
    f.row.assign(kFilterRow, 0);
    f.row[0] = float(kind->second);
    f.row[kCombine] = combineMode(scene::find(given, "combineMode"));
    for (size_t i = 0; i < 16; ++i) f.row[kMatrix + i] = float(toFilter.m[i / 4][i % 4]);
    for (const FilterParameter& p : kAll) {
        const scene::Param* const value = scene::find(given, p.name);
        for (size_t i = 0; i < p.count; ++i)
            if (value && i < value->numbers.size() && std::isfinite(value->numbers[i])) f.row[p.at + i] = value->numbers[i];
            else if (!value && f.row[p.at + i] == 0) f.row[p.at + i] = p.fallback;
    }
    if (kind->second == Rod && !scene::find(given, "intensity")) f.row[kIntensity] = 0; // it blocks
    putRamp(f.row, given);
    if (const scene::Param* map = scene::find(given, "map"); map && !map->strings.empty()) f.map = map->strings[0];
    if (const scene::Param* groups = scene::find(given, "linkingGroups"); groups && !groups->strings.empty())
        f.groups = groups->strings[0];
    return f;
}

std::optional<std::vector<float>> lightProfile(const std::string& text, std::string& why) {
    constexpr size_t kAngles = 1024; // in one direction
    const auto refuse = [&](const char* what) {
        why = what;
        return std::nullopt;
    };
    const size_t tilt = text.find("TILT=");
    if (tilt == std::string::npos) return refuse("it has no line TILT=");
    const size_t line = text.find('\n', tilt);
    if (line == std::string::npos) return refuse("it ends behind TILT=");
    std::string rest = text.substr(line);
    std::replace(rest.begin(), rest.end(), ',', ' ');
    std::istringstream in(rest);
    if (text.compare(tilt + 5, 7, "INCLUDE") == 0) { // what lamps lose when they are turned: how to read over it
        double geometry = 0, count = 0, skipped = 0;
        if (!(in >> geometry >> count) || count < 0 || count > double(kAngles)) return refuse("its TILT is damaged");
        for (double k = 0; k < 2 * count; ++k) in >> skipped;
    }
    std::array<double, 13> head{};
    for (double& h : head)
        if (!(in >> h)) return refuse("its thirteen numbers behind TILT are damaged");
    const double across = head[3], around = head[4];
    if (head[5] != 1) return refuse("it is no photometry of type C");
    if (!(across >= 2 && around >= 1 && across <= double(kAngles) && around <= double(kAngles)))
        return refuse("its numbers of angles are damaged");
    std::vector<float> out{float(across), float(around)};
    const size_t angles = size_t(across) + size_t(around), values = size_t(across) * size_t(around);
    double v = 0;
    for (size_t i = 0; i < angles + values; ++i) {
        if (!(in >> v) || !std::isfinite(v) || std::fabs(v) > 1e30) return refuse("it has fewer numbers than it says");
        out.push_back(float(v));
    }
    for (size_t i = 1; i < angles; ++i)
        if (i != size_t(across) && !(out[2 + i] > out[1 + i])) return refuse("its angles do not grow");
    const auto first = out.begin() + std::ptrdiff_t(2 + angles);
    const float most = *std::max_element(first, out.end());
    if (!(most > 0)) return refuse("it is dark");
    for (auto i = first; i != out.end(); ++i) *i = std::max(*i, 0.f) / most;
    return out;
}

} // namespace alpenglow::ri
