// Display type "png": 8 or 16 bits; alpha is written unchanged (associated, as in RenderMan).
#include "display/drivers/picture.h"

namespace alpenglow::display {
namespace {

class Png : public PictureDriver {
    Format format(const DriverSetup&, Diagnostics&) override { return Format::Png; }
};

} // namespace

const DriverDescriptor pngDriver{
    {"png"},
    "PNG. 8 or 16 bits by Quantize; with Quantize off 0 to 1 is written as 16 bits. One picture: r g b (a), or one channel (a).",
    []() -> std::unique_ptr<Driver> { return std::make_unique<Png>(); }};

} // namespace alpenglow::display
