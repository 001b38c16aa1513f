/* scanlines: an old tube: lines, a triad of phosphors, a tint.
     spacing   of the lines, pixels
     depth     how dark it is between them */
imager scanlines(float spacing = 3, depth = .5; color phosphor = color(.9, 1.1, .9);)
{
    float line = .5 + .5 * cos(2 * PI * ycomp(P) / spacing);
    float third = mod(floor(xcomp(P)), 3);
    color triad = third < .5 ? color(1, .7, .7) : third < 1.5 ? color(.7, 1, .7) : color(.7, .7, 1);
    Ci *= phosphor * triad * (1 - depth * line);
}
