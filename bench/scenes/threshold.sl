/* Traced light above a threshold is kept, below it becomes cold shade: the kernel has to wait for the light. */
surface threshold(float limit = .12, samples = 1;) {
    normal Nf = faceforward(normalize(N), I);
    float dist = 0;
    color light = trace(P, vector(Nf), dist, "distribution", "cosine", "samplecone", PI / 2, "samplearealights", 1, "samples", samples, "type", "diffuse");
    float y = .2126 * light[0] + .7152 * light[1] + .0722 * light[2];
    Oi = 1;
    if (y > limit)
        Ci = Cs * light;
    else
        Ci = Cs * (.3 * light + color(0, .01, .03) * (dist < 1e30 ? 1 : 0));
}
