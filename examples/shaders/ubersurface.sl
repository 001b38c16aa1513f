/* ubersurface: one surface with the layers that a look is built of, from the bottom up:
     Pattern     where everything is looked up: st, a turn and repeats; or a solid space; warped by noise if wanted
     Bump        octaves of noise or a picture, added to the shading normal by its height
     Base        colour times a picture, mottled and veined by noise, dirt in what faces up
     Paint       a second colour over the base through a mask: a picture, noise, or the height of the bump
     Diffuse     wrapped and with a terminator colour, translucency from behind
     Sheen       light at grazing angles, as of velvet and dust
     Metal       mixes from a dielectric to a metal: the highlight takes the colour of the base
     Highlights  two, broad and narrow, each a specular() lobe
     Iridescence a thin film on top that colours what is reflected by its thickness and the angle
     Reflection  a traced ray or an environment picture, by Fresnel
     Glass       refraction with a colour by the length of the way
     Rim         an outline of light for presentation
     Glow        a picture or noise that gives light of its own
     Outputs     every layer by itself, for compositing
   What is zero costs nothing to speak of. Everything is affine in what lights and rays bring, so it is path-traced as it is. 
   Ball: Surface "ubersurface" "float paint" 1 "float paintchips" .6 "float bump" .02 "float Kd" .6 "float Ks" .15 "float Kscoat" .15 "float iridescence" .3 "float mottle" .5 */

#define TINY 1e-5

/* Octaves of signed noise in [-1, 1], more or less. */
float turbid(point where; float octaves, gain, lacunarity, ridged)
{
    float sum = 0, weight = 1, k;
    point p = where;
    for (k = 0; k < octaves; k += 1) {
        float n = 2 * float noise(p) - 1;
        sum += weight * mix(n, 1 - 2 * abs(n), ridged);
        weight *= gain;
        p = p * lacunarity + vector(17.3, 5.1, 11.7);
    }
    return sum;
}

/* Thin lines where noise changes its sign. */
float veining(point where; float sharpness)
{
    float n = abs(2 * float noise(where) - 1);
    return pow(clamp(1 - n, 0, 1), max(sharpness, 1));
}

/* Schlick's Fresnel term between normal and grazing. */
float grazing(float cosine, facing, power)
{
    return facing + (1 - facing) * pow(clamp(1 - abs(cosine), 0, 1), power);
}

/* Colour of a thin film: three wavelengths, the phase of the way through the film at this angle. */
color film(float cosine, thickness, index)
{
    float inside = sqrt(max(1 - (1 - cosine * cosine) / max(index * index, TINY), 0));
    float way = 2 * index * thickness * inside;
    color wave = color(650, 532, 450);
    float r = 0.5 + 0.5 * cos(2 * PI * way / comp(wave, 0) + PI);
    float g = 0.5 + 0.5 * cos(2 * PI * way / comp(wave, 1) + PI);
    float b = 0.5 + 0.5 * cos(2 * PI * way / comp(wave, 2) + PI);
    return color(r, g, b);
}

/* A coverage between 0 and 1 with a threshold and a soft edge no narrower than a pixel. */
float coverage(float x, threshold, softness)
{
    float w = max(softness, abs(Du(x) * du) + abs(Dv(x) * dv));
    return smoothstep(threshold - w, threshold + w, x);
}

surface ubersurface(
    /* pattern */
    float repeats = 1, repeatt = 1, turn = 0;
    float offsets = 0, offsett = 0;
    string patternspace = "shader";
    float patternscale = 1;
    float warp = 0, warpscale = 2;
    /* bump */
    float bump = 0, bumpscale = 8, bumpoctaves = 3;
    float bumpgain = 0.5, bumplacunarity = 2.1, bumpridged = 0;
    string bumpname = "";
    float bumpnameheight = 0;
    /* base */
    color basecolor = color(0.6, 0.6, 0.6);
    string basename = "";
    float basenameamount = 1;
    float mottle = 0, mottlescale = 3;
    color mottlecolor = color(0.3, 0.2, 0.1);
    float veins = 0, veinscale = 2, veinsharpness = 12;
    color veincolor = color(0.1, 0.1, 0.12);
    float dirt = 0, dirtscale = 5;
    color dirtcolor = color(0.2, 0.17, 0.13);
    vector dirtup = vector(0, 1, 0);
    /* paint */
    float paint = 0;
    color paintcolor = color(0.7, 0.1, 0.05);
    string paintname = "";
    float paintscale = 2, paintthreshold = 0.5, paintsoftness = 0.02;
    float paintchips = 0;
    float paintgloss = 1;
    /* diffuse */
    float Ka = 1, Kd = 0.8;
    float wrap = 0;
    color terminator = color(1, 1, 1);
    float translucence = 0;
    color translucentcolor = color(1, 0.8, 0.6);
    /* sheen */
    float sheen = 0, sheenpower = 4;
    color sheencolor = color(1, 1, 1);
    /* metal and highlights */
    float metal = 0;
    float Ks = 0.3, roughness = 0.15;
    color specularcolor = color(1, 1, 1);
    float Kscoat = 0, coatroughness = 0.03;
    color coatcolor = color(1, 1, 1);
    float specularmottle = 0;
    /* iridescence */
    float iridescence = 0;
    float filmthickness = 380, filmvariation = 60, filmscale = 3, filmindex = 1.4;
    /* reflection */
    float Kr = 0;
    float reflectionfacing = 0.04, reflectionpower = 5;
    float reflectionspread = 0;
    string reflectionname = "";
    color reflectioncolor = color(1, 1, 1);
    /* glass */
    float Kt = 0;
    float eta = 1.5;
    color glasscolor = color(1, 1, 1);
    float glassdepth = 1;
    /* rim */
    float rim = 0, rimpower = 3;
    color rimcolor = color(1, 1, 1);
    vector rimfrom = vector(0, 1, 0);
    /* glow */
    float glow = 0;
    color glowcolor = color(1, 0.6, 0.2);
    string glowname = "";
    float glownoise = 0, glowscale = 3;
    /* opacity */
    string opacityname = "";
    float edgeopacity = 1;
    /* the layers */
    output varying color layerbase = 0;
    output varying color layerdiffuse = 0;
    output varying color layerspecular = 0;
    output varying color layerreflection = 0;
    output varying color layerrefraction = 0;
    output varying color layerrim = 0;
    output varying color layerglow = 0;
    output varying float layerheight = 0;
    output varying float layermask = 0;)
{
    color white = color(1, 1, 1);

    /* ---- pattern: flat coordinates and a solid one */
    float cosine = cos(turn), sine = sin(turn);
    float ss = repeats * (cosine * (s - 0.5) - sine * (t - 0.5)) + 0.5 + offsets;
    float tt = repeatt * (sine * (s - 0.5) + cosine * (t - 0.5)) + 0.5 + offsett;
    point solid = patternscale * transform(patternspace, P);
    if (warp != 0) {
        vector push = 2 * vector noise(solid * warpscale) - vector(1, 1, 1);
        solid += warp * push;
        ss += 0.1 * warp * xcomp(push);
        tt += 0.1 * warp * ycomp(push);
    }

    /* ---- bump */
    normal Ngeometric = normalize(N);
    normal Nn = Ngeometric;
    float height = 0;
    if (bump != 0)
        height += bump * turbid(solid * bumpscale, bumpoctaves, bumpgain, bumplacunarity, bumpridged) / bumpscale;
    if (bumpname != "")
        height += bumpnameheight * float texture(bumpname, ss, tt);
    if (bump != 0 || bumpname != "")
        Nn = normalize(calculatenormal(P + height * Ngeometric));
    vector In = normalize(I);
    normal Nf = faceforward(Nn, In);
    vector V = -In;
    float facing = V . Nf;
    layerheight = height;

    /* ---- base */
    color base = basecolor * Cs;
    if (basename != "")
        base *= mix(white, color texture(basename, ss, tt), basenameamount);
    if (mottle > 0) {
        float m = 0.5 + 0.5 * turbid(solid * mottlescale, 3, 0.6, 2.3, 0);
        base = mix(base, mottlecolor, mottle * smoothstep(0.4, 0.8, m));
    }
    if (veins > 0) {
        point bent = solid * veinscale + 0.4 * (vector noise(solid * veinscale * 1.7) - vector(0.5, 0.5, 0.5));
        base = mix(base, veincolor, veins * veining(bent, veinsharpness));
    }
    float soil = 0;
    if (dirt > 0) {
        float up = 0.5 + 0.5 * (normalize(dirtup) . Nn);
        float patch = 0.5 + 0.5 * turbid(solid * dirtscale, 2, 0.5, 2.7, 0);
        soil = dirt * smoothstep(0.3, 0.9, up * (0.5 + patch));
        base = mix(base, dirtcolor, soil);
    }

    /* ---- paint */
    float painted = 0;
    if (paint > 0) {
        float mask = float noise(solid * paintscale);
        if (paintname != "")
            mask = float texture(paintname, ss, tt);
        painted = paint * coverage(mask, paintthreshold, paintsoftness);
        if (paintchips > 0) {
            float chip = float noise(solid * paintscale * 9) + paintchips * clamp(height * bumpscale, -1, 1);
            painted *= 1 - coverage(chip, 0.75, 0.02);
        }
        base = mix(base, paintcolor, painted);
    }
    layerbase = base;
    layermask = painted;

    /* ---- what metal does to the rest */
    float nonmetal = (1 - metal) * (1 - soil) + soil;
    color tint = mix(specularcolor, base, metal);
    float shine = mix(1, paintgloss, painted) * (1 - 0.8 * soil);
    if (specularmottle > 0)
        shine *= 1 - specularmottle * float noise(solid * 7);

    /* ---- diffuse */
    color body = base * nonmetal * (1 - Kt);
    layerdiffuse = body * (Ka * ambient() + Kd * diffuse(Nf));
    if (wrap > 0) {
        /* the part beyond the terminator: a wider cosine less the one that diffuse() has */
        color wrapped = 0;
        illuminance(P, Nf, PI) {
            float c = normalize(L) . Nf;
            float wide = max((c + wrap) / (1 + wrap), 0) - max(c, 0);
            wrapped += Cl * max(wide, 0);
        }
        layerdiffuse += body * terminator * Kd * wrap * wrapped;
    }
    if (translucence > 0)
        layerdiffuse += body * translucentcolor * translucence * diffuse(-Nf);
    if (sheen > 0) {
        color brushed = sheen * sheencolor * pow(clamp(1 - facing, 0, 1), sheenpower);
        layerdiffuse += nonmetal * brushed * diffuse(Nf);
    }

    /* ---- the film colours all that is reflected */
    color filmtint = white;
    if (iridescence > 0) {
        float thickness = filmthickness + filmvariation * turbid(solid * filmscale, 2, 0.5, 2, 0);
        filmtint = mix(white, 2 * film(facing, thickness, filmindex), iridescence);
    }

    /* ---- highlights */
    layerspecular = 0;
    if (Ks > 0)
        layerspecular += Ks * shine * tint * filmtint * specular(Nf, V, max(roughness * (1 + soil), 0.001));
    if (Kscoat > 0)
        layerspecular += Kscoat * (1 - soil) * coatcolor * filmtint * specular(Nf, V, max(coatroughness, 0.001));

    /* ---- reflection */
    if (Kr > 0) {
        float f = mix(grazing(facing, reflectionfacing, reflectionpower), 1, metal);
        vector R = normalize(reflect(In, Nf));
        color mirrored = 0;
        if (reflectionname != "")
            mirrored = color environment(reflectionname, vtransform("world", R), "blur", reflectionspread);
        else
            mirrored = trace(P, R, "samplecone", reflectionspread);
        layerreflection = Kr * shine * f * reflectioncolor * tint * filmtint * mirrored;
    }

    /* ---- glass */
    if (Kt > 0) {
        float inside = (In . Ngeometric > 0) ? 1 : 0;
        float ratio = (inside == 1) ? eta : 1 / eta;
        float kr, kt;
        vector R, T;
        fresnel(In, Nf, ratio, kr, kt, R, T);
        float through = clamp(1 - kr, 0, 1);
        float way = glassdepth / max(abs(facing), 0.1);
        color absorbed = color(pow(max(comp(glasscolor, 0), TINY), way), pow(max(comp(glasscolor, 1), TINY), way),
                               pow(max(comp(glasscolor, 2), TINY), way));
        layerrefraction = Kt * through * absorbed * trace(P, normalize(T)) + Kt * kr * filmtint * trace(P, normalize(R));
    }

    /* ---- rim */
    if (rim > 0) {
        float outline = pow(clamp(1 - facing, 0, 1), rimpower);
        float side = 0.5 + 0.5 * (normalize(rimfrom) . Nf);
        layerrim = rim * rimcolor * outline * side;
    }

    /* ---- glow */
    if (glow > 0) {
        color own = glowcolor;
        if (glowname != "")
            own *= color texture(glowname, ss, tt);
        if (glownoise > 0)
            own *= mix(1, pow(clamp(0.5 + 0.5 * turbid(solid * glowscale, 3, 0.5, 2.2, 1), 0, 1), 3), glownoise);
        layerglow = glow * own;
    }

    /* ---- opacity */
    color solidness = Os;
    if (opacityname != "")
        solidness *= float texture(opacityname, ss, tt);
    if (edgeopacity != 1)
        solidness *= mix(edgeopacity, 1, clamp(facing, 0, 1));

    Oi = solidness;
    Ci = Oi * (layerdiffuse + layerspecular + layerreflection + layerrefraction + layerrim + layerglow);
}
