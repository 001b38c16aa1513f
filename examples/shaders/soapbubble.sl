/* soapbubble: a film whose thickness makes colours by interference; nearly clear in the middle, mirror at the rim.
     thickness   nanometres, at the top and at the bottom of shader space (the film runs down)
     swirl       how much it streams */
#include "noises.h"

/* Reflectance of a film of index 1.33 in air for one wavelength: two-beam interference with the phase jump of the outer face. */
float film(float thickness, cosine, wavelength)
{
    float inside = sqrt(1 - (1 - cosine * cosine) / (1.33 * 1.33));
    float phase = 4 * PI * 1.33 * thickness * inside / wavelength;
    float half = sin(phase / 2);
    return half * half;
}

surface soapbubble(float top = 200, bottom = 900, swirl = 1, Kr = 1, Ks = 1;)
{
    point Q = transform("shader", P);
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    float stream = fBm(Q * 2 + 1.3 * swirl * vfBm(Q * 1.5, .05, 3, 2, .5), .02, 4, 2, .5);
    float thick = mix(bottom, top, clamp(.5 + .5 * zcomp(Q), 0, 1)) + 120 * swirl * stream;
    float c = clamp(Nf . V, 0, 1);
    color tint = color(film(thick, c, 630), film(thick, c, 530), film(thick, c, 450));
    float rim = .05 + .95 * pow(1 - c, 3);
    color mirror = trace(P, reflect(-V, Nf));
    Oi = Os * clamp(rim * tint + color(.02), color(0), color(1));
    Ci = Kr * rim * tint * mirror * 1.6 + Ks * tint * specular(Nf, V, .01);
}
