/* wood: rings of a trunk along z of shader space, cut by whatever shape wears them. Early wood goes over into late wood slowly, and back
   at once; the grain adds fine fibres along the trunk, which also shine less.
     ringscale       rings in a unit of shader space
     ringnoise       how far rings stray from circles
     grainscale      fibres in a unit
     lightwood, darkwood   colours of early and late wood
     Ka Kd Ks roughness    as in plastic
   Ball: TransformBegin Rotate 65 1 0 0 Translate .2 .3 0 Surface "wood" TransformEnd */
#include "noises.h"

surface wood(
    float ringscale = 8, ringnoise = .3, grainscale = 40;
    color lightwood = color(.62, .38, .18), darkwood = color(.33, .16, .06);
    float Ka = 1, Kd = .8, Ks = .25, roughness = .12;)
{
    point Q = transform("shader", P);
    float width = filterwidthp(Q);
    /* The trunk sways: the centre of the rings wanders with height, and the rings are dented. */
    point sway = Q + .1 * vector(snoise(zcomp(Q) * .5), snoise(zcomp(Q) * .5 + 17), 0);
    sway += ringnoise / ringscale * vfBm(Q * 1.5, width * 1.5, 3, 2, .5);
    float r = sqrt(xcomp(sway) * xcomp(sway) + ycomp(sway) * ycomp(sway)) * ringscale;
    r += .2 * snoise(r);
    float phase = mod(r, 1);
    float ring = smoothstep(0, .8, phase) - smoothstep(.83, 1, phase);
    ring = mix(ring, .4, smoothstep(.3, 1, width * ringscale)); /* too far away to be seen one by one */
    /* Fibres: noise that is long in z. */
    point fibre = point(xcomp(Q) * grainscale, ycomp(Q) * grainscale, zcomp(Q) * grainscale * .06);
    float grain = smoothstep(.55, .85, noise(fibre)) * (1 - smoothstep(.2, .7, width * grainscale));
    color C = mix(lightwood, darkwood, ring) * (1 - .35 * grain * (1 - .5 * ring));

    normal Nf = faceforward(normalize(N), I);
    Oi = Os;
    Ci = Os * Cs * (C * (Ka * ambient() + Kd * diffuse(Nf)) + Ks * (1 - .6 * grain) * (1 - .4 * ring) * specular(Nf, -normalize(I), roughness));
}
