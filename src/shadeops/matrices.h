// Matrices: 3Delight manual, 6.4.3. Row vectors, p' = p M, translation in the last row, as base/matrix.h.
#pragma once
#include "shadeops/call.h"
#include "shadeops/geometry.h"

namespace alpenglow::shadeops::AL_NAMESPACE {

template <class T> AL_INLINE Matrix<T> opTranslate(const Matrix<T>& a, const Triple<T>& t) {
    Matrix<T> r = a;
#pragma clang loop unroll(full)
    for (int c = 0; c < 4; ++c) r.m[12 + c] = mad(t.x, a.m[c], mad(t.y, a.m[4 + c], mad(t.z, a.m[8 + c], a.m[12 + c])));
    return r;
}
template <class T> AL_INLINE Matrix<T> opScale(const Matrix<T>& a, const Triple<T>& s) {
    Matrix<T> r = a;
#pragma clang loop unroll(full)
    for (int c = 0; c < 4; ++c) {
        r.m[c] = s.x * a.m[c];
        r.m[4 + c] = s.y * a.m[4 + c];
        r.m[8 + c] = s.z * a.m[8 + c];
    }
    return r;
}
/// Rows of the rotation: cos I + (1 - cos) k k' + sin [k], so that a positive angle about z takes x to y.
template <class T> AL_INLINE Matrix<T> opRotateMatrix(const Matrix<T>& a, const T& angle, const Triple<T>& axis) {
    const Triple<T> k = opNormalize(axis);
    const T c = cosine(angle), s = sine(angle), d = vf(1) - c;
    const T xy = k.x * k.y * d, yz = k.y * k.z * d, zx = k.z * k.x * d;
    const T row[9] = {mad(k.x * k.x, d, c), xy + k.z * s, zx - k.y * s, xy - k.z * s,        mad(k.y * k.y, d, c),
                      yz + k.x * s,         zx + k.y * s, yz - k.x * s, mad(k.z * k.z, d, c)};
    Matrix<T> r = a;
    const vm none = value(dot(k, k)) == 0;
#pragma clang loop unroll(full)
    for (int i = 0; i < 12; ++i) {
        const int q = i / 4 * 3, column = i % 4;
        const T v = mad(row[q], a.m[column], mad(row[q + 1], a.m[4 + column], row[q + 2] * a.m[8 + column]));
        r.m[i] = select(none, a.m[i], v);
    }
    return r;
}

/// The 2x2 minors of the upper two and the lower two rows: everything about a 4x4 matrix follows from these twelve.
template <class T> struct Minors {
    T s[6], c[6]; ///< of the upper rows; of the lower rows
};
template <class T> AL_INLINE Minors<T> minorsOf(const Matrix<T>& a) {
    const T* m = a.m;
    const auto two = [&](int row, int i, int j) __attribute__((always_inline)) {
        return m[row * 4 + i] * m[row * 4 + 4 + j] - m[row * 4 + 4 + i] * m[row * 4 + j];
    };
    return {{two(0, 0, 1), two(0, 0, 2), two(0, 0, 3), two(0, 1, 2), two(0, 1, 3), two(0, 2, 3)},
            {two(2, 0, 1), two(2, 0, 2), two(2, 0, 3), two(2, 1, 2), two(2, 1, 3), two(2, 2, 3)}};
}
template <class T> AL_INLINE T determinantOf(const Minors<T>& k) {
    return k.s[0] * k.c[5] - k.s[1] * k.c[4] + k.s[2] * k.c[3] + k.s[3] * k.c[2] - k.s[4] * k.c[1] + k.s[5] * k.c[0];
}
template <class T> AL_INLINE T opDeterminant(const Matrix<T>& a) { return determinantOf(minorsOf(a)); }
template <class T> AL_INLINE Matrix<T> opInverse(const Matrix<T>& a) {
    const Minors<T> k = minorsOf(a);
    const T det = determinantOf(k), inverse = divide(T(vf(1)), det);
    const vm singular = value(det) == 0;
    const T *m = a.m, *s = k.s, *c = k.c;
    const T adjugate[16] = {m[5] * c[5] - m[6] * c[4] + m[7] * c[3],       -(m[1] * c[5] - m[2] * c[4] + m[3] * c[3]),
                            m[13] * s[5] - m[14] * s[4] + m[15] * s[3],    -(m[9] * s[5] - m[10] * s[4] + m[11] * s[3]),
                            -(m[4] * c[5] - m[6] * c[2] + m[7] * c[1]),    m[0] * c[5] - m[2] * c[2] + m[3] * c[1],
                            -(m[12] * s[5] - m[14] * s[2] + m[15] * s[1]), m[8] * s[5] - m[10] * s[2] + m[11] * s[1],
                            m[4] * c[4] - m[5] * c[2] + m[7] * c[0],       -(m[0] * c[4] - m[1] * c[2] + m[3] * c[0]),
                            m[12] * s[4] - m[13] * s[2] + m[15] * s[0],    -(m[8] * s[4] - m[9] * s[2] + m[11] * s[0]),
                            -(m[4] * c[3] - m[5] * c[1] + m[6] * c[0]),    m[0] * c[3] - m[1] * c[1] + m[2] * c[0],
                            -(m[12] * s[3] - m[13] * s[1] + m[14] * s[0]), m[8] * s[3] - m[9] * s[1] + m[10] * s[0]};
    Matrix<T> r;
#pragma clang loop unroll(full)
    for (int i = 0; i < 16; ++i)
        r.m[i] = select(singular, T(vf(i % 5 == 0 ? 1.0f : 0.0f)), mad(adjugate[i], inverse, T(vf(0)))); // + 0: no negative zeros
    return r;
}
/// An index, truncated and clamped to 0..last.
AL_INLINE vf clampIndex(vf i, float last) { return minLanes(maxLanes(truncLanes(i), vf(0)), vf(last)); }
template <class T> AL_INLINE T opCompMatrix(const Matrix<T>& a, const T& row, const T& column) {
    const vf at = clampIndex(value(row), 3) * 4 + clampIndex(value(column), 3);
    T r = a.m[0];
#pragma clang loop unroll(full)
    for (int i = 1; i < 16; ++i) r = select(at == float(i), a.m[i], r);
    return r;
}
template <class T> AL_INLINE void opSetcompMatrix(Matrix<T>& a, const T& row, const T& column, const T& v) {
    const vf at = clampIndex(value(row), 3) * 4 + clampIndex(value(column), 3);
#pragma clang loop unroll(full)
    for (int i = 0; i < 16; ++i) a.m[i] = select(at == float(i), v, a.m[i]);
}
/// Product a b, for matrix operators that the code generator does not expand itself: al_multiply.
template <class T> AL_INLINE Matrix<T> opMultiply(const Matrix<T>& a, const Matrix<T>& b) {
    Matrix<T> r;
#pragma clang loop unroll(full)
    for (int i = 0; i < 16; ++i) {
        const T* row = a.m + i / 4 * 4;
        const T* column = b.m + i % 4;
        r.m[i] = mad(row[0], column[0], mad(row[1], column[4], mad(row[2], column[8], row[3] * column[12])));
    }
    return r;
}

AL_RUNTIME(al_translate, opTranslate)
AL_RUNTIME(al_scale, opScale)
AL_RUNTIME(al_rotatematrix, opRotateMatrix)
AL_RUNTIME(al_determinant, opDeterminant)
AL_RUNTIME(al_inverse, opInverse)
AL_RUNTIME(al_compm, opCompMatrix)
AL_RUNTIME(al_setcompm, opSetcompMatrix)
AL_RUNTIME(al_multiply, opMultiply)

} // namespace alpenglow::shadeops::AL_NAMESPACE

#ifdef ALPENGLOW_DESCRIBE
#include "shadeops/describe.h"

namespace alpenglow::shadeops {
std::vector<Shadeop> matrixShadeops() {
    std::vector<Shadeop> list;
    const auto add = [&](const char* name, std::vector<Signature> signatures, const char* doc,
                         std::vector<Example> examples) -> Shadeop& {
        Shadeop op;
        op.section = "Matrices";
        op.source = "3Delight manual, 6.4.3";
        op.name = name;
        op.signatures = std::move(signatures);
        op.doc = doc;
        op.examples = std::move(examples);
        list.push_back(std::move(op));
        return list.back();
    };
    const std::string order = " The new transformation applies first, as in RiTranslate: result = new * m (RISpec 3.2, 4.3).";
    add("translate", sigs({{"matrix translate(matrix m; point t)", "al_translate"}}),
        ("Concatenates a translation by t onto m." + order).c_str(),
        {{"translate(matrix(1), point(1,2,3))", "1 0 0 0 0 1 0 0 0 0 1 0 1 2 3 1"}});
    add("scale", sigs({{"matrix scale(matrix m; point s)", "al_scale"}}), ("Concatenates a scaling by s onto m." + order).c_str(),
        {{"scale(matrix(1), point(2,3,4))", "2 0 0 0 0 3 0 0 0 0 4 0 0 0 0 1"}});
    add("rotate", sigs({{"matrix rotate(matrix m; float angle; vector axis)", "al_rotatematrix"}}),
        ("Concatenates a rotation by angle (radians) about axis onto m; m itself for the zero axis." + order).c_str(),
        {{"rotate(matrix(1), 0, vector(0,0,1))", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"}});
    add("determinant", sigs({{"float determinant(matrix m)", "al_determinant"}}), "Determinant of the 4x4 matrix.",
        {{"determinant(matrix(2))", "16"}});
    add("inverse", sigs({{"matrix inverse(matrix m)", "al_inverse"}}), "Inverse; the identity for a singular matrix.",
        {{"inverse(matrix(2))", "0.5 0 0 0 0 0.5 0 0 0 0 0.5 0 0 0 0 0.5"}});
    add("comp", sigs({{"float comp(matrix m; float row, float column)", "al_compm"}}),
        "Element of a matrix; indices are truncated and clamped to 0..3.", {{"comp(matrix(2), 1, 1)", "2"}});
    add("setcomp", sigs({{"void setcomp(output matrix m; float row, float column, float value)", "al_setcompm"}}),
        "Sets an element of a matrix; indices are truncated and clamped to 0..3.",
        {{"comp(m, 0, 3)", "2", "matrix m = 0; setcomp(m, 0, 3, 2);"}});
    Shadeop& mtransform =
        add("mtransform",
            sigs({{"matrix mtransform(string tospace; matrix m)"},
                  {"matrix mtransform(string fromspace, string tospace; matrix m)"},
                  {"matrix mtransform(matrix tomatrix; matrix m)"},
                  {"matrix mtransform(string fromspace; matrix tomatrix; matrix m)"}}),
            "The transformation m followed by the one from a space (default current) to another, or by a matrix: m M. So "
            "transform(mtransform(\"world\", m), p) is transform(\"world\", transform(m, p)), and matrix \"world\" (...) is "
            "mtransform(\"world\", "
            "\"current\", ...).",
            {{"mtransform(matrix(2), matrix(3))", "6 0 0 0 0 6 0 0 0 0 6 0 0 0 0 6"}});
    mtransform.lowering = Lowering::Special;
    mtransform.derivative = DerivativeRule::Inherent;
    mtransform.source = "RISpec 3.2, 15.4";
    return list;
}
} // namespace alpenglow::shadeops
#endif
