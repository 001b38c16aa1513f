/* stdrsl/SpecularAS.h: the glossy lobe of Ashikhmin and Shirley (2000) about two axes. roughness 0.001 is sharp, 1 is wide. */
#ifndef STDRSL_SPECULARAS_H
#define STDRSL_SPECULARAS_H
#include <stdrsl_facetsamples.h>
struct stdrsl_SpecularAS
{
    public varying color m_specColor = 1;
    public varying float m_roughValueU = 100; /* exponents */
    public varying float m_roughValueV = 100;
    public uniform float m_sampleCount = 0;

    public void init(stdrsl_ShadingContext context; color c; float roughness, anisotropy, roughscale; uniform float fewest, most)
    {
        m_specColor = c;
        float r = max(1e-4, roughness * roughscale);
        float k = clamp(anisotropy, -0.99, 0.99);
        m_roughValueU = clamp(1 / r * (1 + k), 0, 1e6);
        m_roughValueV = clamp(1 / r * (1 - k), 0, 1e6);
        m_sampleCount = 0;
        if (most > 0) context->m_SampleMgr->computeMaterialSamples(fewest, most, m_sampleCount);
    }
    public void init(stdrsl_ShadingContext context; color c; float roughness, anisotropy, roughscale)
    {
        init(context, c, roughness, anisotropy, roughscale, 0, 0);
    }
    /* For roughness that was sent along the ray: never sharper than what the ray came from; below 0 none was sent. `sent` is for the
       rays that go on. */
    public void initWithDownstreamRoughness(float received; stdrsl_ShadingContext context; color c; float roughness, anisotropy;
                                            uniform float fewest, most; output float sent)
    {
        sent = max(roughness, received);
        init(context, c, sent, anisotropy, 1, fewest, most);
    }
    void stdrsl_answer(stdrsl_ShadingContext context; vector l; output color answer; output float pdf)
    {
        vector n = vector(context->m_Ns), v = context->m_Vn;
        answer = 0;
        pdf = 0;
        float nl = n . l, nv = n . v;
        if (nl > 0 && nv > 0) {
            vector h = normalize(l + v);
            float nh = n . h, lh = l . h;
            float hu = h . context->m_Tangent, hv = h . context->m_Bitangent;
            float away = 1 - nh * nh;
            float e = (away > 0) ? (m_roughValueU * hu * hu + m_roughValueV * hv * hv) / away : 0;
            float lobe = sqrt((m_roughValueU + 1) * (m_roughValueV + 1)) * pow(nh, e);
            if (lh > 0) {
                answer = m_specColor * (lobe * nl / (4 * M_TWOPI * lh * max(nl, nv)));
                pdf = lobe / (4 * M_TWOPI * lh);
            }
        }
    }
    STDRSL_FACET_SAMPLES
    public void genSpecularSamps(stdrsl_ShadingContext context; stdrsl_Fresnel f; string type; output __radiancesample samples[])
    {
        uniform float i, first = arraylength(samples);
        resize(samples, first + m_sampleCount);
        for (i = 0; i < m_sampleCount; i += 1) {
            float turn = M_TWOPI * random();
            float a = atan(sqrt(m_roughValueU + 1) * sin(turn), sqrt(m_roughValueV + 1) * cos(turn));
            float e = m_roughValueU * cos(a) * cos(a) + m_roughValueV * sin(a) * sin(a);
            stdrsl_mirror(context, pow(1 - random(), 1 / (e + 1)), a, first + i, samples);
        }
    }
}
#endif
