/* PxrDispVectorLayer: layers of vectors, for PxrDisplace, of RIS. Each layer is its value times its amount; layerNComp joins it to what is below: 1 add, 2 over, 3 multiply, 4 average, 5 minimum,
   6 maximum, as far as its mask says; all of it times overallAmount. A base that is not enabled is 0.
   Products, minima and maxima are those of the components. */
#include "rispattern.h"
surface PxrDispVectorLayer(varying float overallAmount = 1; float baseLayerEnabled = 1; varying float baseLayerAmount = 1; varying vector baseLayerDispVector = 0;
                           float layer1Enabled = 1; varying float layer1Amount = 1; varying vector layer1DispVector = 0; varying float layer1Mask = 1; float layer1Comp = 1;
                           float layer2Enabled = 0; varying float layer2Amount = 1; varying vector layer2DispVector = 0; varying float layer2Mask = 1; float layer2Comp = 1;
                           float layer3Enabled = 0; varying float layer3Amount = 1; varying vector layer3DispVector = 0; varying float layer3Mask = 1; float layer3Comp = 1;
                           float layer4Enabled = 0; varying float layer4Amount = 1; varying vector layer4DispVector = 0; varying float layer4Mask = 1; float layer4Comp = 1;
                           RIS_XYZ) {
    float one(float below, value, way;) {
        return (way == 2) ? value : (way == 3) ? below * value : (way == 4) ? (below + value) / 2 : (way == 5) ? min(below, value) : (way == 6) ? max(below, value) : below + value;
    }
    vector joined(vector below, value; float mask, way;) {
        vector both = vector(one(xcomp(below), xcomp(value), way), one(ycomp(below), ycomp(value), way), one(zcomp(below), zcomp(value), way));
        return mix(below, both, mask);
    }
    resultXYZ = (baseLayerEnabled != 0) ? baseLayerAmount * baseLayerDispVector : vector(0, 0, 0);
    if (layer1Enabled != 0) resultXYZ = joined(resultXYZ, layer1Amount * layer1DispVector, layer1Mask, layer1Comp);
    if (layer2Enabled != 0) resultXYZ = joined(resultXYZ, layer2Amount * layer2DispVector, layer2Mask, layer2Comp);
    if (layer3Enabled != 0) resultXYZ = joined(resultXYZ, layer3Amount * layer3DispVector, layer3Mask, layer3Comp);
    if (layer4Enabled != 0) resultXYZ = joined(resultXYZ, layer4Amount * layer4DispVector, layer4Mask, layer4Comp);
    resultXYZ *= overallAmount;
    RIS_COMPONENTS
}
