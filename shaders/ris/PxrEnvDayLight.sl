/* PxrEnvDayLight: sun and sky of a day, of RIS; the zenith is +z of the light's space, north +x, east +y (as
   hdPrman of OpenUSD, light.cpp, has it). The sky is that of A. J. Preetham, P. Shirley and
   B. Smits, "A Practical Analytic Model for Daylight" (1999), with haze as turbidity; the sun that of its appendix. Where month is 0
   sunDirection points to the sun, else date, hour, zone, latitude and longitude tell where it is. The unit is that a white floor under 100 klux has
   radiance 1 at intensity * 2^exposure = 1. Below the horizon is groundColor. Not done: groundMode, enableShadows and shadow parameters.
   Ball: Light "PxrEnvDayLight" "l" "float intensity" 1 */
#include "rislight.h"
light PxrEnvDayLight(float intensity = 1, exposure = 0; vector sunDirection = vector(0, 0, 1); float haze = 2;
         color skyTint = 1, sunTint = 1, groundColor = .2; float groundMode = 0, sunSize = 1;
         float month = 11, day = 20, year = 2014, hour = 14.633333, zone = -8, latitude = 47.602, longitude = -122.332;
         float specular = 1, diffuse = 1; output float __nondiffuse = 0; output float __nonspecular = 0; string __group = "", lightGroup = ""; RIS_SHAPED) {
    float perez(float a, b, c, d, e, ct, g, cg;) {
        return (1 + a * exp(b / max(ct, .01))) * (1 + c * exp(d * g) + e * cg * cg);
    }
    float sky(float a, b, c, d, e, zenith, ts, ct, g, cg;) {
        return zenith * perez(a, b, c, d, e, ct, g, cg) / perez(a, b, c, d, e, 1, ts, cos(ts));
    }
    __nondiffuse = 1 - diffuse;
    __nonspecular = 1 - specular;
    float scale = intensity * pow(2, exposure) * PI * 1e-5 * 1000; /* kilocandela per square metre */
    vector toSun = normalize(sunDirection);
    if (month != 0) {
        float J = floor(30.4375 * (month - 1)) + day, lat = radians(latitude);
        float t = hour + .17 * sin(4 * PI * (J - 80) / 373) - .129 * sin(2 * PI * (J - 8) / 355) + (longitude - 15 * zone) / 15;
        float turn = PI * t / 12, decline = .4093 * sin(2 * PI * (J - 81) / 368);
        float up = sin(lat) * sin(decline) - cos(lat) * cos(decline) * cos(turn);
        toSun = normalize(vector(cos(lat) * sin(decline) + sin(lat) * cos(decline) * cos(turn), cos(decline) * sin(turn), up));
    }
    float cs = clamp(zcomp(toSun), 0, 1), ts = acos(cs), T = clamp(haze, 1.7, 10), day1 = smoothstep(-.1, .05, zcomp(toSun));
    /* zenith: luminance and chromaticity */
    float Yz = (4.0453 * T - 4.9710) * tan((.44444 - T / 120) * (PI - 2 * ts)) - .2155 * T + 2.4192;
    float t2 = ts * ts, t3 = t2 * ts;
    float xz = T * T * (.00166 * t3 - .00375 * t2 + .00209 * ts) + T * (-.02903 * t3 + .06377 * t2 - .03202 * ts + .00394) + .11693 * t3 - .21196 * t2 + .06052 * ts + .25886;
    float yz = T * T * (.00275 * t3 - .00610 * t2 + .00317 * ts) + T * (-.04214 * t3 + .08970 * t2 - .04153 * ts + .00516) + .15346 * t3 - .26756 * t2 + .06670 * ts + .26688;
    solar() {
        vector w = normalize(vtransform("shader", -L));
        float ct = zcomp(w), cg = clamp(w . toSun, -1, 1), g = acos(cg);
        if (ct <= 0) {
            Cl = scale * max(0, Yz) * day1 * groundColor;
        } else {
            float Y = sky(.1787 * T - 1.4630, -.3554 * T + .4275, -.0227 * T + 5.3251, .1206 * T - 2.5771, -.0670 * T + .3703, max(0, Yz), ts, ct, g, cg);
            float x = sky(-.0193 * T - .2592, -.0665 * T + .0008, -.0004 * T + .2125, -.0641 * T - .8989, -.0033 * T + .0452, xz, ts, ct, g, cg);
            float y = sky(-.0167 * T - .2608, -.0950 * T + .0092, -.0079 * T + .2102, -.0441 * T - 1.6537, -.0109 * T + .0529, yz, ts, ct, g, cg);
            float X = x / max(y, .01) * Y, Z = (1 - x - y) / max(y, .01) * Y;
            Cl = scale * day1 * skyTint * color(max(0, 3.2404542 * X - 1.5371385 * Y - .4985314 * Z),
                max(0, -.9692660 * X + 1.8760108 * Y + .0415560 * Z), max(0, .0556434 * X - .2040259 * Y + 1.0572252 * Z));
        }
        Cl = risFiltered(Cl, lightFilters, lightFilterMaps, lightFilterLinks, Ps - 1e5 * normalize(L), Ps);
    }
    /* what comes through the air at .61, .55 and .465 micrometres: Rayleigh and aerosol */
    float m = 1 / (cs + .15 * pow(93.885 - degrees(ts), -1.253)), beta = .04608 * T - .04586;
    color through = color(exp(-m * (.008735 * pow(.61, -4.08) + beta * pow(.61, -1.3))), exp(-m * (.008735 * pow(.55, -4.08) + beta * pow(.55, -1.3))),
                          exp(-m * (.008735 * pow(.465, -4.08) + beta * pow(.465, -1.3))));
    vector axis = vtransform("shader", "current", -toSun);
    solar(axis, radians(.265 * max(sunSize, .05)))
        Cl = risFiltered(intensity * pow(2, exposure) * 1.28 * (zcomp(toSun) > 0 ? 1 : 0) * through * sunTint, lightFilters, lightFilterMaps, lightFilterLinks,
                         Ps - 1e5 * normalize(L), Ps); /* 128 klux outside of the air */
}
