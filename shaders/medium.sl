/* medium: fog, smoke, milk: what fills the inside of a closed surface, the same everywhere. For Interior, or Exterior.
     absorption, scattering: coefficients, a unit of length; scale multiplies both, and emission
     anisotropy: mean cosine of scattering (Henyey and Greenstein): 1 forward, 0 evenly, -1 back
     emission: radiance that a unit of length adds
     priority: where insides overlap the highest counts, and boundaries of the others are not there
   Under Hider "path" light is scattered in it; elsewhere it takes what would be absorbed or scattered away, and nothing comes back.
   The renderer knows a medium by the outputs: any volume shader that has them is one.
   Ball: AttributeBegin Surface "null" Interior "medium" "color scattering" [.3 .5 .8] Sphere 1.5 -1.5 1.5 360 AttributeEnd */
volume medium(color absorption = 0, scattering = .1, emission = 0; float anisotropy = 0, scale = 1, priority = 0;
              output color __absorption = 0, __scattering = 0, __emission = 0; output float __anisotropy = 0, __priority = 0;) {
    __absorption = absorption * scale;
    __scattering = scattering * scale;
    __emission = emission * scale;
    __anisotropy = anisotropy;
    __priority = priority;
    color extinction = __absorption + __scattering;
    float way = length(I), k;
    color left = 1, glow = 0;
    for (k = 0; k < 3; k += 1) {
        float x = comp(extinction, k) * way;
        setcomp(left, k, exp(-x));
        setcomp(glow, k, comp(__emission, k) * way * ((x < .0001) ? 1 - x / 2 : (1 - exp(-x)) / x));
    }
    Ci = Ci * left + glow;
    Oi = 1 - (1 - Oi) * left;
}
