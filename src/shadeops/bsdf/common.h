// What the distributions of bsdf() share: the frame of a surface, Fresnel's equations, half vectors. Models: docs/design/rsl.md.
//
// Every distribution takes l (toward the light), n (the surface's normal) and, most of them, wo (toward the viewer), of any
// length, and gives the reflection function times the cosine n . l, per steradian: over all l its integral is the part of the
// light that is kept. Each file declares its name and
// its formula (Distribution); bsdf() chooses by that name (rsl/ir/build_bsdf.cpp), the lobes of trace() use the formulas.
#pragma once
#include "shadeops/call.h"

namespace alpenglow::shadeops::AL_NAMESPACE {

/// Smaller roughness counts as this: a mirror has no value at a single direction.
inline constexpr float kLeastRoughness = 0.01f;

/// Zero in all components.
template <class T> AL_INLINE Triple<T> none3() { return {T(vf(0)), T(vf(0)), T(vf(0))}; }
/// 0 for negative x.
template <class T> AL_INLINE T positive(const T& x) { return larger(x, T(vf(0))); }
/// At least the least roughness that the formulas bear.
template <class T> AL_INLINE T sane(const T& roughness) { return larger(roughness, T(vf(kLeastRoughness))); }

/// -log(1 - x) / x for 0 <= x <= 1: a series where the quotient has no digits. At 1 a large number.
template <class T> AL_INLINE T logRatio(const T& x) {
    const T series = mad(mad(mad(x, vf(0.25f), vf(1.0f / 3)), x, T(vf(0.5f))), x, T(vf(1)));
    const T whole = divide(-logarithm(larger(vf(1) - x, T(vf(1e-30f)))), x);
    return select(value(x) < 0.01f, series, whole);
}

/// Two unit vectors perpendicular to n (unit) and each other; the first lies as far along udir as it can.
template <class T> AL_INLINE Pair<Triple<T>> tangents(const Triple<T>& n, const Triple<T>& udir) {
    const vm x = absLanes(value(n.x)) < 0.9f;
    const Triple<T> any{T(select(x, vf(1), vf(0))), T(select(x, vf(0), vf(1))), T(vf(0))};
    const Triple<T> wanted = mad3(n, -dot(n, udir), udir);
    const vm given = value(dot(wanted, wanted)) > 1e-12f * value(dot(udir, udir));
    const Triple<T> u = normalize(select3(given, wanted, mad3(n, -dot(n, any), any)));
    return {u, cross(n, u)};
}

/// Fresnel reflectance of a surface with index eta + i k seen from vacuum, c = cosine of the angle of incidence in 0..1.
template <class T> AL_INLINE T fresnelComplex(const T& c, const T& eta, const T& k) {
    const T c2 = c * c, s2 = vf(1) - c2, k2 = k * k;
    const T t0 = eta * eta - k2 - s2, r = root(mad(t0, t0, eta * eta * k2 * vf(4)));
    const T a = root(positive((r + t0) * vf(0.5f)));
    const T sum = r + c2, twice = a * c * vf(2);
    const T rs = divide(sum - twice, sum + twice);
    const T sum2 = mad(c2, r, s2 * s2), twice2 = twice * s2;
    const T rp = rs * divide(sum2 - twice2, sum2 + twice2);
    return smaller(positive((rs + rp) * vf(0.5f)), T(vf(1)));
}
/// One channel of the optional Fresnel factor: 1 where eta is 0 (docs/design/rsl.md, "Distributions").
template <class T> AL_INLINE T fresnelOrFull(const T& c, const T& eta, const T& k) {
    return select(value(eta) <= 0, T(vf(1)), fresnelComplex(c, eta, k));
}
template <class T> AL_INLINE Triple<T> fresnelOrFull3(const T& c, const Triple<T>& eta, const Triple<T>& k) {
    return {fresnelOrFull(c, eta.x, k.x), fresnelOrFull(c, eta.y, k.y), fresnelOrFull(c, eta.z, k.z)};
}

/// What every reflection by small facets needs.
template <class T> struct Facet {
    Triple<T> l, n, o, h; ///< unit: light, normal, viewer, halfway
    T nl, no, nh, oh;     ///< cosines between them
    T sine2;              ///< squared sine between n and h, with digits near 0
    vm seen;              ///< light and viewer on the side of n
};
/// l, n and o are unit.
template <class T> AL_INLINE Facet<T> facetOfUnit(const Triple<T>& l, const Triple<T>& n, const Triple<T>& o) {
    Facet<T> f;
    f.l = l, f.n = n, f.o = o;
    f.h = normalize(f.l + f.o);
    f.nl = dot(f.n, f.l), f.no = dot(f.n, f.o), f.nh = positive(dot(f.n, f.h)), f.oh = positive(dot(f.o, f.h));
    const Triple<T> s = cross(f.n, f.h);
    f.sine2 = smaller(dot(s, s), T(vf(1)));
    f.seen = (value(f.nl) > 0) & (value(f.no) > 0);
    return f;
}
template <class T> AL_INLINE Facet<T> facetOf(const Triple<T>& l0, const Triple<T>& n0, const Triple<T>& o0) {
    return facetOfUnit(normalize(l0), normalize(n0), normalize(o0));
}
/// Shadowing of V-shaped grooves (Torrance and Sparrow 1967).
template <class T> AL_INLINE T grooves(const Facet<T>& f) {
    const T k = divide(f.nh * vf(2), f.oh);
    return smaller(T(vf(1)), smaller(k * f.no, k * f.nl));
}
/// Roughness to exponent: roughness^-3.5 - 1 (docs/design/rsl.md).
template <class T> AL_INLINE T exponentOf(const T& roughness) { return positive(power(sane(roughness), T(vf(-3.5f))) - vf(1)); }

} // namespace alpenglow::shadeops::AL_NAMESPACE

#ifdef ALPENGLOW_DESCRIBE
#include "shadeops/describe.h"
#include "shadeops/distributions.h"

namespace alpenglow::shadeops {
/// A distribution and its hidden shadeop, which is large, so called and not inlined.
inline Distribution bsdfOp(const char* name, const char* signature, const char* symbol, const char* doc, const char* source,
                           Example example) {
    Distribution d;
    d.name = name;
    Shadeop& op = d.formula;
    op.signatures = {parseSignature(signature, symbol)};
    const std::string& text = op.signatures[0].text;
    const size_t open = text.find('(');
    op.name = text.substr(text.find(' ') + 1, open - text.find(' ') - 1);
    op.section = "Lighting";
    op.outOfLine = true;
    op.widest = 16;
    op.doc = "A distribution of bsdf(). \"" + d.name + "\": " + doc;
    op.source = source;
    if (!example.expression.empty()) op.examples = {std::move(example)};
    return d;
}
} // namespace alpenglow::shadeops
#endif
