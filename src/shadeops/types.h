// The types of the shading language (RISpec 3.2, section 11), as descriptors, checker and code generator see them.
#pragma once
#include <cstdint>
#include <string>

namespace alpenglow::rsl {

enum class Base : uint8_t { Void, Bool, Float, Color, Point, Vector, Normal, Matrix, String };

/// Base type and array length. Bool is internal: the result of comparisons, never a variable.
struct Type {
    Base base = Base::Void;
    int array = 0; ///< 0: not an array; > 0: fixed length; -1: open length, `float x[]`
    friend bool operator==(const Type&, const Type&) = default;
    bool isTuple() const { return array == 0 && base >= Base::Color && base <= Base::Normal; }
    bool isPointLike() const { return array == 0 && base >= Base::Point && base <= Base::Normal; }
    bool isNumeric() const { return base >= Base::Float && base <= Base::Matrix; }
    Type element() const { return {base, 0}; }
};

/// Floats per element: float 1, tuples 3, matrix 16, string 1 (an interned id), void 0.
int componentCount(Base);
/// "float", "color", ..., "float[4]".
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

} // namespace alpenglow::rsl
