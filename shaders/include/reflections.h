/* Mirrors: environment maps, flat reflection maps, rays. */
#ifndef REFLECTIONS_H
#define REFLECTIONS_H

#include "filterwidth.h"
#include "raysphere.h"

#define DECLARE_ENVPARAMS string envname, envspace; uniform float envrad, rayjitter, raysamples
#define DECLARE_DEFAULTED_ENVPARAMS \
    string envname = "", envspace = "world"; uniform float envrad = 100, rayjitter = 0, raysamples = 1
#define ENVPARAMS envname, envspace, envrad, rayjitter, raysamples

/* A map on a sphere of radius envrad about the origin of envspace, from P in the direction R. */
color Environment(string envname, envspace; uniform float envrad; point P; vector R; float blur; output float alpha)
{
    point p = transform(envspace, P);
    vector d = normalize(vtransform(envspace, R));
    float b = vector(p) . d, c = vector(p) . vector(p) - envrad * envrad, h = b * b - c;
    if (h > 0) d = vector(p) + d * (sqrt(h) - b);
    alpha = float environment(envname[3], d, "blur", blur, "fill", 1);
    return color environment(envname, d, "blur", blur);
}
/* A picture of the mirrored scene, taken with the raster of this one. */
color ReflMap(string reflname; point P; float blur; output float alpha)
{
    point p = transform("NDC", P);
    alpha = float texture(reflname[3], xcomp(p), 1 - ycomp(p), "blur", blur, "fill", 1);
    return color texture(reflname, xcomp(p), 1 - ycomp(p), "blur", blur);
}
/* What rays find in a cone of about `blur` around Rdir; alpha: how many of them met something. */
color RayTrace(point P; vector Rdir; float Kr, blur, jitter; uniform float nsamples; output float alpha)
{
    color c = 0;
    float distance = 0;
    alpha = 0;
    if (Kr >= 0.0001) {
        color through = 0;
        c = trace(P, normalize(Rdir), "samples", max(1, nsamples), "samplecone", atan(blur / 2), "transmission", through);
        alpha = 1 - comp(through, 1);
    }
    return c;
}
/* What a mirror of strength Kr sees: rays, and where those meet nothing the map. In space "NDC" the map is a picture of the mirrored scene. */
color SampleEnvironment(point P; vector R; float Kr, blur; DECLARE_ENVPARAMS)
{
    color c = 0;
    float alpha = 0;
    if (envname != "") {
        if (envspace == "NDC") c = ReflMap(envname, P, blur, alpha);
        else c = Environment(envname, envspace, envrad, P, R, blur, alpha);
    }
    color met = 0;
    if (Kr >= 0.0001 && envname == "") /* a sum that path can weigh */
        met = trace(P, normalize(R), "samples", max(1, raysamples), "samplecone", atan(sqrt(blur) / 2));
    else met = RayTrace(P, R, Kr, sqrt(blur), rayjitter, raysamples, alpha);
    if (envname != "") met += (1 - alpha) * c;
    return Kr * met;
}
#endif
