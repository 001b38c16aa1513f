/* LamaDiffuse: diffuse reflection, rough by `roughness`, of RIS. Names are those of Pixar's documentation (color_ and normal_ are
   the ones that RSL has for itself). A node of others, too: lama.h. */
#include "lama.h"
surface LamaDiffuse(varying color diffuseColor = .18, color_ = -1; varying float roughness = 0;
                    varying normal diffuseNormal = 0, normal_ = 0; LAMA_OUT)
{
    normal none = 0;
    bxdf_out_diffuse = (comp(color_, 0) >= 0) ? color_ : diffuseColor;
    bxdf_out_diffuseRough = roughness;
    bxdf_out_bump = (diffuseNormal != none) ? diffuseNormal : normal_;
    LAMA_SURFACE(1)
}
