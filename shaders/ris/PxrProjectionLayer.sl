/* PxrProjectionLayer: a picture that a PxrProjector places, of RIS, for a PxrProjectionStack: by the manifold, whose t runs downward, or s and t. resultA is the picture's alpha (1 where it has none) times mask, which takes the
   projector's resultMask; nothing is looked up where that is 0. filter 0 box, else gaussian; blur; premultiply; missingColor and missingAlpha where no file is named or it is missing. Not done: lerp, linearize,
   channels (channelsFilenames). */
#include "rispattern.h"
surface PxrProjectionLayer(string filename = ""; float firstChannel = 0, filter_ = 1, blur = 0, lerp = 1; varying color missingColor = color(1, 0, 1); float missingAlpha = 1, linearize = 0, premultiply = 0; varying float mask = 1;
                           float mipBias = 0, maxResolution = 0, optimizeIndirect = 1; RIS_MANIFOLD; RIS_RGB; output varying float resultA = 0) {
    RIS_COORDINATES(x, y);
    if (mask > 0) {
        resultRGB = missingColor;
        resultA = missingAlpha;
        if (filename != "") {
            uniform float there = 0, channels = 3;
            there = textureinfo(filename, "exists", 0);
            textureinfo(filename, "channels", channels);
            uniform string kind = (filter_ == 0) ? "box" : "gaussian";
            color c = color texture(filename[firstChannel], x, y, "blur", blur, "filter", kind);
            float a = 1;
            if (channels < 3) c = color(float texture(filename[firstChannel], x, y, "blur", blur, "filter", kind));
            if (channels == 4) a = float texture(filename[3], x, y, "blur", blur, "filter", kind);
            if (there != 0) {
                resultRGB = c;
                resultA = a;
            }
        }
        resultA *= min(mask, 1);
        if (premultiply != 0) resultRGB *= resultA;
    }
    RIS_CHANNELS
}
