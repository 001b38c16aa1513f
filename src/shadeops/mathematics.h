// Mathematics: 3Delight manual, 6.4.1. Code for all lane widths above, descriptors below (host only).
#pragma once
#include "shadeops/call.h"

namespace alpenglow::shadeops::AL_NAMESPACE {

template <class T> AL_INLINE T opRadians(const T& x) { return x * vf(kPi / 180); }
template <class T> AL_INLINE T opDegrees(const T& x) { return x * vf(180 / kPi); }
/// Negative numbers give -infinity whatever the base (3Delight manual, 6.4.1); 0 gives the limit, +infinity for bases below 1.
/// Where there is no such logarithm, in base 1 and in bases that are not positive, it is 0, as a division by 0 is.
template <class T> AL_INLINE T opLogBase(const T& x, const T& base) {
    const vf a = value(x), b = value(base), infinite = vf(__builtin_inff());
    const vm none = ((b >= 0x1p-126f) == 0) | (b == 1), zero = (a >= 0x1p-126f) == 0; // what is no normal float counts as 0
    const T inside = divide(logarithm2(select(zero, T(vf(1)), x)), logarithm2(select(none, T(vf(2)), base)));
    const T limit = T(select((a < 0) | (b >= 1), -infinite, infinite));
    return select(a < 0, limit, select(none, T(vf(0)), select(zero, limit, inside)));
}
template <class T> AL_INLINE T opSign(const T& x) { return T(select(value(x) < 0, vf(-1), vf(1))); }
template <class T> AL_INLINE T opFloor(const T& x) { return T(floorLanes(value(x))); }
template <class T> AL_INLINE T opCeil(const T& x) { return T(ceilLanes(value(x))); }
template <class T> AL_INLINE T opRound(const T& x) {
    const vf v = value(x), t = truncLanes(v);
    return T(select(absLanes(v - t) >= 0.5f, t + copySign(vf(1), v), t));
}

/// x - y floor(x / y). The quotient may round across an integer: one correction. 0 where it is too large to have a fraction.
template <class T> AL_INLINE T opMod(const T& x, const T& y) {
    const vf q = divide(value(x), value(y)), n = floorLanes(q);
    const vm sane = absLanes(q) < 16777216.0f;
    const T r = mad(T(select(sane, -n, vf(0))), y, x);
    const vm outside = select(value(y) < 0, -value(r), value(r)) < 0;
    return select(sane, select(value(y) == 0, T(vf(0)), select(outside, r + y, r)), T(vf(0)));
}

template <class T> AL_INLINE T opMin(const T& a, const T& b) { return smaller(a, b); }
template <class T> AL_INLINE T opMax(const T& a, const T& b) { return larger(a, b); }
template <class T> AL_INLINE T opClamp(const T& x, const T& lo, const T& hi) {
    return select(value(x) < value(lo), lo, select(value(x) > value(hi), hi, x));
}
template <class T> AL_INLINE T opStep(const T& edge, const T& x) { return T(select(value(x) < value(edge), vf(0), vf(1))); }
template <class T> AL_INLINE T opSmoothstep(const T& lo, const T& hi, const T& x) {
    const T t = divide(x - lo, hi - lo);
    const T s = t * t * (vf(3) - t * vf(2));
    return select(value(x) < value(lo), T(vf(0)), select(value(x) >= value(hi), T(vf(1)), s));
}
template <class T> AL_INLINE T opMix(const T& x, const T& y, const T& alpha) { return mad(y, alpha, x * (vf(1) - alpha)); }

#define AL_COMPONENTS1(name, f)                                                                                                  \
    template <class T> AL_INLINE Triple<T> name(const Triple<T>& a, const Triple<T>& b) {                                        \
        return {f(a.x, b.x), f(a.y, b.y), f(a.z, b.z)};                                                                          \
    }
#define AL_COMPONENTS2(name, f)                                                                                                  \
    template <class T> AL_INLINE Triple<T> name(const Triple<T>& a, const Triple<T>& b, const Triple<T>& c) {                    \
        return {f(a.x, b.x, c.x), f(a.y, b.y, c.y), f(a.z, b.z, c.z)};                                                           \
    }
template <class T> AL_INLINE Triple<T> opAbs3(const Triple<T>& a) { return {absolute(a.x), absolute(a.y), absolute(a.z)}; }
AL_COMPONENTS1(opMin3, opMin)
AL_COMPONENTS1(opMax3, opMax)
AL_COMPONENTS1(opStep3, opStep)
AL_COMPONENTS2(opClamp3, opClamp)
AL_COMPONENTS2(opSmoothstep3, opSmoothstep)
AL_COMPONENTS2(opMix3, opMix)
#undef AL_COMPONENTS1
#undef AL_COMPONENTS2
template <class T> AL_INLINE Triple<T> opMixFloat(const Triple<T>& x, const Triple<T>& y, const T& alpha) {
    return {opMix(x.x, y.x, alpha), opMix(x.y, y.y, alpha), opMix(x.z, y.z, alpha)};
}

// Filtered steps: 1/2 + sign(d) G(|d|), d = (middle - edge) / width, G the integral of the kernel from 0, clamped to [0,1].
// Supports in widths: box 1, triangle 2, gaussian 2 (exp(-2 d^2)), catmull-rom 4.

/// Integral of a filter kernel from its centre to d >= 0 within its support, in widths.
template <class T> AL_INLINE T boxIntegral(const T& d) { return d; }
template <class T> AL_INLINE T triangleIntegral(const T& d) { return d - d * d * vf(0.5f); }
/// Taylor series of the integral of exp(-2 d^2), terms (-2)^n d^(2n+1) / (n! (2n+1)), over twice its value at 1.
struct GaussianSeries {
    static constexpr int kTerms = 16; ///< of the series
    float c[kTerms] = {};             ///< coefficients of the odd powers of d
    /// Computed by the compiler.
    constexpr GaussianSeries() {
        constexpr double kWhole = 0.59814400666130410; // integral of exp(-2 x^2) over [0, 1]
        double power = 1;
        for (int n = 0; n < kTerms; ++n) {
            c[n] = static_cast<float>(power / (2 * n + 1) / (2 * kWhole));
            power *= -2.0 / (n + 1);
        }
    }
};
inline constexpr GaussianSeries kGaussian;
template <class T> AL_INLINE T gaussianIntegral(const T& d) {
    const T s = d * d;
    T r = T(vf(kGaussian.c[GaussianSeries::kTerms - 1]));
#pragma clang loop unroll(full)
    for (int n = GaussianSeries::kTerms - 2; n >= 0; --n) r = mad(r, s, T(vf(kGaussian.c[n])));
    return r * d;
}
template <class T> AL_INLINE T catmullromIntegral(const T& d) {
    const T s = d * d;
    const T inner = d * (vf(1) + s * (d * vf(0.375f) - vf(2.5f / 3)));
    const T outer = d * (vf(2) + d * (d * (vf(2.5f / 3) - d * vf(0.125f)) - vf(2))) - vf(0.708333333f - 0.541666667f);
    return select(value(d) < 1, inner, outer);
}
template <class T, T (*Integral)(const T&), int Support> AL_INLINE T filteredStep(const T& edge, const T& a, const T& b) {
    const T width = absolute(b - a), middle = (a + b) * vf(0.5f) - edge;
    const T d = divide(middle, width), m = absolute(d);
    const T g = Integral(smaller(m, T(vf(0.5f * Support))));
    const T half = select(value(d) < 0, -g, g) + vf(0.5f);
    const T clamped = larger(T(vf(0)), smaller(half, T(vf(1))));
    return select(absLanes(value(middle)) * 2.0f >= value(width) * float(Support), T(select(value(middle) < 0, vf(0), vf(1))),
                  clamped);
}
template <class T> AL_INLINE T opFilterBox(const T& e, const T& a, const T& b) {
    return filteredStep<T, boxIntegral<T>, 1>(e, a, b);
}
template <class T> AL_INLINE T opFilterTriangle(const T& e, const T& a, const T& b) {
    return filteredStep<T, triangleIntegral<T>, 2>(e, a, b);
}
template <class T> AL_INLINE T opFilterGaussian(const T& e, const T& a, const T& b) {
    return filteredStep<T, gaussianIntegral<T>, 2>(e, a, b);
}
template <class T> AL_INLINE T opFilterCatmullrom(const T& e, const T& a, const T& b) {
    return filteredStep<T, catmullromIntegral<T>, 4>(e, a, b);
}

AL_RUNTIME(al_radians, opRadians)
AL_RUNTIME(al_degrees, opDegrees)
AL_RUNTIME(al_sin, sine)
AL_RUNTIME(al_cos, cosine)
AL_RUNTIME(al_tan, tangent)
AL_RUNTIME(al_asin, arcSine)
AL_RUNTIME(al_acos, arcCosine)
AL_RUNTIME(al_atan, arcTangent)
AL_RUNTIME(al_atan2, arcTangent2)
AL_RUNTIME(al_sqrt, root)
AL_RUNTIME(al_inversesqrt, inverseRoot)
AL_RUNTIME(al_pow, power)
AL_RUNTIME(al_exp, exponential)
AL_RUNTIME(al_log, logarithm)
AL_RUNTIME(al_logbase, opLogBase)
AL_RUNTIME(al_sign, opSign)
AL_RUNTIME(al_mod, opMod)
AL_RUNTIME(al_abs, absolute)
AL_RUNTIME(al_abs_t, opAbs3)
AL_RUNTIME(al_floor, opFloor)
AL_RUNTIME(al_ceil, opCeil)
AL_RUNTIME(al_round, opRound)
AL_RUNTIME(al_min_f, opMin)
AL_RUNTIME(al_min_t, opMin3)
AL_RUNTIME(al_max_f, opMax)
AL_RUNTIME(al_max_t, opMax3)
AL_RUNTIME(al_clamp_f, opClamp)
AL_RUNTIME(al_clamp_t, opClamp3)
AL_RUNTIME(al_step_f, opStep)
AL_RUNTIME(al_step_t, opStep3)
AL_RUNTIME(al_smoothstep_f, opSmoothstep)
AL_RUNTIME(al_smoothstep_t, opSmoothstep3)
AL_RUNTIME(al_mix_f, opMix)
AL_RUNTIME(al_mix_t, opMix3)
AL_RUNTIME(al_mixf_t, opMixFloat)
AL_RUNTIME(al_filterstep_box, opFilterBox)
AL_RUNTIME(al_filterstep_triangle, opFilterTriangle)
AL_RUNTIME(al_filterstep_gaussian, opFilterGaussian)
AL_RUNTIME(al_filterstep_catmullrom, opFilterCatmullrom)

} // namespace alpenglow::shadeops::AL_NAMESPACE

#ifdef ALPENGLOW_DESCRIBE
#include "shadeops/describe.h"

namespace alpenglow::shadeops {
namespace {
inline constexpr const char* kManual = "3Delight manual, 6.4.1"; ///< Shadeop::source

Shadeop mathOp(const char* name, std::initializer_list<SignatureText> texts, const char* doc, const char* source,
               std::vector<Example> examples) {
    Shadeop op;
    op.name = name;
    op.signatures = sigs(texts);
    op.section = "Mathematics";
    op.doc = doc;
    op.source = source;
    op.examples = std::move(examples);
    return op;
}
Shadeop flatOp(Shadeop op) {
    op.derivative = DerivativeRule::Zero;
    return op;
}

/// Angles and their functions.
void addAngles(std::vector<Shadeop>& list) {
    list.push_back(mathOp("radians", {{"float radians(float degrees)", "al_radians"}}, "Degrees to radians: degrees * PI / 180.",
                          kManual, {{"radians(180)", "3.141593"}}));
    list.push_back(mathOp("degrees", {{"float degrees(float radians)", "al_degrees"}}, "Radians to degrees: radians * 180 / PI.",
                          kManual, {{"degrees(1)", "57.29578"}}));
    list.push_back(mathOp(
        "sin", {{"float sin(float radians)", "al_sin"}},
        "Sine. Error below 2 ulp up to 1e5 radians; beyond 1e7 the argument has too few digits and the result is only bounded.",
        kManual, {{"sin(0)", "0"}, {"sin(0.5)", "0.4794255"}}));
    list.push_back(mathOp("cos", {{"float cos(float radians)", "al_cos"}}, "Cosine. Error as for sin.", kManual,
                          {{"cos(0)", "1"}, {"cos(0.5)", "0.8775826"}}));
    list.push_back(mathOp("tan", {{"float tan(float radians)", "al_tan"}},
                          "Tangent. Where the cosine is exactly 0 the result is 0.", kManual, {{"tan(0.5)", "0.5463025"}}));
    list.push_back(mathOp("asin", {{"float asin(float a)", "al_asin"}},
                          "Arc sine, -PI/2..PI/2. The argument is clamped to [-1,1]; there the derivative is 0.",
                          "3Delight manual, 6.4.1; clamping is ours", {{"asin(0.5)", "0.5235988"}, {"asin(2)", "1.570796"}}));
    list.push_back(mathOp("acos", {{"float acos(float a)", "al_acos"}},
                          "Arc cosine, 0..PI. The argument is clamped to [-1,1]; there the derivative is 0.",
                          "3Delight manual, 6.4.1; clamping is ours", {{"acos(0.5)", "1.047198"}, {"acos(-2)", "3.141593"}}));
    list.push_back(mathOp("atan", {{"float atan(float a)", "al_atan"}, {"float atan(float y, float x)", "al_atan2"}},
                          "Arc tangent of a, -PI/2..PI/2; or of y/x in the right quadrant, -PI..PI. atan(0, 0) is 0.", kManual,
                          {{"atan(1)", "0.7853982"}, {"atan(1, -1)", "2.356194"}}));
}

/// Roots, powers and logarithms.
void addPowers(std::vector<Shadeop>& list) {
    list.push_back(mathOp("sqrt", {{"float sqrt(float x)", "al_sqrt"}},
                          "Square root; 0 for x < 0. The derivative at 0 is taken as 0.", kManual,
                          {{"sqrt(2)", "1.414214"}, {"sqrt(-1)", "0"}}));
    list.push_back(mathOp("inversesqrt", {{"float inversesqrt(float x)", "al_inversesqrt"}},
                          "1 / sqrt(x); for x <= 0 a very large float, 1e38.", kManual,
                          {{"inversesqrt(4)", "0.5"}, {"inversesqrt(0)", "1e+38"}}));
    list.push_back(mathOp(
        "pow", {{"float pow(float x, float y)", "al_pow"}},
        "x to the power y. Negative x: exact sign for integer y, 0 for others. pow(x, 0) = 1; pow(0, y) = 0 for y > 0, infinity "
        "for y < 0. Numbers too small for a normal float count as 0.",
        "3Delight manual, 6.4.1; negative x is ours", {{"pow(2, 10)", "1024"}, {"pow(-2, 3)", "-8"}, {"pow(-2, 0.5)", "0"}}));
    list.push_back(mathOp("exp", {{"float exp(float x)", "al_exp"}}, "e to the power x; infinity above 88.72, 0 below -87.3.",
                          kManual, {{"exp(1)", "2.718282"}, {"exp(0)", "1"}}));
    list.push_back(mathOp(
        "log", {{"float log(float x)", "al_log"}, {"float log(float x, float base)", "al_logbase"}},
        "Natural logarithm, or logarithm in a base. For x < 0 -infinity in every base; for 0 too, but infinity in bases below 1. "
        "0 in base 1 and in bases that are not positive, which have no logarithm. Numbers too small for a normal float count as "
        "0.",
        kManual, {{"log(10)", "2.302585"}, {"log(8, 2)", "3"}, {"log(8, 0.5)", "-3"}, {"log(-8, 0.5)", "-inf"}}));
}

/// Signs, remainders and whole numbers.
void addRounding(std::vector<Shadeop>& list) {
    list.push_back(flatOp(mathOp("sign", {{"float sign(float x)", "al_sign"}}, "-1 for x < 0, 1 otherwise: 0 counts as positive.",
                                 kManual, {{"sign(-3)", "-1"}, {"sign(0)", "1"}})));
    list.push_back(mathOp("mod", {{"float mod(float x, float y)", "al_mod"}},
                          "x - n y with n = floor(x / y): in [0, y] for positive y, in [y, 0] for negative y; mod(x, 0) is 0.",
                          kManual, {{"mod(-1, 3)", "2"}, {"mod(7, 3)", "1"}}));
    Shadeop absolute =
        mathOp("abs", {}, "Absolute value. Tuples component by component (seen in the wild), where no number is meant.", kManual,
               {{"abs(-2)", "2"}, {"abs(vector(-1, 2, -3))", "1 2 3"}});
    absolute.signatures = sigs({{"float abs(float x)", "al_abs"}}) + each(kTuples, "$ abs($ x)", "al_abs");
    absolute.lastResort = {Base::Color, Base::Point, Base::Vector, Base::Normal};
    list.push_back(absolute);
    list.push_back(flatOp(mathOp("floor", {{"float floor(float x)", "al_floor"}}, "Largest integer not above x.", kManual,
                                 {{"floor(-1.5)", "-2"}})));
    list.push_back(flatOp(
        mathOp("ceil", {{"float ceil(float x)", "al_ceil"}}, "Smallest integer not below x.", kManual, {{"ceil(1.25)", "2"}})));
    list.push_back(flatOp(mathOp("round", {{"float round(float x)", "al_round"}}, "Nearest integer, halves away from zero.",
                                 "3Delight manual, 6.4.1; halves are ours", {{"round(2.5)", "3"}, {"round(-2.5)", "-3"}})));
}

/// Choices between values, and steps from one to another.
void addRanges(std::vector<Shadeop>& list) {
    Shadeop op = mathOp("min", {}, "Smallest of two or more values of one type; tuples component by component.", kManual,
                        {{"min(1, 2)", "1"}, {"min(point(1,2,3), point(4,3,2))", "1 2 2"}});
    op.signatures = each(kFloatAndTuples, "$ min($ a, $ b, ...)", "al_min");
    list.push_back(op);
    op = mathOp("max", {}, "Largest of two or more values of one type; tuples component by component.", kManual,
                {{"max(1, 2)", "2"}, {"max(point(1,2,3), point(4,3,2))", "4 3 3"}});
    op.signatures = each(kFloatAndTuples, "$ max($ a, $ b, ...)", "al_max");
    list.push_back(op);
    op = mathOp("clamp", {}, "lo if x < lo, hi if x > hi, else x; tuples component by component.", kManual,
                {{"clamp(5, 0, 1)", "1"}, {"clamp(point(-1,0.5,3), point(0,0,0), point(1,1,1))", "0 0.5 1"}});
    op.signatures = each(kFloatAndTuples, "$ clamp($ x, $ lo, $ hi)", "al_clamp");
    list.push_back(op);
    op = flatOp(mathOp("step", {}, "0 if value < edge, else 1. Tuples component by component (seen in the wild).", kManual,
                       {{"step(1, 0.5)", "0"}, {"step(1, 1)", "1"}}));
    op.signatures = each(kFloatAndTuples, "$ step($ edge, $ value)", "al_step");
    list.push_back(op);
    op = mathOp("smoothstep", {},
                "0 below lo, 1 at and above hi, 3t^2 - 2t^3 in between. Tuples component by component (seen in the wild).",
                kManual, {{"smoothstep(0, 1, 0.25)", "0.15625"}, {"smoothstep(0, 1, 2)", "1"}});
    op.signatures = each(kFloatAndTuples, "$ smoothstep($ lo, $ hi, $ value)", "al_smoothstep");
    list.push_back(op);
    op = mathOp("mix", {}, "x (1 - alpha) + y alpha, not clamped; alpha may be a tuple of the same type.",
                "3Delight manual, 6.4.1; tuple alpha is ours",
                {{"mix(1, 3, 0.25)", "1.5"}, {"mix(color(0,0,0), color(1,2,4), 0.5)", "0.5 1 2"}});
    op.signatures = each("float", "$ mix($ x, $ y, float alpha)", "al_mix") +
                    each(kTuples, "$ mix($ x, $ y, float alpha)", "al_mixf") +
                    each(kTuples, "$ mix($ x, $ y, $ alpha)", "al_mix");
    list.push_back(op);
}

/// The filters of filterstep().
void addFilteredSteps(std::vector<Shadeop>& list) {
    for (const char* filter : {"catmullrom", "box", "triangle", "gaussian"}) {
        const std::string name = std::string("__filterstep_") + filter;
        Shadeop op = mathOp(name.c_str(), {}, "step(edge, value) filtered over value1..value2; filterstep() calls it.",
                            "3Delight manual, 6.4.1", {});
        op.signatures = {
            parseSignature("float " + name + "(float edge, float value1, float value2)", std::string("al_filterstep_") + filter)};
        list.push_back(op);
    }
}

} // namespace

std::vector<Shadeop> mathematicsShadeops() {
    std::vector<Shadeop> list;
    addAngles(list);
    addPowers(list);
    addRounding(list);
    addRanges(list);
    addFilteredSteps(list);
    return list;
}
} // namespace alpenglow::shadeops
#endif
