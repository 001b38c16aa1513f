/* MTOR/Slim manner: pxsl functions prefixed, defines for every node, #undef, output arguments everywhere */
#define pxslUserPI 3.14159265
#ifndef _PXSL_H
#define _PXSL_H
#endif
void
pxslManifold (
    string Space; float Freq;
    output point Q;
    output vector dQu, dQv;
)
{
    extern point P; extern float u, v, du, dv;
    extern vector dPdu, dPdv;
    uniform string sys;
    if (Space == "") sys = "shader"; else sys = Space;
    Q = Freq * transform(sys, P);
    dQu = vtransform(sys, dPdu*du); dQv = vtransform(sys, dPdv*dv);
}
void
pxslFractal(
    uniform float layers_;
    uniform float lac; varying float dim;
    point Q; vector dQu, dQv;
    output color result;
)
{
    uniform float i; float mag = 0, wt = 1; point PP = Q;
    float fw = max(length(dQu), length(dQv));
    for (i=0; i<layers_ && fw<1; i+=1) { mag += wt*(noise(PP)*2-1); PP*=lac; fw*=lac; wt *= dim; }
    result = color(mag*.5+.5);
}
#undef pxslUserPI
#define pxslUserPI PI
surface
SlimFractal (
    /* Surface Point */
    string spaceM = "shader"; float freqM = 1;
    uniform float layersF = 6, lacF = 2; float dimF = .5;
    string slim_extra[2] = {"", ""};
    float __smatte = 0;
)
{
    point Q; vector dQu, dQv; color tmp0;
    pxslManifold(spaceM, freqM, Q, dQu, dQv);
    pxslFractal(layersF, lacF, dimF, Q, dQu, dQv, tmp0);
    Ci = tmp0 * (ambient() + diffuse(normalize(faceforward(N,I)))) * sin(pxslUserPI/2);
    Oi = (__smatte > 0) ? color(0) : Os;
    Ci *= Oi;
}
