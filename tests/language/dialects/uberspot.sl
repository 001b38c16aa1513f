/* a light with everything: cone, beam, shadow map, slide, noise, cuton and cutoff */
#define CONE_SHARP 0
float rampdown(float x, lo, hi) { return 1 - smoothstep(lo, hi, x); }

color
getslide(string name; point PL; output float opac)
{
    float ss, tt;
    color c = color (1,1,1);
    opac = 1;
    if (name != "") {
        ss = xcomp(PL) / zcomp(PL) * .5 + .5;
        tt = ycomp(PL) / zcomp(PL) * .5 + .5;
        if (ss > 0 && ss < 1 && tt > 0 && tt < 1) {
            c = color texture(name, ss, tt, "filter", "gaussian", "blur", .01);
            opac = float texture(name[3], ss, tt, "fill", 1);
        }
    }
    return c;
}

light
uberspot (
    string lighttype = "spot";
    float intensity = 1;
    color lightcolor = color (1,1,1);
    float coneangle = radians(30), conedelta = .1, beamdistribution = 2, falloff = 2, maxintensity = 1,
          cuton = 0.01, cutoff = 1.0e6, nearedge = 0, faredge = 0;
    point from = point "shader" (0,0,0), to = point "shader" (0,0,1);
    string slidename = "", noisetype = "none", shadowname = "";
    vector noisescale = vector (1,1,1);
    color shadowcolor = 0;
    float shadowblur = 0.01, shadowsamples = 16, shadowbias = -1, raytraceshadow = 0;
    output float __nonspecular = 0, __nondiffuse = 0;
    output varying color __shadowC = 0;
    output varying float __shadowF = 0;
    output varying float __foglight = 1;
    string __category = "";
)
{
    uniform vector axis = normalize(to - from);
    uniform float cosout = cos(coneangle), cosin = cos(coneangle - conedelta);
    point PL = transform("shader", Ps);
    color lcol = lightcolor;
    float atten = 1, slideopac;
    if (lighttype == "spot" || lighttype == "omni") {
        illuminate (from, axis, lighttype == "omni" ? PI : coneangle) {
            float dist = length(L), shad = 0;
            float cosangle = (L . axis) / dist;
            atten *= smoothstep(cuton - nearedge, cuton, dist) * rampdown(dist, cutoff, cutoff + faredge);
            if (falloff != 0) {
                if (dist > 1) atten *= pow(1 / dist, falloff);
                else {
                    uniform float s0 = log(1 / maxintensity);
                    uniform float beta = -falloff / s0;
                    atten *= maxintensity * exp(s0 * pow(dist, beta));
                }
            }
            if (lighttype == "spot") atten *= pow(max(cosangle, 0), beamdistribution) * smoothstep(cosout, cosin, cosangle);
            lcol *= getslide(slidename, PL, slideopac);
            if (noisetype == "noise" || match("turb", noisetype)) lcol *= noise(PL * noisescale);
            if (shadowname != "") {
                shad = shadow(shadowname, Ps, "blur", shadowblur, "samples", shadowsamples, "bias", shadowbias);
            } else if (raytraceshadow > 0) {
                color vis = 1;
                vis = transmission(Ps, from, "bias", .01);
                shad = 1 - (comp(vis,0) + comp(vis,1) + comp(vis,2)) / 3;
            }
            __shadowF = shad;
            __shadowC = shadowcolor;
            Cl = intensity * atten * mix(lcol, shadowcolor, shad);
        }
    } else {
        solar (axis, 0) { Cl = intensity * lcol; }
    }
    __foglight = comp(lcol, 0);
}
