/* skydome: a sky with a bright horizon, a deep zenith and a glow around its sun; a light of "path".
     zenith, horizon, ground   colours
     sundirection              toward the sun, glow: how bright it is there
   Ball: LightSource "skydome" 1 "float intensity" .8 */
light skydome(
    float intensity = 1, glow = 3, glowsize = 25;
    color zenith = color(.15, .32, .75), horizon = color(.75, .82, .9), ground = color(.25, .22, .2);
    vector sundirection = vector "world" (-.5, .6, -.6);)
{
    solar() {
        vector way = -normalize(L);
        float up = ycomp(vtransform("world", way));
        float near = max(0, way . normalize(sundirection));
        color sky = up > 0 ? mix(horizon, zenith, pow(up, .45)) : mix(horizon, ground, smoothstep(0, .15, -up));
        Cl = intensity * (sky + glow * pow(near, glowsize) * color(1, .85, .6));
    }
}
