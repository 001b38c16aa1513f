// Display types "zfile" and "shadow": depth as floats in OpenEXR under the given name, with the matrices that shadow() needs.
#include "display/drivers/picture.h"
#include <algorithm>

namespace alpenglow::display {
namespace {

class Zfile : public PictureDriver {
    Format format(const DriverSetup&, Diagnostics&) override { return Format::Exr; }
    bool data() const override { return true; }

public:
    bool open(const DriverSetup& s, Diagnostics& diags) override {
        DriverSetup mine = s;
        mine.metadata["textureformat"] = "Shadow";
        std::string type;
        for (char c : s.type) type += char(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
        if (type == "deepshad")
            diags.report(Severity::Warning, Rie::Unimplement, s.place,
                         "display \"" + s.name + "\": deep shadow maps are written as plain ones (the first surface)");
        bool depth = std::find(s.channels.begin(), s.channels.end(), "z") != s.channels.end();
        if (!depth)
            diags.report(Severity::Warning, Rie::Consistency, s.place,
                         "display \"" + s.name + "\" of type \"" + s.type + "\" has no depth; its mode should be \"z\"");
        return PictureDriver::open(mine, diags);
    }
};

} // namespace

const DriverDescriptor zfileDriver{
    {"zfile", "shadow", "shadowmap", "z", "deepshad"},
    "Depth, camera space, as floating point OpenEXR whatever the extension, with the matrices worldToCamera and worldToNDC in "
    "its header. "
    "MakeShadow and shadow() read it. \"deepshad\" writes the same, without the layers behind the first surface.",
    []() -> std::unique_ptr<Driver> { return std::make_unique<Zfile>(); }};

} // namespace alpenglow::display
