/* rustymetal: rust that eats into painted metal: three coats (paint, bare metal, rust) one over the other, each where a fractal says so, rust
   with a relief of its own.
     age       0 new, 1 eaten away
     paint     colour of the paint
     scale     patches in a unit of shader space */
#include "noises.h"

struct Coat {
    color tint;
    float rough, shine;
};

surface rustymetal(float age = .5, scale = 2, Ka = 1, bump = .03; color paint = color(.1, .28, .32);)
{
    point Q = transform("shader", P) * scale;
    float width = filterwidthp(Q);
    float eaten = .5 + .75 * fBm(Q + .5 * vfBm(Q, width, 3, 2, .5), width, 7, 2, .55);
    float rust = smoothstep(1.02 - age, 1.1 - age, eaten), bare = smoothstep(.94 - age, .97 - age, eaten);
    float grit = fBm(Q * 12, width * 12, 4, 2, .6);
    Coat top, metal, oxide;
    top->tint = paint * (1 - .15 * grit);
    top->rough = .05;
    top->shine = .4;
    metal->tint = color(.55, .53, .5);
    metal->rough = .15;
    metal->shine = .8;
    oxide->tint = mix(color(.12, .04, .02), color(.5, .19, .05), clamp(.5 + grit + 1.5 * (eaten - .6), 0, 1));
    oxide->rough = .5;
    oxide->shine = .05;
    color C = mix(mix(top->tint, metal->tint, bare), oxide->tint, rust);
    float roughness = mix(mix(top->rough, metal->rough, bare), oxide->rough, rust);
    float Ks = mix(mix(top->shine, metal->shine, bare), oxide->shine, rust);
    float height = rust * (.4 + .5 * grit) - .3 * bare;
    normal Nf = faceforward(normalize(calculatenormal(P + bump * height * normalize(N))), I);
    Oi = Os;
    Ci = Os * Cs * (C * (Ka * ambient() + .8 * diffuse(Nf)) + Ks * mix(color(1), C, bare * (1 - rust)) * specular(Nf, -normalize(I), roughness));
}
