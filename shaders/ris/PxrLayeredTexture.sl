/* PxrLayeredTexture: a picture under another PxrLayeredTexture, of RIS: textureOverlay takes the resultOverlay of the one that lies on it. maskValue times the channel maskChannel of maskTexture (missingMask where it cannot be
   read) says how much of the picture is there; colorTint and colorOffset change it; mute leaves it out. By s and t or a manifold; invertT 1 puts the lower edge at t = 0. A filename that is missing shows nothing.
   Not done: atlasStyle, linearize; doNotOptimize has no effect. */
#include "rispattern.h"
surface PxrLayeredTexture(float mute = 0, doNotOptimize = 0; varying float maskValue = 1; string maskTexture = ""; float maskChannel = 0, maskAtlasStyle = 0, missingMask = 0; string filename = "";
                          float firstChannel = 0, atlasStyle = 0, invertT = 1, linearize = 0; varying color colorTint = 1, colorOffset = 0, textureOverlay_RGB = 0; varying float textureOverlay_A = 0; RIS_MANIFOLD;
                          RIS_RGB; output varying float resultA = 0, resultOverlay_A = 0; output varying color resultOverlay_RGB = 0) {
    RIS_COORDINATES(x, y);
    if (invertT != 0) y = 1 - y;
    color c = 0;
    float a = 0;
    if (mute == 0 && filename != "") {
        uniform float there = 0, channels = 3;
        there = textureinfo(filename, "exists", 0);
        textureinfo(filename, "channels", channels);
        c = color texture(filename[firstChannel], x, y, "filter", "gaussian");
        a = 1;
        if (channels == 4) a = float texture(filename[3], x, y, "filter", "gaussian");
        if (channels < 3) c = color(float texture(filename[firstChannel], x, y, "filter", "gaussian"));
        if (there == 0) a = 0;
        c = c * colorTint + colorOffset;
        float mask = maskValue;
        if (maskTexture != "") {
            uniform float known = 0;
            known = textureinfo(maskTexture, "exists", 0);
            mask *= (known == 0) ? missingMask : float texture(maskTexture[maskChannel], x, y, "filter", "gaussian");
        }
        a *= clamp(mask, 0, 1);
    }
    /* Colours of overlays are premultiplied. */
    resultOverlay_RGB = textureOverlay_RGB + (1 - textureOverlay_A) * a * c;
    resultOverlay_A = textureOverlay_A + (1 - textureOverlay_A) * a;
    resultRGB = resultOverlay_RGB;
    resultA = resultOverlay_A;
    RIS_CHANNELS
}
