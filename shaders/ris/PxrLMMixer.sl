/* PxrLMMixer: layers of the layered materials of PRMan 19 and 20 over each other, of RIS: baselayer, and over it layer1 to layer4, each by
   its own layerMask times layer1Mask and so on, where it is enabled. Connect what PxrLMLayer gives ("reference struct layer1"
   ["a:result"]), and the "result" of this one to the "lmlayer" of a material. Names are those of PxrLayerMixer, its successor: Pixar's page
   on this node is not at hand. Not here: layers beyond the fourth, and what PxrLMLayer leaves out. */
#include "lmlayer.h"
surface PxrLMMixer(float baselayerEnabled = 1, layer1Enabled = 1, layer2Enabled = 1, layer3Enabled = 1, layer4Enabled = 1;
                   varying float layer1Mask = 1, layer2Mask = 1, layer3Mask = 1, layer4Mask = 1;
                   LM_IN(baselayer) LM_IN(layer1) LM_IN(layer2) LM_IN(layer3) LM_IN(layer4) LM_OUT)
{
    if (baselayerEnabled != 0) LM_PUT(baselayer, baselayer_layerMask)
    if (layer1Enabled != 0) LM_PUT(layer1, layer1_layerMask * layer1Mask)
    if (layer2Enabled != 0) LM_PUT(layer2, layer2_layerMask * layer2Mask)
    if (layer3Enabled != 0) LM_PUT(layer3, layer3_layerMask * layer3Mask)
    if (layer4Enabled != 0) LM_PUT(layer4, layer4_layerMask * layer4Mask)
}
