// Display type "jpeg": 8 bits, quality 95, no alpha.
#include "display/drivers/picture.h"

namespace alpenglow::display {
namespace {

class Jpeg : public PictureDriver {
    Format format(const DriverSetup&, Diagnostics&) override { return Format::Jpeg; }
};

} // namespace

const DriverDescriptor jpegDriver{{"jpeg", "jpg"},
                                  "JPEG. 8 bits, quality 95, colour as sharp as lightness, no alpha: r g b, or one channel. 0 to "
                                  "1 is written as 0 to 255 where "
                                  "Quantize has no codes of 8 bits.",
                                  []() -> std::unique_ptr<Driver> { return std::make_unique<Jpeg>(); }};

} // namespace alpenglow::display
