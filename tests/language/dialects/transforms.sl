transformation twist(float turns = 1)
{
    float a = turns * zcomp(P) * 2 * PI;
    P = point(xcomp(P)*cos(a) - ycomp(P)*sin(a), xcomp(P)*sin(a) + ycomp(P)*cos(a), zcomp(P));
}
