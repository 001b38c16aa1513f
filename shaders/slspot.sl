/* slspot: SLProject's spot light: full inside the cut-off cone, times cos^exponent; OpenGL attenuation. pathtracer.md section 4.2 Lamp: LightSource "slspot" 1 "float cutoff" .17 "float exponent" 20 "float intensity" 4 */
light slspot(float intensity = 1; color lightcolor = 1; point from = point "shader" (0, 0, 0); point to = point "shader" (0, 0, 1);
             float cutoff = radians(45), exponent = 0, kc = 1, kl = 0, kq = 0;) {
    uniform vector axis = normalize(to - from);
    illuminate(from, axis, cutoff) {
        float d = length(L);
        Cl = intensity * lightcolor * pow(max((L . axis) / d, 0), exponent) / (PI * (kc + kl * d + kq * d * d));
    }
}
