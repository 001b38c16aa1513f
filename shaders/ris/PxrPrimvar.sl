/* PxrPrimvar: a variable of the primitive, of RIS: type float, float2 (as x and y of resultP and resultS, resultT), color, point, vector or normal. Where the primitive has none of that name and type,
   the default. Derivatives of it are not known. */
#include "rispattern.h"
surface PxrPrimvar(string varname = "", type = "float", coordsys = ""; float defaultFloat = 0; color defaultColor = 0; vector defaultFloat3 = 0; float filterRadius = 0;
                   RIS_RGB; output varying float resultF = 0, resultI = 0, resultS = 0, resultT = 0; output varying point resultP = 0) {
    resultF = defaultFloat;
    resultRGB = defaultColor;
    if (varname != "") {
        if (type == "color") {
            color c = defaultColor;
            getvar(null, varname, c);
            resultRGB = c;
            resultF = risLuminance(c);
        } else if (type == "point" || type == "vector" || type == "normal") {
            point p = point defaultFloat3;
            vector v = defaultFloat3;
            normal n = normal defaultFloat3;
            if (getvar(null, varname, p) == 0) if (getvar(null, varname, v) == 1) p = point v; else if (getvar(null, varname, n) == 1) p = point n;
            resultP = p;
            resultRGB = color(xcomp(p), ycomp(p), zcomp(p));
        } else if (type == "float2") {
            float st[2] = {0, 0};
            if (varname == "st") { st[0] = s; st[1] = t; } else getvar(null, varname, st);
            resultS = st[0];
            resultT = st[1];
            resultP = point(resultS, resultT, 0);
            resultRGB = color(resultS, resultT, 0);
            resultF = resultS;
        } else {
            float f = defaultFloat;
            getvar(null, varname, f);
            resultF = f;
            resultRGB = f;
        }
    }
    resultI = resultF;
    RIS_CHANNELS
}
