/* PxrBump: the normal of the surface moved by inputBump * scale along its normal, of RIS. adjustAmount scales the tilt, surfaceNormalMix goes back to the surface's normal; reverse, disable. A map filename gives a height of its own, by s and t or a
   manifold. */
#include "rispattern.h"
surface PxrBump(varying float scale = 1, inputBump = 0, adjustAmount = 0, surfaceNormalMix = 0; float disable = 0, reverse_ = 0; varying normal bumpOverlay = 0; string filename = ""; float firstChannel = 0, invertT = 1, blur = 0; RIS_MANIFOLD; output varying normal resultN = 0) {
    normal n = normalize(N);
    resultN = n;
    if (disable == 0) {
        float height = inputBump;
        if (filename != "") {
            RIS_COORDINATES(x, y);
            height += float texture(filename[firstChannel], x, (invertT != 0) ? 1 - y : y, "blur", blur);
        }
        float h = height * scale * ((reverse_ != 0) ? -1 : 1);
        normal b = normalize(calculatenormal(P + h * n));
        if (b . n < 0) b = -b;
        resultN = normalize(mix(b + bumpOverlay, n, clamp(surfaceNormalMix, 0, 1)));
    }
}
