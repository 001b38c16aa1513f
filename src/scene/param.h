// Values of requests: parameters, what moves, calls of shaders.
#pragma once
#include "base/diagnostics.h"
#include "base/matrix.h"
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace alpenglow::scene {

/// How many values a variable has, and how they are interpolated (RISpec 3.2, 5; FaceVarying, FaceVertex: PRMan).
enum class Class { Constant, Uniform, Varying, Vertex, FaceVarying, FaceVertex };
/// What a value is (RISpec 3.2, 3). The transforms of points, vectors and normals differ.
enum class Type { Float, Integer, String, Color, Point, Vector, Normal, HPoint, Matrix };
/// Floats per element: Float/Integer/String 1, tuples 3, HPoint 4, Matrix 16.
int componentCount(Type);

/// One parameter of a request: a primitive variable, a shader parameter, an option or attribute value.
struct Param {
    std::string name;                 ///< without the declaration
    Class cls = Class::Uniform;       ///< storage class
    Type type = Type::Float;          ///< of an element
    int arrayLength = 0;              ///< 0 = not an array
    bool declared = true;             ///< false: type guessed from the values; a shader's own declaration decides
    std::vector<float> numbers;       ///< all numeric types, flattened (integers too)
    std::vector<std::string> strings; ///< Type::String
    SourcePlace place;                ///< of the token
};
using ParamList = std::vector<Param>;
/// The first parameter of this name; null if there is none.
const Param* find(const ParamList&, std::string_view name);

/// A value that may move: keys[i] at times[i], in shutter units, times increasing. One key when static. Between keys interpolate
/// linearly, element by element; outside hold the end. (A moving Rotate comes with keys close enough for that.)
template <class T> struct Moving {
    std::vector<float> times{0};
    std::vector<T> keys{T{}}; ///< as many as times
    Moving() = default;
    /// Without motion.
    Moving(T v) : keys{std::move(v)} {}
    /// The value, or the one of the first time.
    const T& first() const { return keys.front(); }
    /// It has several keys.
    bool moves() const { return keys.size() > 1; }
};
using Transform = Moving<Matrix>;

/// "reference color diffuseColor" ["tex:resultRGB"]: the parameter takes an output of the pattern of that handle
/// (scene/network.h).
struct Connection {
    std::string parameter;
    int element = -1; ///< of an array; -1: the parameter is none
    std::string handle, output;
    SourcePlace place; ///< of the parameter, for messages
};

/// A shader call: Surface "plastic" "Kd" .5
struct ShaderCall {
    std::string name;                         ///< as in the request
    ParamList params;                         ///< in their order
    Transform toWorld;                        ///< "shader" space to world: the CTM at the call
    SourcePlace place;                        ///< of the request
    std::string handle = {};                  ///< of the Bxdf; "": of another request
    std::vector<Connection> connections = {}; ///< of RIS; in their order
};
using ShaderRef = std::shared_ptr<const ShaderCall>;

/// Rows as in RISpec 3.2, 5.2: value at t = (t^3 t^2 t 1) * m * (P0 P1 P2 P3). Bezier by default.
struct Basis {
    double m[4][4] = {{-1, 3, -3, 1}, {3, -6, 3, 0}, {-3, 3, 0, 0}, {1, 0, 0, 0}};
    int step = 3;                ///< step between the starts of neighbouring segments (RISpec 3.2, 5.2)
    std::string name = "bezier"; ///< "" for a matrix of the file's own
};

} // namespace alpenglow::scene
