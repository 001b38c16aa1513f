/* marble: veins by turbulence, coloured by a spline, under a polish that reflects more at grazing angles.
     veinscale    veins in a unit of shader space
     turbulence   how much they wind
     Ka Kd Ks roughness Kr   Kr: share of the mirror reflection, traced */
#include "noises.h"

surface marble(float veinscale = 2.5, winding = 1.4, Ka = 1, Kd = .75, Ks = .3, roughness = .06, Kr = .5;)
{
    point Q = transform("shader", P) * veinscale;
    float width = filterwidthp(Q);
    vector bend = winding * vfBm(Q, width, 6, 2, .5);
    /* A vein lies where a bent wave goes through zero; a second, finer system crosses it. */
    float broad = abs(sin(xcomp(Q) + ycomp(Q) * .6 + 2.2 * xcomp(bend)));
    float fine = abs(fBm(Q * 1.2 + bend, width * 1.2, 5, 2.1, .5));
    float x = pow(broad, .35) - .35 * (1 - smoothstep(0, .06, fine)) + .12 * ycomp(bend);
    x = clamp(x, 0, 1);
    color C = spline("catmull-rom", x,
        color(.12, .13, .17), color(.12, .13, .17), color(.38, .39, .45), color(.72, .72, .75), color(.84, .83, .82),
        color(.9, .89, .86), color(.92, .91, .88), color(.93, .92, .9), color(.93, .92, .9));

    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    float kr, kt;
    fresnel(-V, Nf, 1 / 1.5, kr, kt);
    color mirror = trace(P, reflect(-V, Nf));
    Oi = Os;
    Ci = Os * (Cs * C * (Ka * ambient() + Kd * diffuse(Nf)) + Ks * specular(Nf, V, roughness) + Kr * kr * mirror);
}
