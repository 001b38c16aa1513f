#if defined (ENTROPY) || defined(ALPENGLOW) || \
    defined (AIR)
#define CAN_RAY 1
#else
#define CAN_RAY 0
#endif
#define TEX(n,ss,tt,b) ((n) != "" ? color texture((n)[0], (ss), (tt), "blur", (b), "width", 1) : color 1)
surface entropic ( float Ka = 1, Kd = 0.5, Ks = .5, Kr = 0, rough = 0.1, blurr = 0; string texname = ""; string aovs = "diff,spec";
  output varying color Cdiffuse = 0; output varying color Cspecular = 0; output varying color Creflect = 0; output varying normal Nout = 0; output varying float depthout = 0;)
{
    normal Nf = faceforward (normalize(N),I), NN = Nf;
    vector R = reflect (normalize(I), Nf);
    color Ct = Cs * TEX (texname, s, t, blurr);
    float r = rough == 0 ? 1e-3 : rough;
    Cdiffuse = Ct * (Ka * ambient () + Kd*diffuse(Nf));
    Cspecular = Ks*specular(Nf, -normalize(I), r);
#if CAN_RAY == 1
    if (Kr > 0) Creflect = Kr * color trace (P, R);
#endif
    Nout = ntransform ("world", NN); depthout = depth (P);
    if (match ("spec", aovs) == 0) Cspecular = 0;
    Oi = Os;
    Ci = Oi * (Cdiffuse + Cspecular + Creflect);
}
