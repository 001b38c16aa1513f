/* shadowspot: a spot light that casts shadows where "shadowname" is given: those of the map of that name, with its samples, width, blur and bias;
   by rays where there is no such map, as for "raytrace", and always under path.
   Lamp: LightSource "shadowspot" 1 "float intensity" 50 "float coneangle" .2 "string shadowname" "raytrace" */
light shadowspot(float intensity = 1; color lightcolor = 1; point from = point "shader" (0, 0, 0); point to = point "shader" (0, 0, 1);
                 float coneangle = radians(30), conedeltaangle = radians(5), beamdistribution = 2;
                 string shadowname = ""; float samples = 16, width = 1, blur = 0, bias = -1;) {
    uniform vector axis = normalize(to - from);
    uniform float cosoutside = cos(coneangle);
    uniform float cosinside = cos(coneangle - conedeltaangle);
    illuminate(from, axis, coneangle) {
        float cosangle = (L . axis) / length(L);
        float atten = pow(cosangle, beamdistribution) / (L . L);
        atten *= smoothstep(cosoutside, cosinside, cosangle);
        Cl = atten * intensity * lightcolor;
        if (shadowname != "") {
            if (textureinfo(shadowname, "exists", 0) == 1)
                Cl *= 1 - color shadow(shadowname, Ps, "samples", samples, "width", width, "blur", blur, "bias", bias);
            else
                Cl *= transmission(Ps, from);
        }
    }
}
