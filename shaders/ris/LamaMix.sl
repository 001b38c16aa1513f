/* LamaMix: two nodes, mixed, of RIS: lama.h. Its parameter "mix" has the name mix_ here, for RSL has a function of that name. */
#include "lama.h"
surface LamaMix(LAMA_IN(material1) LAMA_IN(material2) varying float mix_ = .5; LAMA_OUT)
{
    LAMA_ADD(material1, (1 - mix_), material2, mix_)
    LAMA_SURFACE(1)
}
