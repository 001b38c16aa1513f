#define BLEND_NORMAL(a,b,o)   mix((a),(b),(o))
#define BLEND_ADD(a,b,o)      ((a)+(b)*(o))
#define LAYER(num, mode)                                              \
    if (map##num != "") {                                             \
        color c_##num = color texture(map##num, ss, tt,               \
                                      "swidth", 1, "twidth", 1);      \
        float o_##num = opacity##num;                                 \
        if (mask##num != "")                                          \
            o_##num *= float texture(mask##num[0], ss, tt);           \
        Ct = mode(Ct, c_##num, o_##num);                              \
    }
#define LAYERPARAMS(num)                                              \
    string map##num = "";                                             \
    string mask##num = "";                                            \
    float opacity##num = 1;
surface layersblend(
    LAYERPARAMS(1)
    LAYERPARAMS(2)
    LAYERPARAMS(3)
    float repeatS = 1, repeatT = 1, originS = 0, originT = 0;
    string projection = "st";
    string projspace = "shader";
)
{
    float ss, tt;
    point Pt = transform(projspace, P);
    if (projection == "st") { ss = s; tt = t; }
    else if (projection == "planar") { ss = xcomp(Pt); tt = ycomp(Pt); }
    else if (projection == "spherical") {
        vector Vt = normalize(vector Pt);
        ss = (-atan(ycomp(Vt), xcomp(Vt)) / (2*PI) + .5);
        tt = .5 - acos(zcomp(Vt)) / PI;
    }
    else { printf("unknown projection %s\n", projection); ss = s; tt = t; }
    ss = repeatS * (ss - originS);
    tt = repeatT * (tt - originT);
    color Ct = Cs;
    LAYER(1, BLEND_NORMAL)
    LAYER(2, BLEND_ADD)
    LAYER(3, BLEND_NORMAL);
    Oi = Os;
    Ci = Oi * Ct * (ambient() + diffuse(faceforward(normalize(N), I)));
}
