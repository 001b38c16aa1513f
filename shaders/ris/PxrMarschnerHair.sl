/* PxrMarschnerHair: light on and through a strand (Marschner et al., "Light scattering from human hair fibers", 2003), of RIS: R is
   mirrored, TT goes through, TRT is mirrored inside. For Curves. Parameters and defaults are those of Pixar's documentation.
     specularConeAngle*: spread along the strand, degrees; specularOffset: how far the scales tilt it, degrees, below 0 to the root
     specularEccentricity: 1 is round. Unlike there: glints, specularMixFresnel and energy compensation are not read; the diffuse
     part is Lambert's about the strand's side that faces the eye; shadowColor is not read. */
#include "layers.h"
surface PxrMarschnerHair(float diffuseModelType = 0; varying float diffuseGain = 0; varying color diffuseColor = .18;
                         varying float specularGainR = 1, specularGainTRT = 1, specularGainTT = 1, specularGainGLINTS = 1;
                         varying color specularColorR = 1, specularColorTRT = .4, specularColorTT = .4;
                         varying float specularConeAngleR = 8, specularConeAngleTRT = 8, specularConeAngleTT = 8, specularOffset = -3;
                         varying float specularIor = 1.55, specularMixFresnel = 1, specularGlintWidth = 10, specularEccentricity = 1;
                         varying float glowGain = 0; varying color glowColor = 1; varying float specularEnergyCompensation = 0;
                         varying normal eccentricityDirection = 0; varying color shadowColor = 0; varying float presence = 1;
                         varying float inputAOV = 0;)
{
    vector V = -normalize(I), tip = normalize(dPdv);
    float tilt = -radians(specularOffset) / 2;
    color part[3] = trace(P, tip, "distribution", "hair", "wo", V, "eta", specularIor, "type", "diffuse", "samplelights", 1, "lobeparameters",
                          {1, tilt, radians(specularConeAngleR) / .75, .3, 1, tilt, radians(specularConeAngleTT) / .75, .3,
                           1, tilt, radians(specularConeAngleTRT) / .75, .3});
    color light = specularGainR * specularColorR * part[0] + specularGainTT * specularColorTT * part[1] +
        specularGainTRT * specularColorTRT * part[2];
    if (diffuseGain > 0) light += diffuseGain * diffuseColor * diffuse(faceforward(normalize(N), I));
    Oi = presence;
    Ci = presence * (light + glowGain * glowColor);
}
