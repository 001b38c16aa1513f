/* Small tools of procedural texturing. */
#ifndef PROCTEXT_H
#define PROCTEXT_H
#include "noises.h"
#include "rmannotes.h"
#ifndef ABS
#define ABS(x) abs(x)
#endif
#ifndef filterwidthpoint
#define filterwidthpoint(p) filterwidthp(p)
#endif
#ifndef SNOISE
#define SNOISE(x) (2 * noise(x) - 1)
#endif
#endif
