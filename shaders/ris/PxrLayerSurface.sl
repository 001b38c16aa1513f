/* PxrLayerSurface: PxrSurface with the values that PxrLayerMixer gives, of RIS. See PxrSurface. */
#include "rislobes.h"
surface PxrLayerSurface
#include "pxrsurface.h"
