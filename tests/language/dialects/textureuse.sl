surface textureuse(string n = "a.tx"; string many[2] = {"x.tx","y.tx"}; string e = "env.tx"; string sh = "sh.tx"; string b = "bumpy.tx";)
{
    float f; color c;
    f = texture(n); f = texture(n[0]); f = texture((n)[0]); f = float texture(n[2], s, t); c = color texture(n + "", u, v);
    c += texture(n, s, t, s+du, t, s, t+dv, s+du, t+dv);
    c += texture(many[0]) + color texture(many[1], s*2, t*2, "swidth", 2, "twidth", 2, "sblur", .1, "tblur", .1, "filter", "box", "lerp", 1);
    c += color environment(e, reflect(I, N), "blur", .1) + environment(e, N) * environment(e[0], I);
    f += shadow(sh, P) + float shadow(sh, P, "samples", 4, "bias", .1, "blur", .01);
    f += texture("const.tx", .5, .5);
    c += color "rgb" (texture(n[0]), texture(n[1]), texture(n[2]));
    float exists = 0, chans = 0; uniform float res[2];
    if (textureinfo(n, "exists", 0) == 1) { textureinfo(n, "channels", chans); textureinfo(n, "resolution", res); }
    uniform float ok = textureinfo(n, "channels", chans);

    Ci = c * f * (chans + res[0] + ok); Oi = Os;
}
