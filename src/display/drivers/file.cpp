// Display type "file": the format by the extension of the name, TIFF if it is unknown.
#include "display/drivers/picture.h"
#include <strings.h>

namespace alpenglow::display {
namespace {

class File : public PictureDriver {
    Format format(const DriverSetup& s, Diagnostics& diags) override {
        if (auto f = formatOfExtension(s.name)) return *f;
        // Names like "ri.pic" and "frame.12" are as old as the type; these promise a format.
        const size_t dot = s.name.find_last_of('.');
        const std::string e = dot == std::string::npos ? "" : s.name.substr(dot + 1);
        for (const char* foreign : {"bmp", "gif", "tga", "targa", "webp", "hdr", "pfm", "ppm", "pgm", "dpx", "cin", "sgi", "rgb",
                                    "iff", "jp2", "jxl", "avif", "heic", "psd"})
            if (strcasecmp(e.c_str(), foreign) == 0)
                diags.report(Severity::Warning, Rie::Incapable, s.place,
                             "display \"" + s.name + "\": ." + e + " is not written here; TIFF is written under that name",
                             std::string("name it ") + pictureExtensions());
        return Format::Tiff;
    }
};

} // namespace

const DriverDescriptor fileDriver{{"file"},
                                  "A picture file. The extension chooses the format: " + pictureExtensions() +
                                      "; TIFF for all others.",
                                  []() -> std::unique_ptr<Driver> { return std::make_unique<File>(); }};

} // namespace alpenglow::display
