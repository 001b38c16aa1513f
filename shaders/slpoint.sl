/* slpoint: SLProject's point light with the OpenGL attenuation 1 / (kc + kl d + kq d^2). reference: pathtracer.md section 4.2 Lamp: LightSource "slpoint" 1 "float kq" 1 "float intensity" 120 */
light slpoint(float intensity = 1; color lightcolor = 1; point from = point "shader" (0, 0, 0); float kc = 1, kl = 0, kq = 0;) {
    illuminate(from) {
        float d = length(L);
        Cl = intensity * lightcolor / (PI * (kc + kl * d + kq * d * d));
    }
}
