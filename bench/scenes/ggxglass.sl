/* Rough glass: reflection and refraction at GGX facets, sampled by lobe and by lights. */
surface ggxglass(float roughness = .2, index = 1.5;) {
    normal Nn = normalize(N);
    vector wo = -normalize(I);
    Oi = 1;
    Ci = Cs * trace(P, vector(Nn), "distribution", "glass-ggx", "roughness", roughness, "eta", (Nn . wo > 0) ? index : 1 / index, "wo", wo,
                    "samplearealights", 1, "type", "specular");
}
