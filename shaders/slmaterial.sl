/* slmaterial: the materials of SLProject's path tracer as one RSL surface: diffuse, reflective, transparent, emissive; the first of
   them that is not black decides, in that order. docs/design/slproject.md.
     shininess, translucency: Phong exponents of the reflected and transmitted lobe; 1000 and above are perfect
     kn: index of refraction; fresnel "schlick" or "exact"
     texturename, bumpname: pictures; what bumpname is, height or normals, is told by its name (wood_H.png, wood_N.png), or by bumptype
     uscale, vscale, rotation (degrees), uoffset, voffset: the texture matrix of both; bumpscale: of heights
     wrapu, wrapv: repeat, mirror or clamp; filter: nearest, bilinear or mip: of texturename
     uvindex: 1 takes the second set of coordinates, s2 and t2, which the primitive has as varying or facevarying float
     stack: slices, "s%03d.png", in place of texturename, over the box from boxmin to boxmax in object space, or over that of
       the primitive where autobox is 1
   Under Hider "path" diffuse() and trace() are the estimators: they sample lights and lobe, weight both, play roulette. Ball: Surface "slmaterial" "color diffusecolor" [.6 .25 .1] */
#include "slproject.h"
surface slmaterial(color diffusecolor = 1, specularcolor = 0, transmissive = 0, emissive = 0;
                   float shininess = 1000, translucency = 1000, kn = 1;
                   string texturename = "", fresnel = "schlick", bumpname = "", bumptype = "", stack = "";
                   float uscale = 1, vscale = 1, rotation = 0, uoffset = 0, voffset = 0, bumpscale = 1, uvindex = 0;
                   string wrapu = "repeat", wrapv = "repeat", filter = "mip"; varying float s2 = 0, t2 = 0;
                   point boxmin = point(-1, -1, -1), boxmax = point(1, 1, 1);
                   float autobox = 0;) {
    normal Nn = normalize(N);
    float su = 0, sv = 0;
    if (uvindex == 1) slTransform(s2, 1 - t2, uscale, vscale, rotation, uoffset, voffset, su, sv);
    else slTransform(s, 1 - t, uscale, vscale, rotation, uoffset, voffset, su, sv);
    if (bumpname != "")
        Nn = slBump(bumpname, (bumptype == "") ? slTextureType(bumpname) : bumptype, su, sv, bumpscale, Nn, dPdu, -dPdv);
    vector In = normalize(I);
    color zero = 0;
    Oi = 1;
    Ci = emissive;
    if (emissive == zero) {
        if (diffusecolor != zero) {
            color albedo = diffusecolor * Cs;
            if (texturename != "")
                albedo *= slTexture2D(texturename, su, sv, wrapu, wrapv, filter);
            if (stack != "")
                albedo *= (autobox == 1) ? slTexture3D(stack, P) : slTexture3D(stack, P, boxmin, boxmax);
            normal Nf = faceforward(Nn, In);
            Ci += albedo * diffuse(Nf);
        } else if (specularcolor != zero) {
            vector R = reflect(In, Nn);
            Ci += specularcolor * Cs * trace(P, R, "distribution", "slphong", "horizon", Nn, "exponent", shininess, "type", "specular");
        } else if (transmissive != zero) {
            float into = In . Nn;
            normal Nf = faceforward(Nn, In);
            float eta = (into < 0) ? 1 / kn : kn;
            vector T = refract(In, Nf, eta);
            vector R = reflect(In, Nf);
            float Kr, Kt;
            if (T . T == 0) {
                Kr = 1;
            } else if (fresnel == "exact") {
                fresnel(In, Nf, eta, Kr, Kt);
            } else {
                float r0 = (kn - 1) / (kn + 1);
                r0 *= r0;
                float c = 1 - ((into < 0) ? -into : abs(T . Nf));
                Kr = r0 + (1 - r0) * pow(c, 5);
            }
            Kt = 1 - Kr;
            Ci += transmissive * Cs * (Kr * trace(P, R, "distribution", "slphong", "horizon", Nn, "exponent", shininess, "type", "specular")
                + Kt * trace(P, T, "distribution", "slphong", "horizon", Nn, "exponent", translucency, "type", "specular"));
        }
    }
}
