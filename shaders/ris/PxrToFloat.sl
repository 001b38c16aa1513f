/* PxrToFloat: a number of a colour, of RIS: mode 0 red, 1 green, 2 blue, 3 mean, 4 luminance. */
#include "rispattern.h"
surface PxrToFloat(varying color input = 0; float mode = 0; output varying float resultF = 0) {
    resultF = (mode == 0) ? comp(input, 0) : (mode == 1) ? comp(input, 1) : (mode == 2) ? comp(input, 2)
            : (mode == 4) ? risLuminance(input) : (comp(input, 0) + comp(input, 1) + comp(input, 2)) / 3;
}
