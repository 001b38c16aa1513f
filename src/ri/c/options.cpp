// ri.h: cameras, displays and other options.
#include "ri/c/filters.h"
#include "ri/c/pairs.h"
#include "ri/c/ribformat.h"

using namespace alpenglow;
using namespace alpenglow::ri;

namespace {

/// A request of numbers.
template <class... Number> void numeric(const char* request, Number... number) {
    Building b(request);
    (b.number(number), ...);
    b.run();
}

} // namespace

extern "C" {

RtVoid RiFormat(RtInt xres, RtInt yres, RtFloat aspect) { numeric("Format", xres, yres, aspect); }
RtVoid RiFrameAspectRatio(RtFloat ratio) { numeric("FrameAspectRatio", ratio); }
RtVoid RiScreenWindow(RtFloat left, RtFloat right, RtFloat bottom, RtFloat top) {
    numeric("ScreenWindow", left, right, bottom, top);
}
RtVoid RiCropWindow(RtFloat xmin, RtFloat xmax, RtFloat ymin, RtFloat ymax) { numeric("CropWindow", xmin, xmax, ymin, ymax); }
ALPENGLOW_NAMED(Projection)
RtVoid RiClipping(RtFloat hither, RtFloat yon) { numeric("Clipping", hither, yon); }
RtVoid RiClippingPlane(RtFloat x, RtFloat y, RtFloat z, RtFloat nx, RtFloat ny, RtFloat nz) {
    numeric("ClippingPlane", x, y, z, nx, ny, nz);
}
RtVoid RiDepthOfField(RtFloat fstop, RtFloat focallength, RtFloat focaldistance) {
    if (fstop >= RI_INFINITY) Building("DepthOfField").run(); // a pinhole
    else numeric("DepthOfField", fstop, focallength, focaldistance);
}
RtVoid RiShutter(RtFloat open, RtFloat close) { numeric("Shutter", open, close); }
RtVoid RiPixelVariance(RtFloat variance) { numeric("PixelVariance", variance); }
RtVoid RiPixelSamples(RtFloat x, RtFloat y) { numeric("PixelSamples", x, y); }
RtVoid RiPixelFilter(RtFilterFunc filter, RtFloat xwidth, RtFloat ywidth) {
    Building b("PixelFilter");
    filterName(b, filter, xwidth, ywidth).number(xwidth).number(ywidth).run();
}
RtVoid RiExposure(RtFloat gain, RtFloat gamma) { numeric("Exposure", gain, gamma); }
RtVoid RiQuantize(RtToken type, RtInt one, RtInt min, RtInt max, RtFloat dither) {
    Building("Quantize").text(type).number(one).number(min).number(max).number(dither).run();
}

RtVoid RiDisplayV(RtToken name, RtToken type, RtToken mode, RtInt n, RtToken tokens[], RtPointer values[]) {
    Building("Display").text(name).text(type).text(mode).parameters(n, tokens, values).run();
}
RtVoid RiDisplay(RtToken name, RtToken type, RtToken mode, ...) {
    ALPENGLOW_PAIRS(mode);
    RiDisplayV(name, type, mode, ALPENGLOW_LIST);
}
ALPENGLOW_NAMED(DisplayChannel)
ALPENGLOW_NAMED(Hider)
ALPENGLOW_NAMED(Camera)
RtVoid RiColorSamples(RtInt n, RtFloat nRGB[], RtFloat RGBn[]) {
    Building("ColorSamples").numbers(nRGB, 3 * int64_t(n)).numbers(RGBn, 3 * int64_t(n)).run();
}
RtVoid RiRelativeDetail(RtFloat factor) { numeric("RelativeDetail", factor); }
RtVoid RiOptionV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]) {
    if (!noteRibFormat(name, n, tokens, values))
        Building("Option").text(name).parameters(n, tokens, values, nullptr, name ? name : "").run();
}
RtVoid RiOption(RtToken name, ...) {
    ALPENGLOW_PAIRS(name);
    RiOptionV(name, ALPENGLOW_LIST);
}

} // extern "C"
