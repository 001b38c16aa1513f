// Display types of formats we do not write, and unknown ones: a picture under the given name, and a word about it.
#include "display/drivers/picture.h"

namespace alpenglow::display {
namespace {

class Other : public PictureDriver {
    Format format(const DriverSetup& s, Diagnostics& diags) override {
        Format f = formatOfExtension(s.name).value_or(Format::Tiff);
        if (findDriver(s.type)) // for unknown types makeDriver has reported it
            diags.report(Severity::Warning, Rie::Incapable, s.place,
                         "display \"" + s.name + "\": type \"" + s.type + "\" is not available; " + toString(f) +
                             " is written under that name");
        return f;
    }
};

} // namespace

const DriverDescriptor otherDriver{{"targa", "tga",       "bmp", "bitmap", "gif",   "sgi",        "sgif",   "iff",      "mayaiff",
                                    "alias", "cineon",    "dpx", "rla",    "psd",   "xpm",        "ppm",    "radiance", "rgbe",
                                    "hdr",   "softimage", "avs", "pic",    "picio", "dspy_s_avs", "texture"},
                                   "Formats that are not written here (Targa, BMP, ...): a picture file under the given name, by "
                                   "its extension (as for \"file\"), with a message.",
                                   []() -> std::unique_ptr<Driver> { return std::make_unique<Other>(); }};

} // namespace alpenglow::display
