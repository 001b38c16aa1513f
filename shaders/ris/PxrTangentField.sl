/* PxrTangentField: directions along the surface for anisotropic lobes, of RIS: dPdu turned about the normal by 360 degrees times inputRotation times rotationRange plus rotationOffset degrees; where inputVector is
   not 0, by the angle of its red and green from red, which centeredVectors 1 takes from 0 to 1 as from -1 to 1. A rotation that is not 0 comes first. In the current space. */
#include "rispattern.h"
surface PxrTangentField(varying float inputRotation = 0; varying color inputVector = 0; varying float rotationOffset = 0, rotationRange = 1; float centeredVectors = 1; RIS_XYZ) {
    vector n = vector normalize(N), T = dPdu - (dPdu . n) * n;
    T = normalize((T . T > 0) ? T : dPdv ^ n);
    float angle = 2 * PI * inputRotation * rotationRange;
    if (inputRotation == 0 && inputVector != color(0)) {
        float x = comp(inputVector, 0), y = comp(inputVector, 1);
        if (centeredVectors != 0) {
            x = 2 * x - 1;
            y = 2 * y - 1;
        }
        angle = rotationRange * atan(y, x);
    }
    angle += radians(rotationOffset);
    vector B = n ^ T;
    if (B . dPdv < 0) B = -B;
    resultXYZ = cos(angle) * T + sin(angle) * B;
    RIS_COMPONENTS
}
