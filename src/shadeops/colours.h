// Colours: 3Delight manual, 6.4.3. Linear RGB triples; other spaces by explicit conversion.
#pragma once
#include "shadeops/call.h"

namespace alpenglow::shadeops::AL_NAMESPACE {

template <class T> AL_INLINE T opComp(const Triple<T>& c, const T& i) {
    const vf at = truncLanes(value(i));
    return select(at >= 2, c.z, select(at >= 1, c.y, c.x));
}
template <class T> AL_INLINE void opSetcomp(Triple<T>& c, const T& i, const T& v) {
    const vf at = minLanes(maxLanes(truncLanes(value(i)), vf(0)), vf(2));
    c.x = select(at == 0, v, c.x);
    c.y = select(at == 1, v, c.y);
    c.z = select(at == 2, v, c.z);
}
/// The sum a x + b y + d z.
template <class T> AL_INLINE T weighted(const Triple<T>& c, float a, float b, float d) {
    return mad(T(c.x), vf(a), vf(0)) + (c.y * vf(b) + c.z * vf(d));
}
template <class T> AL_INLINE T opLuminance(const Triple<T>& c) { return weighted(c, 0.2126f, 0.7152f, 0.0722f); }

/// Hue in 0..1, 0 for grey; largest - smallest = range.
template <class T> AL_INLINE T hueOf(const Triple<T>& c, const T& largest, const T& range) {
    const T r = divide(c.y - c.z, range), g = divide(c.z - c.x, range) + vf(2), b = divide(c.x - c.y, range) + vf(4);
    const T h = select(value(c.x) == value(largest), r, select(value(c.y) == value(largest), g, b)) * vf(1.0f / 6);
    return select(value(range) == 0, T(vf(0)), select(value(h) < 0, h + vf(1), h));
}
/// x modulo a constant.
template <class T> AL_INLINE T wrapTo(const T& x, float period) { return x - floorLanes(value(x) * (1 / period)) * period; }

template <class T> AL_INLINE Triple<T> opRgbToHsv(const Triple<T>& c) {
    const T most = larger(c.x, larger(c.y, c.z)), range = most - smaller(c.x, smaller(c.y, c.z));
    return {hueOf(c, most, range), divide(range, most), most};
}
template <class T> AL_INLINE Triple<T> opHsvToRgb(const Triple<T>& c) {
    const T chroma = c.y * c.z;
    const auto channel = [&](float n) __attribute__((always_inline)) {
        const T k = wrapTo(c.x * vf(6) + vf(n), 6);
        const T ramp = larger(T(vf(0)), smaller(smaller(k, vf(4) - k), T(vf(1))));
        return c.z - chroma * ramp;
    };
    return {channel(5), channel(3), channel(1)};
}
template <class T> AL_INLINE Triple<T> opRgbToHsl(const Triple<T>& c) {
    const T most = larger(c.x, larger(c.y, c.z)), least = smaller(c.x, smaller(c.y, c.z)), range = most - least;
    const T twice = most + least;
    return {hueOf(c, most, range), divide(range, vf(1) - absolute(twice - vf(1))), twice * vf(0.5f)};
}
template <class T> AL_INLINE Triple<T> opHslToRgb(const Triple<T>& c) {
    const T amount = c.y * smaller(c.z, vf(1) - c.z);
    const auto channel = [&](float n) __attribute__((always_inline)) {
        const T k = wrapTo(c.x * vf(12) + vf(n), 12);
        const T ramp = larger(T(vf(-1)), smaller(smaller(k - vf(3), vf(9) - k), T(vf(1))));
        return c.z - amount * ramp;
    };
    return {channel(0), channel(8), channel(4)};
}
// NTSC: Y from 0.299 0.587 0.114, I and Q of unit range; back by the inverse matrix.
template <class T> AL_INLINE Triple<T> opRgbToYiq(const Triple<T>& c) {
    return {weighted(c, 0.299f, 0.587f, 0.114f), weighted(c, 0.595716f, -0.274453f, -0.321263f),
            weighted(c, 0.211456f, -0.522591f, 0.311135f)};
}
template <class T> AL_INLINE Triple<T> opYiqToRgb(const Triple<T>& c) {
    return {weighted(c, 1, 0.95629572f, 0.62102442f), weighted(c, 1, -0.2721221f, -0.64738060f),
            weighted(c, 1, -1.10698902f, 1.70461500f)};
}
// CIE XYZ from the Rec. 709 primaries (0.64 0.33, 0.30 0.60, 0.15 0.06) and the white point D65 (0.3127 0.3290).
template <class T> AL_INLINE Triple<T> opRgbToXyz(const Triple<T>& c) {
    return {weighted(c, 0.41239080f, 0.35758434f, 0.18048079f), weighted(c, 0.21263901f, 0.71516868f, 0.07219232f),
            weighted(c, 0.01933082f, 0.11919478f, 0.95053215f)};
}
template <class T> AL_INLINE Triple<T> opXyzToRgb(const Triple<T>& c) {
    return {weighted(c, 3.24096994f, -1.53738318f, -0.49861076f), weighted(c, -0.96924364f, 1.87596750f, 0.04155506f),
            weighted(c, 0.05563008f, -0.20397696f, 1.05697151f)};
}

AL_RUNTIME(al_comp, opComp)
AL_RUNTIME(al_setcomp, opSetcomp)
AL_RUNTIME(al_luminance, opLuminance)
AL_RUNTIME(al_rgb_to_hsv, opRgbToHsv)
AL_RUNTIME(al_hsv_to_rgb, opHsvToRgb)
AL_RUNTIME(al_rgb_to_hsl, opRgbToHsl)
AL_RUNTIME(al_hsl_to_rgb, opHslToRgb)
AL_RUNTIME(al_rgb_to_yiq, opRgbToYiq)
AL_RUNTIME(al_yiq_to_rgb, opYiqToRgb)
AL_RUNTIME(al_rgb_to_xyz, opRgbToXyz)
AL_RUNTIME(al_xyz_to_rgb, opXyzToRgb)

} // namespace alpenglow::shadeops::AL_NAMESPACE

#ifdef ALPENGLOW_DESCRIBE
#include "shadeops/describe.h"

namespace alpenglow::shadeops {
std::vector<Shadeop> colourShadeops() {
    std::vector<Shadeop> list;
    Shadeop op;
    op.section = "Colours";
    op.source = "3Delight manual, 6.4.3";
    op.name = "comp";
    op.signatures = sigs({{"float comp(color c; float i)", "al_comp"},
                          {"float comp(vector c; float i)", "al_comp"},
                          {"float comp(point c; float i)", "al_comp"},
                          {"float comp(normal c; float i)", "al_comp"}});
    op.doc = "Component of a colour, a tuple (or of a matrix); the index is truncated and clamped to 0..2.";
    op.examples = {{"comp(color(1,2,3), 1)", "2"}, {"comp(vector(1,2,3), 2)", "3"}};
    list.push_back(op);
    op.name = "setcomp";
    op.signatures = sigs({{"void setcomp(output color c; float i, float value)", "al_setcomp"},
                          {"void setcomp(output vector c; float i, float value)", "al_setcomp"},
                          {"void setcomp(output point c; float i, float value)", "al_setcomp"},
                          {"void setcomp(output normal c; float i, float value)", "al_setcomp"}});
    op.doc = "Sets a component of a colour, a tuple (or of a matrix); the index is truncated and clamped to 0..2.";
    op.examples = {{"c", "0 2 0", "color c = 0; setcomp(c, 1, 2);"}};
    list.push_back(op);
    op.name = "luminance";
    op.signatures = sigs({{"float luminance(color c)", "al_luminance"}});
    op.doc = "0.2126 r + 0.7152 g + 0.0722 b (Rec. 709).";
    op.source = "shaders of 3Delight; weights of Rec. 709";
    op.examples = {{"luminance(color(1,1,1))", "1"}};
    list.push_back(op);
    op.name = "ctransform";
    op.signatures =
        sigs({{"color ctransform(string tospace; color c)"}, {"color ctransform(string fromspace, string tospace; color c)"}});
    op.lowering = Lowering::Special;
    op.derivative = DerivativeRule::Inherent;
    op.doc = "From one colour space (default rgb) to another: rgb hsv hsl yiq xyz, any case; an unknown space leaves c as it is. "
             "hue 0..1; YIQ by "
             "the NTSC coefficients; XYZ of Rec. 709 primaries with D65. Symbols al_rgb_to_hsv, al_hsv_to_rgb, al_rgb_to_hsl, "
             "al_hsl_to_rgb, "
             "al_rgb_to_yiq, al_yiq_to_rgb, al_rgb_to_xyz, al_xyz_to_rgb; the way between two spaces goes through rgb.";
    op.source = "3Delight manual, 6.4.3; RISpec 3.2, 15.3";
    op.examples = {{"ctransform(\"hsv\", color(1,0,0))", "0 1 1"}};
    list.push_back(op);
    return list;
}
} // namespace alpenglow::shadeops
#endif
