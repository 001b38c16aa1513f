/* Cinder blocks: a bump in the surface shader itself, pits of turbulence, joints between the blocks. */
surface cinder(float Ka = 0.2, Kd = 0.9, width = 0.4, height = 0.2, joint = 0.015, pits = 0.006)
{
    point p = transform("shader", P);
    float across = s / width, up = t / height, f = 60, turbulence = 0, row = floor(up), edge, bx, by;
    normal Nf;
    if (mod(row, 2) > 0.5) across += 0.5;
    bx = abs(mod(across, 1) - 0.5) * 2;
    by = abs(mod(up, 1) - 0.5) * 2;
    edge = smoothstep(1 - 2 * joint / width, 1 - joint / width, bx) + smoothstep(1 - 2 * joint / height, 1 - joint / height, by);
    while (f < 2000) {
        turbulence += abs(noise(p * f) - 0.5) * 60 / f;
        f *= 2;
    }
    Nf = calculatenormal(P + normalize(N) * (pits * (turbulence - 0.02 * min(edge, 1)) + 0.004 * (1 - min(edge, 1)) + pits * 0.4 * noise(p * 900)));
    Nf = faceforward(normalize(Nf), I);
    Oi = Os;
    Ci = Os * Cs * mix(1, 0.6, min(edge, 1)) * (Ka * ambient() + Kd * diffuse(Nf));
}
