/* LamaSubsurface: light that walks below the surface, of RIS; sssRadius by channel, times sssScale, in millimetres, of which
   sssUnitLength makes scene units (.00328: feet); 0: diffuse paint. A node of others,
   too: lama.h. Not here: sssMode, sssIOR, sssAnisotropy, sssBleed and what follows surfaces. */
#include "lama.h"
surface LamaSubsurface(varying color sssColor = .18, color_ = -1, sssRadius = 0; varying float sssScale = 1; float sssMode = 0, sssUnitLength = .00328;
           varying float sssIOR = 1, sssAnisotropy = 0; varying normal sssNormal = 0, normal_ = 0; LAMA_OUT)
{
    normal none = 0;
    color paint = (comp(color_, 0) >= 0) ? color_ : sssColor, none_ = 0;
    bxdf_out_sssRadius = sssRadius * sssScale * sssUnitLength;
    if (bxdf_out_sssRadius == none_) bxdf_out_diffuse = paint;
    else bxdf_out_sss = paint;
    bxdf_out_bump = (sssNormal != none) ? sssNormal : normal_;
    LAMA_SURFACE(1)
}
