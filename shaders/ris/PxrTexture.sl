/* PxrTexture: a picture, of RIS, by s and t or a manifold. invertT 1 puts its lower edge at t = 0; firstChannel, filter (0 box, else gaussian), blur;
   saturation, the scales and offsets of colour and alpha; missingColor and missingAlpha where no file is named or it is missing. The colour
   space of a map is its file's (docs/maps.md). Not done: atlasStyle, lerp, linearize. */
#include "rispattern.h"
surface PxrTexture(string filename = ""; float firstChannel = 0, atlasStyle = 0, invertT = 1, filter_ = 1, blur = 0, lerp = 1;
                   varying color missingColor = color(1, 0, 1); float missingAlpha = 1, linearize = 0, saturation = 1, alphaScale = 1, alphaOffset = 0, mipBias = 0, maxResolution = 0, optimizeIndirect = 1;
                   color colorScale = 1, colorOffset = 0; RIS_MANIFOLD; RIS_RGB; output varying float resultA = 1) {
    RIS_COORDINATES(x, y);
    if (invertT != 0) y = 1 - y;
    resultRGB = missingColor;
    resultA = missingAlpha;
    if (filename != "") {
        uniform float there = 0;
        there = textureinfo(filename, "exists", 0);
        uniform float channels = 3;
        textureinfo(filename, "channels", channels);
        string kind = (filter_ == 0) ? "box" : "gaussian";
        if (channels < 3) {
            resultRGB = float texture(filename[firstChannel], x, y, "blur", blur, "filter", kind);
        } else {
            resultRGB = texture(filename[firstChannel], x, y, "blur", blur, "filter", kind);
        }
        resultA = 1;
        if (channels == 4) resultA = float texture(filename[3], x, y, "blur", blur, "filter", kind);
        if (channels == 2) resultA = float texture(filename[1], x, y, "blur", blur, "filter", kind);
        if (there == 0) { /* the lookup above has said so */
            resultRGB = missingColor;
            resultA = missingAlpha;
        }
    }
    resultRGB = risSaturate(resultRGB, saturation) * colorScale + colorOffset;
    resultA = resultA * alphaScale + alphaOffset;
    RIS_CHANNELS
}
