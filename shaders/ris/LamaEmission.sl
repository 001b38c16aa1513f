/* LamaEmission: radiance that the surface adds, of RIS. A node of others, too: lama.h. */
#include "lama.h"
surface LamaEmission(varying color emissionColor = 1, color_ = -1; LAMA_OUT)
{
    bxdf_out_glow = (comp(color_, 0) >= 0) ? color_ : emissionColor;
    LAMA_SURFACE(1)
}
