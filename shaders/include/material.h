/* Materials as functions of their parameters. */
#ifndef MATERIAL_H
#define MATERIAL_H
#include "locillum.h"
#include "reflections.h"

color MaterialConstant(color basecolor; float Ka) { return basecolor * Ka; }
color MaterialMatte(normal Nf; color basecolor; float Ka, Kd) { return basecolor * (Ka * ambient() + Kd * diffuse(Nf)); }
color MaterialClay(normal Nf; color basecolor; float Ka, Kd, roughness)
{
    extern vector I;
    return basecolor * (Ka * ambient() + Kd * LocIllumOrenNayar(Nf, -normalize(I), roughness));
}
color MaterialPlastic(normal Nf; color basecolor; float Ka, Kd, Ks, roughness)
{
    extern vector I;
    return basecolor * (Ka * ambient() + Kd * diffuse(Nf)) + Ks * specular(Nf, -normalize(I), roughness);
}
color MaterialRoughMetal(normal Nf; color basecolor; float Ka, Kd, Ks, roughness)
{
    extern vector I;
    return basecolor * (Ka * ambient() + Kd * diffuse(Nf) + Ks * specular(Nf, -normalize(I), roughness));
}
color MaterialMetal(normal Nf; color basecolor; float Ka, Kd, Ks, roughness)
{
    return MaterialRoughMetal(Nf, basecolor, Ka, Kd, Ks, roughness);
}
color MaterialShinyMetal(normal Nf; color basecolor; float Ka, Kd, Ks, roughness, Kr, blur; DECLARE_ENVPARAMS)
{
    extern point P;
    extern vector I;
    vector IN = normalize(I), R = reflect(IN, Nf);
    return basecolor * (Ka * ambient() + Kd * diffuse(Nf) + Ks * specular(Nf, -IN, roughness) +
                        SampleEnvironment(P, R, Kr, blur, ENVPARAMS));
}
color MaterialBrushedMetal(normal Nf; color basecolor; vector xdir; float Ka, Kd, Ks, uroughness, vroughness)
{
    extern vector I;
    return basecolor * (Ka * ambient() + Kd * diffuse(Nf) +
                        Ks * LocIllumWardAnisotropic(Nf, -normalize(I), xdir, uroughness, vroughness));
}
color MaterialShinyPlastic(normal Nf; color basecolor; float Ka, Kd, Ks, roughness, Kr, blur, ior; DECLARE_ENVPARAMS)
{
    extern point P;
    extern vector I;
    vector IN = normalize(I), R = reflect(IN, Nf);
    float fkr = 1, fkt = 0;
    fresnel(IN, Nf, 1 / ior, fkr, fkt);
    return fkt * basecolor * (Ka * ambient() + Kd * diffuse(Nf)) + Ks * specular(Nf, -IN, roughness) +
           SampleEnvironment(P, R, fkr * Kr, blur, ENVPARAMS);
}
color MaterialCeramic(normal Nf; color basecolor; float Ka, Kd, Ks, roughness, Kr, blur, ior, specsharpness; DECLARE_ENVPARAMS)
{
    extern point P;
    extern vector I;
    vector IN = normalize(I), R = reflect(IN, Nf);
    float fkr = 1, fkt = 0;
    fresnel(IN, Nf, 1 / ior, fkr, fkt);
    return fkt * basecolor * (Ka * ambient() + Kd * diffuse(Nf)) + Ks * LocIllumGlossy(Nf, -IN, roughness, specsharpness) +
           SampleEnvironment(P, R, fkr * Kr, blur, ENVPARAMS);
}
color MaterialThinPlastic(normal Nf; vector V; color basecolor; float Ka, Kd, Kt, Ks, roughness)
{
    return basecolor * (Ka * ambient() + Kd * diffuse(Nf) + Kt * diffuse(-Nf)) + Ks * specular(Nf, V, roughness);
}
#endif
