// Primitive variables: checked, and brought to camera space where their type asks for it.
#pragma once
#include "base/diagnostics.h"
#include "base/matrix.h"
#include "scene/primitive.h"
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::geometry {

/// One variable of a primitive. Values lie one after the other, width() floats each.
struct PrimVar {
    std::string name;
    scene::Class cls = scene::Class::Constant;
    scene::Type type = scene::Type::Float;
    int arrayLength = 0;                 ///< 0 = not an array
    const scene::Param* param = nullptr; ///< the request's own parameter; lives as long as the primitive
    std::vector<float> cameraValues;     ///< points, vectors, normals, hpoints in camera space; empty: param->numbers as they are
    const float* data() const { return cameraValues.empty() ? param->numbers.data() : cameraValues.data(); }
    int elements() const { return arrayLength > 0 ? arrayLength : 1; }
    /// Floats a value takes in data().
    int width() const { return scene::componentCount(type) * elements(); }
    /// Floats interpolate() writes: hpoints come out divided, as points.
    int outWidth() const { return (type == scene::Type::HPoint ? 3 : scene::componentCount(type)) * elements(); }
};

/// One value's share in an interpolated value, and the derivatives of that share.
struct Weight {
    size_t index = 0;
    double w = 0, du = 0, dv = 0;
};

/// The parameter of that name; the last one where a file gives it twice. Null when absent.
const scene::Param* lastParam(const scene::ParamList&, std::string_view name);

/// Checks that a parameter has `count` values of finite numbers and brings it to camera space. False: reported, not usable.
bool makePrimVar(const scene::Param&, size_t count, const Matrix& toCamera, const std::string& kind, Diagnostics&, PrimVar& out);

/// Weighted sum and its derivatives; outWidth() floats each, du and dv may be null.
void interpolatePrimVar(const PrimVar&, const Weight* w, int n, float* out, float* du, float* dv);

} // namespace alpenglow::geometry
