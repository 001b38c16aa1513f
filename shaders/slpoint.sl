/* slpoint: SLProject's point light with the OpenGL attenuation 1 / (kc + kl d + kq d^2). docs/design/slproject.md.
   radius: of a disk about from that faces each point and casts the shadows; samples: rays to it outside of "path" (docs/light.md).
   Lamp: LightSource "slpoint" 1 "float kq" 1 "float intensity" 120 */
light slpoint(float intensity = 1; color lightcolor = 1; point from = point "shader" (0, 0, 0); float kc = 1, kl = 0, kq = 0,
              radius = 0, samples = 1; output float __shadowradius = 0, __shadowsamples = 1;) {
    __shadowradius = radius;
    __shadowsamples = samples;
    illuminate(from) {
        float d = length(L);
        Cl = intensity * lightcolor / (PI * (kc + kl * d + kq * d * d));
    }
}
