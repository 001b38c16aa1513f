/* PxrManifold3DN: places for solid patterns with their normals, of RIS: P and N in the space coordsys, P times scale; pref and nref name variables at rest. */
#include "rispattern.h"
surface PxrManifold3DN(varying float scale = 1; string coordsys = "object", pref = "", nref = ""; RIS_RESULT; output varying float resultX = 0, resultY = 0, resultZ = 0; output varying normal resultN = 0, result_N = 0) {
    uniform string space = (coordsys == "") ? "object" : coordsys;
    point q = transform(space, P), rest = q;
    normal n = normalize(ntransform(space, N)), turned = n;
    if (pref != "" && getvar(null, pref, rest) == 1) q = rest;
    if (nref != "" && getvar(null, nref, turned) == 1) n = turned;
    q = point(scale * xcomp(q), scale * ycomp(q), scale * zcomp(q));
    result_Q = q;
    result_Qradius = .5 * (length(Du(q) * du) + length(Dv(q) * dv));
    resultX = xcomp(q);
    resultY = ycomp(q);
    resultZ = zcomp(q);
    resultN = n;
    result_N = n;
}
