/* PxrBlackBody: the colour of a black body of so many kelvins, relative to that of 6500, of RIS. */
#include "rispattern.h"
#include "rislight.h"
surface PxrBlackBody(varying float temperature = 6500, intensity = 1; RIS_RGB) {
    resultRGB = intensity * risBlackbody(temperature) / risBlackbody(6500);
    RIS_CHANNELS
}
