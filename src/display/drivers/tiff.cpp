// Display type "tiff": 8 or 16 bits by Quantize, floats when it is off.
#include "display/drivers/picture.h"

namespace alpenglow::display {
namespace {

class Tiff : public PictureDriver {
    Format format(const DriverSetup&, Diagnostics&) override { return Format::Tiff; }
};

} // namespace

const DriverDescriptor tiffDriver{
    {"tiff"},
    "TIFF. 8 bits when Quantize's codes end at 255 or below, 16 bits to 65535, floats when it is off (one = 0). Parameter: "
    "\"string compression\" none, lzw, packbits, zip (default).",
    []() -> std::unique_ptr<Driver> { return std::make_unique<Tiff>(); }};

} // namespace alpenglow::display
