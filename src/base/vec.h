// Small vectors. Float for shading, double where transforms compose (docs/design/decisions.md, "Current space").
#pragma once
#include <cmath>

namespace alpenglow {

/// Three components; a point, direction, normal or colour, by context. No space is implied.
template <class T> struct Vec3T {
    T x{}, y{}, z{}; ///< 0 by default
    constexpr Vec3T() = default;
    /// S in every component.
    constexpr explicit Vec3T(T s) : x(s), y(s), z(s) {}
    constexpr Vec3T(T a, T b, T c) : x(a), y(b), z(c) {}
    /// Converts each component.
    template <class U> constexpr explicit Vec3T(const Vec3T<U>& o) : x(T(o.x)), y(T(o.y)), z(T(o.z)) {}
    /// Component i: 0 is x, 1 is y, all others z.
    constexpr T& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
    /// Component i, as above.
    constexpr T operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
    /// Component by component.
    constexpr Vec3T operator-() const { return {-x, -y, -z}; }
    constexpr Vec3T& operator+=(const Vec3T& o) {
        x += o.x;
        y += o.y;
        z += o.z;
        return *this;
    }
    constexpr Vec3T& operator-=(const Vec3T& o) {
        x -= o.x;
        y -= o.y;
        z -= o.z;
        return *this;
    }
    constexpr Vec3T& operator*=(const Vec3T& o) {
        x *= o.x;
        y *= o.y;
        z *= o.z;
        return *this;
    }
    constexpr Vec3T& operator*=(T s) {
        x *= s;
        y *= s;
        z *= s;
        return *this;
    }
    constexpr Vec3T& operator/=(T s) {
        x /= s;
        y /= s;
        z /= s;
        return *this;
    }
    friend constexpr Vec3T operator+(Vec3T a, const Vec3T& b) { return a += b; }
    friend constexpr Vec3T operator-(Vec3T a, const Vec3T& b) { return a -= b; }
    friend constexpr Vec3T operator*(Vec3T a, const Vec3T& b) { return a *= b; }
    friend constexpr Vec3T operator*(Vec3T a, T s) { return a *= s; }
    friend constexpr Vec3T operator*(T s, Vec3T a) { return a *= s; }
    friend constexpr Vec3T operator/(Vec3T a, T s) { return a /= s; }
    friend constexpr bool operator==(const Vec3T& a, const Vec3T& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
};

/// Vectors of single precision, and of double.
using Vec3 = Vec3T<float>;
using Vec3d = Vec3T<double>;
using Color = Vec3T<float>; ///< linear RGB, Rec. 709 primaries; radiance where nothing else is said

/// The scalar product.
template <class T> constexpr T dot(const Vec3T<T>& a, const Vec3T<T>& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
/// a x b. Right-handed components: in the left-handed spaces of RenderMan the result follows the left hand.
template <class T> constexpr Vec3T<T> cross(const Vec3T<T>& a, const Vec3T<T>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// The Euclidean length. Squares are not scaled: components beyond about 1e19 in float overflow.
template <class T> T length(const Vec3T<T>& a) { return std::sqrt(dot(a, a)); }
/// Unit vector along a; a itself when its length is zero (RSL normalize).
template <class T> Vec3T<T> normalize(const Vec3T<T>& a) {
    T l = length(a);
    return l > 0 ? a / l : a;
}
/// Rec. 709 luminance of a linear colour.
template <class T> constexpr T luminance(const Vec3T<T>& c) { return T(0.2126) * c.x + T(0.7152) * c.y + T(0.0722) * c.z; }
/// The largest of the three components.
template <class T> constexpr T maxComponent(const Vec3T<T>& c) {
    T m = c.x > c.y ? c.x : c.y;
    return m > c.z ? m : c.z;
}

/// Two numbers: a sample, or a position on a surface or in a map.
struct Vec2 {
    float x = 0, y = 0; ///< 0 by default
};

/// |x|, |y|, |z|.
template <class T> Vec3T<T> absolute(const Vec3T<T>& c) { return {std::fabs(c.x), std::fabs(c.y), std::fabs(c.z)}; }
/// Unit vector along a; the fallback where a has no direction (zero, infinite or NaN length).
template <class T> Vec3T<T> normalizeOr(const Vec3T<T>& a, const Vec3T<T>& fallback) {
    const T l = length(a);
    return l > 0 && std::isfinite(l) ? a / l : fallback;
}

/// Pi, in double and in float.
inline constexpr double kPi = 3.14159265358979323846;
inline constexpr float kFloatPi = float(kPi);

} // namespace alpenglow
