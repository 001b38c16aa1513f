/* stdrsl/SphericalHarmonics.h: values over the sphere as coefficients. The integral of a product is the sum of the products of the
   coefficients. rotate() leaves them as they are. */
#ifndef STDRSL_SPHERICALHARMONICS_H
#define STDRSL_SPHERICALHARMONICS_H
struct stdrsl_SphericalHarmonic
{
    public varying color m_c[];
    public void createFromArray(color c[])
    {
        uniform float i, n = arraylength(c);
        resize(m_c, 0);
        for (i = 0; i < n; i += 1) push(m_c, c[i]);
    }
    public void createFromArray(float c[])
    {
        uniform float i, n = arraylength(c);
        resize(m_c, 0);
        for (i = 0; i < n; i += 1) push(m_c, color(c[i]));
    }
    public void rotate(string space) {}
    public color convolve(stdrsl_SphericalHarmonic other; float bands)
    {
        uniform float i, n = min(arraylength(m_c), arraylength(other->m_c));
        color sum = 0;
        for (i = 0; i < n; i += 1) sum += m_c[i] * other->m_c[i];
        return sum;
    }
}
#endif
