#include "rsl/front/headers.h"
#include <algorithm>
#include <array>
#include <string>

namespace alpenglow::rsl::front {

namespace {

struct OtherName {
    std::string_view name, header;
};

// The same functions went round under several names.
constexpr OtherName kOtherNames[] = {
    {"rmannotes.sl", "rmannotes.h"},  {"rmannotes", "rmannotes.h"},       {"rmanotes.h", "rmannotes.h"},
    {"rmannotes2.h", "rmannotes.h"},  {"rmannotes2.sl", "rmannotes.h"},   {"rmnotes.h", "rmannotes.h"},
    {"noise.h", "noises.h"},          {"oldnoises.h", "noises.h"},        {"oldnoise.h", "noises.h"},
    {"noises.sl", "noises.h"},        {"fractal.h", "noises.h"},          {"fbm.h", "noises.h"},
    {"turbulence.h", "noises.h"},     {"voronoi.h", "noises.h"},          {"extranoise.h", "noises.h"},
    {"patterns.sl", "patterns.h"},    {"pattern.h", "patterns.h"},        {"pulse.h", "patterns.h"},
    {"filters.h", "patterns.h"},      {"filter.h", "patterns.h"},         {"materials.h", "material.h"},
    {"illum.h", "locillum.h"},        {"illumination.h", "locillum.h"},   {"oren_nayar.h", "locillum.h"},
    {"orennayar.h", "locillum.h"},    {"reflection.h", "reflections.h"},  {"refl.h", "reflections.h"},
    {"envmap.h", "reflections.h"},    {"filtwidth.h", "filterwidth.h"},   {"filter_width.h", "filterwidth.h"},
    {"displacement.h", "displace.h"}, {"projection.h", "project.h"},      {"projections.h", "project.h"},
    {"shadow.h", "shadows.h"},        {"rayserver_rsl.h", "rayserver.h"}, {"ray_sphere.h", "raysphere.h"},
    {"proctex.h", "proctext.h"},      {"util.h", "rmannotes.h"},          {"utils.h", "rmannotes.h"},
    {"utility.h", "rmannotes.h"},     {"math.h", "mathutil.h"},           {"mathutils.h", "mathutil.h"},
    {"dpproctext.h", "proctext.h"},   {"proctexh.h", "proctext.h"},       {"oaktexture.h", "oak.h"},
    {"bmrt.h", "rayserver.h"},        {"prman.h", "rayserver.h"},         {"stdrsl.h", "rmannotes.h"},
    {"pxslrayutil.h", "pxslutil.h"},  {"rfm_blinn.h", "pxslutil.h"},      {"normals.h", "pxslutil.h"},
};

constexpr std::array<std::string_view, 8> kDialects = {"3delight", "prman", "aqsis", "bmrt", "pixie", "entropy", "air", "rispec"};
constexpr std::array<std::string_view, 1> kDelight = {"DELIGHT 1"};
constexpr std::array<std::string_view, 1> kPrman = {"PRMAN 1"};
constexpr std::array<std::string_view, 1> kAqsis = {"AQSIS 1"};
constexpr std::array<std::string_view, 1> kBmrt = {"BMRT 1"};
constexpr std::array<std::string_view, 1> kPixie = {"PIXIE 1"};
constexpr std::array<std::string_view, 1> kEntropy = {"ENTROPY 1"};
constexpr std::array<std::string_view, 1> kAir = {"AIR 1"};

std::string lower(std::string_view s) {
    std::string l(s);
    for (char& c : l)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return l;
}

} // namespace

const ShippedHeader* shippedHeader(std::string_view name) {
    std::string wanted = lower(name);
    if (constexpr std::string_view kOfK3d = "k3d_"; wanted.starts_with(kOfK3d)) wanted.erase(0, kOfK3d.size());
    for (const OtherName& o : kOtherNames)
        if (o.name == wanted) wanted = o.header;
    for (const ShippedHeader& h : shippedHeaders())
        if (h.name == wanted) return &h;
    return nullptr;
}

std::span<const std::string_view> dialects() { return kDialects; }

std::span<const std::string_view> dialectMacros(std::string_view dialect) {
    const std::string d = lower(dialect);
    if (d.empty() || d == "3delight" || d == "delight") return kDelight;
    if (d == "prman") return kPrman;
    if (d == "aqsis") return kAqsis;
    if (d == "bmrt") return kBmrt;
    if (d == "pixie") return kPixie;
    if (d == "entropy") return kEntropy;
    if (d == "air") return kAir;
    return {};
}

std::string_view dialectPrelude(std::string_view dialect) {
    const std::string d = lower(dialect);
    if (d == "aqsis") return "#define calculatenormal(p) (normal normalize(calculatenormal(p)))\n"; // its own is of unit length
    return d == "bmrt" || d == "entropy" ? "#include \"rayserver.h\"\n" : "";
}

// Shaders for PRMan and BMRT call rayserver(), a program that ran next to PRMan, through macros that BMRT's compiler rejects.
std::string_view dialectOfFunction(std::string_view function) {
    return function == "rayserver" || function == "rayservercall" ? "bmrt" : "";
}

bool dialectRispecSpecular(std::string_view dialect) { return lower(dialect) == "rispec"; }

bool dialectLitPoint(std::string_view dialect) { return lower(dialect) == "pixie"; }

float dialectShadowBias(std::string_view dialect) { return lower(dialect) == "aqsis" ? 0.f : .225f; }

} // namespace alpenglow::rsl::front
