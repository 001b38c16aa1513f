/* PxrMyFractal: PxrFractal under the name that the plug-in example of Pixar's development kit, and courses that follow it, give a copy. */
#define PxrFractal PxrMyFractal
#include "PxrFractal.sl"
