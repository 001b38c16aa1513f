surface messages(output varying color _diffuse = 0, _specular = 0; output varying float _ao = 0; string lightcat = "key&-fill";)
{
    normal Nn = normalize(N); vector V = -normalize(I);
    float nd, ns; uniform float depth = 0; string type = "", rname; float version[4]; color user = 0; point org;
    rayinfo("depth", depth); rayinfo("type", type); rayinfo("origin", org);
    rendererinfo("renderer", rname); rendererinfo("version", version);
    if (attribute("user:tint", user) == 0) user = 1;
    string objname = ""; attribute("identifier:name", objname);
    float shot[2]; option("Shutter", shot);
    illuminance(lightcat, P, Nn, PI/2, "light:__nondiffuse", nd, "light:__nonspecular", ns, "send:light:__extra", depth) {
        float sh = 0; color lc = 0; float isok = lightsource("__shadowF", sh); lightsource("lightcolor", lc);
        if (nd == 0) _diffuse += Cl * (normalize(L) . Nn) * (1 - sh * isok);
        if (ns == 0) _specular += Cl * specularbrdf(normalize(L), Nn, V, 0.1);
    }
    if (type == "camera" && depth == 0) _ao = 1;
    float bound; if (displacement("Km", bound) == 1) _ao *= bound;
    if (surface("Kd", bound) == 1) _ao += 0;
    if (atmosphere("density", bound) == 0) _ao += 0;
    Ci = user * Cs * _diffuse + _specular; Oi = Os; Ci *= Oi;
}
