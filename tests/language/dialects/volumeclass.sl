class thinfog(float density = 0.1; color scatter = color(0.5);)
{
    float transmit(float d) { return exp(-density * d); }
    public void volume(output color Ci, Oi)
    {
        float tr = transmit(length(I));
        Ci = Ci * tr + scatter * (1 - tr);
        Oi = Oi * tr + color(1 - tr);
    }
}
