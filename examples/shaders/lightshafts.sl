/* lightshafts: dusty air that shows the beams of lights: it steps along the ray and asks the lights at every step.
     density    of the dust
     steps      along the ray
     billow     how uneven it is
   Lamp: LightSource "stencilsun" 1 "float width" 2.4 "float height" 2.4 "float bars" .35 "float soft" .02 "float intensity" 1.5
   Ball: Atmosphere "lightshafts" "float density" .15 "float billow" .3 */
volume lightshafts(float density = .1, steps = 24, billow = .5, maxlength = 20; color dust = 1;)
{
    float way = min(length(I), maxlength), step = way / steps, i;
    vector In = normalize(I);
    point start = P - I;
    color glow = 0;
    float seen = 1, offset = random();
    for (i = 0; i < steps; i += 1) {
        point Q = start + (i + offset) * step * In;
        float local = density * (1 - billow + 2 * billow * noise(3 * transform("world", Q)));
        color lit = 0;
        illuminance(Q) { lit += Cl; }
        glow += seen * local * step * dust * lit / 4;
        seen *= exp(-local * step);
    }
    Ci = seen * Ci + glow;
    Oi = mix(color(1), Oi, seen);
}
