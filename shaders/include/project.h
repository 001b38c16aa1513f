/* Texture coordinates from places: "st", "planar", "perspective", "spherical", "cylindrical". */
#ifndef PROJECT_H
#define PROJECT_H
#include "filterwidth.h"
void spherical_projection(point p; output float ss, tt, ds, dt)
{
    vector V = normalize(vector p);
    ss = (-atan(ycomp(V), xcomp(V)) + PI) / (2 * PI);
    tt = 0.5 - acos(zcomp(V)) / PI + 0.5;
    ds = filterwidth(ss);
    if (ds > 0.5) ds = max(1 - ds, MINFILTWIDTH);
    dt = filterwidth(tt);
    if (dt > 0.5) dt = max(1 - dt, MINFILTWIDTH);
}
void cylindrical_projection(point p; output float ss, tt, ds, dt)
{
    vector V = normalize(vector p);
    ss = (-atan(ycomp(V), xcomp(V)) + PI) / (2 * PI);
    tt = (zcomp(p) + 1) / 2;
    ds = filterwidth(ss);
    if (ds > 0.5) ds = max(1 - ds, MINFILTWIDTH);
    dt = filterwidth(tt);
}
void ProjectTo2D(string projection; point P; string whichspace; matrix xform; output float ss, tt, ds, dt)
{
    point p = transform(whichspace, P);
    extern float s, t;
    if (projection == "st") {
        p = point(s, t, 0);
    }
    p = transform(xform, p);
    if (projection == "spherical") spherical_projection(p, ss, tt, ds, dt);
    else if (projection == "cylindrical") cylindrical_projection(p, ss, tt, ds, dt);
    else {
        float w = projection == "perspective" ? max(abs(zcomp(p)), MINFILTWIDTH) : 1;
        ss = xcomp(p) / w;
        tt = ycomp(p) / w;
        ds = filterwidth(ss);
        dt = filterwidth(tt);
    }
}
/* colour and coverage of a map at a place with the size of a sample */
color GetColorTextureAndAlpha(string name; float ss, tt, ds, dt; output float alpha)
{
    color c = color texture(name, ss, tt);
    alpha = float texture(name[3], ss, tt, "fill", 1);
    return c;
}
color ApplyColorTextureOver(color under; string name, projection; point P; string whichspace; matrix xform; float opacity)
{
    float ss, tt, ds, dt, alpha;
    color c = under;
    if (name != "") {
        ProjectTo2D(projection, P, whichspace, xform, ss, tt, ds, dt);
        c = GetColorTextureAndAlpha(name, ss, tt, ds, dt, alpha);
        c = mix(under, c, alpha * opacity);
    }
    return c;
}
#endif
