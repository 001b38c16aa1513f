/* LamaLayer: a node over another, which gets the light that the upper one neither reflects nor spreads, of RIS: lama.h. What a
   LamaDielectric at the top lets through is the node below, tinted. topThickness is not read. */
#include "lama.h"
surface LamaLayer(LAMA_IN(materialTop) LAMA_IN(materialBase) varying float topMix = 1, topThickness = 0; LAMA_OUT)
{
    normal n;
    risSide(normal 0, materialTop_bump, n);
    color zero = 0, one = 1, tint = one, through = materialTop_through;
    if (through != zero) tint = mix(one, through, topMix);
    color left = tint * clamp(one - topMix * LAMA_ALBEDO(materialTop, (n . -normalize(I))), zero, one);
    LAMA_ADD(materialTop, topMix, materialBase, left)
    bxdf_out_through = left * materialBase_through;
    LAMA_SURFACE(1)
}
