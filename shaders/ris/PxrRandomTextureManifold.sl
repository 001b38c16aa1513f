/* PxrRandomTextureManifold: one of numTextures pictures for each object, of RIS, for PxrMultiTexture: by chance (textureOrder 1) or in order (0) of Attribute "identifier" "id" (randomSource 0) or
   of the hash of its name (1); s and t as PxrManifold2D has them, with quarter turns, mirrorings and shifts by chance. */
#include "rispattern.h"
surface PxrRandomTextureManifold(float numTextures = 1, textureOrder = 1, randomSource = 0, randomExtraSeed = 0, randomOrientation = 0, randomFlipS = 0, randomFlipT = 0, randomOffsetS = 0, randomOffsetT = 0;
                                 varying float angle = 0, globalScale = 1, scaleS = 1, scaleT = 1, offsetS = 0, offsetT = 0; float invertT = 1; string primvarS = "", primvarT = "";
                                 RIS_RESULT; output varying float resultS = 0, resultT = 0; output varying color resultMask = 0; RIS_RESULT_MULTI) {
    float object = risObject(randomSource), x = s, y = t, n = max(numTextures, 1);
    if (primvarS != "" && primvarS != "s" && primvarS != "st") getvar(null, primvarS, x);
    if (primvarT != "" && primvarT != "t" && primvarT != "st") getvar(null, primvarT, y);
    float own = object + 17.3 * randomExtraSeed, turned = radians(angle);
    if (randomOrientation != 0) turned += PI / 2 * floor(4 * risRandom(own, 1));
    float c = cos(turned), d = sin(turned);
    float a = globalScale * scaleS * (c * x - d * y) + offsetS, b = globalScale * scaleT * (d * x + c * y) + offsetT;
    if (randomFlipS != 0 && risRandom(own, 2) < .5) a = -a;
    if (randomFlipT != 0 && risRandom(own, 3) < .5) b = -b;
    if (randomOffsetS != 0) a += risRandom(own, 4);
    if (randomOffsetT != 0) b += risRandom(own, 5);
    resultS = a;
    resultT = b;
    result_Q = point(a, b, 0);
    resultMulti_Q0 = result_Q;
    resultMulti_id = risRandom(own, 6);
    float one = (textureOrder == 0) ? mod(object, n) : min(floor(n * risRandom(own, 7)), n - 1);
    resultMulti_index = vector(one, -1, -1);
    resultMulti_weight = vector(1, 0, 0);
    resultMask = one / n;
}
