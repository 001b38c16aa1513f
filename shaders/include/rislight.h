/* What lights of RIS have in common: radiance, temperature, focus and cone. From the published manual of PRMan's lights. */
#ifndef RISLIGHT_H
#define RISLIGHT_H

/* The colour of a black body at so many kelvins, of luminance 1, relative to that at 6500: Planck's law at the wavelengths of the
   Rec. 709 primaries' peaks would miss the matching functions, so chromaticity by Kim et al. (2002), US patent 7024034: piecewise cubic in 1/T. */
color risBlackbody(float kelvins;) {
    float T = clamp(kelvins, 1667, 25000), i = 1000 / T, x, y;
    if (T < 4000)
        x = ((-0.2661239 * i - 0.2343589) * i + 0.8776956) * i + 0.179910;
    else
        x = ((-3.0258469 * i + 2.1070379) * i + 0.2226347) * i + 0.240390;
    if (T < 2222)
        y = ((-1.1063814 * x - 1.34811020) * x + 2.18555832) * x - 0.20219683;
    else if (T < 4000)
        y = ((-0.9549476 * x - 1.37418593) * x + 2.09137015) * x - 0.16748867;
    else
        y = ((3.0817580 * x - 5.87338670) * x + 3.75112997) * x - 0.37001483;
    float X = x / y, Z = (1 - x - y) / y;
    return color(max(0, 3.2404542 * X - 1.5371385 - 0.4985314 * Z), max(0, -0.9692660 * X + 1.8760108 + 0.0415560 * Z),
                 max(0, 0.0556434 * X - 0.2040259 + 1.0572252 * Z));
}

/* Radiance of a light: colour * intensity * 2^exposure, tinted by its temperature where that is on. */
color risRadiance(float intensity, exposure; color lightColor; float enableTemperature, temperature;) {
    color c = intensity * pow(2, exposure) * lightColor;
    if (enableTemperature != 0)
        c *= risBlackbody(temperature) / risBlackbody(6500);
    return c;
}

/* How much of it leaves at an angle whose cosine to the axis is given. focus f: cosine to the power f, tinted where it dims; cone: full light
   within (1 - softness) of the angle, none outside. */
color risShape(float cosine, focus; color tint; float coneAngle, coneSoftness;) {
    color shape = 1;
    float c = max(0, cosine);
    if (focus > 0) {
        float k = pow(c, focus);
        shape = mix(tint, color(1), color(k)) * k;
    }
    if (coneAngle < 90) {
        float outside = cos(radians(coneAngle)), inside = cos(radians(coneAngle * (1 - clamp(coneSoftness, 0, 1))));
        shape *= (coneSoftness > 0) ? smoothstep(outside, max(inside, outside + 1e-4), c) : ((c >= outside) ? 1 : 0);
    }
    return shape;
}
#endif
