/* What lights of RIS have in common: radiance, temperature, focus and cone. From the published manual of PRMan's lights. */
#ifndef RISLIGHT_H
#define RISLIGHT_H

/* The colour of a black body at so many kelvins, of luminance 1, relative to that at 6500: Planck's law at the wavelengths of the
   Rec. 709 primaries' peaks would miss the matching functions, so chromaticity by Kim et al. (2002), US patent 7024034: piecewise cubic in 1/T. */
color risBlackbody(float kelvins;) {
    float T = clamp(kelvins, 1667, 25000), i = 1000 / T, x, y;
    if (T < 4000)
        x = ((-0.2661239 * i - 0.2343589) * i + 0.8776956) * i + 0.179910;
    else
        x = ((-3.0258469 * i + 2.1070379) * i + 0.2226347) * i + 0.240390;
    if (T < 2222)
        y = ((-1.1063814 * x - 1.34811020) * x + 2.18555832) * x - 0.20219683;
    else if (T < 4000)
        y = ((-0.9549476 * x - 1.37418593) * x + 2.09137015) * x - 0.16748867;
    else
        y = ((3.0817580 * x - 5.87338670) * x + 3.75112997) * x - 0.37001483;
    float X = x / y, Z = (1 - x - y) / y;
    return color(max(0, 3.2404542 * X - 1.5371385 - 0.4985314 * Z), max(0, -0.9692660 * X + 1.8760108 + 0.0415560 * Z),
                 max(0, 0.0556434 * X - 0.2040259 + 1.0572252 * Z));
}

/* Radiance of a light: colour * intensity * 2^exposure, tinted by its temperature where that is on. */
color risRadiance(float intensity, exposure; color lightColor; float enableTemperature, temperature;) {
    color c = intensity * pow(2, exposure) * lightColor;
    if (enableTemperature != 0)
        c *= risBlackbody(temperature) / risBlackbody(6500);
    return c;
}

/* 1 where a map is named and can be read: light with a map that is missing shines as if it had none. */
float risMap(string map;) {
    uniform float there = 0;
    if (map != "") there = textureinfo(map, "exists", 0);
    return there;
}
/* What a map holds, with saturation and gamma applied. */
color risMapped(color seen, gammas; float saturation;) {
    color c = mix(color(.2126 * comp(seen, 0) + .7152 * comp(seen, 1) + .0722 * comp(seen, 2)), seen, color(saturation));
    return color(pow(max(0, comp(c, 0)), 1 / comp(gammas, 0)), pow(max(0, comp(c, 1)), 1 / comp(gammas, 1)), pow(max(0, comp(c, 2)), 1 / comp(gammas, 2)));
}
/* A direction in the space of a dome as environment() takes it: the map's left edge is +x, a quarter from it -y (as hdPrman of OpenUSD,
   light.cpp, turns domes to the layout of OpenEXR). */
vector risLatLong(vector w;) { return vector(xcomp(w), -ycomp(w), zcomp(w)); }

/* What every light has: filters and a profile as the renderer gives them (src/ri/lightfilters.h). Photometry is that of iesProfile, 1 where it
   is brightest; iesProfileScale s stretches its angles from the axis by 1 + s. */
#define RIS_SHAPED uniform float lightFilters[] = {}; string lightFilterMaps[] = {}, lightFilterLinks[] = {}; \
    float enableShadows = 1; string iesProfile = ""; uniform float lightProfile[] = {}; float iesProfileScale = 0

/* Where x lies among n angles from at on, with wrong ends held: the index below, and how far it is to the next. */
float risAmong(uniform float a[]; uniform float at, n; float x; output float part;) {
    float low = 0;
    uniform float i;
    part = 0;
    for (i = 1; i < n; i += 1)
        if (x >= a[at + i - 1]) {
            low = i - 1;
            part = clamp((x - a[at + i - 1]) / (a[at + i] - a[at + i - 1]), 0, 1);
        }
    return low;
}
/* What a profile sends along w, a direction in the light's space, whose axis is +z: that of LM-63 is the axis straight down. */
float risProfile(uniform float p[]; float scale; vector w;) {
    float answer = 1;
    if (arraylength(p) > 2) {
        uniform float across = p[0], around = p[1], last = p[2 + across + around - 1], first = 2 + across + around;
        vector d = normalize(w);
        float theta = degrees(acos(clamp(zcomp(d), -1, 1))) / max(1 + scale, 1e-3), phi = mod(degrees(atan(ycomp(d), xcomp(d))), 360);
        if (last <= 90.001) phi = (phi > 180) ? 360 - phi : phi;
        if (last <= 90.001) phi = (phi > 90) ? 180 - phi : phi;
        else if (last <= 180.001) phi = (phi > 180) ? 360 - phi : phi;
        float kt, kp, t, f;
        t = risAmong(p, 2, across, theta, kt);
        f = risAmong(p, 2 + across, around, phi, kp);
        float g = min(f + 1, around - 1), u = min(t + 1, across - 1);
        answer = mix(mix(p[first + f * across + t], p[first + f * across + u], kt), mix(p[first + g * across + t], p[first + g * across + u], kt), kp);
        if (theta < p[2] - 1e-3 || theta > p[1 + across] + 1e-3) answer = 0;
    }
    return answer;
}

/* Filters (docs/ris.md, "Light filters"). */
/* 1 inside of a box with rounded corners, falling to 0 over edge: half sizes h about c. */
float risRounded(vector q, h; float radius, edge;) {
    float r = min(radius, xcomp(h), min(ycomp(h), zcomp(h)));
    vector o = vector(max(abs(xcomp(q)) - xcomp(h) + r, 0), max(abs(ycomp(q)) - ycomp(h) + r, 0), max(abs(zcomp(q)) - zcomp(h) + r, 0));
    float d = length(o) - r;
    return (edge > 0) ? 1 - smoothstep(0, edge, d) : ((d <= 0) ? 1 : 0);
}
/* Where the way from a to b, in the filter's space, meets its plane z = 0: 0 where it does not. mode 1: as it is projected along z, or from
   the apex behind it. */
float risCrossing(uniform float f[]; uniform float at; point a, b; output float x, y;) {
    float crosses = 1;
    vector d = b - a;
    if (f[at + 34] == 1) {
        float z = zcomp(b), k = (f[at + 35] == 1) ? 1 : f[at + 38] / max(f[at + 38] + z, 1e-6);
        x = (xcomp(b) - f[at + 36] * z) * k;
        y = (ycomp(b) - f[at + 37] * z) * k;
        crosses = (z > 0) ? 1 : 0;
    } else {
        float k = (zcomp(d) == 0) ? 0 : -zcomp(a) / zcomp(d);
        x = xcomp(a) + k * xcomp(d);
        y = ycomp(a) + k * ycomp(d);
        crosses = (zcomp(a) * zcomp(b) < 0) ? 1 : 0;
    }
    return crosses;
}
/* How much of the effect holds at b, lit from a; tint: by which colour. */
float risFilter(uniform float f[]; uniform float at; string map; point a, b; output color tint;) {
    float v = 1, x, y;
    uniform float kind = f[at];
    tint = color(1);
    if (kind == 2 || kind == 3) {
        float crosses = risCrossing(f, at, a, b, x, y);
        if (kind == 2) {
            float left = f[at + 23] / 2 + f[at + 28], right = f[at + 23] / 2 + f[at + 29], low = f[at + 24] / 2 + f[at + 30],
                  high = f[at + 24] / 2 + f[at + 31];
            vector q = vector(x - (right - left) / 2, y - (high - low) / 2, 0);
            float open = risRounded(q, vector((left + right) / 2, (low + high) / 2, 1e9), f[at + 26], f[at + 27]);
            if (crosses == 0 && f[at + 39] != 1) open = (f[at + 39] == 2) ? 0 : 1;
            tint = color(open);
        } else {
            float s = x / max(f[at + 23], 1e-6), t = -y / max(f[at + 24], 1e-6);
            if (f[at + 40] == 1) s = -s;
            if (f[at + 41] == 1) t = -t;
            s = s / f[at + 45] + .5 - f[at + 47];
            t = t / f[at + 46] + .5 - f[at + 48];
            color fill = color(f[at + 42], f[at + 43], f[at + 44]);
            if (f[at + 49] == 1) {
                s = mod(s, 1);
                t = mod(t, 1);
            } else if (f[at + 49] == 2) {
                s = clamp(s, 0, 1);
                t = clamp(t, 0, 1);
            }
            uniform float there = 0;
            if (map != "") there = textureinfo(map, "exists", 0);
            if (crosses == 0) v = 0;
            else if (s < 0 || s > 1 || t < 0 || t > 1) tint = fill;
            else if (there != 0) tint = color texture(map, s, t);
            tint *= color(f[at + 50], f[at + 51], f[at + 52]);
        }
    } else if (kind == 4) {
        float left = f[at + 23] / 2 + f[at + 28], right = f[at + 23] / 2 + f[at + 29], low = f[at + 24] / 2 + f[at + 30],
              high = f[at + 24] / 2 + f[at + 31], back = f[at + 25] / 2 + f[at + 32], front = f[at + 25] / 2 + f[at + 33];
        vector c = vector((right - left) / 2, (high - low) / 2, (front - back) / 2);
        v = risRounded(b - point(0, 0, 0) - c, vector((left + right) / 2, (low + high) / 2, (back + front) / 2), f[at + 26], f[at + 27]);
    } else if (kind == 6 || kind == 5) {
        float type = f[at + 53], d = distance(a, b);
        if (type == 1) d = zcomp(b);
        if (type == 2) d = length(b - point(0, 0, 0));
        if (type == 3) d = sqrt(xcomp(b) * xcomp(b) + ycomp(b) * ycomp(b));
        float k = (f[at + 55] == f[at + 54]) ? 0 : clamp((d - f[at + 54]) / (f[at + 55] - f[at + 54]), 0, 1);
        uniform float i, n = f[at + 56];
        tint = color(f[at + 73], f[at + 74], f[at + 75]);
        for (i = 1; i < n; i += 1) {
            float p = f[at + 56 + i], q = f[at + 57 + i];
            color next = color(f[at + 73 + 3 * i], f[at + 74 + 3 * i], f[at + 75 + 3 * i]), last = color(f[at + 70 + 3 * i], f[at + 71 + 3 * i], f[at + 72 + 3 * i]);
            if (k > p) tint = (k >= q) ? next : mix(last, next, color((k - p) / max(q - p, 1e-6)));
        }
    }
    return v;
}
/* Light Cl from one point to another, both in current space, behind all filters that act on what is lit: each link asks the renderer whether one does;
   without links all do. */
color risFiltered(color light; uniform float f[]; string maps[], links[]; point from, to;) {
    color out = light, most = 0, least = 1, kept = 1;
    uniform float i, maxima = 0, screens = 0;
    for (i = 0; i < arraylength(maps); i += 1) {
        uniform float at = 128 * i, mode = f[at + 1];
        uniform matrix m = matrix(f[at + 2], f[at + 3], f[at + 4], f[at + 5], f[at + 6], f[at + 7], f[at + 8], f[at + 9], f[at + 10],
                                  f[at + 11], f[at + 12], f[at + 13], f[at + 14], f[at + 15], f[at + 16], f[at + 17]);
        color tint;
        float v = risFilter(f, at, maps[i], transform(m, transform("world", from)), transform(m, transform("world", to)), tint) * f[at + 18];
        float gain = f[at + 20] * pow(2, f[at + 21]);
        if (f[at + 19] == 1) gain = 1 / max(gain, 1e-6);
        float acts = 1;
        if (arraylength(links) > 0) surface(links[i], acts);
        v *= acts;
        color effect = mix(color(1), gain * tint, color(v));
        if (f[at + 22] != 1)
            out = mix(out, mix(color(.2126 * comp(out, 0) + .7152 * comp(out, 1) + .0722 * comp(out, 2)), out, color(f[at + 22])), color(v));
        if (mode == 0) out *= effect;
        if (mode == 1 && acts != 0) {
            most = (maxima == 0) ? effect : max(most, effect);
            maxima = 1;
        }
        if (mode == 2) least = min(least, effect);
        if (mode == 3 && acts != 0) {
            kept *= color(1) - effect;
            screens = 1;
        }
    }
    if (maxima == 1) out *= most;
    if (screens == 1) out *= color(1) - kept;
    return out * least;
}

/* How much of it leaves at an angle whose cosine to the axis is given. focus f: cosine to the power f, tinted where it dims; cone: full light
   within (1 - softness) of the angle, none outside. */
color risShape(float cosine, focus; color tint; float coneAngle, coneSoftness;) {
    color shape = 1;
    float c = max(0, cosine);
    if (focus > 0) {
        float k = pow(c, focus);
        shape = mix(tint, color(1), color(k)) * k;
    }
    if (coneAngle < 90) {
        float outside = cos(radians(coneAngle)), inside = cos(radians(coneAngle * (1 - clamp(coneSoftness, 0, 1))));
        shape *= (coneSoftness > 0) ? smoothstep(outside, max(inside, outside + 1e-4), c) : ((c >= outside) ? 1 : 0);
    }
    return shape;
}
#endif
