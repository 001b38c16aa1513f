/* shadowpoint: a point light that casts shadows where one of its six map names is given: sfpx for what lies along the x axis of the world, and so
   on; shadowname for all around. By rays where there is no such map, as for "raytrace", and always under path.
   Lamp: LightSource "shadowpoint" 1 "float intensity" 38 "string sfpx" "raytrace" */
light shadowpoint(float intensity = 1; color lightcolor = 1; point from = point "shader" (0, 0, 0);
                  string shadowname = "", sfpx = "", sfnx = "", sfpy = "", sfny = "", sfpz = "", sfnz = "";
                  float samples = 16, width = 1, blur = 0, bias = -1;) {
    illuminate(from) {
        Cl = intensity * lightcolor / (L . L);
        string map = shadowname;
        if (map == "") {
            vector w = vtransform("world", L);
            float x = xcomp(w), y = ycomp(w), z = zcomp(w);
            if (abs(x) > abs(y) && abs(x) > abs(z)) map = (x > 0) ? sfpx : sfnx;
            else if (abs(y) > abs(z)) map = (y > 0) ? sfpy : sfny;
            else map = (z > 0) ? sfpz : sfnz;
        }
        if (shadowname != "" || sfpx != "" || sfnx != "" || sfpy != "" || sfny != "" || sfpz != "" || sfnz != "") {
            if (textureinfo(map, "exists", 0) == 1)
                Cl *= 1 - color shadow(map, Ps, "samples", samples, "width", width, "blur", blur, "bias", bias);
            else
                Cl *= transmission(Ps, from);
        }
    }
}
