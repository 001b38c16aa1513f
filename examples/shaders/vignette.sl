/* vignette: darkens a picture toward its corners, as a lens does.
     strength   at the corners
     start      where it begins, 0 in the middle, 1 in the corner */
imager vignette(float strength = .7, start = .3;)
{
    uniform float format[3] = {1, 1, 1};
    option("Format", format);
    float x = 2 * xcomp(P) / format[0] - 1, y = 2 * ycomp(P) / format[1] - 1;
    float r = sqrt((x * x + y * y) / 2);
    Ci *= 1 - strength * smoothstep(start, 1, r);
}
