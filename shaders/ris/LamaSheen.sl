/* LamaSheen: the shine of cloth and dust at the rim, of RIS: diffuse light weighted by what such a sheen reflects in all. A node of
   others, too: lama.h. */
#include "lama.h"
surface LamaSheen(varying color sheenColor = 1, color_ = -1; varying float roughness = .1; varying normal sheenNormal = 0, normal_ = 0;
                  LAMA_OUT)
{
    normal none = 0;
    bxdf_out_sheen = (comp(color_, 0) >= 0) ? color_ : sheenColor;
    bxdf_out_sheenRough = roughness;
    bxdf_out_bump = (sheenNormal != none) ? sheenNormal : normal_;
    LAMA_SURFACE(1)
}
