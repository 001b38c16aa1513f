#include "noises.h"
#include "patterns.h"
#include "rmannotes.sl"
#include "material.h"
#include "displace.h"
#include "project.h"
#include "raysphere.h"
#include "pshad.h"
#include "oak.h"
#include "shadows.h"
#include "rayserver.h"
#include "proctext.h"
#include <OldNoises.h>
#include "..\include\filterwidth.h"

surface all(float Ka = 1, Kd = .5, Ks = .5, roughness = .1, Kr = .5, blur = 0, ior = 1.5; string texturename = "";
            string projection = "planar", textureprojspace = "shader"; matrix texturexform = 1;
            DEFAULT_PSHAD_PARAMS; float xform[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
            DECLARE_DEFAULTED_ENVPARAMS;)
{
    point PP = transform("shader", P);
    float filtwidth = filterwidthp(PP);
    color Ct = Cs * (0.5 + 0.5 * fBm(PP, filtwidth, 4, 2, 0.5));
    Ct += turbulence(PP, filtwidth, 4, 2, 0.5) + turbulence(PP, 5);
    Ct *= fBm_default(PP) * turbulence_default(PP);
    vector d = vfBm(PP, filtwidth, 4, 2, 0.5) + vsnoise(PP) + filteredvsnoise(PP, filtwidth);
    float n = snoise(PP) + snoise(s * 3) + snoisexy(s, t) + VLNoise(PP, 1);
    point q = PP + vector snoise(PP);
    float f1, f2, s1, t1, s2, t2;
    voronoi_f1f2_2d(s * 10, t * 10, 1, f1, s1, t1, f2, s2, t2);
    point p1, p2;
    voronoi_f1f2_3d(PP, 1, f1, p1, f2, p2);
    float ss = repeat(s, 4), tt = repeat(t, 4), row = whichtile(t, 4);
    if (odd(row)) ss = mod(ss + .5, 1);
    float r, a;
    topolar2d(ss, tt, r, a);
    rotate2d(ss, tt, radians(45), .5, .5, r, a);
    Ct = mix(Ct, color(1, 0, 0), pulse(.35, .65, .05, ss) * filteredpulsetrain(.1, .5, tt, filterwidth(tt)));
    Ct = blend(Ct, color(0, 1, 0), intersection(pulse(.2, .4, .02, ss), 1 - smoothpulse(0, .1, .2, .3, tt)));
    Ct = ApplyColorTextureOver(Ct, texturename, projection, P, textureprojspace, texturexform, blur) *
         ApplyFloatTextureOver(1, texturename, projection, P, textureprojspace, texturexform, blur);
    normal Nf = faceforward(normalize(N), I);
    vector bump = 0.1 * udn(row, 0, 1) * vector Nf; Nf = normalize(Nf + normal bump);
    float t0, t11;
    if (raysphere(PP, d, 1, 0.001, t0, t11) > 0) Ct *= .5;
    Ci = MaterialPlastic(Nf, Ct, Ka, Kd, Ks, roughness) + MaterialShinyPlastic(Nf, Ct, Ka, Kd, Ks, roughness, Kr, blur, ior, ENVPARAMS)
         + MaterialShinyMetal(Nf, Ct, Ka, Kd, Ks, roughness, Kr, blur, ENVPARAMS) + MaterialClay(Nf, Ct, Ka, Kd, .3)
         + MaterialBrushedMetal(Nf, Ct, Ka, Kd, Ks, normalize(dPdu), .1, .3) + MaterialRoughMetal(Nf, Ct, Ka, Kd, Ks, roughness);
    Ci += LocIllumCookTorrance(Nf, -normalize(I), .3, 1.5) + LocIllumGlossy(Nf, -normalize(I), .1, .5) + MaterialMatte(Nf, Ct, Ka, Kd);
    Ci += MaterialShinyPlastic(Nf, Ct, Ka, Kd, Ks, roughness, Kr, blur, ior, 0, ENVPARAMS) + MaterialCeramic(Nf, Ct, Ka, Kd, Ks, roughness, .5)
        + MaterialGlass(Nf, Ct, Ka, Kd, Ks, roughness, Kr, blur, .5, 0, ior, color 1, 0, 1, ENVPARAMS);
    GET_PSHAD;
    Ct = mix(Ct, varyEach(Ct, row, .1, .1, .1), oaktexture(Pshad, dPshad, 8, .5, 25, .02, 1, .15, .025, 1, 1.5, .5, 1));
    float column, xtile, ytile;
    basictile(s * 5, t * 5, 1, 1, .5, .1, 1, .1, column, row, xtile, ytile);
    Ct *= tilepattern(s * 5, t * 5, filterwidth(s), filterwidth(t), .05, .05, column, row, xtile, ytile) + filteredsnoise(s, filtwidth);
    Ct *= xcomp(transform(array_to_mx(xform), PP)) + filtered_fBm_default(PP) + VLfBm_default(PP);
    Ci += Ct;
    Ci *= n + xcomp(q);
    Oi = Os; Ci *= Oi;
}
