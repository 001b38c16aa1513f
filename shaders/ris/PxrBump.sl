/* PxrBump: the normal of the surface moved by inputBump * scale along its normal, of RIS. adjustAmount scales the tilt, surfaceNormalMix goes back to the surface's normal; reverse, disable. */
#include "rispattern.h"
surface PxrBump(varying float scale = 1, inputBump = 0, adjustAmount = 0, surfaceNormalMix = 0; float disable = 0, reverse_ = 0; varying normal bumpOverlay = 0; output varying normal resultN = 0) {
    normal n = normalize(N);
    resultN = n;
    if (disable == 0) {
        float h = inputBump * scale * ((reverse_ != 0) ? -1 : 1);
        normal b = normalize(calculatenormal(P + h * n));
        if (b . n < 0) b = -b;
        resultN = normalize(mix(b + bumpOverlay, n, clamp(surfaceNormalMix, 0, 1)));
    }
}
