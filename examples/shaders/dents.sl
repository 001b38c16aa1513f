/* dents: dents of many sizes, as of a metal can that has been through a lot. Displacement, the shape is really changed.
     depth      of the largest
     scale      dents in a unit of shader space
     octaves    sizes */
displacement dents(float depth = .12, scale = 1.6, octaves = 5;)
{
    point Q = transform("shader", P) * scale;
    float magnitude = 0, size = 1, i;
    for (i = 0; i < octaves; i += 1) {
        magnitude += abs(.5 - noise(Q * size)) / size;
        size *= 2;
    }
    P -= depth * pow(magnitude, 3) * 8 * normalize(N);
    N = calculatenormal(P);
}
