/* torch: a hand lamp: rings of its reflector, a hot middle, dust on its glass. Asks the surface that it lights for "fluorescence" and gives it
   more if it has some: messages from a surface to its lights.
     coneangle   degrees
   Lamp: LightSource "torch" 1 "float intensity" 60 "float coneangle" 14 */
light torch(
    float intensity = 1, coneangle = 25, rings = 5, dirt = .3; color lightcolor = color(1, .93, .75);
    point from = point "shader" (0, 0, 0), to = point "shader" (0, 0, 1);)
{
    uniform vector axis = normalize(to - from);
    uniform float edge = radians(coneangle);
    illuminate(from, axis, edge) {
        float cosine = (L . axis) / length(L);
        float r = acos(clamp(cosine, -1, 1)) / edge;
        float fluorescence = 0;
        surface("fluorescence", fluorescence);
        float spill = 1 - smoothstep(.7, 1, r);
        float ring = 1 + .25 * cos(2 * PI * rings * r) * (1 - r);
        float dust = 1 - dirt * noise(8 * normalize(L));
        Cl = intensity * lightcolor / (L . L) * (.35 * spill + exp(-8 * r * r)) * ring * dust * (1 + fluorescence);
    }
}
