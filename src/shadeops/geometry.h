// Geometry: 3Delight manual, 6.4.3. Code for all lane widths above, descriptors below (host only).
#pragma once
#include "shadeops/call.h"

namespace alpenglow::shadeops::AL_NAMESPACE {

template <class T> AL_INLINE T opX(const Triple<T>& p) { return p.x; }
template <class T> AL_INLINE T opY(const Triple<T>& p) { return p.y; }
template <class T> AL_INLINE T opZ(const Triple<T>& p) { return p.z; }
template <class T> AL_INLINE void opSetX(Triple<T>& p, const T& v) { p.x = v; }
template <class T> AL_INLINE void opSetY(Triple<T>& p, const T& v) { p.y = v; }
template <class T> AL_INLINE void opSetZ(Triple<T>& p, const T& v) { p.z = v; }
/// The square of a length leaves the range of floats long before the length does. Where it would, the power of two that brings
/// the vector into the middle of the range; else 1, and nothing changes.
template <class T> AL_INLINE vf midRange(const Triple<T>& v) {
    const vf x = value(v.x), y = value(v.y), z = value(v.z), square = mad(x, x, mad(y, y, z * z));
    return select(square < 0x1p-100f, vf(0x1p100f), select(square > 0x1p120f, vf(0x1p-70f), vf(1)));
}
/// What undoes midRange().
AL_INLINE vf fromMidRange(vf k) { return select(k > 1, vf(0x1p-100f), select(k < 1, vf(0x1p70f), vf(1))); }
/// V times k.
template <class T> AL_INLINE Triple<T> scaled(const Triple<T>& v, vf k) { return {v.x * k, v.y * k, v.z * k}; }
template <class T> AL_INLINE T opLength(const Triple<T>& v) {
    const vf k = midRange(v);
    return length(scaled(v, k)) * fromMidRange(k);
}
template <class T> AL_INLINE T opDistance(const Triple<T>& a, const Triple<T>& b) { return opLength(b - a); }
template <class T> AL_INLINE Triple<T> opNormalize(const Triple<T>& v) { return normalize(scaled(v, midRange(v))); }
template <class T> AL_INLINE T opPtlined(const Triple<T>& a, const Triple<T>& b, const Triple<T>& q) {
    const Triple<T> d = b - a, e = q - a;
    const vf kd = midRange(d), ke = midRange(e);
    const Triple<T> dm = scaled(d, kd), em = scaled(e, ke);
    const T t = divide(dot(dm, em), dot(dm, dm)) * kd * fromMidRange(ke);
    const T s = larger(T(vf(0)), smaller(t, T(vf(1))));
    return opLength(e - times(d, s));
}

/// Rodrigues' formula about the line through a along b - a.
template <class T> AL_INLINE Triple<T> opRotatePoint(const Triple<T>& q, const T& angle, const Triple<T>& a, const Triple<T>& b) {
    const Triple<T> k = opNormalize(b - a), d = q - a;
    const T c = cosine(angle), s = sine(angle);
    const Triple<T> r = mad3(k, dot(k, d) * (vf(1) - c), mad3(cross(k, d), s, times(d, c)));
    return select3(value(dot(k, k)) == 0, q, a + r);
}

template <class T> AL_INLINE Triple<T> opReflect(const Triple<T>& i, const Triple<T>& n) {
    return mad3(n, dot(i, n) * vf(-2), i);
}
template <class T> AL_INLINE Triple<T> opRefract(const Triple<T>& i, const Triple<T>& n, const T& eta) {
    const T d = dot(i, n), k = vf(1) - eta * eta * (vf(1) - d * d);
    const T zero = T(vf(0));
    return select3(value(k) < 0, Triple<T>{zero, zero, zero}, times(i, eta) - times(n, eta * d + root(k)));
}

/// Row vectors: p' = (p, 1) M, divided by the fourth component.
template <class T> AL_INLINE Triple<T> opTransformPoint(const Matrix<T>& a, const Triple<T>& p) {
    const auto column = [&](int c) __attribute__((always_inline)) {
        return mad(p.x, a.m[c], mad(p.y, a.m[4 + c], mad(p.z, a.m[8 + c], a.m[12 + c])));
    };
    const T w = column(3);
    return {divide(column(0), w), divide(column(1), w), divide(column(2), w)};
}
template <class T> AL_INLINE Triple<T> opTransformVector(const Matrix<T>& a, const Triple<T>& p) {
    const auto column = [&](int c)
                            __attribute__((always_inline)) { return mad(p.x, a.m[c], mad(p.y, a.m[4 + c], p.z * a.m[8 + c])); };
    return {column(0), column(1), column(2)};
}
/// By the inverse transpose of the upper 3x3, which is its matrix of cofactors over the determinant. 0 for a singular matrix.
template <class T> AL_INLINE Triple<T> opTransformNormal(const Matrix<T>& a, const Triple<T>& n) {
    const Triple<T> r0{a.m[0], a.m[1], a.m[2]}, r1{a.m[4], a.m[5], a.m[6]}, r2{a.m[8], a.m[9], a.m[10]};
    const Triple<T> c0 = cross(r1, r2), c1 = cross(r2, r0), c2 = cross(r0, r1);
    const T inverse = divide(T(vf(1)), dot(r0, c0));
    return times(mad3(c0, n.x, mad3(c1, n.y, times(c2, n.z))), inverse);
}

AL_RUNTIME(al_xcomp_t, opX)
AL_RUNTIME(al_ycomp_t, opY)
AL_RUNTIME(al_zcomp_t, opZ)
AL_RUNTIME(al_setxcomp_t, opSetX)
AL_RUNTIME(al_setycomp_t, opSetY)
AL_RUNTIME(al_setzcomp_t, opSetZ)
AL_RUNTIME(al_distance, opDistance)
AL_RUNTIME(al_length, opLength)
AL_RUNTIME(al_normalize_t, opNormalize)
AL_RUNTIME(al_ptlined, opPtlined)
AL_RUNTIME(al_rotatepoint, opRotatePoint)
AL_RUNTIME(al_reflect, opReflect)
AL_RUNTIME(al_refract, opRefract)
AL_RUNTIME(al_transformpoint, opTransformPoint)
AL_RUNTIME(al_transformvector, opTransformVector)
AL_RUNTIME(al_transformnormal, opTransformNormal)

} // namespace alpenglow::shadeops::AL_NAMESPACE

#ifdef ALPENGLOW_DESCRIBE
#include "shadeops/describe.h"

namespace alpenglow::shadeops {
namespace {

/// Adds a shadeop with what most of the section have in common.
Shadeop& addGeometric(std::vector<Shadeop>& list, const char* name, std::vector<Signature> signatures, const char* doc,
                      std::vector<Example> examples) {
    Shadeop op;
    op.section = "Geometry";
    op.source = "3Delight manual, 6.4.3";
    op.name = name;
    op.signatures = std::move(signatures);
    op.doc = doc;
    op.examples = std::move(examples);
    list.push_back(std::move(op));
    return list.back();
}

void addComponents(std::vector<Shadeop>& list) {
    for (int i = 0; i < 3; ++i) {
        const std::string axis(1, "xyz"[i]);
        addGeometric(list, (axis + "comp").c_str(), each(kTuples, "float " + axis + "comp($ p)", "al_" + axis + "comp"),
                     ("The " + axis + " component of a tuple.").c_str(), {{axis + "comp(point(1,2,3))", std::to_string(i + 1)}});
        addGeometric(list, ("set" + axis + "comp").c_str(),
                     each(kTuples, "void set" + axis + "comp(output $ p; float value)", "al_set" + axis + "comp"),
                     ("Sets the " + axis + " component of a tuple.").c_str(),
                     {{"p", std::string(i == 0 ? "2" : "0") + (i == 1 ? " 2" : " 0") + (i == 2 ? " 2" : " 0"),
                       "point p = 0; set" + axis + "comp(p, 2);"}});
    }
}

void addDistances(std::vector<Shadeop>& list) {
    addGeometric(list, "distance", sigs({{"float distance(point a, point b)", "al_distance"}}), "Length of b - a.",
                 {{"distance(point(1,2,3), point(1,5,7))", "5"}});
    addGeometric(list, "length", sigs({{"float length(vector v)", "al_length"}}),
                 "Euclidean length. Its derivative at the zero vector is taken as 0.", {{"length(vector(0,3,4))", "5"}});
    addGeometric(list, "normalize", each("vector point normal", "$ normalize($ v)", "al_normalize"),
                 "v / length(v); the zero vector for the zero vector.",
                 {{"normalize(vector(0,3,4))", "0 0.6 0.8"}, {"normalize(vector(0,0,0))", "0 0 0"}});
    addGeometric(
        list, "ptlined", sigs({{"float ptlined(point a, point b, point q)", "al_ptlined"}}),
        "Distance from q to the segment from a to b.",
        {{"ptlined(point(0,0,0), point(1,0,0), point(4,4,0))", "5"}, {"ptlined(point(0,0,0), point(4,0,0), point(1,2,0))", "2"}});
}

/// What turns points and directions.
void addDirections(std::vector<Shadeop>& list) {
    addGeometric(list, "rotate", sigs({{"point rotate(point q; float angle; point a, point b)", "al_rotatepoint"}}),
                 "Rotates q by angle (radians) about the line from a to b, counterclockwise seen with b - a toward the eye in a "
                 "right-handed space. "
                 "q itself when a = b.",
                 {{"rotate(point(1,0,0), 0, point(0,0,0), point(0,0,1))", "1 0 0"}});
    addGeometric(list, "faceforward", {},
                 "n or -n, so that it faces against i: n if i . nref <= 0, else -n. nref defaults to the geometric normal Ng.",
                 {{"faceforward(vector(0,0,1), vector(0,0,1), vector(0,0,1))", "0 0 -1"}});
    list.back().lowering = Lowering::Rsl;
    list.back().derivative = DerivativeRule::Inherent;
    list.back().signatures = each("vector normal", "$ faceforward($ n; vector i; vector nref)") +
                             each("vector normal", "$ faceforward($ n; vector i)");
    list.back().rsl = R"(
vector faceforward(vector n; vector i; vector nref) { return (i . nref) > 0 ? -n : n; }
normal faceforward(normal n; vector i; vector nref) { return (i . nref) > 0 ? -n : n; }
vector faceforward(vector n; vector i) { extern normal Ng; return (i . Ng) > 0 ? -n : n; }
normal faceforward(normal n; vector i) { extern normal Ng; return (i . Ng) > 0 ? -n : n; }
)";
    addGeometric(list, "reflect", sigs({{"vector reflect(vector i, vector n)", "al_reflect"}}),
                 "i - 2 (i . n) n: i mirrored at the plane of the unit vector n.",
                 {{"reflect(vector(1,-1,0), vector(0,1,0))", "1 1 0"}});
    addGeometric(
        list, "refract", sigs({{"vector refract(vector i, vector n; float eta)", "al_refract"}}),
        "Direction of the refracted ray; i and n unit, n against i, eta = index of the side of i / index of the side entered. "
        "The zero vector on "
        "total reflection.",
        {{"refract(vector(0,0,1), vector(0,0,-1), 0.5)", "0 0 1"}, {"refract(vector(0.6,0,0.8), vector(0,0,-1), 2)", "0 0 0"}});
}

/// Spaces.
void addTransforms(std::vector<Shadeop>& list) {
    Shadeop& depth = addGeometric(list, "depth", sigs({{"float depth(point p)"}}),
                                  "Camera depth of p, 0 at the near and 1 at the far clipping plane; p in current space.",
                                  {{"depth(P)", "0.5", "", "P stands in the middle between the planes of clipping"}});
    depth.lowering = Lowering::Service;
    depth.derivative = DerivativeRule::ZeroWarn;

    Shadeop& transform =
        addGeometric(list, "transform", {}, "", {{"transform(translate(matrix(1), point(1, 2, 3)), P)", "1 2 3"}});
    transform.lowering = Lowering::Special;
    transform.derivative = DerivativeRule::Inherent;
    for (const char* type : {"point", "vector", "normal"}) {
        const std::string parts[] = {std::string(type) + " transform(string tospace; " + type + " p)",
                                     std::string(type) + " transform(string fromspace, string tospace; " + type + " p)",
                                     std::string(type) + " transform(matrix m; " + type + " p)",
                                     std::string(type) + " transform(string fromspace; matrix m; " + type + " p)"};
        for (const std::string& text : parts) transform.signatures.push_back(parseSignature(text));
    }
    transform.doc = "From one named space (default current) to another, or by a matrix. Points with translation and homogeneous "
                    "divide, vectors by "
                    "the upper 3x3, normals by its inverse transpose. Symbols al_transformpoint, al_transformvector, "
                    "al_transformnormal (matrix, "
                    "tuple). Row vectors: p' = p M.";
    Shadeop& vtransform =
        addGeometric(list, "vtransform", {}, "transform() by the rule of vectors, whatever the type of the argument.",
                     {{"vtransform(scale(matrix(1), point(2, 3, 4)), vector(1, 1, 1))", "2 3 4"}});
    vtransform.lowering = Lowering::Special;
    vtransform.derivative = DerivativeRule::Inherent;
    vtransform.signatures = sigs({{"vector vtransform(string tospace; vector v)"},
                                  {"vector vtransform(string fromspace, string tospace; vector v)"},
                                  {"vector vtransform(matrix m; vector v)"},
                                  {"vector vtransform(string fromspace; matrix m; vector v)"}});
    Shadeop& ntransform =
        addGeometric(list, "ntransform", {}, "transform() by the rule of normals, whatever the type of the argument.",
                     {{"ntransform(scale(matrix(1), point(2, 1, 1)), normal(1, 0, 0))", "0.5 0 0"}});
    ntransform.lowering = Lowering::Special;
    ntransform.derivative = DerivativeRule::Inherent;
    ntransform.signatures = sigs({{"normal ntransform(string tospace; normal n)"},
                                  {"normal ntransform(string fromspace, string tospace; normal n)"},
                                  {"normal ntransform(matrix m; normal n)"},
                                  {"normal ntransform(string fromspace; matrix m; normal n)"}});
}

} // namespace

std::vector<Shadeop> geometryShadeops() {
    std::vector<Shadeop> list;
    addComponents(list);
    addDistances(list);
    addDirections(list);
    addTransforms(list);
    return list;
}
} // namespace alpenglow::shadeops
#endif
