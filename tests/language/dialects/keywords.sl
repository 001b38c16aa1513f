/* names that became keywords or shadeops later */
surface keywordish(float gather = .5; color light = 1; string shader = "x"; float class = 2, public = 1;)
{
    vector incident = normalize(I);
    normal opposite = -N;
    float bake = 1, occlusion = .2, struct = 3, null = 0, subsurface = 1;
    color imager = Cs, transmission = 1, photonmap = 0;
    float visibility = 1, trace = 1, displace = 0, volume = 1, surface = 1;
    point displacement = P;
    float resize = 1, push = 2, match = 3;
    if (shader == "x") imager *= class;
    displacement += incident * bake;
    Ci = light * gather * imager * transmission + photonmap + null * xcomp(opposite) * occlusion;
    Ci *= public * struct * subsurface * visibility * trace * volume * surface * (1 - displace) * length(displacement);
    Ci += resize * push * match;
    Oi = Os;
}
