/* stdrsl/IsotropicVolume.h: a medium that scatters the same in all directions. */
#ifndef STDRSL_ISOTROPICVOLUME_H
#define STDRSL_ISOTROPICVOLUME_H
#include <stdrsl/RadianceSample.h>
#include <stdrsl/Fresnel.h>
struct stdrsl_IsotropicVolume
{
    public varying color m_diffColor = 1;
    public void init(color c) { m_diffColor = c; }
    public void evalDiffuseSamps(stdrsl_ShadingContext context; stdrsl_Fresnel f; output __radiancesample samples[])
    {
        uniform float i, n = arraylength(samples);
        for (i = 0; i < n; i += 1) samples[i]->setMaterialResponse(m_diffColor * 0.5 * M_INVTWOPI, 0.5 * M_INVTWOPI);
    }
}
#endif
