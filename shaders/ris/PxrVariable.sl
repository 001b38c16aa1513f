/* PxrVariable: a variable of the point that is shaded, of RIS: P, Po, PoP, Nn, Ngn, Vn, Tn, dPdu, dPdv, dPdtime, u, v, w, du, dv, time, curvature, biasR, id, outsideIOR and other names; s and t as well. In the space coordsys, where
   one is named. Those that this program has not are 0. */
#include "rispattern.h"
surface PxrVariable(string variable = "", type = "float", coordsys = ""; RIS_RGB; output varying float resultF = 0, resultI = 0, resultA = 1; output varying point resultP = 0) {
    string space = (coordsys == "") ? "current" : coordsys;
    point p = 0;
    if (variable == "P" || variable == "Po" || variable == "PoP") p = transform(space, P);
    else if (variable == "Nn" || variable == "N") p = point normalize(ntransform(space, N));
    else if (variable == "Ngn" || variable == "Ng") p = point normalize(ntransform(space, Ng));
    else if (variable == "Vn" || variable == "V") p = point normalize(vtransform(space, -I));
    else if (variable == "I") p = point vtransform(space, I);
    else if (variable == "Tn") p = point normalize(vtransform(space, dPdu));
    else if (variable == "dPdu") p = point vtransform(space, dPdu);
    else if (variable == "dPdv") p = point vtransform(space, dPdv);
    else if (variable == "u") p = point(u, u, u);
    else if (variable == "v") p = point(v, v, v);
    else if (variable == "s") p = point(s, s, s);
    else if (variable == "t") p = point(t, t, t);
    else if (variable == "st") p = point(s, t, 0);
    else if (variable == "du") p = point(du, du, du);
    else if (variable == "dv") p = point(dv, dv, dv);
    else if (variable == "time") p = point(time, time, time);
    else if (variable == "outsideIOR") p = point(1, 1, 1);
    resultP = p;
    resultRGB = color(xcomp(p), ycomp(p), zcomp(p));
    resultF = xcomp(p);
    resultI = resultF;
    RIS_CHANNELS
}
