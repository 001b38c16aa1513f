/* pointlight: light from one point, falling with the square of the distance. RISpec standard shader.
   radius: of a disk about from that faces each point and casts the shadows; samples: rays to it outside of "path" (docs/light.md).
   Lamp: LightSource "pointlight" 1 "float intensity" 38 */
light pointlight(float intensity = 1; color lightcolor = 1; point from = point "shader" (0, 0, 0); float radius = 0, samples = 1;
                 output float __shadowradius = 0, __shadowsamples = 1;) {
    __shadowradius = radius;
    __shadowsamples = samples;
    illuminate(from)
        Cl = intensity * lightcolor / (L . L);
}
