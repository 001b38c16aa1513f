/* stdrsl/Fresnel.h: how much of the light a smooth surface reflects and lets through, and where to. */
#ifndef STDRSL_FRESNEL_H
#define STDRSL_FRESNEL_H
#include <stdrsl/ShadingContext.h>
struct stdrsl_Fresnel
{
    public varying float m_Kr = 0;
    public varying float m_Kt = 1;
    public varying vector m_Rv = vector(0, 0, 1);
    public varying vector m_Tv = vector(0, 0, 1);
    public varying float m_eta = 1;

    public void init(stdrsl_ShadingContext context; float mediaIor, ior)
    {
        normal n = context->m_Nf;
        m_eta = (context->m_Nn . context->m_In > 0) ? ior / mediaIor : mediaIor / ior;
        fresnel(context->m_In, n, m_eta, m_Kr, m_Kt, m_Rv, m_Tv);
        m_Kt = 1 - m_Kr;
        m_Rv = normalize(m_Rv);
        if (m_Tv . m_Tv > 0) m_Tv = normalize(m_Tv);
    }
    /* Schlick's curve through `facing`, what is reflected straight back; without an ior nothing is bent */
    public void initSchlick(stdrsl_ShadingContext context; float mediaIor, ior, facing)
    {
        vector n = vector(context->m_Nf), in = context->m_In;
        m_eta = 1;
        if (ior != 0) m_eta = (context->m_Nn . in > 0) ? ior / mediaIor : mediaIor / ior;
        m_Kr = facing + (1 - facing) * pow(1 - clamp(-(n . in), 0, 1), 5);
        m_Kt = 1 - m_Kr;
        m_Rv = normalize(reflect(in, n));
        m_Tv = (ior != 0) ? refract(in, n, m_eta) : in;
    }
}
#endif
