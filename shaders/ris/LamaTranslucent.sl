/* LamaTranslucent: diffuse light through a thin surface, of RIS. A node of others, too: lama.h. */
#include "lama.h"
surface LamaTranslucent(varying color translucentColor = .18, color_ = -1; varying float roughness = 0;
                        varying normal translucentNormal = 0, normal_ = 0; LAMA_OUT)
{
    normal none = 0;
    bxdf_out_translucent = (comp(color_, 0) >= 0) ? color_ : translucentColor;
    bxdf_out_bump = (translucentNormal != none) ? translucentNormal : normal_;
    LAMA_SURFACE(1)
}
