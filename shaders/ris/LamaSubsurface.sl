/* LamaSubsurface: light that walks below the surface, of RIS; sssRadius by channel, times sssScale, in scene units. A node of others,
   too: lama.h. Not here: sssMode, sssIOR, sssAnisotropy, sssBleed and what follows surfaces. */
#include "lama.h"
surface LamaSubsurface(varying color sssColor = .18, color_ = -1, sssRadius = 1; varying float sssScale = 1; float sssMode = 0, sssUnitLength = 1;
           varying float sssIOR = 1.3, sssAnisotropy = 0; varying normal sssNormal = 0, normal_ = 0; LAMA_OUT)
{
    normal none = 0;
    bxdf_out_sss = (comp(color_, 0) >= 0) ? color_ : sssColor;
    bxdf_out_sssRadius = sssRadius * sssScale * sssUnitLength;
    bxdf_out_bump = (sssNormal != none) ? sssNormal : normal_;
    LAMA_SURFACE(1)
}
