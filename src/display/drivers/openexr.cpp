// Display type "openexr": floating point, any channels, layers.
#include "display/drivers/picture.h"

namespace alpenglow::display {
namespace {

class OpenExr : public PictureDriver {
    Format format(const DriverSetup&, Diagnostics&) override { return Format::Exr; }
};

} // namespace

const DriverDescriptor openexrDriver{{"openexr", "exr"},
                                     "OpenEXR. Floating point whatever Quantize says; AOVs are layers. Parameters: \"string "
                                     "exrpixeltype\" float (default) or half; "
                                     "\"string exrcompression\" none, rle, zips, zip (default), piz.",
                                     []() -> std::unique_ptr<Driver> { return std::make_unique<OpenExr>(); }};

} // namespace alpenglow::display
