/* shadowspot: a spot light that casts shadows where "shadowname" is given. The name of a map that was made for the light, or "raytrace": either
   way rays find the shadow, so that scenes of several passes do not depend on their maps.
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
        if (shadowname != "")
            Cl *= transmission(Ps, from);
    }
}
