/* uberlight: one light with everything that a lighting desk asks for. Each effect is off by default; what is off costs nothing.
     Type          "spot" (a cone of any superelliptic section), "omni" (all around), "beam" (its section does not grow)
     Section       the lit window: width and height of the full light, width and height of the soft edge around it, roundness
                   (1 ellipse, 0 rectangle), shear of the window
     Depth         where along the axis the light begins and ends, with soft ramps
     Falloff       none, or a power of the distance that is 1 at a reference distance and never beyond a maximum
     Slide         a picture projected through the window, with its own place, size and blur
     Gobo          moving noise in the beam: clouds, leaves, water
     Blockers      up to three cards in the beam: superellipses in any plane, lit through by their own colour
     Shadow        "none", "raytrace"; its colour, its density, its bias, and how fast it fades with distance
     Contribution  to diffuse and specular reflection separately, a group name for the surface to pick by
   Everything is measured in "shader" space: the light stands at the origin and looks along +z. 
   Lamp: LightSource "uberlight" 1 "float intensity" 40 "float width" .16 "float height" .11 "float roundness" .3 "float goboamount" .7 "float goboscale" 30 "float edgewidth" .01 "float edgeheight" .01 */

#define MINIMUM 1e-6
#define BLOCKERS 3

/* 0 inside the small, 1 outside the large of two superellipses around the origin, smooth between. roundness 1 is an ellipse, 0 a
   rectangle. */
float superellipse(float x, y, width, height, edgewidth, edgeheight, roundness)
{
    float px = abs(x), py = abs(y), result;
    if (roundness < MINIMUM) {
        float outsidex = smoothstep(width, width + max(edgewidth, MINIMUM), px);
        float outsidey = smoothstep(height, height + max(edgeheight, MINIMUM), py);
        result = 1 - (1 - outsidex) * (1 - outsidey);
    } else {
        float power = 2 / roundness;
        float small = pow(pow(px / max(width, MINIMUM), power) + pow(py / max(height, MINIMUM), power), -1 / power);
        float wide = max(width + edgewidth, MINIMUM), high = max(height + edgeheight, MINIMUM);
        float large = pow(pow(px / wide, power) + pow(py / high, power), -1 / power);
        /* small and large are where the ray from the centre crosses the two curves, in units of this point's distance */
        result = (large - small < MINIMUM) ? step(small, 1) : smoothstep(small, large, 1);
    }
    return result;
}

/* How much of the beam passes at a depth: ramps up from `start`, down from `end`. */
float depthwindow(float z, start, end, startedge, endedge)
{
    float on = smoothstep(start - startedge, start + MINIMUM, z);
    float off = 1 - smoothstep(end, end + endedge + MINIMUM, z);
    return on * off;
}

/* A power of the distance, 1 at the reference distance, rolled off smoothly below it so that it never exceeds the maximum. */
float distancefalloff(float d, reference, exponent, maximum)
{
    float result = 1;
    if (exponent != 0) {
        float x = max(d, MINIMUM) / max(reference, MINIMUM);
        if (x > 1) {
            result = pow(x, -exponent);
        } else {
            float top = log(max(maximum, 1 + MINIMUM));
            float slope = exponent / top;
            result = exp(top * (1 - pow(x, slope)));
        }
    }
    return result;
}

/* Octaves of noise in [0, 1] with a contrast curve. */
float clouding(point where; float octaves, gain, lacunarity, contrast)
{
    float sum = 0, weight = 1, whole = 0, k;
    point p = where;
    for (k = 0; k < octaves; k += 1) {
        sum += weight * float noise(p);
        whole += weight;
        weight *= gain;
        p *= lacunarity;
    }
    float x = sum / max(whole, MINIMUM);
    return smoothstep(0.5 - 0.5 / max(contrast, MINIMUM), 0.5 + 0.5 / max(contrast, MINIMUM), x);
}

/* Where the line from the light through p meets the plane of a blocker, in the blocker's own x and y; false behind the light or
   behind p. */
float meetsblocker(point p; point centre; float turn, tilt; output float x, y)
{
    float answer = 0;
    vector across = vector(cos(turn) * cos(tilt), sin(turn), -cos(turn) * sin(tilt));
    vector up = vector(-sin(turn) * cos(tilt), cos(turn), sin(turn) * sin(tilt));
    vector facing = across ^ up;
    vector way = p - point(0, 0, 0);
    float slope = facing . way;
    x = 0;
    y = 0;
    if (abs(slope) > MINIMUM) {
        float t = (facing . vector(centre)) / slope;
        if (t > 0 && t < 1) {
            vector hit = t * way - vector(centre);
            x = hit . across;
            y = hit . up;
            answer = 1;
        }
    }
    return answer;
}

light uberlight(
    /* what comes out */
    float intensity = 1;
    color lightcolor = color(1, 1, 1);
    string lighttype = "spot";
    /* the window, at distance 1 from a spot, anywhere along a beam */
    float width = 0.5, height = 0.5;
    float edgewidth = 0.05, edgeheight = 0.05;
    float roundness = 1;
    float shearx = 0, sheary = 0;
    /* depth */
    float cuton = 0.01, cutoff = 1e6;
    float cutonedge = 0, cutoffedge = 0;
    /* falloff with the distance, and towards the rim */
    float falloff = 2;
    float falloffdistance = 1;
    float falloffmaximum = 4;
    float beamdistribution = 0;
    /* slide */
    string slidename = "";
    float slideamount = 1;
    float slidex = 0, slidey = 0;
    float slidewidth = 1, slideheight = 1;
    float slideblur = 0;
    color slidetint = color(1, 1, 1);
    /* gobo */
    float goboamount = 0;
    float goboscale = 4;
    float gobooctaves = 3;
    float gobocontrast = 1.5;
    float gobogain = 0.5;
    float gobolacunarity = 2.1;
    vector gobodrift = vector(0, 0, 0);
    color gobocolor = color(0, 0, 0);
    /* blockers: places, sizes, turns about z and y, soft edges, roundness, density and colour */
    float blockers = 0;
    point blockerplace[3] = {point(0, 0, 1), point(0.3, 0, 1.5), point(-0.3, 0, 2)};
    float blockerwidth[3] = {0.2, 0.2, 0.2};
    float blockerheight[3] = {0.2, 0.2, 0.2};
    float blockerturn[3] = {0, 0, 0};
    float blockertilt[3] = {0, 0, 0};
    float blockeredge[3] = {0.02, 0.02, 0.02};
    float blockerroundness[3] = {1, 0.5, 0};
    float blockerdensity[3] = {1, 1, 1};
    color blockercolor[3] = {color(0, 0, 0), color(0, 0, 0), color(0, 0, 0)};
    /* shadow */
    string shadowtype = "none";
    color shadowcolor = color(0, 0, 0);
    float shadowdensity = 1;
    float shadowfade = 0;
    float shadowfadedistance = 10;
    /* colour by distance: a warm source turns to the colour of the air */
    float airamount = 0;
    float airdistance = 20;
    color aircolor = color(0.6, 0.7, 0.9);
    /* contribution */
    string __category = "";
    output varying float __nondiffuse = 0;
    output varying float __nonspecular = 0;)
{
    uniform point from = point "shader" (0, 0, 0);
    uniform float omni = (lighttype == "omni") ? 1 : 0;
    uniform float beam = (lighttype == "beam") ? 1 : 0;

    illuminate(from) {
        /* The lit point in the light's own space. */
        point Pl = transform("shader", Ps);
        float far = length(vector(Pl));
        float z = zcomp(Pl);
        float amount = 1;
        color tint = lightcolor;

        /* Section. A spot's window grows with the distance, a beam's does not. */
        if (omni == 0) {
            float spread = (beam == 1) ? 1 : max(z, MINIMUM);
            float x = (xcomp(Pl) - shearx * z) / spread;
            float y = (ycomp(Pl) - sheary * z) / spread;
            if (z <= 0) {
                amount = 0;
            } else {
                amount *= 1 - superellipse(x, y, width, height, edgewidth, edgeheight, roundness);
                if (beamdistribution != 0)
                    amount *= pow(max(z / max(far, MINIMUM), 0), beamdistribution);
            }
            /* Slide: (0,0)-(1,1) over the window. */
            if (slidename != "" && slideamount > 0) {
                float sx = 0.5 + 0.5 * (x - slidex) / max(slidewidth * (width + edgewidth), MINIMUM);
                float sy = 0.5 - 0.5 * (y - slidey) / max(slideheight * (height + edgeheight), MINIMUM);
                color picture = slidetint * color texture(slidename, sx, sy, "blur", slideblur);
                tint *= mix(color(1, 1, 1), picture, slideamount);
            }
            amount *= depthwindow(z, cuton, cutoff, cutonedge, cutoffedge);
        } else {
            amount *= depthwindow(far, cuton, cutoff, cutonedge, cutoffedge);
        }

        /* Falloff. */
        amount *= distancefalloff((beam == 1) ? z : far, falloffdistance, falloff, falloffmaximum);

        /* Gobo: noise over directions, drifting with time. */
        if (goboamount > 0) {
            point where;
            if (beam == 1)
                where = point(xcomp(Pl), ycomp(Pl), 0);
            else
                where = point(normalize(vector(Pl)));
            where = goboscale * where + time * gobodrift;
            float pattern = clouding(where, gobooctaves, gobogain, gobolacunarity, gobocontrast);
            tint *= mix(color(1, 1, 1), mix(gobocolor, color(1, 1, 1), pattern), goboamount);
        }

        /* Blockers. */
        uniform float k;
        for (k = 0; k < min(blockers, BLOCKERS); k += 1) {
            float bx, by;
            if (meetsblocker(Pl, blockerplace[k], blockerturn[k], blockertilt[k], bx, by) == 1) {
                float covered = 1 - superellipse(bx, by, blockerwidth[k], blockerheight[k], blockeredge[k], blockeredge[k],
                                                 blockerroundness[k]);
                tint *= mix(color(1, 1, 1), blockercolor[k], blockerdensity[k] * covered);
            }
        }

        /* Air. */
        if (airamount > 0) {
            float thick = 1 - exp(-far / max(airdistance, MINIMUM));
            tint = mix(tint, aircolor * luminance(tint), airamount * thick);
        }

        /* Shadow. */
        if (shadowtype == "raytrace") {
            color through = transmission(Ps, from);
            float density = shadowdensity;
            if (shadowfade > 0)
                density *= mix(1, exp(-far / max(shadowfadedistance, MINIMUM)), shadowfade);
            tint *= mix(color(1, 1, 1), mix(shadowcolor, color(1, 1, 1), through), density);
        }

        Cl = intensity * amount * tint;
    }
}
