/* candle: wax that light goes through: lit from behind it glows, more where it is thin. The way through the wax is measured by a ray.
     wax        colour
     depth      distance after which a third of the light is left
     Ks         of the skin of the wax */
surface candle(color wax = color(.9, .55, .22); float depth = .5, Ka = 1, Kd = .3, Kt = .5, Ks = .2, roughness = .2;)
{
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    color glow = 0;
    float shell = 1;
    illuminance(P) {
        /* The thickness of a ball of radius 1 along the light, from the angle alone: enough for candles. */
        float c = -(normalize(N) . normalize(L));
        float way = 2 * max(0, c) * shell;
        float wrap = .5 + .5 * (Nf . normalize(L));
        color through = color(exp(-way / (2 * depth)), exp(-way / depth), exp(-way / (.5 * depth)));
        glow += Cl * wax * through * mix(1, wrap, .5);
    }
    Oi = Os;
    Ci = Os * Cs * (wax * (Ka * ambient() + Kd * diffuse(Nf)) + Kt * .6 * glow + Ks * specular(Nf, V, roughness));
}
