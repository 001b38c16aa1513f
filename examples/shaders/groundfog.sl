/* groundfog: mist that lies low: its density falls with the height in "world", so that the way through it has a closed form.
     density    at the ground
     layer      height at which a third of it is left
     background colour of the mist
   Ball: Atmosphere "groundfog" "float density" .9 "float layer" .35 "float ground" -1 */
volume groundfog(float density = .2, layer = 1, ground = 0; color background = color(.75, .8, .85);)
{
    point a = transform("world", P - I), b = transform("world", P);
    float ya = ycomp(a) - ground, yb = ycomp(b) - ground, rise = (yb - ya) / layer;
    /* Integral of density exp(-y / layer) along the way. */
    float mean = abs(rise) < 1e-3 ? exp(-ya / layer) : (exp(-ya / layer) - exp(-yb / layer)) / rise;
    float clear = exp(-density * length(I) * mean);
    Ci = mix(background, Ci, clear);
    Oi = mix(color(1), Oi, clear);
}
