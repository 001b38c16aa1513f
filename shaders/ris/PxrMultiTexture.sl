/* PxrMultiTexture: up to ten pictures, of RIS, mixed as the manifold says that is connected to manifoldMulti (PxrRoundCube, PxrTileManifold, PxrRandomTextureManifold); without one
   filename0 by s and t. invertT, firstChannel, filter, blur and missingColor as PxrTexture has them; randomHue and so on vary each tile as PxrVary does. Not done: linearize, lerp,
   missingAlpha. */
#include "rispattern.h"
#define RIS_PICTURE(file, n) \
    if (file != "") { \
        float a = (xcomp(index) == n) ? xcomp(weight) : 0, b = (ycomp(index) == n) ? ycomp(weight) : 0, c = (zcomp(index) == n) ? zcomp(weight) : 0; \
        uniform float there = 0; \
        there = textureinfo(file, "exists", 0); \
        if (there == 0) resultRGB += (a + b + c) * missingColor; \
        if (there != 0 && a > 0) resultRGB += a * color texture(file[firstChannel], xcomp(q0), up(ycomp(q0)), "blur", blur, "filter", kind); \
        if (there != 0 && b > 0) resultRGB += b * color texture(file[firstChannel], xcomp(q1), up(ycomp(q1)), "blur", blur, "filter", kind); \
        if (there != 0 && c > 0) resultRGB += c * color texture(file[firstChannel], xcomp(q2), up(ycomp(q2)), "blur", blur, "filter", kind); \
    } else { \
        resultRGB += (((xcomp(index) == n) ? xcomp(weight) : 0) + ((ycomp(index) == n) ? ycomp(weight) : 0) + ((zcomp(index) == n) ? zcomp(weight) : 0)) * missingColor; \
    }
surface PxrMultiTexture(string filename0 = "", filename1 = "", filename2 = "", filename3 = "", filename4 = "", filename5 = "", filename6 = "", filename7 = "", filename8 = "", filename9 = "";
                        float firstChannel = 0, invertT = 1, filter_ = 1, blur = 0, lerp = 1; color missingColor = color(1, 0, 1); float missingAlpha = 1, linearize = 0, randomSource = 0, randomSeed = 0,
                        randomHue = 0, randomSaturation = 0, randomLuminance = 0, randomGamma = 0, hueMode = 0, saturationMode = 0, luminanceMode = 0, gammaMode = 0;
                        RIS_MULTI; RIS_RGB; output varying float resultA = 1; output varying color resultMask = 0) {
    float up(float y;) { return (invertT != 0) ? 1 - y : y; }
    uniform string kind = (filter_ == 0) ? "box" : "gaussian";
    point q0 = manifoldMulti_Q0, q1 = manifoldMulti_Q1, q2 = manifoldMulti_Q2;
    vector index = manifoldMulti_index, weight = manifoldMulti_weight;
    if (manifoldMulti_given < .5) {
        q0 = point(s, t, 0);
        index = 0;
        weight = vector(1, 0, 0);
    }
    RIS_PICTURE(filename0, 0)
    RIS_PICTURE(filename1, 1)
    RIS_PICTURE(filename2, 2)
    RIS_PICTURE(filename3, 3)
    RIS_PICTURE(filename4, 4)
    RIS_PICTURE(filename5, 5)
    RIS_PICTURE(filename6, 6)
    RIS_PICTURE(filename7, 7)
    RIS_PICTURE(filename8, 8)
    RIS_PICTURE(filename9, 9)
    if (randomHue != 0 || randomSaturation != 0 || randomLuminance != 0 || randomGamma != 0)
        resultRGB = risVaried(resultRGB, 100 * manifoldMulti_id + randomSeed + risObject(randomSource), randomHue, randomSaturation, randomLuminance, randomGamma, hueMode, saturationMode, luminanceMode, gammaMode);
    resultMask = color(xcomp(weight), ycomp(weight), zcomp(weight));
    RIS_CHANNELS
}
