/* a checkered plane of another coordinate */
surface
check(float Kd = .8, Ka = .2, frequency = 10; color blackcolor = color (0,0,0))
{
    float smod = mod(s*frequency, 1),
          tmod = mod(t*frequency, 1);
    Oi = Os;
    if (smod < 0.5)
        if (tmod < 0.5)
            Ci = Cs;
        else
            Ci = blackcolor;
    else
        if (tmod < 0.5)
            Ci = blackcolor;
        else
            Ci = Cs;
    Ci = Oi * Ci * (Ka * ambient() + Kd * diffuse(faceforward(normalize(N), I)));
}
