/* slfog: the fog of SLProject's camera, as an atmosphere. docs/design/slproject.md.
     mode: 0 linear between start and end, 1 exp(-density z), 2 exp(-(density z)^2); z is the way, at most clipfar (0: of Clipping)
   Ci is held between 0 and 1, as there; what rays bring under Hider "path" is not.
   Ball: Atmosphere "slfog" "float mode" 0 "float start" 2 "float end" 9 "color fogcolor" [.6 .65 .7] */
volume slfog(float mode = 0, density = .2, start = 1, end = 6, clipfar = 0; color fogcolor = .5;) {
    uniform float planes[2] = {0, 1e30};
    uniform float most = clipfar;
    if (most <= 0) {
        option("Ri:Clipping", planes);
        most = planes[1];
    }
    float z = min(length(I), most), f;
    if (mode < .5)
        f = (end - z) / (end - start);
    else if (mode < 1.5)
        f = exp(-density * z);
    else
        f = exp(-(density * z) * (density * z));
    Ci = clamp(f * Ci + (1 - f) * fogcolor, color(0), color(1));
    Oi = mix(Oi, color(1), color(clamp(1 - f, 0, 1)));
}
