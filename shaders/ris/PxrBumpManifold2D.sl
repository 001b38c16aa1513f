/* PxrBumpManifold2D: s and t for the map of a PxrBump, of RIS, as PxrManifold2D gives them. */
#include "rispattern.h"
surface PxrBumpManifold2D(varying float angle = 0, scaleS = 1, scaleT = 1, offsetS = 0, offsetT = 0; float invertT = 1; string primvarS = "", primvarT = ""; RIS_RESULT; output varying float resultS = 0, resultT = 0) {
    float x = s, y = t;
    if (primvarS != "" && primvarS != "s" && primvarS != "st") getvar(null, primvarS, x);
    if (primvarT != "" && primvarT != "t" && primvarT != "st") getvar(null, primvarT, y);
    float c = cos(radians(angle)), d = sin(radians(angle));
    resultS = scaleS * (c * x - d * y) + offsetS;
    resultT = scaleT * (d * x + c * y) + offsetT;
    if (invertT != 0) resultT = 1 - resultT;
    result_Q = point(resultS, resultT, 0);
    result_Qradius = .5 * (abs(Du(resultS) * du) + abs(Dv(resultS) * dv) + abs(Du(resultT) * du) + abs(Dv(resultT) * dv));}
