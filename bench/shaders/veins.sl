// Six octaves of turbulence bending the stripes of a sine, as in marble.
surface veins(float scale = 5, stripes = 3;)
{
    point where = scale * point(u, v, 0.9);
    float bent = 0, frequency = 1, octave;
    for (octave = 0; octave < 6; octave += 1) {
        bent += abs(float noise(where * frequency) - 0.5) / frequency;
        frequency *= 2.01;
    }
    float stripe = 0.5 + 0.5 * sin(2 * PI * stripes * (v + 1.3 * bent));
    Ci = mix(color(0.2, 0.18, 0.16), color(0.93, 0.9, 0.86), pow(stripe, 0.6));
    Oi = 1;
}
