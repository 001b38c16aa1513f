// Display type "file": the format by the extension of the name, TIFF when there is none that is known.
#include "display/drivers/picture.h"

namespace alpenglow::display {
namespace {

class File : public PictureDriver {
    Format format(const DriverSetup& s, Diagnostics&) override { return formatOfExtension(s.name).value_or(Format::Tiff); }
};

} // namespace

const DriverDescriptor fileDriver{
    {"file"},
    "A picture file. The extension chooses OpenEXR (.exr), PNG (.png) or TIFF (.tif, .tiff and all others).",
    []() -> std::unique_ptr<Driver> { return std::make_unique<File>(); }};

} // namespace alpenglow::display
