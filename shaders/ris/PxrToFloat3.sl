/* PxrToFloat3: a colour of one number, or of three (inputR, inputG, inputB where connected to others), of RIS. */
#include "rispattern.h"
surface PxrToFloat3(varying float input = 0, inputR = -1e30, inputG = -1e30, inputB = -1e30; RIS_RGB) {
    resultRGB = color((inputR > -1e29) ? inputR : input, (inputG > -1e29) ? inputG : input, (inputB > -1e29) ? inputB : input);
    RIS_CHANNELS
}
