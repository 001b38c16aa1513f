/* stdrsl/ShadingContext.h: normals, directions and depths that materials ask for again and again. Its members have their values
   without init() too: the methods that call it may belong to another kind of shader than those that ask. */
#ifndef STDRSL_SHADINGCONTEXT_H
#define STDRSL_SHADINGCONTEXT_H
#include <stdrsl/Math.h>
#include <stdrsl/SampleMgrPathTrace.h>
struct stdrsl_ShadingUtils
{
    /* nn: N with length 1; in: I with length 1; nf: nn towards the viewer; ns: nf where the surface has two sides or a ray hit it */
    public void GetShadingVars(float raydepth; float sides; output normal nn; output vector in; output normal nf; output normal ns)
    {
        extern normal N;
        nn = normalize(N);
        in = normalize(stdrsl_incident());
        nf = (nn . in > 0) ? -nn : nn;
        ns = (sides == 2 || raydepth > 0) ? nf : nn;
    }
    vector stdrsl_incident() { extern vector I; return I; }
}
struct stdrsl_ShadingContext
{
    public varying normal m_Nn = normalize(N);
    public varying normal m_OrigNn = normalize(N);
    public varying normal m_Ns = shadingnormal(N);
    public varying normal m_Nf = faceforward(normalize(N), I);
    public varying vector m_In = normalize(I);
    public varying vector m_Vn = -normalize(I);
    public varying vector m_Tangent = normalize(dPdu);
    public varying vector m_Bitangent = normalize(normalize(N) ^ normalize(dPdu));
    public uniform float m_RayDepth = 0;
    public uniform float m_DiffuseDepth = 0;
    public uniform float m_SpecularDepth = 0;
    public uniform float m_Sides = 2;
    public varying float m_Inside = 0;
    public varying float m_EnteringRegion = 1; /* 1 where I goes into what the surface bounds, 0 where it comes out */
    public stdrsl_SampleMgrPathTrace m_SampleMgr;

    public void construct() { m_SampleMgr->construct(); }
    /* what follows from m_Nn and m_Tangent */
    public void reinit()
    {
        m_Nf = (m_Nn . m_In > 0) ? -m_Nn : m_Nn;
        m_Ns = (m_Sides == 2) ? m_Nf : m_Nn;
        m_Inside = (m_Nn . m_In > 0) ? 1 : 0;
        m_EnteringRegion = 1 - m_Inside;
        m_Bitangent = normalize(m_Nn ^ m_Tangent);
    }
    public void init()
    {
        extern normal N;
        extern vector I, dPdu;
        m_SampleMgr->begin();
        rayinfo("depth", m_RayDepth);
        rayinfo("diffusedepth", m_DiffuseDepth);
        rayinfo("speculardepth", m_SpecularDepth);
        attribute("Sides", m_Sides);
        m_Nn = normalize(N);
        m_OrigNn = m_Nn;
        m_In = normalize(I);
        m_Vn = -m_In;
        m_Tangent = normalize(dPdu);
        reinit();
    }
    /* the tangent is the direction in which a value grows on the surface */
    public void initWithTangentField(float field)
    {
        extern vector dPdu, dPdv;
        init();
        vector along = Du(field) * normalize(dPdu) + Dv(field) * normalize(dPdv);
        if (along . along > 0) m_Tangent = normalize(along);
        reinit();
    }
    /* curves: the tangent runs along the hair; their normals, unless trusted, are turned towards the viewer */
    public void initHair(uniform float trusted)
    {
        extern vector dPdv;
        init();
        m_Tangent = normalize(dPdv);
        if (trusted == 0) m_Nn = normalize(normal(m_Vn - (m_Vn . m_Tangent) * m_Tangent));
        reinit();
    }
    /* mode "bump" leaves the point where it is */
    public void displace(vector direction; float amount; uniform string mode)
    {
        extern point P;
        extern normal N;
        normal before = normalize(N);
        point to = P + amount * direction;
        N = calculatenormal(to);
        if (N . before < 0) N = -N;
        if (mode != "bump") P = to;
        m_Nn = normalize(N);
        reinit();
    }
}
#endif
