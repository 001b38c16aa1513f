displacement emboss(string texturename = ""; float Km = 0.03; string dispspace = "shader"; float truedisp = 1; float sstart = 0, sscale = 1, tstart = 0, tscale = 1, blur = 0;)
{
    normal Ndiff = normalize(N) - normalize(Ng);
    if (texturename != "") {
        float ss = (s - sstart) / sscale, tt = (t - tstart) / tscale;
        float amp = float texture(texturename[0], ss, tt, "blur", blur);
        point PP;
        vector disp = vtransform(dispspace, normalize(vector N));
        if (truedisp != 0) { P = P + (amp*Km) * normalize(vector N) / max(length(disp), 1e-4); PP = P; }
        else PP = P + (amp*Km) * vector normalize(N);
        N = normalize(calculatenormal(PP)) + Ndiff;
    }
}
