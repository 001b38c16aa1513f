// Predefined variables by kind of shader: RISpec 3.2, section 12.
#include "rsl/front/ast.h"
#include <array>

namespace alpenglow::rsl {

const char* toString(ShaderKind k) {
    static constexpr const char* kNames[] = {"surface", "displacement", "light", "volume", "imager", "transformation"};
    return kNames[int(k)];
}

Context contextOf(ShaderKind k) { return Context(1u << int(k)); }

namespace {

constexpr Type kF{Base::Float, 0}, kC{Base::Color, 0}, kP{Base::Point, 0}, kV{Base::Vector, 0}, kN{Base::Normal, 0};
constexpr bool U = true, V = false, W = true, R = false;

constexpr GlobalVariable kCamera[] = {{"E", kP, U, R, "position of the eye"},
                                      {"ncomps", kF, U, R, "number of colour components"},
                                      {"time", kF, U, R, "shutter time"},
                                      {"dtime", kF, U, R, "time covered by the sample"}};

constexpr GlobalVariable kPatch[] = {{"dPdu", kV, V, R, "derivative of P by u"},
                                     {"dPdv", kV, V, R, "derivative of P by v"},
                                     {"Ng", kN, V, R, "geometric normal"},
                                     {"u", kF, V, R, "surface parameter"},
                                     {"v", kF, V, R, "surface parameter"},
                                     {"du", kF, V, R, "change of u to the next sample"},
                                     {"dv", kF, V, R, "change of v to the next sample"},
                                     {"dPdtime", kV, V, R, "motion of P"}};

template <size_t... N> constexpr auto join(const GlobalVariable (&... parts)[N]) {
    std::array<GlobalVariable, (N + ...)> all{};
    size_t i = 0;
    (
        [&] {
            for (const auto& g : parts) all[i++] = g;
        }(),
        ...);
    return all;
}

constexpr GlobalVariable kSurfaceOwn[] = {{"Cs", kC, V, W, "colour of the primitive"},
                                          {"Os", kC, V, W, "opacity of the primitive"},
                                          {"P", kP, V, R, "position"},
                                          {"N", kN, V, W, "shading normal"},
                                          {"s", kF, V, W, "texture coordinate"},
                                          {"t", kF, V, W, "texture coordinate"},
                                          {"L", kV, V, R, "toward the light; in illuminance"},
                                          {"Cl", kC, V, R, "light colour; in illuminance"},
                                          {"Ol", kC, V, R, "light opacity; in illuminance"},
                                          {"I", kV, V, R, "from the viewing point to P"},
                                          {"Ci", kC, V, W, "result: colour times opacity"},
                                          {"Oi", kC, V, W, "result: opacity"}};
constexpr GlobalVariable kDisplacementOwn[] = {
    {"P", kP, V, W, "position, to be moved"},      {"N", kN, V, W, "shading normal, to be replaced"},
    {"s", kF, V, W, "texture coordinate"},         {"t", kF, V, W, "texture coordinate"},
    {"Cs", kC, V, R, "colour of the primitive"},   {"Os", kC, V, R, "opacity of the primitive"},
    {"I", kV, V, R, "from the viewing point to P"}};
constexpr GlobalVariable kLightOwn[] = {{"P", kP, V, R, "position on the light"},
                                        {"N", kN, V, R, "normal of the area light; without area that of the lit surface"},
                                        {"s", kF, V, R, "texture coordinate"},
                                        {"t", kF, V, R, "texture coordinate"},
                                        {"L", kV, V, W, "from the light to the surface; in illuminate and solar"},
                                        {"Ps", kP, V, R, "point being lit"},
                                        {"Ns", kN, V, R, "shading normal of the lit surface"},
                                        {"Ngs", kN, V, R, "geometric normal of the lit surface; of 3Delight for Maya"},
                                        {"I", kV, V, R, "incident ray at the lit point"},
                                        {"Cl", kC, V, W, "result: colour of the light"},
                                        {"Ol", kC, V, W, "result: opacity of the light"}};
constexpr GlobalVariable kVolumeOwn[] = {
    {"P", kP, V, R, "end of the ray segment"},        {"I", kV, V, R, "the segment; it starts at P - I"},
    {"N", kN, V, R, "normal of the surface at P"},    {"Cs", kC, V, R, "colour of the surface at P"},
    {"Os", kC, V, R, "opacity of the surface at P"},  {"Ci", kC, V, W, "colour at P, to be changed"},
    {"Oi", kC, V, W, "opacity at P, to be changed"},  {"L", kV, V, R, "toward the light; in illuminance"},
    {"Cl", kC, V, R, "light colour; in illuminance"}, {"Ol", kC, V, R, "light opacity; in illuminance"}};
constexpr GlobalVariable kImagerOwn[] = {{"P", kP, V, R, "pixel position in raster space"},
                                         {"s", kF, V, R, "position across the picture, 0 to 1"},
                                         {"t", kF, V, R, "position down the picture, 0 to 1"},
                                         {"u", kF, V, R, "as s"},
                                         {"v", kF, V, R, "as t"},
                                         {"du", kF, V, R, "a pixel, in u"},
                                         {"dv", kF, V, R, "a pixel, in v"},
                                         {"Ci", kC, V, W, "colour of the pixel"},
                                         {"Oi", kC, V, W, "opacity of the pixel"},
                                         {"alpha", kF, V, W, "coverage"}};
constexpr GlobalVariable kTransformationOwn[] = {{"P", kP, V, W, "position"}, {"N", kN, V, W, "normal"}};

constexpr auto kSurfaceAll = join(kSurfaceOwn, kPatch, kCamera);
constexpr auto kDisplacementAll = join(kDisplacementOwn, kPatch, kCamera);
constexpr auto kLightAll = join(kLightOwn, kPatch, kCamera);
constexpr auto kVolumeAll = join(kVolumeOwn, kCamera);
constexpr auto kImagerAll = join(kImagerOwn, kCamera);
constexpr auto kTransformationAll = join(kTransformationOwn, kCamera);

} // namespace

std::span<const GlobalVariable> globalVariables(ShaderKind k) {
    switch (k) {
    case ShaderKind::Surface:
        return kSurfaceAll;
    case ShaderKind::Displacement:
        return kDisplacementAll;
    case ShaderKind::Light:
        return kLightAll;
    case ShaderKind::Volume:
        return kVolumeAll;
    case ShaderKind::Imager:
        return kImagerAll;
    case ShaderKind::Transformation:
        return kTransformationAll;
    }
    return {};
}

} // namespace alpenglow::rsl
