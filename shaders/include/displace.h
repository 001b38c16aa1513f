/* Moving the surface, or only the way it seems to be turned. */
#ifndef DISPLACE_H
#define DISPLACE_H
/* Moves P by amp along dir, both in `space`; gives the new normal. truedisp 1 moves, 0 only turns, in between mixes. */
normal Displace(vector dir; string space; float amp; float truedisp)
{
    extern point P;
    extern normal N, Ng;
    float k = 1 / length(vtransform(space, dir));
    point moved = P + dir * (amp * k);
    normal bent = normalize(calculatenormal(moved)) + (normalize(N) - normalize(Ng));
    P = mix(P, moved, truedisp);
    return normalize(bent);
}
normal Displace(vector dir; string space; float amp) { return Displace(dir, space, amp, 1); }
#endif
