/* PxrManifold3D: places for solid patterns, of RIS: P in the space coordsys ("object" when not given), scaled and moved. A variable of the primitive that
   pref or prefVar names (a point at rest) comes first. Not done: the matrices of later versions. */
#include "rispattern.h"
surface PxrManifold3D(varying float scale = 1, offset = 0; varying float scaleX = 1, scaleY = 1, scaleZ = 1, offsetX = 0, offsetY = 0, offsetZ = 0; string coordsys = "object", pref = "", prefVar = "";
                      RIS_RESULT; output varying float resultX = 0, resultY = 0, resultZ = 0) {
    point q = transform((coordsys == "") ? "object" : coordsys, P), rest = q;
    if (pref != "" && getvar(null, pref, rest) == 1) q = rest;
    if (prefVar != "" && getvar(null, prefVar, rest) == 1) q = rest;
    q = point(scale * scaleX * xcomp(q) + offset + offsetX, scale * scaleY * ycomp(q) + offset + offsetY, scale * scaleZ * zcomp(q) + offset + offsetZ);
    result_Q = q;
    resultX = xcomp(q);
    resultY = ycomp(q);
    resultZ = zcomp(q);
    result_Qradius = .5 * (length(Du(q) * du) + length(Dv(q) * dv));
}
