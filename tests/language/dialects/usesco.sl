surface usesco(string layername = "layer1"; shader direct = null; shader many[2] = {null, null};)
{
    shader h = getshader(layername);
    uniform float i, n = 0;
    shader all[] = getshaders("category", "layer");
    color c = Cs; float w = 0;
    n = arraylength(all);
    for (i = 0; i < n; i += 1) {
        c = all[i]->evalColor(c);
        float x = all[i]->evalFloat("noise", w);
        w = x;
    }
    if (h != null) { h->evalBoth(c, c, w); w += h->amount; }
    if (direct != null && many[0] == null) c *= 0.5;
    float amt = 0;
    if (getvar(h, "amount", amt) == 1) w *= amt;
    string nm = shadername();
    Ci = c * (1 + w); Oi = Os;
    if (nm == "") Ci = 0;
}
