/* stdrsl/SampleMgr.h: how many samples of lights and materials to take. Each bounce takes a quarter of what the one before took. */
#ifndef STDRSL_SAMPLEMGR_H
#define STDRSL_SAMPLEMGR_H
struct stdrsl_SampleMgr
{
    public uniform float m_PathTracing = 0;
    public uniform float m_RayDepth = 0;
    public uniform float m_DiffuseDepth = 0;

    public void construct() {}
    public void begin()
    {
        rayinfo("depth", m_RayDepth);
        rayinfo("diffusedepth", m_DiffuseDepth);
        string hider = "";
        option("Hider", hider);
        m_PathTracing = (hider == "path") ? 1 : 0;
    }
    /* fewest: never less than this; most: never more, if it is not 0 */
    public void computeDepthBasedSampleReduction(uniform float depth, samples, fewest, most; output uniform float n)
    {
        n = max(fewest, ceil(samples * pow(0.25, depth)));
        if (most > 0) n = min(n, most);
    }
    public void computeIndirectDiffuseSamples(uniform float samples, variation; output uniform float n; output uniform float outVariation)
    {
        computeDepthBasedSampleReduction(m_DiffuseDepth, samples, 1, 0, n);
        outVariation = (m_DiffuseDepth > 0) ? 4 * variation : variation;
    }
    public void computeLightSamples(uniform float fewest, most; output uniform float n)
    {
        computeDepthBasedSampleReduction(m_RayDepth, most, fewest, most, n);
    }
    public void computeMaterialSamples(uniform float fewest, most; output uniform float n)
    {
        computeDepthBasedSampleReduction(m_RayDepth, most, fewest, most, n);
    }
}
#endif
