/* marble by a spline of colours */
#define PALE_BLUE        color (0.25, 0.25, 0.35)
#define MEDIUM_BLUE      color (0.10, 0.10, 0.30)
#define DARK_BLUE        color (0.05, 0.05, 0.26)
#define NNOISE           4
surface bluestone(
        float   Ks    = .4,
                Kd    = .6,
                Ka    = .1,
                roughness = .1,
                txtscale = 1;
        color   specularcolor = 1)
{
    point PP;             /* scaled point in shader space */
    float csp;            /* color spline parameter */
    point Nf;             /* forward-facing normal */
    point V;              /* for specular() */
    float pixelsize, twice, scale, weight, turbulence;

    Nf = faceforward( normalize(N), I );
    V = normalize(-I);
    PP = transform("shader", P) * txtscale;
    pixelsize = sqrt(area(PP));
    twice = 2 * pixelsize;
    turbulence = 0;
    for (scale = 1; scale > twice; scale /= 2)
        turbulence += scale * noise(PP/scale);
    if (scale > pixelsize) {
        weight = (scale / pixelsize) - 1;
        weight = clamp(weight, 0, 1);
        turbulence += weight * scale * noise(PP/scale);
    }
    csp = clamp(4 * turbulence - 3, 0, 1);
    Ci = color spline(csp,
        PALE_BLUE, PALE_BLUE,
        MEDIUM_BLUE, MEDIUM_BLUE, MEDIUM_BLUE,
        PALE_BLUE, PALE_BLUE,
        DARK_BLUE, DARK_BLUE,
        PALE_BLUE, DARK_BLUE);
    Ci *= (Ka*ambient() + Kd*diffuse(Nf));
    Oi = Os;
    Ci = Oi * Ci + specularcolor * Ks * specular(Nf, V, roughness);
}
