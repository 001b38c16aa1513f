/* Mirrors: environment maps, flat reflection maps, rays. */
#ifndef REFLECTIONS_H
#define REFLECTIONS_H

#define DECLARE_ENVPARAMS \
    string envname, envspace; uniform float envrad; float rayjitter; float raysamples
#define DECLARE_DEFAULTED_ENVPARAMS \
    string envname = "", envspace = "world"; uniform float envrad = 100; float rayjitter = 0; float raysamples = 1
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
    alpha = float texture(reflname[3], xcomp(p), ycomp(p), "blur", blur, "fill", 1);
    return color texture(reflname, xcomp(p), ycomp(p), "blur", blur);
}
/* What a mirror of strength Kr sees: the map when there is one, else rays. */
color SampleEnvironment(point P; vector R; float Kr, blur; DECLARE_ENVPARAMS)
{
    color c = 0;
    float alpha = 1;
    if (Kr > 0.0001) {
        if (envname == "reflection") c = ReflMap(envname, P, blur, alpha);
        else if (envname != "") c = Environment(envname, envspace, envrad, P, R, blur, alpha);
        if (envname == "" || alpha < 1) c = c + (1 - (envname == "" ? 0 : alpha)) * trace(P, R);
    }
    return Kr * c;
}
color RayTrace(point P; vector Rdir; float rayjitter, blur; uniform float raysamples; output float alpha)
{
    alpha = 1;
    return trace(P, normalize(Rdir));
}
#endif
