// ri.h: blocks, attributes, shaders, lights and transformations.
#include "ri/c/pairs.h"
#include "ri/c/strings.h"
#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <optional>

using namespace alpenglow;
using namespace alpenglow::ri;

namespace {

/// A request without arguments.
void bare(const char* request) { Building(request).run(); }

template <class Number> void oneNumber(const char* request, Number d) { Building(request).number(d).run(); }
void oneText(const char* request, const char* s) { Building(request).text(s).run(); }
void someNumbers(const char* request, const RtFloat* f, int64_t n) { Building(request).numbers(f, n).run(); }
void someNumbers(const char* request, std::initializer_list<RtFloat> f) { someNumbers(request, f.begin(), int64_t(f.size())); }

/// Colours have as many components as ColorSamples sets.
void color(const char* request, const RtFloat* c) {
    Building b(request);
    if (b.client()) b.numbers(c, b.client()->to.colorSamples()).run();
}

/// The name that a program sets for a light by "string __handleid", which is removed from the list.
std::optional<std::string> ownHandle(std::vector<RtToken>& tokens, std::vector<RtPointer>& values) {
    for (size_t i = 0; i < tokens.size(); ++i) {
        const std::string_view token = tokens[i] ? tokens[i] : "";
        if (token != "__handleid" && !token.ends_with(" __handleid")) continue;
        const void* value = values[i];
        tokens.erase(tokens.begin() + std::ptrdiff_t(i));
        values.erase(values.begin() + std::ptrdiff_t(i));
        if (auto text = textInsteadOfAddress(value)) return text;
        const RtToken* name = static_cast<const RtToken*>(value);
        if (name && *name) return *name;
        return {};
    }
    return {};
}

RtPointer light(const char* request, const char* shader, RtInt n, RtToken tokens[], RtPointer values[]) {
    Building b(request);
    if (!b.may(n, {tokens, values})) return nullptr;
    std::vector<RtToken> names(tokens, tokens + n);
    std::vector<RtPointer> of(values, values + n);
    RtPointer handle = newHandle(*b.client());
    if (auto own = ownHandle(names, of)) b.client()->to.nameHandle(int(reinterpret_cast<uintptr_t>(handle)), *own);
    const std::string name = handleName(*b.client(), handle);
    b.text(shader).text(name).parameters(RtInt(names.size()), names.data(), of.data()).run();
    return handle;
}

const char* basisName(const RtFloat* b) {
    static const std::pair<const RtFloat*, const char*> kNames[] = {{RiBezierBasis[0], "bezier"},
                                                                    {RiBSplineBasis[0], "b-spline"},
                                                                    {RiCatmullRomBasis[0], "catmull-rom"},
                                                                    {RiHermiteBasis[0], "hermite"},
                                                                    {RiPowerBasis[0], "power"}};
    for (const auto& [address, name] : kNames)
        if (address == b) return name;
    return nullptr;
}

Building& basis(Building& b, RtBasis m) {
    if (const char* name = basisName(m ? m[0] : nullptr)) return b.text(name);
    return b.numbers(m ? m[0] : nullptr, 16);
}

} // namespace

extern "C" {

#define ALPENGLOW_SIXTH RtFloat(1.0 / 6)
#define ALPENGLOW_HALF RtFloat(0.5)
RtBasis RiBezierBasis = {{-1, 3, -3, 1}, {3, -6, 3, 0}, {-3, 3, 0, 0}, {1, 0, 0, 0}};
RtBasis RiBSplineBasis = {{-ALPENGLOW_SIXTH, ALPENGLOW_HALF, -ALPENGLOW_HALF, ALPENGLOW_SIXTH},
                          {ALPENGLOW_HALF, -1, ALPENGLOW_HALF, 0},
                          {-ALPENGLOW_HALF, 0, ALPENGLOW_HALF, 0},
                          {ALPENGLOW_SIXTH, 4 * ALPENGLOW_SIXTH, ALPENGLOW_SIXTH, 0}};
RtBasis RiCatmullRomBasis = {{-.5f, 1.5f, -1.5f, .5f}, {1, -2.5f, 2, -.5f}, {-.5f, 0, .5f, 0}, {0, 1, 0, 0}};
RtBasis RiHermiteBasis = {{2, 1, -2, 1}, {-3, -2, 3, -1}, {0, 1, 0, 0}, {1, 0, 0, 0}};
RtBasis RiPowerBasis = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};

RtToken RiDeclare(const char* name, const char* declaration) {
    Building("Declare").text(name).text(declaration).run();
    return name;
}

RtVoid RiAttributeBegin(void) { bare("AttributeBegin"); }
RtVoid RiAttributeEnd(void) { bare("AttributeEnd"); }
RtVoid RiTransformBegin(void) { bare("TransformBegin"); }
RtVoid RiTransformEnd(void) { bare("TransformEnd"); }
RtVoid RiSolidBegin(RtToken operation) { oneText("SolidBegin", operation); }
RtVoid RiSolidEnd(void) { bare("SolidEnd"); }

RtObjectHandle RiObjectBegin(void) {
    Building b("ObjectBegin");
    if (!b.client()) return nullptr;
    RtPointer handle = newHandle(*b.client());
    b.text(handleName(*b.client(), handle)).run();
    return handle;
}
RtVoid RiObjectEnd(void) { bare("ObjectEnd"); }
RtVoid RiObjectInstance(RtObjectHandle handle) {
    Building b("ObjectInstance");
    if (b.client()) b.text(handleName(*b.client(), handle)).run();
}
RtVoid RiFrameBegin(RtInt number) { oneNumber("FrameBegin", number); }
RtVoid RiFrameEnd(void) { bare("FrameEnd"); }
RtVoid RiWorldBegin(void) { bare("WorldBegin"); }
RtVoid RiWorldEnd(void) { bare("WorldEnd"); }
RtVoid RiResourceBegin(void) { bare("ResourceBegin"); }
RtVoid RiResourceEnd(void) { bare("ResourceEnd"); }
RtVoid RiElse(void) { bare("Else"); }
RtVoid RiIfEnd(void) { bare("IfEnd"); }

RtVoid RiMotionBegin(RtInt n, ...) {
    std::vector<RtFloat> times;
    va_list list;
    va_start(list, n);
    for (RtInt i = 0; i < n && i < 100'000; ++i) times.push_back(RtFloat(va_arg(list, double)));
    va_end(list);
    RiMotionBeginV(RtInt(times.size()), times.data());
}
RtVoid RiMotionBeginV(RtInt n, RtFloat times[]) { someNumbers("MotionBegin", times, n); }
RtVoid RiMotionEnd(void) { bare("MotionEnd"); }

RtVoid RiColor(RtColor c) { color("Color", c); }
RtVoid RiOpacity(RtColor c) { color("Opacity", c); }
RtVoid RiTextureCoordinates(RtFloat s1, RtFloat t1, RtFloat s2, RtFloat t2, RtFloat s3, RtFloat t3, RtFloat s4, RtFloat t4) {
    someNumbers("TextureCoordinates", {s1, t1, s2, t2, s3, t3, s4, t4});
}
RtVoid RiShadingRate(RtFloat size) { oneNumber("ShadingRate", size); }
RtVoid RiShadingInterpolation(RtToken type) { oneText("ShadingInterpolation", type); }
RtVoid RiMatte(RtBoolean on) { oneNumber("Matte", RtInt(on)); }
RtVoid RiBound(RtBound bound) { someNumbers("Bound", bound, 6); }
RtVoid RiDetail(RtBound bound) { someNumbers("Detail", bound, 6); }
RtVoid RiDetailRange(RtFloat a, RtFloat b, RtFloat c, RtFloat d) { someNumbers("DetailRange", {a, b, c, d}); }
RtVoid RiGeometricApproximation(RtToken type, RtFloat value) {
    Building("GeometricApproximation").text(type).number(value).run();
}
RtVoid RiGeometricRepresentation(RtToken type) { oneText("GeometricRepresentation", type); }
RtVoid RiOrientation(RtToken orientation) { oneText("Orientation", orientation); }
RtVoid RiReverseOrientation(void) { bare("ReverseOrientation"); }
RtVoid RiSides(RtInt sides) { oneNumber("Sides", sides); }

RtVoid RiBasis(RtBasis ubasis, RtInt ustep, RtBasis vbasis, RtInt vstep) {
    Building b("Basis");
    basis(b, ubasis).number(ustep);
    basis(b, vbasis).number(vstep).run();
}

RtVoid RiTrimCurve(RtInt nloops, RtInt ncurves[], RtInt order[], RtFloat knot[], RtFloat min[], RtFloat max[], RtInt n[],
                   RtFloat u[], RtFloat v[], RtFloat w[]) {
    Building b("TrimCurve");
    if (!b.may(nloops, {ncurves, order, knot, min, max, n, u, v, w})) return;
    const int64_t curves = total(ncurves, nloops);
    if (!b.may(curves, {})) return;
    const int64_t points = total(n, curves), orders = total(order, curves);
    if (!b.may(points, {}) || !b.may(orders, {})) return;
    b.ints(ncurves, nloops).ints(order, curves).numbers(knot, points + orders).numbers(min, curves).numbers(max, curves);
    b.ints(n, curves).numbers(u, points).numbers(v, points).numbers(w, points).run();
}

RtVoid RiAttributeV(const char* name, RtInt n, RtToken tokens[], RtPointer values[]) {
    Building("Attribute").text(name).parameters(n, tokens, values, nullptr, name ? name : "").run();
}
RtVoid RiAttribute(const char* name, ...) {
    ALPENGLOW_PAIRS(name);
    RiAttributeV(name, ALPENGLOW_LIST);
}

RtLightHandle RiLightSourceV(const char* name, RtInt n, RtToken tokens[], RtPointer values[]) {
    return light("LightSource", name, n, tokens, values);
}
RtLightHandle RiLightSource(const char* name, ...) {
    ALPENGLOW_PAIRS(name);
    return RiLightSourceV(name, ALPENGLOW_LIST);
}
RtLightHandle RiAreaLightSourceV(const char* name, RtInt n, RtToken tokens[], RtPointer values[]) {
    return light("AreaLightSource", name, n, tokens, values);
}
RtLightHandle RiAreaLightSource(const char* name, ...) {
    ALPENGLOW_PAIRS(name);
    return RiAreaLightSourceV(name, ALPENGLOW_LIST);
}
RtVoid RiIlluminate(RtLightHandle light, RtBoolean on) {
    Building b("Illuminate");
    if (b.client()) b.text(handleName(*b.client(), light)).number(RtInt(on != 0)).run();
}

RtVoid RiIdentity(void) { bare("Identity"); }
RtVoid RiTransform(RtMatrix m) { someNumbers("Transform", m ? m[0] : nullptr, 16); }
RtVoid RiConcatTransform(RtMatrix m) { someNumbers("ConcatTransform", m ? m[0] : nullptr, 16); }
RtVoid RiPerspective(RtFloat fov) { oneNumber("Perspective", fov); }
RtVoid RiTranslate(RtFloat x, RtFloat y, RtFloat z) { someNumbers("Translate", {x, y, z}); }
RtVoid RiRotate(RtFloat angle, RtFloat x, RtFloat y, RtFloat z) { someNumbers("Rotate", {angle, x, y, z}); }
RtVoid RiScale(RtFloat x, RtFloat y, RtFloat z) { someNumbers("Scale", {x, y, z}); }
RtVoid RiSkew(RtFloat angle, RtFloat x1, RtFloat y1, RtFloat z1, RtFloat x2, RtFloat y2, RtFloat z2) {
    someNumbers("Skew", {angle, x1, y1, z1, x2, y2, z2});
}
RtVoid RiCoordinateSystem(RtToken space) { oneText("CoordinateSystem", space); }
RtVoid RiScopedCoordinateSystem(RtToken space) { oneText("ScopedCoordinateSystem", space); }
RtVoid RiCoordSysTransform(RtToken space) { oneText("CoordSysTransform", space); }

RtPoint* RiTransformPoints(RtToken from, RtToken to, RtInt n, RtPoint points[]) {
    Building b("CoordSysTransform"); // which looks for spaces as well
    if (!b.may(1, {from, to, points}) || !b.may(n, {})) return nullptr;
    const auto between = b.client()->to.between(from, to);
    if (!between) {
        b.drop(Rie::BadToken, fmt::format("TransformPoints: there is no space \"{}\" or no \"{}\" here", from, to));
        return nullptr;
    }
    const Matrix& m = *between;
    for (RtInt i = 0; i < n; ++i) {
        const Vec3d p = transformPoint(m, Vec3d(points[i][0], points[i][1], points[i][2]));
        points[i][0] = toFloat(p.x);
        points[i][1] = toFloat(p.y);
        points[i][2] = toFloat(p.z);
    }
    return points;
}

} // extern "C"
