/* fog thick near the ground */
volume groundfog(float distance = 1, height = 1; color background = 0;)
{
    float d;
    point PW = transform("world", P);
    d = 1 - exp(-length(I) / distance * exp(-ycomp(PW) / height));
    Ci = mix(Ci, background, d);
    Oi = mix(Oi, color (1,1,1), d);
}
