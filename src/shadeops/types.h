// The types of the shading language (RISpec 3.2, section 11), as descriptors, checker and code generator see them.
#pragma once
#include <cstdint>
#include <string>

namespace alpenglow::shadeops {

/// Shader: a handle of another shader. Struct: a structure, which only the front end knows; kernels have its members.
enum class Base : uint8_t { Void, Bool, Float, Color, Point, Vector, Normal, Matrix, String, Shader, Struct };

/// Base type and array length. Bool is internal: the result of comparisons, never a variable.
struct Type {
    Base base = Base::Void; ///< element type
    int array = 0;          ///< 0: not an array; > 0: fixed length; -1: open length, `float x[]`
    int16_t structure = -1; ///< Struct: its number in the program that declares it; else -1
    friend bool operator==(const Type&, const Type&) = default;
    /// Whether it is a color, point, vector or normal; the same without color; or a number of any kind. False for arrays, except
    /// isNumeric().
    bool isTuple() const { return array == 0 && base >= Base::Color && base <= Base::Normal; }
    bool isPointLike() const { return array == 0 && base >= Base::Point && base <= Base::Normal; }
    bool isNumeric() const { return base >= Base::Float && base <= Base::Matrix; }
    /// The type without its array length.
    Type element() const { return {base, 0, structure}; }
};

/// Whether it is a structure or an array of structures.
constexpr bool isStruct(Type t) { return t.base == Base::Struct; }
/// Whether values are texts when they are stored: strings, and handles, which are the names of what they stand for.
constexpr bool isStringLike(Base b) { return b == Base::String || b == Base::Shader; }
/// The type as kernels and their users see it, for whom a handle is a string.
constexpr Type storedType(Type t) { return {t.base == Base::Shader ? Base::String : t.base, t.array}; }
/// Floats per element: float 1, tuples 3, matrix 16, string and shader 1 (an interned id), void and structures 0.
int componentCount(Base);
/// "float", "color", ..., "float[4]"; of any structure "structure".
std::string toString(Type);

/// Kinds of shader, as bits: the contexts in which a construct is legal.
enum Context : uint32_t {
    kSurface = 1,
    kDisplacement = 2,
    kLight = 4,
    kVolume = 8,
    kImager = 16,
    kTransformation = 32,
    kAnyContext = 63
};

} // namespace alpenglow::shadeops
