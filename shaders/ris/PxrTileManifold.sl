/* PxrTileManifold: s and t in tiles, of RIS: scaled, turned by angle degrees and moved, each tile from 0 to 1 with a turn of orientation quarters and, where
   randomOrientation is 1, one of its own; every second row is moved by rowOffset. resultMulti is for PxrMultiTexture: each tile has one of numTextures pictures, by
   chance (textureOrder 1) or in order (0). Not done: grout and bevels. */
#include "rispattern.h"
surface PxrTileManifold(varying float angle = 0, scaleS = 1, scaleT = 1, offsetS = 0, offsetT = 0; float invertT = 0, randomOrientation = 0, orientation = 0, rowOffset = 0, numTextures = 1, randomSeed = 0, textureOrder = 1, randomExtraSeed = 0;
                        string primvarS = "", primvarT = ""; RIS_RESULT; output varying float resultS = 0, resultT = 0, id = 0; RIS_RESULT_MULTI) {
    float x = s, y = t;
    if (primvarS != "" && primvarS != "s" && primvarS != "st") getvar(null, primvarS, x);
    if (primvarT != "" && primvarT != "t" && primvarT != "st") getvar(null, primvarT, y);
    float c = cos(radians(angle)), d = sin(radians(angle));
    float a = scaleS * (c * x - d * y) + offsetS, b = scaleT * (d * x + c * y) + offsetT;
    if (invertT != 0) b = 1 - b;
    float row = floor(b);
    a += rowOffset * mod(row, 2);
    float column = floor(a), turns = orientation;
    id = cellnoise(column + .5 + 31 * randomSeed, row + .5);
    if (randomOrientation != 0) turns += floor(4 * id);
    float p = a - column, q = b - row, k = mod(turns, 4);
    resultS = (k < .5) ? p : (k < 1.5) ? 1 - q : (k < 2.5) ? 1 - p : q;
    resultT = (k < .5) ? q : (k < 1.5) ? p : (k < 2.5) ? 1 - q : 1 - p;
    result_Q = point(resultS, resultT, 0);
    resultMulti_Q0 = result_Q;
    resultMulti_id = id;
    float n = max(numTextures, 1), which = (textureOrder == 0) ? mod(column + row, n) : min(floor(n * cellnoise(column + 7.5 + 31 * randomSeed, row + 3.5)), n - 1);
    resultMulti_index = vector(which, -1, -1);
    resultMulti_weight = vector(1, 0, 0);
}
