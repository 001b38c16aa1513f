// Joins a value that was looked up with its slopes, and the coordinates of the lookup, to one value with derivatives by the
// chain rule (rsl/passes/gradients.h). What is looked up counts as constant; al_chain*: as if the slopes were the same
// everywhere; al_chain*c: with the second derivatives of the map, too.
#pragma once
#include "shadeops/call.h"

namespace alpenglow::shadeops::AL_NAMESPACE {

/// A value with its slopes, over two coordinates and over three: the slopes times the coordinates' derivatives. Triples component
/// by component.
template <class T> AL_INLINE T opChain2(const T& v, const T& byS, const T& byT, const T& s, const T& t) {
    return withValue(s * value(byS) + t * value(byT), value(v));
}
template <class T>
AL_INLINE Triple<T> opChain2Triple(const Triple<T>& v, const Triple<T>& a, const Triple<T>& b, const T& s, const T& t) {
    return {opChain2(v.x, a.x, b.x, s, t), opChain2(v.y, a.y, b.y, s, t), opChain2(v.z, a.z, b.z, s, t)};
}
template <class T> AL_INLINE T opChain3(const T& v, const T& a, const T& b, const T& c, const Triple<T>& d) {
    return withValue(d.x * value(a) + d.y * value(b) + d.z * value(c), value(v));
}
template <class T>
AL_INLINE Triple<T> opChain3Triple(const Triple<T>& v, const Triple<T>& a, const Triple<T>& b, const Triple<T>& c,
                                   const Triple<T>& d) {
    return {opChain3(v.x, a.x, b.x, c.x, d), opChain3(v.y, a.y, b.y, c.y, d), opChain3(v.z, a.z, b.z, c.z, d)};
}

/// Parabola over the coordinates; aa, ab, bb: second derivatives.
template <class T>
AL_INLINE T opCurve2(const T& v, const T& a, const T& b, const T& aa, const T& ab, const T& bb, const T& s, const T& t) {
    const T x = withValue(s, vf(0)), y = withValue(t, vf(0));
    const T second = x * x * (value(aa) * vf(0.5f)) + x * y * value(ab) + y * y * (value(bb) * vf(0.5f));
    return withValue(x * value(a) + y * value(b) + second, value(v));
}
template <class T>
AL_INLINE Triple<T> opCurve2Triple(const Triple<T>& v, const Triple<T>& a, const Triple<T>& b, const Triple<T>& aa,
                                   const Triple<T>& ab, const Triple<T>& bb, const T& s, const T& t) {
    return {opCurve2(v.x, a.x, b.x, aa.x, ab.x, bb.x, s, t), opCurve2(v.y, a.y, b.y, aa.y, ab.y, bb.y, s, t),
            opCurve2(v.z, a.z, b.z, aa.z, ab.z, bb.z, s, t)};
}

/// The same over three coordinates.
template <class T>
AL_INLINE T opCurve3(const T& v, const T& a, const T& b, const T& c, const T& aa, const T& ab, const T& ac, const T& bb,
                     const T& bc, const T& cc, const Triple<T>& d) {
    const T x = withValue(d.x, vf(0)), y = withValue(d.y, vf(0)), z = withValue(d.z, vf(0));
    const T second = x * x * (value(aa) * vf(0.5f)) + x * y * value(ab) + x * z * value(ac) + y * y * (value(bb) * vf(0.5f)) +
                     y * z * value(bc) + z * z * (value(cc) * vf(0.5f));
    return withValue(x * value(a) + y * value(b) + z * value(c) + second, value(v));
}
template <class T>
AL_INLINE Triple<T> opCurve3Triple(const Triple<T>& v, const Triple<T>& a, const Triple<T>& b, const Triple<T>& c,
                                   const Triple<T>& aa, const Triple<T>& ab, const Triple<T>& ac, const Triple<T>& bb,
                                   const Triple<T>& bc, const Triple<T>& cc, const Triple<T>& d) {
    return {opCurve3(v.x, a.x, b.x, c.x, aa.x, ab.x, ac.x, bb.x, bc.x, cc.x, d),
            opCurve3(v.y, a.y, b.y, c.y, aa.y, ab.y, ac.y, bb.y, bc.y, cc.y, d),
            opCurve3(v.z, a.z, b.z, c.z, aa.z, ab.z, ac.z, bb.z, bc.z, cc.z, d)};
}

AL_RUNTIME(al_chain2_f, opChain2)
AL_RUNTIME(al_chain2_t, opChain2Triple)
AL_RUNTIME(al_chain3_f, opChain3)
AL_RUNTIME(al_chain3_t, opChain3Triple)
AL_RUNTIME(al_chain2c_f, opCurve2)
AL_RUNTIME(al_chain2c_t, opCurve2Triple)
AL_RUNTIME(al_chain3c_f, opCurve3)
AL_RUNTIME(al_chain3c_t, opCurve3Triple)

} // namespace alpenglow::shadeops::AL_NAMESPACE
