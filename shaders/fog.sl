/* fog: an exponential haze between the eye and the surface. RISpec standard shader. Ball: Atmosphere "fog" "float distance" 12 "color background" [.6 .65 .7] */
volume fog(float distance = 1; color background = 0;) {
    float d = 1 - exp(-length(I) / distance);
    Ci = mix(Ci, background, color(d));
    Oi = mix(Oi, color(1), color(d));
}
