/* PxrDispScalarLayer: layers of heights, for PxrDisplace, of RIS. Each layer is its value times its amount; layerNComp joins it to what is below: 1 add, 2 over, 3 multiply, 4 average, 5 minimum,
   6 maximum, as far as its mask says; all of it times overallAmount. A base that is not enabled is 0. */
surface PxrDispScalarLayer(varying float overallAmount = 1; float baseLayerEnabled = 1; varying float baseLayerAmount = 1, baseLayerDispScalar = 0;
                           float layer1Enabled = 1; varying float layer1Amount = 1; varying float layer1DispScalar = 0; varying float layer1Mask = 1; float layer1Comp = 1;
                           float layer2Enabled = 0; varying float layer2Amount = 1; varying float layer2DispScalar = 0; varying float layer2Mask = 1; float layer2Comp = 1;
                           float layer3Enabled = 0; varying float layer3Amount = 1; varying float layer3DispScalar = 0; varying float layer3Mask = 1; float layer3Comp = 1;
                           float layer4Enabled = 0; varying float layer4Amount = 1; varying float layer4DispScalar = 0; varying float layer4Mask = 1; float layer4Comp = 1;
                           output varying float resultF = 0) {
    float joined(float below, value, mask, way;) {
        float both = (way == 2) ? value : (way == 3) ? below * value : (way == 4) ? (below + value) / 2 : (way == 5) ? min(below, value) : (way == 6) ? max(below, value) : below + value;
        return mix(below, both, mask);
    }
    resultF = (baseLayerEnabled != 0) ? baseLayerAmount * baseLayerDispScalar : 0;
    if (layer1Enabled != 0) resultF = joined(resultF, layer1Amount * layer1DispScalar, layer1Mask, layer1Comp);
    if (layer2Enabled != 0) resultF = joined(resultF, layer2Amount * layer2DispScalar, layer2Mask, layer2Comp);
    if (layer3Enabled != 0) resultF = joined(resultF, layer3Amount * layer3DispScalar, layer3Mask, layer3Comp);
    if (layer4Enabled != 0) resultF = joined(resultF, layer4Amount * layer4DispScalar, layer4Mask, layer4Comp);
    resultF *= overallAmount;
}
