/* PxrHexTileManifold: s and t in hexagonal tiles that are blended, of RIS, so that pictures repeat without being seen to (Heitz and Neyret, "High-Performance By-Example Noise", 2018; Mikkelsen, "Practical Real-Time Hex-Tiling",
   2022). For PxrMultiTexture: three tiles lie about each point, with their places in the picture, which of numTextures each shows, and their weights. frequency: tiles across s; jitter: how far each is moved at random, in
   parts of a picture; jitterAngle: how far each is turned, in degrees; blend: 1 the whole way from tile to tile, 0 an edge. The pictures must repeat (maketx -mode periodic). No manual at hand gives the names of Pixar's parameters; these are ours. */
#include "rispattern.h"
surface PxrHexTileManifold(varying float frequency = 4, blend = .5, jitter = 1, jitterAngle = 0, angle = 0, scaleS = 1, scaleT = 1, offsetS = 0, offsetT = 0; float invertT = 0, numTextures = 1, randomSeed = 0;
                           RIS_RESULT; output varying float resultS = 0, resultT = 0, id = 0; RIS_RESULT_MULTI) {
    float c = cos(radians(angle)), d = sin(radians(angle));
    resultS = scaleS * (c * s - d * t) + offsetS;
    resultT = scaleT * (d * s + c * t) + offsetT;
    if (invertT != 0) resultT = 1 - resultT;
    result_Q = point(resultS, resultT, 0);
    /* A grid of triangles: each point lies between three corners, whose tiles are the hexagons about them. */
    float root = sqrt(3), f = max(frequency, 1e-6), x = f * (resultS - resultT / root), y = f * 2 * resultT / root;
    float column = floor(x), row = floor(y), p = x - column, q = y - row, z = 1 - p - q, upper = (z < 0) ? 1 : 0;
    float a = (upper == 0) ? z : -z, b = (upper == 0) ? p : 1 - p, e = (upper == 0) ? q : 1 - q;
    uniform float n = max(floor(numTextures), 1);
    float chance(float i, j, k;) { return cellnoise(i + .5 + 31 * randomSeed, j + .5 + 101 * k); }
    point place(float i, j;) {
        float atS = (i + j / 2) / f, atT = j * root / (2 * f), turn = radians(jitterAngle) * (2 * chance(i, j, 1) - 1);
        float u = resultS - atS, v = resultT - atT;
        return point(atS + cos(turn) * u - sin(turn) * v + jitter * chance(i, j, 2), atT + sin(turn) * u + cos(turn) * v + jitter * chance(i, j, 3), 0);
    }
    float picture(float i, j;) { return min(floor(n * chance(i, j, 4)), n - 1); }
    float ai = column + upper, aj = row + upper, bi = column + 1 - upper, bj = row + upper, ei = column + upper, ej = row + 1 - upper;
    float sharp = 1 / clamp(blend, .02, 1), wa = pow(max(a, 0), sharp), wb = pow(max(b, 0), sharp), we = pow(max(e, 0), sharp), sum = max(wa + wb + we, 1e-30);
    resultMulti_Q0 = place(ai, aj);
    resultMulti_Q1 = place(bi, bj);
    resultMulti_Q2 = place(ei, ej);
    resultMulti_index = vector(picture(ai, aj), picture(bi, bj), picture(ei, ej));
    resultMulti_weight = vector(wa, wb, we) / sum;
    id = (wa >= wb && wa >= we) ? chance(ai, aj, 5) : (wb >= we) ? chance(bi, bj, 5) : chance(ei, ej, 5);
    resultMulti_id = id;
}
