// A value that was looked up with its slopes, and the coordinates it was looked up at: made one value with derivatives by the chain
// rule (rsl/passes/gradients.h). The slopes count as constant, so second derivatives are those of the coordinates alone.
#pragma once
#include "shadeops/call.h"

namespace alpenglow::rsl::AL_NAMESPACE {

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
AL_INLINE Triple<T> opChain3Triple(const Triple<T>& v, const Triple<T>& a, const Triple<T>& b, const Triple<T>& c, const Triple<T>& d) {
    return {opChain3(v.x, a.x, b.x, c.x, d), opChain3(v.y, a.y, b.y, c.y, d), opChain3(v.z, a.z, b.z, c.z, d)};
}

AL_RUNTIME(al_chain2_f, opChain2)
AL_RUNTIME(al_chain2_t, opChain2Triple)
AL_RUNTIME(al_chain3_f, opChain3)
AL_RUNTIME(al_chain3_t, opChain3Triple)

} // namespace alpenglow::rsl::AL_NAMESPACE
