/* toon: flat steps of light and a line around, as in a drawing.
     steps      of light
     ink        colour of the line; width of it
     paper      brightness of the darkest step */
surface toon(color paint = color(.95, .55, .1), ink = color(.02, .02, .05); float steps = 3, linewidth = .3, paper = .35, highlight = .985;)
{
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    float level = 0, spot = 0;
    illuminance(P, Nf, PI / 2) {
        vector l = normalize(L);
        float gain = clamp(luminance(Cl), 0, 1);
        level = max(level, gain * (Nf . l));
        spot = max(spot, step(highlight, Nf . normalize(l + V)) * step(.3, gain));
    }
    float q = (floor(clamp(level, 0, .999) * steps) + .5) / steps;
    float facing = Nf . V;
    float w = abs(Du(facing) * du) + abs(Dv(facing) * dv);
    float line = 1 - smoothstep(linewidth - w, linewidth + w, facing);
    Oi = Os;
    Ci = Os * mix(mix(Cs * paint * mix(paper, 1, q), color(1), spot), ink, line);
}
