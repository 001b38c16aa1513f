/* PxrPtexture: a Ptex file, of RIS, by the face at the point and its own coordinates, the face's number moved by faceIndexOffset. filter 0 point, 1 box, else gaussian; blur; missingColor where no file is named. Not done: invertWindingOrder, linearize, manifolds. */
#include "rispattern.h"
surface PxrPtexture(string filename = ""; float firstChannel = 0, faceIndexOffset = 0, invertWindingOrder = 0, filter_ = 1, blur = 0, lerp = 1; color missingColor = color(1, 0, 1); float missingAlpha = 1, linearize = 0;
                    RIS_MANIFOLD; RIS_RGB; output varying float resultA = 1) {
    uniform string kind = (filter_ == 0) ? "point" : (filter_ == 1) ? "box" : "gaussian";
    resultRGB = missingColor;
    resultA = missingAlpha;
    if (filename != "") {
        float face = 0;
        getvar(null, "__faceindex", face);
        resultRGB = color ptexture(filename, firstChannel, face + faceIndexOffset, "blur", blur, "filter", kind);
        resultA = 1;
    }
    RIS_CHANNELS
}
