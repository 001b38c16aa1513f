/* threads: the thread of a screw around z of shader space; runs out smoothly at both ends of v.
     turns    of the thread, along v
     depth    of it */
displacement threads(float turns = 12, depth = .05, runout = .12;)
{
    float phase = mod(v * turns + u, 1);
    float profile = 1 - abs(2 * phase - 1);
    profile = smoothstep(.15, .85, profile);
    float run = smoothstep(0, runout, v) * (1 - smoothstep(1 - runout, 1, v));
    P += depth * run * profile * normalize(N);
    N = calculatenormal(P);
}
