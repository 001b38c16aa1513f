/* A wall of bricks as shaders of the 1990s made them: the joints are cut by smoothsteps, the grain is noise finer than a pixel. */
displacement bricks(float width = 0.25, height = 0.08, joint = 0.012, depth = 0.012, grain = 0.004, fine = 400)
{
    point p = transform("shader", P);
    float across = s * 4 / width / 4, up = t / height;
    float row = floor(up), bx, by, w = joint / width, h = joint / height, solid;
    if (mod(row, 2) > 0.5) across += 0.5;
    bx = across - floor(across);
    by = up - row;
    solid = smoothstep(w / 2, w, bx) * (1 - smoothstep(1 - w, 1 - w / 2, bx)) * smoothstep(h / 2, h, by) * (1 - smoothstep(1 - h, 1 - h / 2, by));
    P += normalize(N) * (depth * solid + grain * (noise(p * fine) - 0.5));
    N = calculatenormal(P);
}
