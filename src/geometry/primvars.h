// Primitive variables: validated, and converted to camera space by type.
#pragma once
#include "base/diagnostics.h"
#include "base/matrix.h"
#include "scene/primitive.h"
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::geometry {

/// One variable of a primitive. Values are consecutive, width() floats each.
struct PrimVar {
    std::string name;                          ///< without its declaration
    scene::Class cls = scene::Class::Constant; ///< storage class
    scene::Type type = scene::Type::Float;     ///< of an element
    int arrayLength = 0;                       ///< 0 = not an array
    const scene::Param* param = nullptr;       ///< the request's own parameter; lives as long as the primitive
    std::vector<float> cameraValues;           ///< points, vectors, normals, hpoints in camera space; empty: uses param->numbers
    /// The values, in the space in which shaders get them.
    const float* data() const { return cameraValues.empty() ? param->numbers.data() : cameraValues.data(); }
    /// Of an array; else 1.
    int elements() const { return arrayLength > 0 ? arrayLength : 1; }
    /// Floats of a value in data().
    int width() const { return scene::componentCount(type) * elements(); }
    /// Floats written by interpolate(): hpoints are divided, as points.
    int outWidth() const { return (type == scene::Type::HPoint ? 3 : scene::componentCount(type)) * elements(); }
};

/// One value's share in an interpolated value, and the derivatives of that share.
struct Weight {
    size_t index = 0;             ///< of the value in its class
    double w = 0, du = 0, dv = 0; ///< share, and its derivatives by u and v
};

/// The parameter of that name; the last one if there are several. Null if there is none.
const scene::Param* lastParam(const scene::ParamList&, std::string_view name);

/// Checks that a parameter has `count` finite values and converts it to camera space. Returns false if it is unusable, which is
/// reported.
bool makePrimVar(const scene::Param&, size_t count, const Matrix& toCamera, const std::string& kind, Diagnostics&, PrimVar& out);

/// Weighted sum and its derivatives; outWidth() floats each, du and dv may be null.
void interpolatePrimVar(const PrimVar&, const Weight* w, int n, float* out, float* du, float* dv);

} // namespace alpenglow::geometry
