/* Pictures of a principled surface. */
#ifndef LAYERMAPS_H
#define LAYERMAPS_H
/* (s, t) scaled, turned (degrees) and moved, in that order, where (0, 0) is the upper left corner of the picture; repeat 1: beside the
   picture it begins anew. */
void layerPlace(float scaleS, scaleT, offsetS, offsetT, rotation, repeat; output float ss, tt)
{
    extern float s, t;
    float x = s * scaleS, y = t * scaleT;
    ss = x + offsetS;
    tt = y + offsetT;
    if (rotation != 0) {
        float c = cos(radians(rotation)), k = sin(radians(rotation));
        ss = c * x + k * y + offsetS;
        tt = c * y - k * x + offsetT;
    }
    if (repeat == 1) {
        if (ss < 0 || ss > 1) ss -= floor(ss);
        if (tt < 0 || tt > 1) tt -= floor(tt);
    }
}
/* 1 where there is none. */
color layerMap(string map; float ss, tt)
{
    color x = 1;
    if (map != "") x = color texture(map, ss, tt);
    return x;
}
/* One channel of it; -1: the mean of three. */
float layerChannel(string map; float channel, ss, tt)
{
    float x = 1;
    if (map != "") {
        if (channel < 0) {
            x = (float texture(map[0], ss, tt) + float texture(map[1], ss, tt) + float texture(map[2], ss, tt)) / 3;
        } else x = float texture(map[channel], ss, tt, "fill", 1);
    }
    return x;
}
/* A picture of slopes: red along s, green against t (up in the picture), blue along the normal, -1 to 1 as 0 to 1. */
normal layerNormalMap(string map; float ss, tt, strength; normal n; vector along)
{
    float x = float texture(map[0], ss, tt), y = float texture(map[1], ss, tt), z = float texture(map[2], ss, tt); /* data, not colours */
    vector u = normalize(along - (along . n) * n), v = n ^ u;
    float su = (2 * x - 1) * strength, sv = (2 * y - 1) * strength;
    extern vector dPdu, dPdv;
    extern float s, t;
    float det = Du(s) * Dv(t) - Dv(s) * Du(t);
    vector up = normalize(sign(det) * (dPdv * Du(s) - dPdu * Dv(s))); /* in which t grows */
    if (v . up > 0) v = -v; /* green leads against t */
    return normalize(normal(su * u + sv * v + max(2 * z - 1, .01) * vector(n)));
}
#endif
