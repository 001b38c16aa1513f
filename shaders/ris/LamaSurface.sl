/* LamaSurface: the node that makes a surface of others, of RIS: lama.h. materialBack is taken from behind where it has lobes. */
#include "lama.h"
surface LamaSurface(LAMA_IN(materialFront) LAMA_IN(materialBack) varying float presence = 1; LAMA_OUT)
{
    color back = materialBack_diffuse + materialBack_metal + materialBack_mirror + materialBack_through + materialBack_sheen +
        materialBack_sss + materialBack_translucent + materialBack_glow, none = 0;
    normal n;
    if (risSide(normal 0, normal 0, n) == 0 && back != none) {
        LAMA_COPY(materialBack)
    } else {
        LAMA_COPY(materialFront)
    }
    LAMA_SURFACE(presence)
}
