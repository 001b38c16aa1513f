/* PxrInvert: one minus a colour in a colour model, of RIS: colorModel 0 is RGB, 1 HSL, 2 HSV; where invertChannel0, 1 or 2 is 0 that channel
   stays. The result is RGB in [0, 1]. Names are those of Pixar's documentation, which does not say what one minus a hue is: 1 - h here, so red stays. */
#include "rispattern.h"
surface PxrInvert(varying color inputRGB = 0; float colorModel = 0, invertChannel0 = 1, invertChannel1 = 1, invertChannel2 = 1; RIS_RGB) {
    uniform string model = (colorModel == 1) ? "hsl" : "hsv";
    color c = inputRGB;
    if (colorModel > 0) c = ctransform("rgb", model, clamp(c, color 0, color 1));
    c = color((invertChannel0 != 0) ? 1 - comp(c, 0) : comp(c, 0), (invertChannel1 != 0) ? 1 - comp(c, 1) : comp(c, 1),
              (invertChannel2 != 0) ? 1 - comp(c, 2) : comp(c, 2));
    if (colorModel > 0) c = ctransform(model, "rgb", c);
    resultRGB = clamp(c, color 0, color 1);
    RIS_CHANNELS
}
