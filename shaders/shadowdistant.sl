/* shadowdistant: parallel light that casts shadows where "shadowname" is given, a map's name or "raytrace": either way rays find the shadow.
   Lamp: LightSource "shadowdistant" 1 "string shadowname" "raytrace" */
light shadowdistant(float intensity = 1; color lightcolor = 1; point from = point "shader" (0, 0, 0); point to = point "shader" (0, 0, 1);
                    string shadowname = ""; float samples = 16, width = 1, blur = 0, bias = -1;) {
    solar(to - from, 0) {
        Cl = intensity * lightcolor;
        if (shadowname != "")
            Cl *= transmission(Ps, Ps - 1e6 * normalize(to - from));
    }
}
