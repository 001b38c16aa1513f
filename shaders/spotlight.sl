/* spotlight: a cone of light with a soft edge. RISpec standard shader.
   radius: of a disk about from that faces each point and casts the shadows; samples: rays to it outside of "path" (docs/light.md).
   Lamp: LightSource "spotlight" 1 "float intensity" 50 "float coneangle" .2 */
light spotlight(float intensity = 1; color lightcolor = 1; point from = point "shader" (0, 0, 0); point to = point "shader" (0, 0, 1);
                float coneangle = radians(30), conedeltaangle = radians(5), beamdistribution = 2, radius = 0, samples = 1;
                output float __shadowradius = 0, __shadowsamples = 1;) {
    __shadowradius = radius;
    __shadowsamples = samples;
    uniform vector axis = normalize(to - from);
    uniform float cosoutside = cos(coneangle);
    uniform float cosinside = cos(coneangle - conedeltaangle);
    illuminate(from, axis, coneangle) {
        float cosangle = (L . axis) / length(L);
        float atten = pow(cosangle, beamdistribution) / (L . L);
        atten *= smoothstep(cosoutside, cosinside, cosangle);
        Cl = atten * intensity * lightcolor;
    }
}
