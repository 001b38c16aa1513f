// Display type "framebuffer": there is no window here, so a picture under the given name, and a word about it.
#include "display/drivers/picture.h"

namespace alpenglow::display {
namespace {

class Framebuffer : public PictureDriver {
    Format format(const DriverSetup& s, Diagnostics& diags) override {
        diags.report(Severity::Info, Rie::NoError, s.place,
                     "display \"" + s.name + "\": no viewer; the picture is written to a file of that name");
        return formatOfExtension(s.name).value_or(Format::Tiff);
    }
};

} // namespace

const DriverDescriptor framebufferDriver{
    {"framebuffer", "it", "idisplay", "i-display", "piqsl", "iv", "rgbframebuffer", "x11", "windows"},
    "A window. Without a viewer a picture file is written under the given name, by its "
    "extension (as for \"file\"), with a message.",
    []() -> std::unique_ptr<Driver> { return std::make_unique<Framebuffer>(); }};

} // namespace alpenglow::display
