/* Parameters and body of ris/PxrSurface and ris/PxrLayerSurface, from the parameter list on. Include rislobes.h before. */
(float utilityPattern = 0;
 varying float diffuseGain = 1; varying color diffuseColor = .18; varying float diffuseRoughness = 0, diffuseExponent = 1;
 varying normal diffuseBumpNormal = 0; float diffuseDoubleSided = 0, diffuseBackUseDiffuseColor = 1;
 varying color diffuseBackColor = .18; varying float diffuseTransmitGain = 0; varying color diffuseTransmitColor = .18;
 float specularFresnelMode = 0; varying color specularFaceColor = 0, specularEdgeColor = 0; varying float specularFresnelShape = 5;
 varying color specularIor = 1.5, specularExtinctionCoeff = 0; varying float specularRoughness = .2; float specularModelType = 0;
 varying float specularAnisotropy = 0; varying vector specularAnisotropyDirection = 0; varying normal specularBumpNormal = 0;
 float specularDoubleSided = 0;
 float roughSpecularFresnelMode = 0; varying color roughSpecularFaceColor = 0, roughSpecularEdgeColor = 0;
 varying float roughSpecularFresnelShape = 5; varying color roughSpecularIor = 1.5, roughSpecularExtinctionCoeff = 0;
 varying float roughSpecularRoughness = .6; float roughSpecularModelType = 0; varying float roughSpecularAnisotropy = 0;
 varying vector roughSpecularAnisotropyDirection = 0; varying normal roughSpecularBumpNormal = 0; float roughSpecularDoubleSided = 0;
 float clearcoatFresnelMode = 0; varying color clearcoatFaceColor = 0, clearcoatEdgeColor = 0; varying float clearcoatFresnelShape = 5;
 varying color clearcoatIor = 1.5, clearcoatExtinctionCoeff = 0; varying float clearcoatThickness = 0;
 varying color clearcoatAbsorptionTint = 0; varying float clearcoatRoughness = 0; float clearcoatModelType = 0;
 varying float clearcoatAnisotropy = 0; varying vector clearcoatAnisotropyDirection = 0; varying normal clearcoatBumpNormal = 0;
 float clearcoatDoubleSided = 0; varying float specularEnergyCompensation = 0, clearcoatEnergyCompensation = 0;
 varying float iridescenceFaceGain = 0, iridescenceEdgeGain = 0, iridescenceFresnelShape = 5; float iridescenceMode = 0;
 varying color iridescencePrimaryColor = color(1, 0, 0), iridescenceSecondaryColor = color(0, 0, 1);
 varying float iridescenceRoughness = .2, iridescenceAnisotropy = 0; varying vector iridescenceAnisotropyDirection = 0;
 varying normal iridescenceBumpNormal = 0; varying float iridescenceCurve = 1, iridescenceScale = 1; float iridescenceFlip = 0;
 varying float iridescenceThickness = 800; float iridescenceDoubleSided = 0;
 varying float fuzzGain = 0; varying color fuzzColor = 1; varying float fuzzConeAngle = 8; varying normal fuzzBumpNormal = 0;
 float fuzzDoubleSided = 0;
 float subsurfaceType = 0; varying float subsurfaceGain = 0; varying color subsurfaceColor = color(.83, .791, .753);
 varying float subsurfaceDmfp = 10; varying color subsurfaceDmfpColor = color(.851, .557, .395);
 varying float shortSubsurfaceGain = 0; varying color shortSubsurfaceColor = .9; varying float shortSubsurfaceDmfp = 5;
 varying float longSubsurfaceGain = 0; varying color longSubsurfaceColor = color(.8, 0, 0); varying float longSubsurfaceDmfp = 20;
 varying float subsurfaceDirectionality = 0, subsurfaceBleed = 0, subsurfaceDiffuseBlend = 0;
 float subsurfaceResolveSelfIntersections = 0; varying float subsurfaceIor = 1.4; varying color subsurfacePostTint = 1;
 varying float subsurfaceDiffuseSwitch = 1; float subsurfaceDoubleSided = 0; varying float subsurfaceTransmitGain = 0;
 float considerBackside = 1, continuationRayMode = 0, maxContinuationHits = 2, followTopology = 0; string subsurfaceSubset = "";
 varying float singlescatterGain = 0; varying color singlescatterColor = color(.83, .791, .753); varying float singlescatterMfp = 10;
 varying color singlescatterMfpColor = color(.851, .557, .395);
 varying float singlescatterDirectionality = 0, singlescatterIor = 1.3, singlescatterBlur = 0, singlescatterDirectGain = 0;
 varying color singlescatterDirectGainTint = 1;
 float singlescatterDoubleSided = 0, singlescatterConsiderBackside = 1, singlescatterContinuationRayMode = 0,
     singlescatterMaxContinuationHits = 2, singlescatterDirectGainMode = 0;
 string singlescatterSubset = ""; varying color irradianceTint = 1; varying float irradianceRoughness = 0; float unitLength = .1;
 varying float refractionGain = 0, reflectionGain = 0; varying color refractionColor = 1;
 varying float glassRoughness = .1, glassRefractionRoughness = -1, glassAnisotropy = 0; varying vector glassAnisotropyDirection = 0;
 varying normal glassBumpNormal = 0; varying float glassIor = 1.5; float mwWalkable = 0, mwIor = -1, thinGlass = 0;
 float ignoreFresnel = 0, ignoreAccumOpacity = 0, blocksVolumes = 0; varying color ssAlbedo = 0, extinction = 0; varying float g = 0;
 float multiScatter = 0, enableOverlappingVolumes = 0; varying float glowGain = 0; varying color glowColor = 1;
 varying normal bumpNormal = 0; float shadowBumpTerminator = 0; varying color shadowColor = 0; float shadowMode = 0;
 varying float presence = 1; float presenceCached = 1, mwStartable = 0, roughnessMollificationClamp = 32; varying color userColor = 0;)
{
    color light = 0, black = 0, white = 1, shines, below;
    normal nd, ns, nr, nc, nf, ng, ni;
    float front = risSide(diffuseBumpNormal, bumpNormal, nd);
    vector V = -normalize(I);

    /* From the bottom: diffuse, and what walks below the surface. */
    if (diffuseGain > 0) {
        color front_ = diffuseGain * diffuseColor;
        if (front == 0 && diffuseBackUseDiffuseColor == 0) front_ = diffuseGain * diffuseBackColor;
        if (subsurfaceGain > 0) front_ *= mix(1, 1 - subsurfaceGain, subsurfaceDiffuseBlend);
        light += front_ * layerDiffuse(nd, V, diffuseRoughness, 1);
    }
    if (diffuseTransmitGain > 0) light += diffuseTransmitGain * diffuseTransmitColor * diffuse(-nd);
    if (subsurfaceGain > 0)
        light += subsurfaceGain * subsurfacePostTint *
            risSubsurface(subsurfaceColor, subsurfaceDmfp * subsurfaceDmfpColor * unitLength, subsurfaceDirectionality, subsurfaceIor);
    if (shortSubsurfaceGain > 0)
        light += shortSubsurfaceGain * risSubsurface(shortSubsurfaceColor, white * (shortSubsurfaceDmfp * unitLength), 0, subsurfaceIor);
    if (longSubsurfaceGain > 0)
        light += longSubsurfaceGain * risSubsurface(longSubsurfaceColor, white * (longSubsurfaceDmfp * unitLength), 0, subsurfaceIor);
    if (singlescatterGain > 0)
        light += singlescatterGain * risSubsurface(singlescatterColor, singlescatterMfp * singlescatterMfpColor * unitLength,
                                                   singlescatterDirectionality, singlescatterIor);
    if (fuzzGain > 0) {
        risSide(fuzzBumpNormal, bumpNormal, nf);
        light += fuzzGain * fuzzColor * layerSheen(nf . V, clamp(fuzzConeAngle / 40, .1, 1)) * diffuse(nf);
    }
    /* Glass stands in place of what is below by as much as it lets through. */
    if (refractionGain > 0 || reflectionGain > 0) {
        color glass, mirror = reflectionGain, through = refractionGain * refractionColor;
        float gf = risSide(glassBumpNormal, bumpNormal, ng), gx, gy, rx, ry;
        float own = (glassRefractionRoughness < 0) ? glassRoughness : glassRefractionRoughness;
        layerWidths(glassRoughness * glassRoughness, glassAnisotropy, gx, gy);
        layerWidths(own * own, glassAnisotropy, rx, ry);
        vector gu = risAlong(glassAnisotropy, glassAnisotropyDirection, ng);
        if (own != glassRoughness) { /* each by itself */
            if (thinGlass == 1)
                glass = layerSheet(ng, V, gu, gx, gy, glassIor, 1, mirror, black) +
                    layerSheet(ng, V, gu, rx, ry, glassIor, 1, black, through);
            else
                glass = layerGlass(ng, gf, V, gu, gx, gy, glassIor, 1, mirror, black) +
                    layerGlass(ng, gf, V, gu, rx, ry, glassIor, 1, black, through);
        } else if (thinGlass == 1)
            glass = layerSheet(ng, V, gu, gx, gy, glassIor, 1, mirror, through);
        else
            glass = layerGlass(ng, gf, V, gu, gx, gy, glassIor, 1, mirror, through);
        light = (1 - clamp(refractionGain, 0, 1)) * light + glass;
    }
    /* Reflections: rough, iridescent, primary, coat. Each takes from what is below by its part of specularEnergyCompensation. */
    below = white;
    if (max(comp(roughSpecularFaceColor, 0), comp(roughSpecularFaceColor, 1), comp(roughSpecularFaceColor, 2),
            comp(roughSpecularEdgeColor, 0), comp(roughSpecularEdgeColor, 1), comp(roughSpecularEdgeColor, 2)) > 0) {
        risSide(roughSpecularBumpNormal, bumpNormal, nr);
        color rough = risSpecular(roughSpecularFresnelMode, roughSpecularModelType, roughSpecularFaceColor, roughSpecularEdgeColor,
                                  roughSpecularFresnelShape, roughSpecularIor, roughSpecularExtinctionCoeff, roughSpecularRoughness,
                                  roughSpecularAnisotropy, nr, V, risAlong(roughSpecularAnisotropy, roughSpecularAnisotropyDirection, nr), shines);
        light = rough + light * (1 - specularEnergyCompensation * shines);
    }
    if (iridescenceFaceGain > 0 || iridescenceEdgeGain > 0) {
        risSide(iridescenceBumpNormal, bumpNormal, ni);
        float turn = pow(1 - ni . V, iridescenceCurve) * iridescenceScale;
        color hue = mix(iridescencePrimaryColor, iridescenceSecondaryColor, mod(turn, 1.0001));
        if (iridescenceFlip == 1) hue = mix(iridescenceSecondaryColor, iridescencePrimaryColor, mod(turn, 1.0001));
        color film = risSpecular(0, 1, iridescenceFaceGain * hue, iridescenceEdgeGain * hue, iridescenceFresnelShape, black, black,
                                 iridescenceRoughness, iridescenceAnisotropy, ni, V, risAlong(iridescenceAnisotropy, iridescenceAnisotropyDirection, ni),
                                 shines);
        light = film + light * (1 - specularEnergyCompensation * shines);
    }
    if (max(comp(specularFaceColor, 0), comp(specularFaceColor, 1), comp(specularFaceColor, 2), comp(specularEdgeColor, 0),
            comp(specularEdgeColor, 1), comp(specularEdgeColor, 2)) > 0) {
        risSide(specularBumpNormal, bumpNormal, ns);
        color primary = risSpecular(specularFresnelMode, specularModelType, specularFaceColor, specularEdgeColor,
                                    specularFresnelShape, specularIor, specularExtinctionCoeff, specularRoughness,
                                    specularAnisotropy, ns, V, risAlong(specularAnisotropy, specularAnisotropyDirection, ns), shines);
        light = primary + light * (1 - specularEnergyCompensation * shines);
    }
    if (max(comp(clearcoatFaceColor, 0), comp(clearcoatFaceColor, 1), comp(clearcoatFaceColor, 2), comp(clearcoatEdgeColor, 0),
            comp(clearcoatEdgeColor, 1), comp(clearcoatEdgeColor, 2)) > 0) {
        risSide(clearcoatBumpNormal, bumpNormal, nc);
        color coat = risSpecular(clearcoatFresnelMode, clearcoatModelType, clearcoatFaceColor, clearcoatEdgeColor,
                                 clearcoatFresnelShape, clearcoatIor, clearcoatExtinctionCoeff, clearcoatRoughness,
                                 clearcoatAnisotropy, nc, V, risAlong(clearcoatAnisotropy, clearcoatAnisotropyDirection, nc), shines);
        if (clearcoatThickness > 0 && clearcoatAbsorptionTint != black)
            below = layerPower(max(clearcoatAbsorptionTint, color 1e-4), clearcoatThickness / max(nc . V, .1));
        light = coat + below * light * (1 - clearcoatEnergyCompensation * shines);
    }
    color solid = presence; /* shadows keep what is not shadowColor */
    if (shadowColor != black) solid *= 1 - isshadowray() * clamp(shadowColor, black, white);
    Oi = solid;
    Ci = presence * (light + glowGain * glowColor);
}
