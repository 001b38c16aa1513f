/* xray: what an X-ray plate or an electron microscope shows: bright where you look along the surface, clear where you look through it.
     exponent   how fast it clears
     glow       colour */
surface xray(float exponent = 2, strength = 1; color glow = color(.4, .9, 1);)
{
    float along = 1 - abs(normalize(N) . normalize(I));
    float amount = strength * pow(along, exponent);
    Oi = Os * clamp(amount, 0, 1);
    Ci = Os * Cs * glow * amount;
}
