/* PxrGeometricAOVs: what the surface is, as outputs for displays, of RIS: __Pworld, __Nworld, __st, __depth (the distance along z) and the variables at rest __Pref and __Nref. Connect resultAOV to the
   utilityPattern or inputAOV of a material. Names are those of RenderMan for Maya. */
surface PxrGeometricAOVs(varying float inputAOV = 0; output varying float resultAOV = 0) {
    point rest = 0;
    normal turned = 0;
    getvar(null, "__Pref", rest);
    getvar(null, "__Nref", turned);
    outputchannel("__Pworld", transform("world", P));
    outputchannel("__Nworld", normalize(ntransform("world", N)));
    outputchannel("__depth", zcomp(transform("camera", P)));
    outputchannel("__st", vector(s, t, 0));
    outputchannel("__Pref", rest);
    outputchannel("__Nref", turned);
    resultAOV = inputAOV;
}
