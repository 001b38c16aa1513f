/* PxrFacingRatio: 1 where the surface faces the ray, 0 at its outline, of RIS; invert, faceForward. */
#include "rispattern.h"
surface PxrFacingRatio(varying normal bumpNormal = 0; float invert = 0, faceForward_ = 1; output varying float resultF = 0) {
    normal n = normalize((bumpNormal . bumpNormal > 0) ? bumpNormal : N);
    float c = -normalize(I) . n;
    resultF = (faceForward_ != 0) ? abs(c) : max(0, c);
    if (invert != 0) resultF = 1 - resultF;
}
