/* PxrLMLayer: a layer on the layered materials of PRMan 19 and 20, of RIS: a whole material, there by layerMask. Names are those of
   Pixar's documentation. Connect its "result" to the "lmlayer" of a PxrLMDiffuse, PxrLMPlastic, PxrLMMetal, PxrLMGlass or
   PxrLMSubsurface, or to that of a further layer, which is then below this one.
     diffuseBehavior, specularBehavior, clearcoatBehavior  0: the layer has no such lobe
   Not here: normals of its own (diffuseNn, specularNn, clearcoatNn: those of the material below count), subsurface and transmission of
   layers, clearcoatThickness and clearcoatTransmission; defaults of colours are PxrLMPlastic's, with no coat. */
#include "lmlayer.h"
surface PxrLMLayer(varying float layerMask = 1; float diffuseBehavior = 1; varying color diffuseColor = .5;
                   varying float diffuseRoughness = 0; varying color sheen = 0, incandescence = 0; varying normal diffuseNn = 0;
                   float specularBehavior = 1; varying color specularColor = 1;
                   varying float specularEta = 1.5, specularRoughness = .3, specularAnisotropy = 0; varying normal specularNn = 0;
                   float clearcoatBehavior = 1; varying color clearcoatColor = 0; varying float clearcoatRoughness = .05, clearcoatEta = 1.5;
                   varying normal clearcoatNn = 0; LM_IN(lmlayer) LM_OUT)
{
    color none = 0;
    result_layerMask = clamp(layerMask, 0, 1);
    result_diffuseColor = (diffuseBehavior != 0) ? diffuseColor : none;
    result_diffuseRoughness = diffuseRoughness;
    result_sheen = (diffuseBehavior != 0) ? sheen : none;
    result_incandescence = (diffuseBehavior != 0) ? incandescence : none;
    result_specularColor = (specularBehavior != 0) ? specularColor : none;
    result_specularRoughness = specularRoughness;
    result_specularAnisotropy = specularAnisotropy;
    result_specularEta = specularEta;
    result_clearcoatColor = (clearcoatBehavior != 0) ? clearcoatColor : none;
    result_clearcoatRoughness = clearcoatRoughness;
    result_clearcoatEta = clearcoatEta;
    LM_PUT(lmlayer, lmlayer_layerMask)
}
