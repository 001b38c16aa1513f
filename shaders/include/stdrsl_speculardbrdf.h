/* stdrsl/SpecularDBRDF.h: a glossy lobe that is known by how the normals of its facets are distributed: Ashikhmin and Premoze (2007).
   distribution: "beckmann", or "phong" for a power of the cosine. roughness 0.01 is sharp, 1 is wide. */
#ifndef STDRSL_SPECULARDBRDF_H
#define STDRSL_SPECULARDBRDF_H
#include <stdrsl_facetsamples.h>
struct stdrsl_SpecularDBRDF
{
    public varying color m_specColor = 1;
    public varying float m_roughness = 0.1;
    public uniform float m_phong = 0;
    public uniform float m_sampleCount = 0;

    public void init(stdrsl_ShadingContext context; uniform string distribution; color c; float roughness; uniform float fewest, most)
    {
        m_specColor = c;
        m_roughness = clamp(roughness, 1e-3, 1);
        m_phong = (distribution == "beckmann") ? 0 : 1;
        m_sampleCount = 0;
        if (most > 0) context->m_SampleMgr->computeMaterialSamples(fewest, most, m_sampleCount);
    }
    /* what the facets' normals do about one direction, for 1 over the half sphere of the projected ones */
    float stdrsl_facets(float up)
    {
        float c = max(up, 1e-4), slope = (1 - c * c) / (c * c), r = m_roughness * m_roughness, e = 2 / r - 2;
        return (m_phong == 0) ? exp(-slope / r) / (M_PI * r * c * c * c * c) : (e + 2) / M_TWOPI * pow(c, e);
    }
    void stdrsl_answer(stdrsl_ShadingContext context; vector l; output color answer; output float pdf)
    {
        vector n = vector(context->m_Ns), v = context->m_Vn;
        float nl = n . l, nv = n . v;
        answer = 0;
        pdf = 0;
        if (nl > 0 && nv > 0) {
            vector h = normalize(l + v);
            float d = stdrsl_facets(n . h);
            answer = m_specColor * (d * nl / (4 * (nl + nv - nl * nv)));
            pdf = d * (n . h) / (4 * max(l . h, 1e-4));
        }
    }
    STDRSL_FACET_SAMPLES
    public void genSpecularSamps(stdrsl_ShadingContext context; stdrsl_Fresnel f; string type; output __radiancesample samples[])
    {
        uniform float i, first = arraylength(samples);
        resize(samples, first + m_sampleCount);
        for (i = 0; i < m_sampleCount; i += 1) {
            float a = M_TWOPI * random(), x = 1 - random(), r = m_roughness * m_roughness;
            float up = (m_phong == 0) ? 1 / sqrt(1 - r * log(max(x, 1e-30))) : pow(x, r / 2);
            stdrsl_mirror(context, up, a, first + i, samples);
        }
    }
}
#endif
