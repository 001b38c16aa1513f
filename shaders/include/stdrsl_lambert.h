/* stdrsl/Lambert.h: a surface that reflects the same in all directions. */
#ifndef STDRSL_LAMBERT_H
#define STDRSL_LAMBERT_H
#include <stdrsl/RadianceSample.h>
#include <stdrsl/Fresnel.h>
struct stdrsl_Lambert
{
    public varying color m_diffColor = 1;
    public uniform float m_sampleCount = 0;

    public void init(color c) { m_diffColor = c; }
    public void init(stdrsl_ShadingContext context; color c; uniform float fewest, most)
    {
        m_diffColor = c;
        m_sampleCount = 0;
        if (most > 0) context->m_SampleMgr->computeMaterialSamples(fewest, most, m_sampleCount);
    }
    public void evalDiffuseSamps(stdrsl_ShadingContext context; stdrsl_Fresnel f; output __radiancesample samples[])
    {
        uniform float i, n = arraylength(samples);
        for (i = 0; i < n; i += 1) {
            float pdf = max(0, context->m_Ns . samples[i]->direction) * M_INVPI;
            samples[i]->setMaterialResponse(m_diffColor * pdf, pdf);
        }
    }
    public void genDiffuseSamps(stdrsl_ShadingContext context; stdrsl_Fresnel f; output __radiancesample samples[])
    {
        uniform float i, first = arraylength(samples);
        resize(samples, first + m_sampleCount);
        for (i = 0; i < m_sampleCount; i += 1) {
            float a = M_TWOPI * random(), r = random();
            vector across = sqrt(r) * (cos(a) * context->m_Tangent + sin(a) * context->m_Bitangent);
            vector d = normalize(across + sqrt(1 - r) * vector(context->m_Ns));
            float pdf = max(0, context->m_Ns . d) * M_INVPI;
            samples[first + i]->direction = d;
            samples[first + i]->setMaterialResponse(m_diffColor * pdf, pdf);
        }
    }
}
#endif
