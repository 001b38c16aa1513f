/* Plaster: peaks of noise cut at a level, in three octaves, the last one far finer than a pixel. */
displacement stucco(float depth = 0.01, frequency = 60, level = 0.55)
{
    point p = transform("shader", P) * frequency;
    float i, size = 1, height = 0;
    for (i = 0; i < 3; i += 1) {
        height += size * smoothstep(level - 0.2, level + 0.2, noise(p));
        size *= 0.5;
        p *= 4;
    }
    P += normalize(N) * depth * height;
    N = calculatenormal(P);
}
