light multi(float n = 4, spread = 1; color c1 = 1, c2 = color(1,.5,.2); float intensity = 1; float falloff = 2;)
{
    uniform float i;
    point from; float w = 1 / n;
    for (i = 0; i < n; i += 1) {
        from = point "shader" (spread * cos(2*PI*i/n), spread * sin(2*PI*i/n), 0);
        illuminate(from) { Cl = w * intensity * mix(c1, c2, i/n) / pow(length(L), falloff); }
    }
}
