/* Rough metal: Beckmann's facets. */
surface facetmetal(float roughness = .2;) {
    normal Nf = faceforward(normalize(N), I);
    Oi = 1;
    Ci = Cs * trace(P, vector(Nf), "distribution", "cook-torrance", "roughness", roughness, "eta", color(2.5), "wo", -normalize(I),
                    "samplearealights", 1, "type", "specular");
}
