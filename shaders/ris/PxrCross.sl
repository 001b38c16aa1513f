/* PxrCross: the cross product of two vectors, of RIS, of unit length unless normalizeResult is 0. */
#include "rispattern.h"
surface PxrCross(varying vector vector1 = 0, vector2 = 0; float normalizeResult = 1; RIS_XYZ) {
    resultXYZ = vector1 ^ vector2;
    if (normalizeResult != 0 && resultXYZ . resultXYZ > 0) resultXYZ = normalize(resultXYZ);
    RIS_COMPONENTS
}
