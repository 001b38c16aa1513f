/* mist: mist that fills what it is the Interior of, without light of its own: "density" is what a unit of length takes, by
   colour. */
volume mist(color density = color(0.5, 0.7, 1.0); color tint = color(0.55, 0.6, 0.7);)
{
    float l = length(I);
    color left = color(exp(-l * comp(density, 0)), exp(-l * comp(density, 1)), exp(-l * comp(density, 2)));
    Ci = Ci * left + tint * (1 - left);
    Oi = 1 - (1 - Oi) * left;
}
