/* PxrVary: a colour that differs from object to object, of RIS. varySource 0: Attribute "identifier" "id", 1: its name, 2: the variable of the primitive, 3: the
   attribute of the name varName ("user:x"). Where it is 0 or missing nothing varies. hue, saturation, luminance and gamma limit the steps; their
   modes are 0 about the value, 1 upwards, 2 downwards. Random numbers are this program's. */
#include "rispattern.h"
surface PxrVary(varying color inputRGB = .5; float varySource = 0; string varName = ""; float varType = 0, hue = 0, saturation = 0, luminance_ = 0, gamma_ = 0, probability = 1,
                hueMode = 0, saturationMode = 0, luminanceMode = 0, gammaMode = 0, seed = 0, scaleNormalizedPrimvar = 0, verbosity = 0; RIS_RGB) {
    float x = 0;
    uniform float a = 0;
    if (varySource == 2) { if (varName != "") getvar(null, varName, x); }
    else if (varySource == 3) { if (varName != "") { attribute(varName, a); x = a; } }
    else x = risObject(varySource);
    resultRGB = inputRGB;
    float own = x + 17.3 * seed;
    if (x != 0 && risRandom(own, 5) < probability)
        resultRGB = risVaried(inputRGB, own, hue, saturation, luminance_, gamma_, hueMode, saturationMode, luminanceMode, gammaMode);
    RIS_CHANNELS
}
