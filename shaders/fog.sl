/* fog: an exponential haze between the eye and the surface. RISpec standard shader. */
volume fog(float distance = 1; color background = 0;) {
    float d = 1 - exp(-length(I) / distance);
    Ci = mix(Ci, background, color(d));
    Oi = mix(Oi, color(1), color(d));
}
