/* shadowdistant: parallel light that casts shadows where "shadowname" is given: those of the map of that name, by rays where there
   is none, as for "raytrace", and always under path.
   Lamp: LightSource "shadowdistant" 1 "string shadowname" "raytrace" */
light shadowdistant(float intensity = 1; color lightcolor = 1; point from = point "shader" (0, 0, 0); point to = point "shader" (0, 0, 1);
                    string shadowname = ""; float samples = 16, width = 1, blur = 0, bias = -1;) {
    solar(to - from, 0) {
        Cl = intensity * lightcolor;
        if (shadowname != "") {
            if (textureinfo(shadowname, "exists", 0) == 1)
                Cl *= 1 - color shadow(shadowname, Ps, "samples", samples, "width", width, "blur", blur, "bias", bias);
            else
                Cl *= transmission(Ps, Ps - 1e6 * normalize(to - from));
        }
    }
}
