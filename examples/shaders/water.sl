/* water: a sea that is not displaced but bumped by sums of sine waves, each with its own direction (Gerstner's without their horizontal part).
   Clear over its bottom, mirror at the horizon.
     waves      how many
     size       length of the longest, in shader space
     height     of it
     clock      the time
     deep, shallow   colours of the water */
surface water(float waves = 6, size = .9, height = .025, clock = 0, ior = 1.33, Ks = .8; color deep = color(.01, .07, .1), shallow = color(.04, .24, .24);)
{
    point Q = transform("shader", P);
    float sum = 0, i, length = size, amplitude = height;
    for (i = 0; i < waves; i += 1) {
        float angle = 2 * PI * cellnoise(i * 1.7 + .5);
        vector way = vector(cos(angle), sin(angle), .5 * cos(2 * angle));
        float k = 2 * PI / length;
        sum += amplitude * sin(k * (vector(Q) . way) + sqrt(9.8 * k) * clock + 6 * cellnoise(i + 20.5));
        length *= .63;
        amplitude *= .6;
    }
    normal Nf = faceforward(normalize(calculatenormal(P + sum * normalize(N))), I);
    vector V = -normalize(I);
    float kr, kt;
    fresnel(-V, Nf, 1 / ior, kr, kt);
    color body = mix(deep, shallow, clamp(.5 + sum / (3 * height), 0, 1) * (Nf . V));
    Oi = Os;
    Ci = Os * (kt * body * (.4 + diffuse(Nf) + ambient()) + kr * trace(P, reflect(-V, Nf)) + Ks * specular(Nf, V, .015));
}
