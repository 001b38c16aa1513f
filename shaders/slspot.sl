/* slspot: SLProject's spot light: full inside the cut-off cone, times cos^exponent; OpenGL attenuation. docs/design/slproject.md.
   radius: of a disk about from that faces each point and casts the shadows; samples: rays to it outside of "path" (docs/light.md).
   Lamp: LightSource "slspot" 1 "float cutoff" .17 "float exponent" 20 "float intensity" 4 */
light slspot(float intensity = 1; color lightcolor = 1; point from = point "shader" (0, 0, 0); point to = point "shader" (0, 0, 1);
             float cutoff = radians(45), exponent = 0, kc = 1, kl = 0, kq = 0, radius = 0, samples = 1;
             output float __shadowradius = 0, __shadowsamples = 1;) {
    __shadowradius = radius;
    __shadowsamples = samples;
    uniform vector axis = normalize(to - from);
    illuminate(from, axis, cutoff) {
        float d = length(L);
        Cl = intensity * lightcolor * pow(max((L . axis) / d, 0), exponent) / (PI * (kc + kl * d + kq * d * d));
    }
}
