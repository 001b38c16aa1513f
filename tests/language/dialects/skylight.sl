light amb_occ(float samples = 64; color filter = color(1); string envmap = "", envspace = "world"; float maxdist = 1e15, coneangle = PI/2; float intensity = 1;)
{
    normal shn = shadingnormal_(N);
    if (samples > 0) {
        float occ = occlusion(Ps, shn, samples, "maxdist", maxdist, "coneangle", coneangle);
        Cl = filter * (1 - occ) * intensity;
    }
    else Cl = filter;
    if (envmap != "") {
        vector e; color irr = color environment(envmap, vtransform(envspace, vector shn));
        Cl *= irr;
    }
}
normal shadingnormal_(normal x) { extern normal Ns; return faceforward(normalize(Ns), vector x * -1); }
