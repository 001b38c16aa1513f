imager filmlook(float gamma = 1, gain = 1, vignette = .2, grain = 0.02; color background = color "rgb" (.1, .1, .2); float seed = 0;)
{
    float res[3] = {640, 480, 1};
    float n;
    option("Format", res);
    n = float cellnoise(xcomp(P) + seed, ycomp(P));
    float dx = xcomp(P) / res[0] - .5, dy = ycomp(P) / res[1] - .5;
    Ci += (1 - alpha) * background;
    Ci *= 1 - vignette * (dx*dx + dy*dy);
    Ci = color (pow(comp(Ci,0), 1/gamma), pow(comp(Ci,1), 1/gamma), pow(comp(Ci,2), 1/gamma)) * gain;
    Ci += grain * (n - .5);
    Oi = 1;
    alpha = 1;
}
