/* carpaint: a base coat that changes its colour with the angle, metal flakes in it, a clear coat over it.
     face, edge   colours seen straight on and along the surface
     flakes       size of a flake, and how far flakes lean
     coat         strength of the clear coat's reflection, by Fresnel's law */
surface carpaint(
    color face = color(.55, .02, .03), edge = color(.12, 0, .08);
    float flakesize = .012, flakelean = .5, flakes = 1.2, coat = 1, Ka = 1, Kd = .5;)
{
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    point Q = transform("shader", P) / flakesize;
    vector lean = vector cellnoise(Q) - .5;
    normal Nflake = normalize(Nf + flakelean * ntransform("shader", "current", normal(lean)));
    float view = Nf . V;
    color base = mix(edge, face, pow(clamp(view, 0, 1), .8));
    float shown = 1 - smoothstep(.6, 3, sqrt(area(Q)));
    color glitter = base * flakes * (shown * specular(Nflake, V, .03) + (1 - shown) * .5 * specular(Nf, V, .3));
    float kr, kt;
    fresnel(-V, Nf, 1 / 1.5, kr, kt);
    Oi = Os;
    Ci = Os * Cs * (base * (Ka * ambient() + Kd * diffuse(Nf)) + glitter + coat * (kr * trace(P, reflect(-V, Nf)) + .6 * specular(Nf, V, .008)));
}
