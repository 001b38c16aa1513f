/* LamaAdd: two nodes, weighted and added up, of RIS: lama.h. */
#include "lama.h"
surface LamaAdd(LAMA_IN(material1) LAMA_IN(material2) varying float weight1 = 1, weight2 = 1; LAMA_OUT)
{
    LAMA_ADD(material1, weight1, material2, weight2)
    LAMA_SURFACE(1)
}
