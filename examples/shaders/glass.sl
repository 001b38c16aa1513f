/* glass: reflection and refraction by Fresnel's law, colour by the way through the glass (Beer), and a little dispersion if asked for.
     ior          index of refraction
     density      1 / distance at which "tint" is reached inside
     tint         colour of thick glass
     dispersion   difference of the index between red and blue; above 0 three rays go in */
surface glass(float ior = 1.5, density = .4, dispersion = 0, Ks = .4, roughness = .01; color tint = color(.75, .95, .85);)
{
    normal Nn = normalize(N);
    vector In = normalize(I);
    float inside = (In . Nn) > 0 ? 1 : 0;
    normal Nf = faceforward(Nn, I);
    float eta = inside > .5 ? ior : 1 / ior;
    float kr, kt;
    vector R, T;
    fresnel(In, Nf, eta, kr, kt, R, T);
    color through = 1;
    if (inside > .5) {
        float way = length(I) * density;
        through = color(pow(comp(tint, 0), way), pow(comp(tint, 1), way), pow(comp(tint, 2), way));
    }
    color mirror = kr * trace(P, R);
    color refracted = 0;
    if (dispersion > 0) {
        // A sum of products with trace(), so that the shader need not wait for its rays, and photons go through it.
        float red = ior - dispersion / 2, blue = ior + dispersion / 2;
        refracted = kt * (color(1, 0, 0) * trace(P, refract(In, Nf, inside > .5 ? red : 1 / red))
            + color(0, 1, 0) * trace(P, refract(In, Nf, inside > .5 ? ior : 1 / ior))
            + color(0, 0, 1) * trace(P, refract(In, Nf, inside > .5 ? blue : 1 / blue)));
    } else if (kt > 0) {
        refracted = kt * trace(P, T);
    }
    Oi = 1;
    Ci = through * (mirror + refracted);
    if (inside < .5) Ci += Ks * specular(Nf, -In, roughness);
}
