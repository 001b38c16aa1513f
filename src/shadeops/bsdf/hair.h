// bsdf(): "hair": one lobe of the light that a fibre scatters, seen from far away: R, TT, TRT, TRRT (Marschner et al. 2003).
//
// Along the fibre: d'Eon et al. 2011, whose integral is exactly one. Around the fibre: the paths through its width, in pieces;
// within a piece the angle at which light leaves grows evenly, spread by a logistic bell, so that the integral over all angles is
// exactly what the pieces let through and no piece shows, however sharp the bell is.
#pragma once
#include "shadeops/bsdf/common.h"
#include "shadeops/lighting_fresnel.h"

namespace alpenglow::shadeops::AL_NAMESPACE {

/// Index of refraction of a call that gives none.
inline constexpr float kHairEta = 1.55f;
/// Pieces of half the fibre's width, bounded at equal angles.
inline constexpr int kHairPieces = 12;
/// Sines of the angles of the bounds and the middles of the pieces, by their Taylor series.
struct HairTable {
    /// At bounds and middles in turn, from 0 to PI/2.
    float angle[2 * kHairPieces + 1] = {}, sine[2 * kHairPieces + 1] = {}, cosine[2 * kHairPieces + 1] = {};
    /// Computed by the compiler.
    constexpr HairTable() {
        for (int i = 0; i <= 2 * kHairPieces; ++i) {
            const double x = 0.5 * 3.14159265358979323846 * i / (2 * kHairPieces);
            double s = 0, c = 0, term = 1;
            for (int n = 0; n < 24; ++n) {
                const double sign = n / 2 % 2 ? -1 : 1;
                (n % 2 ? s : c) += sign * term;
                term *= x / (n + 1);
            }
            angle[i] = static_cast<float>(x), sine[i] = static_cast<float>(s),
            cosine[i] = static_cast<float>(i == 2 * kHairPieces ? 0 : c);
        }
    }
};
inline constexpr HairTable kHair;

/// exp(-x) times the modified Bessel function I0(x), x >= 0 (Abramowitz and Stegun 9.8.1 and 9.8.2).
template <class T> AL_INLINE T besselScaled(const T& x) {
    const T a = divide(x, T(vf(3.75f))), t = a * a;
    T p = mad(t, vf(0.0045813f), vf(0.0360768f));
    p = mad(p, t, T(vf(0.2659732f)));
    p = mad(p, t, T(vf(1.2067492f)));
    p = mad(p, t, T(vf(3.0899424f)));
    p = mad(p, t, T(vf(3.5156229f)));
    p = mad(p, t, T(vf(1)));
    const T y = divide(T(vf(3.75f)), larger(x, T(vf(3.75f))));
    T q = mad(y, vf(0.00392377f), vf(-0.01647633f));
    q = mad(q, y, T(vf(0.02635537f)));
    q = mad(q, y, T(vf(-0.02057706f)));
    q = mad(q, y, T(vf(0.00916281f)));
    q = mad(q, y, T(vf(-0.00157565f)));
    q = mad(q, y, T(vf(0.00225319f)));
    q = mad(q, y, T(vf(0.01328592f)));
    q = mad(q, y, T(vf(0.39894228f)));
    return select(value(x) < 3.75f, p * exponential(-x), q * inverseRoot(larger(x, T(vf(3.75f)))));
}

/// The bell around the fibre, cut off at +-PI and repeated, as the function whose differences are its integrals.
template <class T> struct HairBell {
    T perWidth, low, scale; ///< 1 / width; logistic at -PI; 1 over what lies within +-PI
    HairBell() = default;
    /// width: scale of the bell, radians, > 0.
    AL_MEMBER explicit HairBell(const T& width) : perWidth(divide(T(vf(1)), width)) {
        low = logistic(perWidth * vf(-kPi));
        scale = divide(T(vf(1)), vf(1) - low * vf(2));
    }
    /// The logistic function; arguments below -30 count as -30.
    static AL_MEMBER T logistic(const T& x) { return divide(T(vf(1)), exponential(-larger(x, T(vf(-30)))) + vf(1)); }
    /// X in -PI to PI, and in `turns` the whole turns that were subtracted.
    static AL_MEMBER T wrap(const T& x, vf& turns) {
        turns = floorLanes((value(x) + vf(kPi)) * vf(0.5f / kPi));
        return x - T(turns * vf(2 * kPi));
    }
    /// The bell's integral up to x, before `scale`, and the whole turns to add: differences of both are integrals.
    AL_MEMBER T upTo(const T& x, vf& turns) const { return logistic(wrap(x, turns) * perWidth); }
    /// The bell's value at x.
    AL_MEMBER T at(const T& x) const {
        vf n;
        const T e = exponential(-absolute(wrap(x, n)) * perWidth), s = e + vf(1);
        return divide(e * perWidth * scale, s * s);
    }
};

/// Two directions at a fibre: what all lobes have in common.
template <class T> struct HairLight {
    T sl, so, cl, co; ///< sines and cosines of the inclinations toward the light and the viewer
    T crossing;       ///< the part of the light that crosses the fibre: reciprocal, and never more than all
    T phi, cd;        ///< angle around the fibre; cosine of half the difference of the inclinations
    /// Of refraction; 1 over that in the plane across the fibre; minus the path through the middle, in radii.
    T index, perIndex, way;
};
/// l, tip and o are unit; axes: tangents(tip, udir).
template <class T>
AL_INLINE HairLight<T> hairLight(const Triple<T>& l, const Triple<T>& tip, const Triple<T>& o, const Pair<Triple<T>>& axes,
                                 const Triple<T>& udir, const T& eta) {
    HairLight<T> g;
    const T one = T(vf(1)), sl = larger(smaller(dot(l, tip), one), -one), so = larger(smaller(dot(o, tip), one), -one);
    const T cl = root(vf(1) - sl * sl), co = root(vf(1) - so * so);
    g.sl = sl, g.so = so, g.cl = cl, g.co = co;
    g.crossing = divide(cl, larger(cl, co));
    // Half the difference of the two inclinations sets how light bends inside (Bravais).
    const T cosDifference = mad(cl, co, sl * so), cd2 = positive((cosDifference + vf(1)) * vf(0.5f));
    const T sd2 = positive(vf(1) - cd2);
    g.cd = root(cd2);
    const Triple<T> lp = normalize(mad3(tip, -sl, l)), op = normalize(mad3(tip, -so, o));
    g.phi = arcTangent2(dot(cross(op, lp), tip), dot(op, lp));
    // An elliptic section acts as a round one whose index depends on the direction of the half vector (Marschner et al. 2003, 6).
    const Triple<T> half = lp + op;
    const T hu = dot(half, axes.a), hv = dot(half, axes.b), hh = mad(hu, hu, hv * hv);
    const T cos2 = divide(mad(hu, hu, -hv * hv), hh);
    const T ratio2 = vf(1) - smaller(dot(udir, udir), T(vf(0.9f)));
    const T bend = eta - vf(1), n1 = bend * ratio2 * vf(2) - bend + vf(1), n2 = divide(bend * vf(2), ratio2) - bend + vf(1);
    g.index = larger((n1 + n2 + cos2 * (n1 - n2)) * vf(0.5f), T(vf(1.01f)));
    const T inner = divide(root(g.index * g.index - sd2), larger(g.cd, T(vf(1e-4f))));
    const T cosInside = root(vf(1) - divide(sd2, g.index * g.index));
    g.way = divide(T(vf(-2)), cosInside), g.perIndex = divide(one, inner);
    return g;
}

/// Light in one piece of the fibre's width, whatever lobe it is of. `to` and `middle`: angles inside.
template <class T> struct HairPiece {
    T to, middle, fresnel; ///< angles inside, and Fresnel reflectance
    Triple<T> through;     ///< transmittance of one way through the fibre, by channel
};
/// Piece i, 0 to kHairPieces - 1.
template <class T> AL_INLINE HairPiece<T> hairPiece(const HairLight<T>& g, const Triple<T>& absorption, int i) {
    HairPiece<T> x;
    const T one = T(vf(1)), s = g.perIndex * vf(kHair.sine[2 * i + 1]);
    x.to = arcSine(g.perIndex * vf(kHair.sine[2 * i + 2])), x.middle = arcSine(s);
    x.fresnel = dielectricReflectance(smaller(g.cd * vf(kHair.cosine[2 * i + 1]), one), divide(one, g.index));
    const T path = g.way * root(vf(1) - s * s);
    x.through = {exponential(path * positive(absorption.x)), exponential(path * positive(absorption.y)),
                 exponential(path * positive(absorption.z))};
    return x;
}

/// One lobe, while the pieces are added up.
template <class T> struct HairLobe {
    vf p;                     ///< number of passes inside: 0 is reflection
    T along;                  ///< the part of the light that leaves at the inclination of l
    HairBell<T> bell;         ///< around the fibre
    T from;                   ///< angle between in and out where the piece begins
    T plus, minus;            ///< the logistic of phi - from and phi + from
    vf plusTurns, minusTurns; ///< whole turns of plus and minus
    Triple<T> around;         ///< sum so far, by channel
};
/// The lobe by its number: 0 to 3.
template <class T> AL_INLINE vf hairNumber(const T& lobe) { return minLanes(maxLanes(floorLanes(value(lobe)), vf(0)), vf(3)); }
/// Scale of the bell around the fibre for a spread of 0..1.
template <class T> AL_INLINE T hairBellWidth(const T& azimuthal) {
    const T a = larger(smaller(azimuthal, T(vf(1))), T(vf(0.02f))), a2 = a * a, a4 = a2 * a2, a8 = a4 * a4,
            a22 = a8 * a8 * a4 * a2;
    return (a22 * vf(5.372f) + a2 * vf(1.194f) + a * vf(0.265f)) * vf(0.626657069f); // sqrt(PI / 8)
}
/// Variance along the fibre for a spread of 0..1 (Chiang et al. 2016).
template <class T> AL_INLINE T hairVariance(const T& longitudinal) {
    const T b = larger(smaller(longitudinal, T(vf(1))), T(vf(0.02f))), b2 = b * b, b4 = b2 * b2, b8 = b4 * b4, b20 = b8 * b8 * b4;
    const T width = mad(b20, vf(3.7f), vf(0)) + b2 * vf(0.812f) + b * vf(0.726f);
    return width * width;
}
/// turn: (2 - 3 p) tilt, its sine and cosine: the scales turn lobe p by 2, -1, -4 times the tilt for R, TT, TRT.
template <class T>
AL_INLINE HairLobe<T> hairLobe(const HairLight<T>& g, vf p, const T& st, const T& ct, const T& v, const HairBell<T>& bell) {
    HairLobe<T> lobe{p, T(vf(0)), bell, T(vf(kPi) * p - vf(2 * kHair.angle[0])), T(vf(0)), T(vf(0)), vf(0), vf(0), none3<T>()};
    const T s2 = g.so * ct - g.co * st, c2 = absolute(mad(g.co, ct, g.so * st));
    lobe.along = divide(exponential(divide(mad(c2, g.cl, -s2 * g.sl) - vf(1), v)) * besselScaled(divide(c2 * g.cl, v)),
                        v * (vf(1) - exponential(divide(T(vf(-2)), v))));
    lobe.plus = bell.upTo(g.phi - lobe.from, lobe.plusTurns);
    lobe.minus = bell.upTo(g.phi + lobe.from, lobe.minusTurns);
    return lobe;
}
/// Adds piece i to a lobe.
template <class T> AL_INLINE void addPiece(HairLobe<T>& lobe, const HairLight<T>& g, const HairPiece<T>& x, int i) {
    const vf p = lobe.p;
    const HairBell<T>& bell = lobe.bell;
    const T to = x.to * (vf(2) * p) + T(vf(kPi) * p - vf(2 * kHair.angle[2 * i + 2]));
    const T middle = x.middle * (vf(2) * p) + T(vf(kPi) * p - vf(2 * kHair.angle[2 * i + 1]));
    vf plusTurns, minusTurns;
    const T plusTo = bell.upTo(g.phi - to, plusTurns), minusTo = bell.upTo(g.phi + to, minusTurns);
    // Light that is spread over no angle at all counts as the bell itself.
    const T wide = to - lobe.from;
    const vm still = absLanes(value(wide)) * value(bell.perWidth) < 0.05f;
    const vm falling = value(wide) < 0;
    const T span = absolute(wide);
    const T over = (lobe.plus - plusTo) * bell.scale + T(lobe.plusTurns - plusTurns),
            under = (minusTo - lobe.minus) * bell.scale + T(minusTurns - lobe.minusTurns);
    const T plus = select(still, bell.at(g.phi - middle), divide(select(falling, -over, over), span));
    const T minus = select(still, bell.at(g.phi + middle), divide(select(falling, -under, under), span));
    const T share = (plus + minus) * vf(0.5f * (kHair.sine[2 * i + 2] - kHair.sine[2 * i]));
    const T one = T(vf(1)), entered = vf(1) - x.fresnel;
    const auto kept = [&](const T& through) __attribute__((always_inline)) {
        const T again = x.fresnel * through;
        const T more = select(p > 2.5f, again * again, select(p > 1.5f, again, one));
        return share * select(p < 0.5f, x.fresnel, entered * entered * through * more);
    };
    lobe.around = lobe.around + Triple<T>{kept(x.through.x), kept(x.through.y), kept(x.through.z)};
    lobe.from = to, lobe.plus = plusTo, lobe.minus = minusTo, lobe.plusTurns = plusTurns, lobe.minusTurns = minusTurns;
}

template <class T>
AL_INLINE Triple<T> opBsdfHair(const Triple<T>& l, const Triple<T>& tip0, const Triple<T>& o, const Triple<T>& udir, const T& eta,
                               const Triple<T>& absorption, const T& lobe, const T& tilt, const T& longitudinal,
                               const T& azimuthal) {
    const Triple<T> tip = normalize(tip0);
    const HairLight<T> g = hairLight(normalize(l), tip, normalize(o), tangents(tip, udir), udir, eta);
    const vf p = hairNumber(lobe);
    const T turn = tilt * (vf(2) - vf(3) * p);
    HairLobe<T> sum = hairLobe(g, p, sine(turn), cosine(turn), hairVariance(longitudinal), HairBell<T>(hairBellWidth(azimuthal)));
    for (int i = 0; i < kHairPieces; ++i) addPiece(sum, g, hairPiece(g, absorption, i), i);
    return times(sum.around, sum.along * g.crossing);
}
AL_RUNTIME(al_bsdf_hair, opBsdfHair)

} // namespace alpenglow::shadeops::AL_NAMESPACE

#ifdef ALPENGLOW_DESCRIBE
namespace alpenglow::shadeops {
inline Distribution bsdfHair() {
    Distribution d =
        bsdfOp("hair",
               "color __bsdf_hair(vector l, vector tip, vector wo, vector udir; float eta; color absorption; float "
               "lobe, float tilt, float longitudinal, "
               "float azimuthal)",
               "al_bsdf_hair",
               "lobe 0 (R) to 3 (TRRT) of a fibre that points along tip, for its whole width. tilt turns lobe "
               "p by (2 - 3 p) tilt toward the tip; "
               "longitudinal and azimuthal, 0..1, set its spread along and around the fibre; absorption acts along "
               "paths inside, 2 being the diameter. udir is "
               "the long axis of an elliptic section, its length the eccentricity (below 1, 0 is round). Without tilt "
               "the lobes are reciprocal; together "
               "they keep at most all light.",
               "3Delight manual, 6.4.5.2; Marschner et al. 2003, d'Eon et al. 2011, Chiang et al. 2016", {"", ""});
    d.eta = AL_NAMESPACE::kHairEta;
    d.parts = 4; // 3Delight manual, 6.4.5.2: up to 4 lobes of 4 numbers: weight, tilt, longitudinal, azimuthal
    d.lobe = {1, 0, 0.3f, 0.3f};
    d.lobes = 3;
    d.surface = false;
    return d;
}
} // namespace alpenglow::shadeops
#endif
