// The nearest and the second nearest of points scattered one to a cell, over 27 cells.
surface cells(float scale = 10;)
{
    point where = scale * point(u, v, 0.33);
    point home = point(floor(xcomp(where)), floor(ycomp(where)), floor(zcomp(where)));
    float nearest = 100, second = 100, x, y, z;
    for (z = -1; z <= 1; z += 1)
        for (y = -1; y <= 1; y += 1)
            for (x = -1; x <= 1; x += 1) {
                point corner = home + vector(x, y, z);
                vector away = corner + vector cellnoise(corner + 0.5) - where;
                float squared = away . away;
                if (squared < nearest) {
                    second = nearest;
                    nearest = squared;
                } else if (squared < second)
                    second = squared;
            }
    float edge = sqrt(second) - sqrt(nearest);
    Ci = color(sqrt(nearest), smoothstep(0.01, 0.1, edge), edge);
    Oi = 1;
}
