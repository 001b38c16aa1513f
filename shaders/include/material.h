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
/* twosided 0: the inside of the object mirrors nothing. */
color MaterialShinyMetal(normal Nf; color basecolor; float Ka, Kd, Ks, roughness, Kr, blur; uniform float twosided; DECLARE_ENVPARAMS)
{
    extern point P;
    extern vector I;
    extern normal N;
    vector IN = normalize(I), R = reflect(IN, Nf);
    float kr = twosided == 0 && N . I > 0 ? 0 : Kr;
    return basecolor * (Ka * ambient() + Kd * diffuse(Nf) + Ks * specular(Nf, -IN, roughness) +
                        SampleEnvironment(P, R, kr, blur, ENVPARAMS));
}
color MaterialShinyMetal(normal Nf; color basecolor; float Ka, Kd, Ks, roughness, Kr, blur; DECLARE_ENVPARAMS)
{
    return MaterialShinyMetal(Nf, basecolor, Ka, Kd, Ks, roughness, Kr, blur, 1, ENVPARAMS);
}
color MaterialBrushedMetal(normal Nf; color basecolor; float Ka, Kd, Ks; vector xdir; float uroughness, vroughness)
{
    extern vector I;
    return basecolor * (Ka * ambient() + Kd * diffuse(Nf) +
                        Ks * LocIllumWardAnisotropic(Nf, -normalize(I), xdir, uroughness, vroughness));
}
color MaterialShinyPlastic(normal Nf; color basecolor; float Ka, Kd, Ks, roughness, Kr, blur, ior; uniform float twosided;
                           DECLARE_ENVPARAMS)
{
    extern point P;
    extern vector I;
    extern normal N;
    vector IN = normalize(I), R, T;
    float fkr = 1, fkt = 0;
    fresnel(IN, Nf, 1 / ior, fkr, fkt, R, T);
    fkt = 1 - fkr;
    if (twosided == 0 && N . I > 0) fkr = 0;
    return fkt * basecolor * (Ka * ambient() + Kd * diffuse(Nf)) + Ks * specular(Nf, -IN, roughness) +
           SampleEnvironment(P, R, fkr * Kr, blur, ENVPARAMS);
}
color MaterialShinyPlastic(normal Nf; color basecolor; float Ka, Kd, Ks, roughness, Kr, blur, ior; DECLARE_ENVPARAMS)
{
    return MaterialShinyPlastic(Nf, basecolor, Ka, Kd, Ks, roughness, Kr, blur, ior, 1, ENVPARAMS);
}
color MaterialCeramic(normal Nf; color basecolor; float Ka, Kd, Ks, roughness, specsharpness)
{
    extern vector I;
    return basecolor * (Ka * ambient() + Kd * diffuse(Nf)) + Ks * LocIllumGlossy(Nf, -normalize(I), roughness / 10, specsharpness);
}
/* Glass of index eta: mirrors Kr of what Fresnel gives, lets Kt of the rest through, tinted. */
color MaterialGlass(normal Nf; color basecolor; float Ka, Kd, Ks, roughness, Kr, reflblur; float Kt, refrblur, eta; color transmitcolor;
                    uniform float refrrayjitter, refrraysamples; DECLARE_ENVPARAMS)
{
    extern point P;
    extern vector I;
    extern normal N;
    vector IN = normalize(I), R, T;
    float kr, kt;
    fresnel(IN, Nf, I . N < 0 ? 1 / eta : eta, kr, kt, R, T);
    kt = (1 - kr) * Kt;
    kr *= Kr;
    color mirrored = SampleEnvironment(P, normalize(R), kr, reflblur, ENVPARAMS);
    color through = SampleEnvironment(P, normalize(T), kt, refrblur, envname, envspace, envrad, refrrayjitter, refrraysamples);
    return basecolor * (Ka * ambient() + Kd * diffuse(Nf)) + mirrored + Ks * LocIllumGlossy(Nf, -IN, roughness, 0.5) +
           transmitcolor * through;
}
color MaterialThinPlastic(normal Nf; vector V; color basecolor; float Ka, Kd, Kt, Ks, roughness)
{
    return basecolor * (Ka * ambient() + Kd * diffuse(Nf) + Kt * diffuse(-Nf)) + Ks * specular(Nf, V, roughness);
}
#endif
