// An example of an RSL plug-in: a woven cloth, and a few small functions that show each kind of argument. Built by the project,
// or with
//   c++ -std=c++17 -O2 -shared -fPIC -I include examples/plugins/weave.cpp -o weave.so
#include "alpenglow/rslplugin.h"
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

using namespace alpenglow::rslplugin;

namespace {

float fraction(float x) { return x - std::floor(x); }

/// The height of a plain weave at (s, t), 0 to 1: threads along s and along t go over and under each other.
float weave(float s, float t) {
    const float across = fraction(s) - 0.5f, along = fraction(t) - 0.5f;
    const bool even = (int64_t(std::floor(s)) + int64_t(std::floor(t))) % 2 == 0;
    const float warp = std::cos(3.14159265f * across), weft = std::cos(3.14159265f * along);
    return even ? std::max(warp, 0.5f * weft) : std::max(weft, 0.5f * warp);
}

/// A colour of two threads, and which of them it is: an output argument.
Color thread(float s, float t, const Color& warp, const Color& weft, float& which) {
    which = (int64_t(std::floor(s)) + int64_t(std::floor(t))) % 2 == 0 ? 0.0f : 1.0f;
    const float height = weave(s, t);
    const Color& c = which == 0 ? warp : weft;
    return {c.r * height, c.g * height, c.b * height};
}

/// The whole row at once: no work for points that are not wanted is saved, but the loop is one that a compiler makes wide.
void triangle(int32_t lanes, uint64_t, const float* in, float* out) {
    for (int32_t n = 0; n < lanes; ++n) {
        const float f = in[n] - std::floor(in[n]);
        out[n] = f < 0.5f ? 2 * f : 2 - 2 * f;
    }
}

/// Polynomial with the coefficients of an array, the constant first.
float polynomial(float x, const Array<float, 4>& c) { return ((c.e[3] * x + c.e[2]) * x + c.e[1]) * x + c.e[0]; }

/// The text said n times, at most ten.
std::string repeated(const char* text, float n) {
    std::string s;
    for (int k = 0; k < 10 && k < n; ++k) s += text;
    return s;
}

void swap(Vector& a, Vector& b) { std::swap(a, b); }

float trace(const Matrix& m) { return m.m[0][0] + m.m[1][1] + m.m[2][2] + m.m[3][3]; }

} // namespace

ALPENGLOW_RSL_PLUGIN(perPoint<weave>("float weave(float s, t)", "Height of a plain weave, 0 to 1; a thread is 1 wide."),
                     perPoint<thread>("color weave(float s, t; color warp, weft; output float which)",
                                      "Colour of a plain weave, and which thread lies on top."),
                     overLanes(triangle, "float triangle(float x)", "Rises to 1 at 1/2 and falls, with period 1."),
                     perPoint<polynomial>("float polynomial(float x; float c[4])", "c[0] + c[1] x + c[2] x^2 + c[3] x^3."),
                     perPoint<repeated>("string repeated(string text; float n)"),
                     perPoint<swap>("void swap(output vector a; output vector b)"), perPoint<trace>("float trace(matrix m)"))
