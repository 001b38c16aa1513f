/* stdrsl/Colors.h: between sRGB and linear light. */
#ifndef STDRSL_COLORS_H
#define STDRSL_COLORS_H
float stdrsl_linearOf(float x) { return (x <= 0.04045) ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4); }
float stdrsl_srgbOf(float x) { return (x <= 0.0031308) ? x * 12.92 : 1.055 * pow(x, 1 / 2.4) - 0.055; }
color srgbToLinear(color c)
{
    return color(stdrsl_linearOf(comp(c, 0)), stdrsl_linearOf(comp(c, 1)), stdrsl_linearOf(comp(c, 2)));
}
color linearToSrgb(color c)
{
    return color(stdrsl_srgbOf(comp(c, 0)), stdrsl_srgbOf(comp(c, 1)), stdrsl_srgbOf(comp(c, 2)));
}
color linearToSRGB(color c) { return linearToSrgb(c); }
#endif
