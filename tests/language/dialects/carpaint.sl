#ifndef BMRT
#define RAYTRACE_OK 0
#else
#define RAYTRACE_OK 1
#endif
#if defined(PRMAN) || defined(DELIGHT)
# define HAS_ENV
#endif
surface metallic_car (
    float  Ka = .4, Kd = .3, Ks = .6, Kr = .25, rough1 = .2, rough2 = .03;
    color  flakes = color(.9,.85,.7), base = color (.5,.02,.02);
    string envname = "";
    float  eta = 1.5;)
{
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I), Rdir, Tdir;
    float kr, kt, facing = clamp(V . Nf, 0, 1);
    color env = 0, spec;
    fresnel(-V, Nf, 1/eta, kr, kt, Rdir, Tdir);
    kr = smoothstep(0, .5, kr);
#ifdef HAS_ENV
    if (envname != "") env = color environment(envname, vtransform("world", Rdir));
#endif
#if RAYTRACE_OK
    else env = trace(P, Rdir);
#endif
    spec = Ks * (flakes * specular(Nf, V, rough1) + specular (Nf,V,rough2));
    color sparkle = flakes * pow(float noise(transform("shader", P) * 200), 8) * facing;
    Oi = Os;
    Ci = Os * (base * mix(color 1, Cs, .2) * (Ka*ambient() + Kd*diffuse(Nf)) + spec + sparkle + Kr*kr*env);
}
