/* PxrNormalMap: a normal in tangent space, of RIS, from a map or from inputRGB: red along dPdu, green along dPdv, blue along the normal, as 0 to 1; mapType 0
   that of OpenGL. bumpScale scales the tilt; flipX, flipY, reverse; surfaceNormalMix. Not done: orientation, atlasStyle. */
#include "rispattern.h"
surface PxrNormalMap(varying color inputRGB = color(.5, .5, 1); string filename = ""; varying float bumpScale = 1, adjustAmount = 0, surfaceNormalMix = 0; float firstChannel = 0, atlasStyle = 0, invertT = 1, blur = 0, lerp = 1, flipX = 0, flipY = 0, orientation = 2, disable = 0, reverse_ = 0, invertBump = 0;
                     varying normal bumpOverlay = 0; RIS_MANIFOLD; output varying normal resultN = 0) {
    RIS_COORDINATES(x, y);
    if (invertT != 0) y = 1 - y;
    color c = inputRGB;
    uniform float there = 0;
    if (filename != "") there = textureinfo(filename, "exists", 0);
    if (filename != "") c = color(float texture(filename[0], x, y, "blur", blur), float texture(filename[1], x, y, "blur", blur), float texture(filename[2], x, y, "blur", blur));
    if (filename != "" && there == 0) c = inputRGB;
    normal n = normalize(N);
    resultN = n;
    if (disable == 0) {
        float a = 2 * comp(c, 0) - 1, b = 2 * comp(c, 1) - 1, z = 2 * comp(c, 2) - 1;
        if (flipX != 0) a = -a;
        if (flipY != 0) b = -b;
        if (reverse_ != 0 || invertBump != 0) { a = -a; b = -b; }
        vector T = normalize(dPdu - (dPdu . n) * vector n), B = normalize(dPdv - (dPdv . n) * vector n - (dPdv . T) * T);
        normal m = normalize(normal(bumpScale * (a * T + b * B)) + max(z, 1e-3) * n + bumpOverlay);
        resultN = normalize(mix(m, n, clamp(surfaceNormalMix, 0, 1)));
    }
}
