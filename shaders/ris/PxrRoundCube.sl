/* PxrRoundCube: pictures projected along three axes, of RIS, for PxrMultiTexture: those of the cube from -1 to 1 of the space coordsys, frequency times across a face.
   numberOfTextures 1: the same picture for all faces, 3: the pictures 0 to 2 by axis, 6: 0 to 5 for +x, +y, +z, -x, -y, -z. Faces count by the square of how much
   they are seen beyond 1 - transitionWidth of the one that is seen most. pref and nref name variables at rest. Not done: randomization. */
#include "rispattern.h"
surface PxrRoundCube(float numberOfTextures = 1; varying float frequency = 1; float transitionWidth = .5, use = 0; string pref = "", nref = "", coordsys = "object"; float useUndisplacedPosition = 0;
                     output varying color resultMask = 0; RIS_RESULT_MULTI) {
    uniform string space = (coordsys == "") ? "object" : coordsys;
    point q = transform(space, P), rest = q;
    normal n = ntransform(space, N), turned = n;
    if (pref != "" && getvar(null, pref, rest) == 1) q = rest;
    if (nref != "" && getvar(null, nref, turned) == 1) n = turned;
    float at(float x;) { return frequency * (.5 + x / 2); }
    resultMulti_Q0 = point(at(ycomp(q)), at(zcomp(q)), 0);
    resultMulti_Q1 = point(at(xcomp(q)), at(zcomp(q)), 0);
    resultMulti_Q2 = point(at(xcomp(q)), at(ycomp(q)), 0);
    float x = abs(xcomp(n)), y = abs(ycomp(n)), z = abs(zcomp(n)), most = max(x, y, z), limit = most * (1 - clamp(transitionWidth, 1e-4, 1));
    float a = max(x - limit, 0), b = max(y - limit, 0), c = max(z - limit, 0), sum = max(a * a + b * b + c * c, 1e-30);
    resultMulti_weight = vector(a * a, b * b, c * c) / sum;
    resultMulti_index = (numberOfTextures >= 6) ? vector((xcomp(n) < 0) ? 3 : 0, (ycomp(n) < 0) ? 4 : 1, (zcomp(n) < 0) ? 5 : 2)
                      : (numberOfTextures >= 3) ? vector(0, 1, 2) : vector(0, 0, 0);
    resultMask = color(xcomp(resultMulti_weight), ycomp(resultMulti_weight), zcomp(resultMulti_weight));
    resultMulti_id = risRandom(xcomp(resultMulti_index) + 7 * ycomp(resultMulti_index), 6);
}
