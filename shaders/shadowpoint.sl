/* shadowpoint: a point light that casts shadows where one of its six map names is given. Rays find the shadow, whatever map is named.
   Lamp: LightSource "shadowpoint" 1 "float intensity" 38 "string sfpx" "raytrace" */
light shadowpoint(float intensity = 1; color lightcolor = 1; point from = point "shader" (0, 0, 0);
                  string shadowname = "", sfpx = "", sfnx = "", sfpy = "", sfny = "", sfpz = "", sfnz = "";
                  float samples = 16, width = 1, blur = 0, bias = -1;) {
    illuminate(from) {
        Cl = intensity * lightcolor / (L . L);
        if (shadowname != "" || sfpx != "" || sfnx != "" || sfpy != "" || sfny != "" || sfpz != "" || sfnz != "")
            Cl *= transmission(Ps, from);
    }
}
