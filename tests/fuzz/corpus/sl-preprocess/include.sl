#include "normals.h"
#include <patterns.h>
#include "include.sl"
#define A B
#define B A
#define F(x) x F(x)
#define G(x) F(G(x))
surface t() { float A = 1; Ci = F(1) G(2); }
