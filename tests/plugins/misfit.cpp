// A plug-in whose signature does not fit its function.
#include "alpenglow/rslplugin.h"

static float sum(float a, float b) { return a + b; }

ALPENGLOW_RSL_PLUGIN(alpenglow::rslplugin::perPoint<sum>("float sum(float a; color b)"))
