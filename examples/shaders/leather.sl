/* leather: scales between creases (a cellular pattern), pores in them, a worn polish on the heights. The bump is made by displacing the point and
   taking its new normal; the shape stays as it is.
     scale     scales in a unit of shader space
     depth     of the creases
     dye       colour */
#include "noises.h"

surface leather(float scale = 9, depth = .02, wear = .5, Ka = 1, Kd = .8, Ks = .3, roughness = .15; color dye = color(.3, .13, .06);)
{
    point Q = transform("shader", P) * scale;
    float f1, f2;
    point a, b;
    Q += .35 * (vector noise(Q * 1.3) - .5);
    voronoi_f1f2_3d(Q, .8, f1, a, f2, b);
    float ridge = smoothstep(0, .45, f2 - f1);
    float pore = 1 - smoothstep(.05, .14, f1);
    float fine = fBm(Q * 8, filterwidthp(Q * 8), 3, 2, .5);
    float height = ridge + .08 * fine - .35 * pore;
    normal Nf = faceforward(normalize(calculatenormal(P + depth * height * normalize(N))), I);
    color C = dye * (.4 + .6 * ridge) * (1 + .25 * fine) * (1 - .5 * pore);
    C = mix(C, dye * 1.7, wear * .5 * smoothstep(.9, 1, ridge) * noise(Q * .6));
    Oi = Os;
    Ci = Os * Cs * (C * (Ka * ambient() + Kd * diffuse(Nf)) + Ks * ridge * specular(Nf, -normalize(I), roughness));
}
