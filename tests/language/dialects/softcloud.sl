/* volume with marching and an integrand of its own; from the time of ray servers */
#include "noises.h"
#define STEPSIZE 0.25

float
volumedensity (point Pshad; float use_noise, freq, octaves, density)
{
    float d = density;
    point Psmoke = Pshad * freq;
    if (use_noise != 0) {
        uniform float f = 1; uniform float i;
        float smoke = snoise(Psmoke);
        for (i = 1; i < 3; i += 1) {
            f *= 0.5;
            Psmoke *= 2;
            smoke += f * snoise(Psmoke);
        }
        d *= clamp(smoke * 0.5 + 0.5, 0, 1);
    }
    return d;
}

color
volumelight (point Pcur)
{
    color Cscat = 0;
    illuminance (Pcur) {
        extern color Cl;
        Cscat += Cl;
    }
    return Cscat;
}

volume
softcloud (float opacdensity = 1, lightdensity = 1, integstart = 0, integend = 20, stepsize = STEPSIZE,
           use_lighting = 1, use_noise = 1, freq = 1, octaves = 3, maxsteps = 20;
           color scatter = 1;)
{
    point Worigin = P - I;
    vector incident = vtransform("shader", I);
    point origin = transform("shader", Worigin);
    vector IN = normalize(incident);
    float d = integstart, end = min(length(incident), integend) - 0.0001, ss, dtau, last_dtau, nsteps = 0;
    color Cv = 0, Ov = 0, li, last_li, scat;

    if (d < end) {
        ss = min(clamp(stepsize, 0.005, end - d), end - d);
        d += random() * ss;
        last_dtau = volumedensity(origin + d * IN, use_noise, freq, octaves, opacdensity);
        last_li = use_lighting != 0 ? volumelight(Worigin + d * normalize(I)) : color(1);
        while (d <= end && nsteps < maxsteps) {
            ss = clamp(ss, 0.005, end - d + 0.005);
            d += ss;
            dtau = volumedensity(origin + d * IN, use_noise, freq, octaves, opacdensity);
            li = use_lighting != 0 ? volumelight(Worigin + d * normalize(I)) : color(1);
            float tau = .5 * ss * opacdensity * (dtau + last_dtau);
            scat = -tau * scatter;
            scat = 1 - color (exp(comp(scat,0)), exp(comp(scat,1)), exp(comp(scat,2)));
            Cv += (1 - Ov) * scat * (li + last_li) * .5;
            Ov += (1 - Ov) * scat;
            last_dtau = dtau;
            last_li = li;
            nsteps += 1;
        }
    }
    Ci = Cv + (1 - Ov) * Ci;
    Oi = Ov + (1 - Ov) * Oi;
}
