/* PxrMix: color1 for mix 0, color2 for mix 1, linearly, of RIS. */
#include "rispattern.h"
surface PxrMix(varying color color1 = 0; varying color color2 = 1; varying float mix_ = 0; float clampMix = 0; RIS_RGB) {
    resultRGB = mix(color1, color2, color((clampMix != 0) ? clamp(mix_, 0, 1) : mix_));
    RIS_CHANNELS
}
