/* PxrLMPlastic: a diffuse body below a clear, rough surface and a coat, of RIS. Names are those of Pixar's documentation. What the
   layers reflect is taken from those below.
     clearcoatThickness, clearcoatTransmission  what is left of light after one unit of thickness, straight down and back
     lmlayer  a layer on top (PxrLMLayer)
   Ball: Surface "ris/PxrLMPlastic" "color diffuseColor" [.1 .4 .1] */
#include "lmlayer.h"
surface PxrLMPlastic(varying color diffuseColor = .5; varying float diffuseRoughness = 0; varying color sheen = 0, translucence = 0;
                     varying color specularColor = 1; varying float specularEta = 1.5, specularRoughness = .3, specularAnisotropy = 0;
                     varying color clearcoatColor = 0; varying float clearcoatRoughness = .05, clearcoatEta = 1.5, clearcoatThickness = 0;
                     varying color clearcoatTransmission = 1, emission = 0;
                     varying normal diffuseNn = 0, specularNn = 0, clearcoatNn = 0; varying float presence = 1, inputAOV = 0; LM_IN(lmlayer))
{
    normal n, nShine, nCoat;
    risSide(normal 0, diffuseNn, n);
    risSide(normal 0, specularNn, nShine);
    risSide(normal 0, clearcoatNn, nCoat);
    vector V = -normalize(I), along = layerAlong(specularAnisotropy, nShine);
    color shines, none = 0, body = diffuseColor * layerDiffuse(n, V, diffuseRoughness, 1);
    if (translucence != none) body += translucence * diffuse(-n);
    if (sheen != none) body += sheen * layerSheen(n . V, .3) * diffuse(n);
    color shine =
        risSpecular(1, 1, none, specularColor, 5, color specularEta, none, specularRoughness, specularAnisotropy, nShine, V, along, shines);
    color light = shine + (1 - shines) * body;
    if (clearcoatColor != none) {
        color coat = risSpecular(1, 1, none, clearcoatColor, 5, color clearcoatEta, none, clearcoatRoughness, 0, nCoat, V, along, shines);
        color left = clearcoatThickness > 0 ? layerPower(clamp(clearcoatTransmission, color 1e-4, color 1), 2 * clearcoatThickness) : color 1;
        light = coat + (1 - shines) * left * light;
    }
    light += emission;
    LM_COVER(light, n, V)
    Oi = presence;
    Ci = presence * light;
}
