/* stdrsl/OrenNayar.h: a rough surface without gloss, in the short form of the model (SIGGRAPH 1994); sigma in radians. */
#ifndef STDRSL_ORENNAYAR_H
#define STDRSL_ORENNAYAR_H
#include <stdrsl/Lambert.h>
struct stdrsl_OrenNayar : stdrsl_Lambert
{
    public varying float m_sigma = 0;

    public void init(color c; float sigma) { m_diffColor = c; m_sigma = sigma; }
    public void init(stdrsl_ShadingContext context; color c; float sigma; uniform float fewest, most)
    {
        stdrsl_Lambert::init(context, c, fewest, most);
        m_sigma = sigma;
    }
    public void evalDiffuseSamps(stdrsl_ShadingContext context; stdrsl_Fresnel f; output __radiancesample samples[])
    {
        float s2 = m_sigma * m_sigma;
        float a = 1 - 0.5 * s2 / (s2 + 0.33), b = 0.45 * s2 / (s2 + 0.09);
        vector v = context->m_Vn;
        float nv = clamp(context->m_Ns . v, 0, 1);
        uniform float i, n = arraylength(samples);
        for (i = 0; i < n; i += 1) {
            vector l = samples[i]->direction;
            float nl = clamp(context->m_Ns . l, 0, 1);
            float between = max(0, l . v - nl * nv); /* sines of both angles times the cosine of the turn between them */
            float most = max(nl, nv);
            float k = (most > 0) ? a + b * between / most : a;
            samples[i]->setMaterialResponse(m_diffColor * k * nl * M_INVPI, nl * M_INVPI);
        }
    }
}
#endif
