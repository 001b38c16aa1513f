/* stainedglass: panes of coloured glass in lead. Shadow rays see the colours too: the window colours what it shades.
     panes      around
     glasses    colours, resized to what is asked for: "palette" names a set
     lead       width of the lead */
surface stainedglass(float panes = 7, lead = .06, Kt = .85, Ks = .5; string palette = "gothic";)
{
    color glasses[];
    if (palette == "gothic") {
        push(glasses, color(.75, .05, .05));
        push(glasses, color(.06, .12, .7));
        push(glasses, color(.9, .62, .05));
        push(glasses, color(.05, .45, .16));
    } else {
        push(glasses, color(.8, .9, .75));
        push(glasses, color(.55, .75, .85));
    }
    float x = s * panes * 2, y = t * panes;
    float row = floor(y);
    x += .5 * mod(row, 2);
    float cx = mod(x, 1) - .5, cy = mod(y, 1) - .5;
    /* Lozenges: the lead lies where |x| + |y| is a half, and around the pane. */
    float d = abs(abs(cx) + abs(cy) - .5), rim = .5 - max(abs(cx), abs(cy));
    float w = abs(Du(x) * du) + abs(Dv(x) * dv) + 1e-4;
    float isLead = max(1 - smoothstep(lead - w, lead + w, d), 1 - smoothstep(lead / 2 - w, lead / 2 + w, rim));
    float inner = abs(cx) + abs(cy) < .5 ? 0 : 1;
    float which = mod(floor(arraylength(glasses) * cellnoise(floor(x), row + 7 * inner)), arraylength(glasses));
    color g = glasses[which] * (.8 + .4 * float noise(s * 60, t * 60));
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    color leadlight = color(.12, .12, .13) * (ambient() + diffuse(Nf)) + .2 * specular(Nf, V, .15);
    /* Glass takes from what is behind by its opacity, and shines where light is on either side. */
    color glow = g * .5 * (diffuse(Nf) + diffuse(-Nf)) + Ks * specular(Nf, V, .02);
    Oi = mix(color(1) - Kt * g, color(1), isLead);
    Ci = mix(glow * (color(1) - .5 * g), leadlight, isLead);
}
