/* Texture coordinates from places: "st", "planar", "perspective", "spherical", "cylindrical". */
#ifndef PROJECT_H
#define PROJECT_H
#include "filterwidth.h"
void spherical_projection(point p; output float ss, tt, ds, dt)
{
    vector V = normalize(vector p);
    ss = (-atan(ycomp(V), xcomp(V)) + PI) / (2 * PI);
    tt = 0.5 - acos(zcomp(V)) / PI;
    ds = filterwidth(ss);
    if (ds > 0.5) ds = max(1 - ds, MINFILTWIDTH);
    dt = filterwidth(tt);
    if (dt > 0.5) dt = max(1 - dt, MINFILTWIDTH);
}
void cylindrical_projection(point p; output float ss, tt, ds, dt)
{
    vector V = normalize(vector p);
    ss = (-atan(ycomp(V), xcomp(V)) + PI) / (2 * PI);
    tt = zcomp(p);
    ds = filterwidth(ss);
    if (ds > 0.5) ds = max(1 - ds, MINFILTWIDTH);
    dt = filterwidth(tt);
}
void ProjectTo2D(string projection; point P; string whichspace; matrix xform; output float ss, tt, ds, dt)
{
    extern float s, t;
    point p;
    if (projection == "st") p = point(s, t, 0);
    else p = transform(whichspace, P);
    p = transform(xform, p);
    if (projection == "spherical") spherical_projection(p, ss, tt, ds, dt);
    else if (projection == "cylindrical") cylindrical_projection(p, ss, tt, ds, dt);
    else {
        float w = projection == "perspective" ? max(zcomp(p), 1e-6) : 1;
        ss = xcomp(p) / w;
        tt = ycomp(p) / w;
        ds = filterwidth(ss);
        dt = filterwidth(tt);
    }
}
/* Colour and coverage (of its channel alphachannel) of a map that is projected in whichspace. */
color GetColorTextureAndAlpha(string texturename, projection; point P; string whichspace; matrix xform; float blur; uniform float alphachannel;
                              output float alpha)
{
    float ss, tt, ds, dt;
    ProjectTo2D(projection, P, whichspace, xform, ss, tt, ds, dt);
    float a = ds / 2, b = dt / 2;
    alpha = float texture(texturename[alphachannel], ss - a, tt - b, ss + a, tt - b, ss - a, tt + b, ss + a, tt + b, "blur", blur, "fill", 1);
    return color texture(texturename, ss - a, tt - b, ss + a, tt - b, ss - a, tt + b, ss + a, tt + b, "blur", blur);
}
/* A map with coverage over a colour; the map is premultiplied. */
color ApplyColorTextureOver(color basecolor; string texturename, projection; point P; string whichspace; matrix xform; float blur)
{
    float alpha = 1;
    color c = GetColorTextureAndAlpha(texturename, projection, P, whichspace, xform, blur, 3, alpha);
    return c + (1 - alpha) * basecolor;
}
float GetFloatTextureAndAlpha(string texturename, projection; point P; string whichspace; matrix xform; float blur; uniform float alphachannel;
                              output float alpha)
{
    float ss, tt, ds, dt;
    ProjectTo2D(projection, P, whichspace, xform, ss, tt, ds, dt);
    float a = ds / 2, b = dt / 2;
    alpha = float texture(texturename[alphachannel], ss - a, tt - b, ss + a, tt - b, ss - a, tt + b, ss + a, tt + b, "blur", blur, "fill", 1);
    return float texture(texturename, ss - a, tt - b, ss + a, tt - b, ss - a, tt + b, ss + a, tt + b, "blur", blur);
}
float ApplyFloatTextureOver(float baseval; string texturename, projection; point P; string whichspace; matrix xform; float blur)
{
    float alpha = 1;
    float x = GetFloatTextureAndAlpha(texturename, projection, P, whichspace, xform, blur, 3, alpha);
    return x + (1 - alpha) * baseval;
}
matrix array_to_mx(float m[16])
{
    return matrix(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8], m[9], m[10], m[11], m[12], m[13], m[14], m[15]);
}
#endif
