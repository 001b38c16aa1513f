/* What the lobes of stdrsl/SpecularAS.h and stdrsl/SpecularDBRDF.h have in common: each has a stdrsl_answer() for one direction and draws
   normals of facets of its own. A macro, because structures of RSL have no other way to share methods. */
#ifndef STDRSL_FACETSAMPLES_H
#define STDRSL_FACETSAMPLES_H
#include <stdrsl/RadianceSample.h>
#include <stdrsl/Fresnel.h>
#define STDRSL_FACET_SAMPLES \
    /* fills in what the lobe makes of the light from each direction */ \
    public void evalSpecularSamps(stdrsl_ShadingContext context; stdrsl_Fresnel f; output __radiancesample samples[]) \
    { \
        uniform float i, n = arraylength(samples); \
        for (i = 0; i < n; i += 1) { \
            color answer; \
            float pdf; \
            stdrsl_answer(context, samples[i]->direction, answer, pdf); \
            samples[i]->setMaterialResponse(answer, pdf); \
        } \
    } \
    /* sample `at` is the view mirrored at a facet whose normal has the cosine `up` and the angle `a` about the normal */ \
    void stdrsl_mirror(stdrsl_ShadingContext context; float up, a; uniform float at; output __radiancesample samples[]) \
    { \
        float out = sqrt(max(0, 1 - up * up)); \
        vector h = out * cos(a) * context->m_Tangent + out * sin(a) * context->m_Bitangent + up * vector(context->m_Ns); \
        vector l = normalize(2 * (context->m_Vn . h) * h - context->m_Vn); \
        color answer; \
        float pdf; \
        stdrsl_answer(context, l, answer, pdf); \
        samples[at]->direction = l; \
        samples[at]->setMaterialResponse(answer, pdf); \
    }
#endif
