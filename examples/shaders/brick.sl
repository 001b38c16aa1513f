/* brick: courses in running bond, mortar between them, each brick with a tint, a size and a wear of its own. The joints are bumped,
   not painted: the mortar lies deeper. Edges are filtered over the width that a point covers.
     swidth, twidth     of a brick, in s and t, mortar included
     mortar             its width
     brickcolor, mortarcolor, variation   colours, and how much bricks differ
     depth              of the joints, in shader space */
surface brick(
    float swidth = .125, twidth = .06, mortar = .009, variation = .35, depth = .02, Ka = 1, Kd = .9;
    color brickcolor = color(.52, .16, .09), mortarcolor = color(.5, .48, .44);)
{
    float row = floor(t / twidth);
    float offset = .5 * mod(row, 2) + .1 * (cellnoise(row) - .5);
    float ss = s / swidth + offset;
    float column = floor(ss);
    float sb = (ss - column) * swidth, tb = t - row * twidth;
    float half = mortar / 2;
    float wob = .3 * mortar * (noise(s * 160, t * 160) - .5);
    float inside = (filterstep(half + wob, sb) - filterstep(swidth - half + wob, sb)) * (filterstep(half + wob, tb) - filterstep(twidth - half + wob, tb));

    /* The face of a brick: rough, with a few pits. */
    float rough = noise(s * 90, t * 90) * .6 + noise(s * 220, t * 220) * .4;
    float height = inside * (.8 + .2 * rough) - .3 * inside * smoothstep(.72, .8, noise(s * 60 + 5, t * 60)) + .25 * (1 - inside) * rough;
    normal Nn = normalize(N);
    normal bumped = calculatenormal(P + depth * height * Nn);
    normal Nf = faceforward(normalize(bumped + normalize(N) - normalize(Ng)), I);

    color tint = brickcolor * (1 + variation * (float cellnoise(column, row) - .5));
    tint = mix(tint, tint * color(.6, .5, .55), smoothstep(.6, .95, cellnoise(row + .5, column + 77)));
    color C = mix(mortarcolor * (.85 + .3 * rough), tint * (.75 + .5 * rough), inside);
    Oi = Os;
    Ci = Os * Cs * C * (Ka * ambient() + Kd * diffuse(Nf));
}
