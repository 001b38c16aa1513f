// ri.h: calls of a name and a parameter list: shaders, and what later renderers have in their place.
#include "ri/c/pairs.h"

using namespace alpenglow;
using namespace alpenglow::ri;

extern "C" {

ALPENGLOW_NAMED(Surface)
ALPENGLOW_NAMED(Displacement)
ALPENGLOW_NAMED(Atmosphere)
ALPENGLOW_NAMED(Interior)
ALPENGLOW_NAMED(Exterior)
ALPENGLOW_NAMED(Deformation)
ALPENGLOW_NAMED(Imager)
ALPENGLOW_NAMED_TWICE(Shader)
ALPENGLOW_NAMED_TWICE(Resource)
ALPENGLOW_NAMED(IfBegin)
ALPENGLOW_NAMED(ElseIf)

ALPENGLOW_NAMED_TWICE(Bxdf)
ALPENGLOW_NAMED_TWICE(Pattern)
ALPENGLOW_NAMED_TWICE(Displace)
ALPENGLOW_NAMED_TWICE(Light)
ALPENGLOW_NAMED_TWICE(LightFilter)
ALPENGLOW_NAMED_TWICE(Integrator)
ALPENGLOW_NAMED_TWICE(DisplayFilter)
ALPENGLOW_NAMED_TWICE(SampleFilter)
ALPENGLOW_NAMED(PixelSampleImager)
ALPENGLOW_NAMED(VPAtmosphere)
ALPENGLOW_NAMED(VPInterior)
ALPENGLOW_NAMED(VPSurface)
RtVoid RiEnableLightFilter(RtToken light, RtToken filter, RtBoolean on) {
    Building("EnableLightFilter").text(light).text(filter).number(RtInt(on != 0)).run();
}

} // extern "C"
