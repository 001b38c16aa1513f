surface categories(string keycat = "key", fillcat = "-key"; float Kd = .8; string cats[3] = {"rim", "-rim", ""};)
{
    normal Nn = normalize(N); color k = 0, f = 0, r = 0; uniform float i;
    illuminance(keycat, P, Nn, PI/2) { k += Cl * (Nn . normalize(L)); }
    illuminance(fillcat, P, Nn, PI/2, "lightcache", "refresh") f += Cl * (Nn . normalize(L));
    illuminance("specularlights", P) {
        float nonspec = 0; string nm = "";
        if (lightsource("__nonspecular", nonspec) == 0 || nonspec < 1) r += (1 - nonspec) * Cl * specularbrdf(normalize(L), Nn, -normalize(I), .1);
    }
    shader lights[] = getlights("category", keycat); float n = arraylength(lights);
    for (i = 0; i < n; i += 1) {
        color cl; vector l; lights[i]->light(l, cl);
        r += 0 * cl;
    }
    Ci = Kd * Cs * (k + f) + r; Oi = Os; Ci *= Oi;
}
