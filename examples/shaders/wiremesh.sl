/* wiremesh: woven wire with holes that are really open. Over- and underpasses are shaded as bumps.
     wires       along s; half as many along t
     thickness   of a wire, as a part of the mesh
     metal       colour */
surface wiremesh(float wires = 40, thickness = .35, Ka = 1, Kd = .4, Ks = .9, roughness = .08; color metal = color(.75, .7, .6);)
{
    float x = s * wires, y = t * wires / 2;
    float cx = mod(x, 1) - .5, cy = mod(y, 1) - .5;
    float half = thickness / 2;
    float wx = 1 - filterstep(half, abs(cx)), wy = 1 - filterstep(half, abs(cy));
    float over = mod(floor(x) + floor(y), 2);
    float upon = over > .5 ? wx : wy * (1 - wx) > 0 ? 0 : wx;
    /* The round of the wire that lies on top. */
    float across = upon > .5 ? cx / half : cy / half;
    vector side = upon > .5 ? normalize(dPdu) : normalize(dPdv);
    normal Nf = faceforward(normalize(N), I);
    normal Nw = normalize(Nf + clamp(across, -.95, .95) * side);
    float cover = max(wx, wy);
    Oi = Os * cover;
    Ci = Oi * Cs * metal * (Ka * ambient() + Kd * diffuse(Nw) + Ks * specular(Nw, -normalize(I), roughness));
}
