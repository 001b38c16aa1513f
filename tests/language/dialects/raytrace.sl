surface raytraced(float eta = 1.4, Kr = 1, Kt = 1, samples = 8, angle = 0.1; string subset = "", hitmode = "default"; color absorb = 0;)
{
    vector In = normalize(I), R, T; normal Nn = normalize(N); float kr, kt, dist = 0; color refl = 0, refr = 0, hitc = 0, trans = 0; point hp = 0;
    float ior = (In . Nn < 0) ? 1/eta : eta;
    normal Nf = faceforward(Nn, I);
    fresnel(In, Nf, ior, kr, kt, R, T);
    refl = trace(P, R, "samples", samples, "samplecone", angle, "bias", 0.01, "subset", subset);
    refr = trace(P, T, "maxdist", 1e10, "hitsides", "both");
    color shd = transmission(P, P + 10 * R, "samples", samples);
    float ct = 0, occ = 0;
    gather("illuminance", P, Nf, PI/2, samples, "surface:Ci", hitc, "ray:length", dist, "ray:origin", hp, "label", "gi", "distribution", "cosine") { refl += hitc/samples; ct += 1; } else { occ += 1; }
    occ = occlusion(P, Nf, samples, "maxdist", 10, "adaptive", 1);
    color ind = indirectdiffuse(P, Nf, samples);
    trans = subsurface(P, Nf, "scattering", color(1), "absorption", color(.1));
    Ci = Kr*kr*refl + Kt*kt*refr*exp(-comp(absorb,0)*dist) + ind*(1-occ) + trans*ct + shd*0; Oi = 1;
}
