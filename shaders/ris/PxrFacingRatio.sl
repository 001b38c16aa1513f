/* PxrFacingRatio: how much the surface faces the ray, 1 to 0 at its outline, of RIS; use 1: how much it faces direction in the space coordSys. faceForward 1 takes both sides alike, else backs are below 0 (0 with
   clamp). mode 1: what a dielectric of the index ior reflects there. Then invert, and the power 1 / gamma. */
#include "rispattern.h"
surface PxrFacingRatio(varying normal bumpNormal = 0; float use = 0; varying vector direction = vector(0, 1, 0); string coordSys = ""; float faceForward_ = 1, clamp_ = 0, invert = 0, mode = 0; varying float gamma_ = 1, ior = 1.5;
                       output varying float resultF = 0) {
    normal n = normalize((bumpNormal . bumpNormal > 0) ? bumpNormal : N);
    vector to = (use == 0) ? -normalize(I) : normalize((coordSys == "") ? direction : vtransform(coordSys, "current", direction));
    float c = to . n;
    c = (faceForward_ != 0) ? abs(c) : (clamp_ != 0) ? max(0, c) : c;
    if (mode == 1) {
        float g = sqrt(max(ior * ior - 1 + c * c, 0)), a = (g - c) / max(g + c, 1e-6), b = (c * (g + c) - 1) / (c * (g - c) + 1);
        c = .5 * a * a * (1 + b * b);
    }
    if (invert != 0) c = 1 - c;
    resultF = (gamma_ != 1) ? pow(max(c, 0), 1 / max(gamma_, 1e-3)) : c;
}
