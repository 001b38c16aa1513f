/* Layers on the layered materials of PRMan 19 and 20 (ris/PxrLMDiffuse and its kin). A layer is a struct of parameters: PxrLMLayer and
   PxrLMMixer give it as "result", materials take it as "lmlayer". It covers what is below by layerMask; layers over each other become
   one, each of whose values is the mean of theirs by what is seen of them. */
#ifndef LMLAYER_H
#define LMLAYER_H
#include "rislobes.h"
#define LM_IN(S) \
    varying float S##_layerMask = 0; varying color S##_diffuseColor = 0; varying float S##_diffuseRoughness = 0; \
    varying color S##_sheen = 0, S##_incandescence = 0, S##_specularColor = 0; \
    varying float S##_specularRoughness = .3, S##_specularAnisotropy = 0, S##_specularEta = 1.5; \
    varying color S##_clearcoatColor = 0; varying float S##_clearcoatRoughness = .05, S##_clearcoatEta = 1.5;
#define LM_OUT \
    output varying float result_layerMask = 0; output varying color result_diffuseColor = 0; \
    output varying float result_diffuseRoughness = 0; output varying color result_sheen = 0; \
    output varying color result_incandescence = 0; output varying color result_specularColor = 0; \
    output varying float result_specularRoughness = .3; output varying float result_specularAnisotropy = 0; \
    output varying float result_specularEta = 1.5; output varying color result_clearcoatColor = 0; \
    output varying float result_clearcoatRoughness = .05; output varying float result_clearcoatEta = 1.5
#define LM_MEAN(S, value, share) result_##value += (S##_##value - result_##value) * share
/* The result with layer S, of that mask, over it. */
#define LM_PUT(S, mask) { \
    float over_ = clamp(mask, 0, 1), all_ = over_ + (1 - over_) * result_layerMask, share_ = (all_ > 0) ? over_ / all_ : 0; \
    result_layerMask = all_; \
    LM_MEAN(S, diffuseColor, share_); LM_MEAN(S, diffuseRoughness, share_); LM_MEAN(S, sheen, share_); \
    LM_MEAN(S, incandescence, share_); LM_MEAN(S, specularColor, share_); LM_MEAN(S, specularRoughness, share_); \
    LM_MEAN(S, specularAnisotropy, share_); LM_MEAN(S, specularEta, share_); LM_MEAN(S, clearcoatColor, share_); \
    LM_MEAN(S, clearcoatRoughness, share_); LM_MEAN(S, clearcoatEta, share_); }
/* Light of a layer that covers all: what its coat and its facets reflect is taken from what is below them. */
color lmLight(color diffuseColor; float diffuseRoughness; color sheen, specularColor; float specularRoughness, anisotropy, eta;
              color clearcoatColor; float clearcoatRoughness, clearcoatEta; normal n; vector V)
{
    color none = 0, shines, light = diffuseColor * layerDiffuse(n, V, diffuseRoughness, 1);
    if (sheen != none) light += sheen * layerSheen(n . V, .3) * diffuse(n);
    if (specularColor != none) {
        color shine = risSpecular(1, 1, none, specularColor, 5, color eta, none, specularRoughness, anisotropy, n, V,
                                  layerAlong(anisotropy, n), shines);
        light = shine + (1 - shines) * light;
    }
    if (clearcoatColor != none) {
        color coat = risSpecular(1, 1, none, clearcoatColor, 5, color clearcoatEta, none, clearcoatRoughness, 0, n, V,
                                 layerAlong(0, n), shines);
        light = coat + (1 - shines) * light;
    }
    return light;
}
/* Puts "lmlayer" over the light of a material with that normal and direction to the viewer. */
#define LM_COVER(light, n, V) \
    if (lmlayer_layerMask > 0) { \
        float over_ = clamp(lmlayer_layerMask, 0, 1); \
        light = (1 - over_) * light + over_ * (lmlayer_incandescence + \
            lmLight(lmlayer_diffuseColor, lmlayer_diffuseRoughness, lmlayer_sheen, lmlayer_specularColor, lmlayer_specularRoughness, \
                    lmlayer_specularAnisotropy, lmlayer_specularEta, lmlayer_clearcoatColor, lmlayer_clearcoatRoughness, \
                    lmlayer_clearcoatEta, n, V)); \
    }
#endif
