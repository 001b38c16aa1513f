/* stdrsl/Hair.h: light on thin strands: diffuse by the angle to the strand, gloss in a cone about it that is shifted to the root.
   Angles in degrees. */
#ifndef STDRSL_HAIR_H
#define STDRSL_HAIR_H
#include <stdrsl/RadianceSample.h>
#include <stdrsl/Fresnel.h>
struct stdrsl_Hair
{
    public varying color m_diffColor = 1;
    public varying color m_specColor = 1;
    public varying float m_reflect = 0.5, m_transmit = 0.5;
    public varying float m_shift = 0, m_width = 0.1;
    public uniform float m_sampleCount = 0;

    public void initDiffuse(stdrsl_ShadingContext context; float gain, reflectGain, transmitGain; color root, tip)
    {
        extern float v;
        m_diffColor = gain * mix(root, tip, v);
        m_reflect = reflectGain;
        m_transmit = transmitGain;
    }
    public void initSpecular(stdrsl_ShadingContext context; uniform float samples; color transmitColor; float shift, width, gain; float index)
    {
        m_specColor = color(gain);
        m_shift = radians(shift);
        m_width = max(1e-3, radians(width));
        m_sampleCount = samples;
    }
    public void evalDiffuseSamps(stdrsl_ShadingContext context; output __radiancesample samples[])
    {
        vector t = context->m_Tangent;
        uniform float i, n = arraylength(samples);
        for (i = 0; i < n; i += 1) {
            vector l = samples[i]->direction;
            float across = sqrt(max(0, 1 - (t . l) * (t . l)));
            float side = 0.5 + 0.5 * clamp(context->m_Nn . l, -1, 1);
            float pdf = across / (M_PI * M_PI);
            samples[i]->setMaterialResponse(m_diffColor * mix(m_transmit, m_reflect, side) * pdf, pdf);
        }
    }
    public void evalSpecularSamps(stdrsl_ShadingContext context; output __radiancesample samples[])
    {
        vector t = context->m_Tangent;
        float seen = asin(clamp(t . context->m_Vn, -1, 1));
        uniform float i, n = arraylength(samples);
        for (i = 0; i < n; i += 1) {
            vector l = samples[i]->direction;
            float lit = asin(clamp(t . l, -1, 1));
            float d = (0.5 * (lit + seen) - m_shift) / m_width;
            float pdf = exp(-0.5 * d * d) / (m_width * sqrt(M_TWOPI) * M_TWOPI);
            samples[i]->setMaterialResponse(m_specColor * pdf * cos(lit), pdf);
        }
    }
    public void genSpecularSamps(stdrsl_ShadingContext context; output __radiancesample samples[]) {}
}
#endif
