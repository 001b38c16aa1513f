/* PxrDispTransform: makes heights and vectors of maps into displacement, of RIS. dispType 1 scalar, 2 vector in object space, 3 world, 4 tangent (x dPdu, y normal, z dPdv); 5 and 6 are 4 with
   y and z, or x and z, the other way round. dispRemapMode 1: heights are centred about dispCenter; 2: those above it times dispHeight, those below times dispDepth; 3 the same, between 0 and 1.
   vectorSpace of versions before 22. */
#include "rispattern.h"
surface PxrDispTransform(varying float dispScalar = 0, dispHeight = .1, dispDepth = .1, dispCenter = .5; varying vector dispVector = 0; float dispType = 1, vectorSpace = 1, dispRemapMode = 1;
                         output varying float resultF = 0; output varying vector resultXYZ = 0; output varying color resultRGB = 0) {
    float h = dispScalar;
    if (dispRemapMode == 2 || dispRemapMode == 3) {
        float x = h - dispCenter;
        h = x * ((x > 0) ? dispHeight : dispDepth) / max((x > 0) ? 1 - dispCenter : dispCenter, 1e-4);
    } else {
        h *= dispHeight;
    }
    resultF = (dispType == 1) ? h : 0;
    vector v = dispVector * dispHeight;
    if (dispType == 3) v = vtransform("world", "shader", v);
    if (dispType >= 4) {
        vector T = normalize(dPdu), B = normalize(dPdv), n = vector normalize(N);
        float x = xcomp(v), y = ycomp(v), z = zcomp(v);
        v = vtransform("shader", (dispType == 5) ? x * T + z * n + y * B : (dispType == 6) ? z * T + y * n + x * B : x * T + y * n + z * B);
    }
    resultXYZ = (dispType == 1) ? vector(0, 0, 0) : v;
    resultRGB = color(xcomp(resultXYZ), ycomp(resultXYZ), zcomp(resultXYZ));
}
