/* PxrLMPlastic: a diffuse body below a clear, rough surface and a coat, of RIS. Names are those of Pixar's documentation. What the
   layers reflect is taken from those below.
   Ball: Surface "ris/PxrLMPlastic" "color diffuseColor" [.1 .4 .1] */
#include "rislobes.h"
surface PxrLMPlastic(varying color diffuseColor = .5; varying float roughness = 0; varying color specularColor = 1;
                     varying float specularIor = 1.5, specularRoughness = .3, anisotropy = 0; varying color clearcoatColor = 0;
                     varying float clearcoatRoughness = .05, clearcoatIor = 1.5; varying color emissionColor = 0;
                     varying normal bumpNormal = 0; varying float presence = 1;)
{
    normal n;
    risSide(normal 0, bumpNormal, n);
    vector V = -normalize(I), along = layerTangent(n, dPdu, 0);
    color shines, none = 0;
    color shine = risSpecular(1, 1, none, specularColor, 5, color specularIor, none, specularRoughness, anisotropy, n, V, along, shines);
    color light = shine + (1 - shines) * diffuseColor * layerDiffuse(n, V, roughness, layerSamples(16));
    if (clearcoatColor != none) {
        color coat = risSpecular(1, 1, none, clearcoatColor, 5, color clearcoatIor, none, clearcoatRoughness, 0, n, V, along, shines);
        light = coat + (1 - shines) * light;
    }
    Oi = presence;
    Ci = presence * (light + emissionColor);
}
