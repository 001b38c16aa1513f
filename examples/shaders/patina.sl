/* patina: old bronze. occlusion() finds the hollows, where verdigris keeps; rays that gather() sends into the metal and that soon leave it find
   the edges, which hands have worn bright; a third gather() brings the light: of the sky where its rays miss, and what the things that
   they meet show. Things that rays meet are not asked to gather again: they are lit by the sky as far as it stands over them.
     metal, verdigris    colours of the worn edges and of the hollows; between them the colour is Cs
     reach               how far hollows and edges reach, in the space of the shader
     samples             rays of each of the three
     zenith, horizon     colours of the sky */
surface patina(color metal = color(.95, .62, .28), verdigris = color(.16, .5, .42); float reach = .25, samples = 64; color zenith = color(.45, .62, 1),
               horizon = color(1, .86, .7);)
{
    normal Nf = faceforward(normalize(N), I);
    vector up = normalize(vtransform("world", "current", vector(0, 1, 0)));
    float far = reach * length(vtransform("shader", "current", vector(1, 0, 0)));
    color light = 0, seen = 0, paint = Cs;
    uniform float depth = 0;
    rayinfo("depth", depth);
    if (depth == 0) {
        float hollow = occlusion(P, Nf, samples, "maxdist", far), worn = 0;
        vector way = 0;
        gather("", P, -Nf, 1.2, samples, "maxdist", far, "hitsides", "both") worn += 1 / samples;
        paint = mix(paint, verdigris, smoothstep(.25, .65, hollow));
        paint = mix(paint, metal, smoothstep(.3, .75, worn));
        gather("illuminance", P, Nf, PI / 2, samples, "distribution", "cosine", "surface:Ci", seen, "ray:direction", way)
            light += seen / samples;
        else
            light += mix(horizon, zenith, max(0, up . way)) / samples;
        seen = trace(P, reflect(normalize(I), Nf)) * .25 * smoothstep(.3, .75, worn) * metal;
    } else {
        light = mix(horizon, zenith, .5) * (.5 + .5 * (up . Nf));
    }
    Oi = Os;
    Ci = Os * (paint * light + seen);
}
