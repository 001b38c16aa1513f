/* Local illumination models as loops over the lights. */
#ifndef LOCILLUM_H
#define LOCILLUM_H

/* rough diffuse surfaces: Oren and Nayar's qualitative model */
color LocIllumOrenNayar(normal N; vector V; float roughness)
{
    float sigma2 = roughness * roughness;
    float A = 1 - 0.5 * sigma2 / (sigma2 + 0.33), B = 0.45 * sigma2 / (sigma2 + 0.09);
    float theta_r = acos(clamp(V . N, -1, 1));
    vector across = normalize(V - N * (V . N));
    color C = 0;
    extern point P;
    illuminance (P, N, PI / 2) {
        uniform float nondiff = 0;
        lightsource("__nondiffuse", nondiff);
        if (nondiff < 1) {
            vector LN = normalize(L);
            float cos_i = LN . N, theta_i = acos(clamp(cos_i, -1, 1));
            float side = max(0, across . normalize(LN - N * cos_i));
            C += (1 - nondiff) * Cl * cos_i * (A + B * side * sin(max(theta_i, theta_r)) * tan(min(theta_i, theta_r)));
        }
    }
    return C;
}
/* a highlight with an edge */
color LocIllumGlossy(normal N; vector V; float roughness, sharpness)
{
    color C = 0;
    float w = 0.18 * (1 - sharpness); /* half the width of the edge */
    extern point P;
    illuminance (P, N, PI / 2) {
        uniform float nonspec = 0;
        lightsource("__nonspecular", nonspec);
        if (nonspec < 1) {
            vector H = normalize(normalize(L) + V);
            C += (1 - nonspec) * Cl * smoothstep(0.72 - w, 0.72 + w, pow(max(0, N . H), 1 / roughness));
        }
    }
    return C;
}
/* Ward's anisotropic highlight, roughness along xdir and across it */
color LocIllumWardAnisotropic(normal N; vector V; vector xdir; float xroughness, yroughness)
{
    float cos_r = clamp(N . V, 0.0001, 1);
    vector X = xdir / xroughness, Y = (N ^ xdir) / yroughness;
    color C = 0;
    extern point P;
    illuminance (P, N, PI / 2) {
        uniform float nonspec = 0;
        lightsource("__nonspecular", nonspec);
        if (nonspec < 1) {
            vector LN = normalize(L), H = normalize(V + LN);
            float rho = exp(-2 * ((X . H) * (X . H) + (Y . H) * (Y . H)) / (1 + H . N)) / sqrt(max(LN . N, 0.0001) * cos_r);
            C += (1 - nonspec) * Cl * (LN . N) * rho / (4 * xroughness * yroughness);
        }
    }
    return C;
}
color LocIllumGreenbergAnisotropic(normal N; vector V; vector xdir; float xroughness, yroughness)
{
    return LocIllumWardAnisotropic(N, V, xdir, xroughness, yroughness);
}
/* Cook and Torrance: Beckmann's facets, shadowing and Fresnel's reflection */
color LocIllumCookTorrance(normal N; vector V; float roughness, eta)
{
    float cos_r = max(N . V, 0.0001), m2 = roughness * roughness;
    color C = 0;
    extern point P;
    illuminance (P, N, PI / 2) {
        vector LN = normalize(L), H = normalize(LN + V);
        float nh = max(N . H, 0.0001), nl = max(N . LN, 0.0001), vh = max(V . H, 0.0001);
        float D = exp(-(1 - nh * nh) / (nh * nh * m2)) / (m2 * nh * nh * nh * nh);
        float G = min(1, min(2 * nh * cos_r / vh, 2 * nh * nl / vh));
        float Kr, Kt;
        fresnel(-V, normal H, 1 / eta, Kr, Kt);
        C += Cl * D * G * Kr / (PI * cos_r);
    }
    return C;
}
#endif
