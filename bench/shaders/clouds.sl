// Eight octaves of noise, coloured by a spline.
color sky(float x)
{
    return spline(x, color(0.05, 0.1, 0.4), color(0.05, 0.1, 0.4), color(0.2, 0.35, 0.7), color(0.5, 0.6, 0.8), color(0.8, 0.8, 0.85),
                  color(1, 1, 1), color(1, 1, 1));
}
surface clouds(float scale = 7, roughness = 0.52;)
{
    point where = scale * point(u, v, 0.4);
    float height = 0, weight = 1, octave;
    for (octave = 0; octave < 8; octave += 1) {
        height += weight * (float noise(where) - 0.5);
        where = where * 2.05;
        weight *= roughness;
    }
    Ci = sky(0.5 + height);
    Oi = 1;
}
