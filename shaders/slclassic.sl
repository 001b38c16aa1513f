/* slclassic: the material of SLProject's classic ray tracer: Blinn and Phong's light with ambient, and rays that mirror and glass send.
   For Hider "raytrace" (or "hidden"); slmaterial is for "path". docs/design/slproject.md has the formulas.
     ambientcolor, globalambient   ambient light is their product, and ambientcolor times ambient()
     shininess        exponent of the highlight
     kr, kt, kn       how much is reflected and let through, and the index of refraction
     fresnel          1: what is let through and what is reflected are mixed by Schlick's formula, from kr on; 0: by kt and kr
     mincontribution  rays that contribute no more than this to the picture send no others: the product of kr and kt along their way
     gain             on the light of lamps: PI undoes the division by it in slpoint, slspot and sldirect
   Shadows: Attribute "light" "shadows" "on" before the lamp; soft ones from an area light with "samples". Depth: Option "trace" "maxdepth" and
   Attribute "trace" "maxspeculardepth". Ball: Surface "slclassic" "color diffusecolor" [.1 .2 .5] "color specularcolor" [.8 .8 .8] "float shininess" 60 "float kr" .3 */
surface slclassic(color ambientcolor = .2, globalambient = 0, diffusecolor = .8, specularcolor = .5, emissive = 0;
                  float shininess = 100, kr = 0, kt = 0, kn = 1, fresnel = 1, mincontribution = 1 / 256, gain = PI;
                  string texturename = "";) {
    normal Nn = normalize(N), Nf = faceforward(Nn, I);
    vector In = normalize(I);
    color albedo = diffusecolor * Cs, diff = 0, spec = 0;
    if (texturename != "")
        albedo *= color texture(texturename);
    illuminance (P, Nn, PI / 2) {
        vector Ln = normalize(L), H = normalize(Ln - In);
        diff += Cl * gain * (Ln . Nn);
        spec += Cl * gain * pow(max(Nn . H, 0), shininess);
    }
    Oi = 1;
    Ci = clamp(emissive + ambientcolor * (globalambient + ambient()) + albedo * diff + specularcolor * spec, color 0, color 1);
    float contribution = 1;
    rayinfo("weight", contribution);
    if (kr > 0 || kt > 0) {
        float goes = (contribution > mincontribution) ? 1 : 0; /* a ray of weight 0 is not sent, and counted as ignored */
        vector R = reflect(In, Nf), T = refract(In, Nf, (In . Nn < 0) ? 1 / kn : kn);
        float inside = (T . T == 0) ? 1 : 0; /* total reflection: what would go through comes back, whole */
        if (inside == 1) T = R;
        float mirrored = kr, through = kt;
        if (fresnel != 0 && kt > 0) {
            mirrored = kr + (1 - kr) * pow(1 - abs(In . Nn), 5);
            through = 1 - mirrored;
        }
        if (kt > 0 && inside == 1)
            Ci += through * trace(P, T, "type", "specular", "label", "totalreflection", "weight", color(goes));
        if (kt > 0 && inside == 0)
            Ci += through * trace(P, T, "type", "specular", "weight", color(goes * kt));
        if (mirrored > 0)
            Ci += mirrored * trace(P, R, "type", "specular", "weight", color(goes * max(kr, 1e-9)));
    }
}
