// Display types "zfile" and "shadow", and "deepshad", which includes layers behind the first surface: depth as floats under the
// given name, with the matrices for shadow(): a zfile is what other programs and Blobby's repelling planes read, the rest
// OpenEXR.
#include "display/drivers/picture.h"
#include <algorithm>

namespace alpenglow::display {
namespace {

/// Float OpenEXR that shadow() accepts as a depth map.
class DepthDriver : public PictureDriver {
    Format format(const DriverSetup&, Diagnostics&) override { return Format::Exr; }
    bool data() const override { return true; }

public:
    bool open(const DriverSetup& s, Diagnostics& diags) override {
        DriverSetup mine = s;
        mine.metadata["textureformat"] = "Shadow";
        return PictureDriver::open(mine, diags);
    }
};

std::string small(std::string name) {
    for (char& c : name) c = char(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    return name;
}

class Zfile : public DepthDriver {
    bool write(const std::string& name, const Image& image, const WriteOptions& o, Diagnostics& diags) override {
        return exr_ ? writeImage(name, image, o, diags) : writeZfile(name, image, o.policy, diags, o.place);
    }
    bool exr_ = false;

public:
    bool open(const DriverSetup& s, Diagnostics& diags) override {
        exr_ =
            small(s.type) != "zfile" || s.channels != std::vector<std::string>{"z"} || formatOfExtension(s.name) == Format::Exr;
        bool depth = std::find(s.channels.begin(), s.channels.end(), "z") != s.channels.end();
        if (!depth)
            diags.report(Severity::Warning, Rie::Consistency, s.place,
                         "display \"" + s.name + "\" of type \"" + s.type + "\" has no depth; its mode should be \"z\"");
        return DepthDriver::open(s, diags);
    }
};

/// Its pixels are in the setup.
class DeepShadow : public DepthDriver {
public:
    bool open(const DriverSetup& s, Diagnostics& diags) override {
        if (!s.deep)
            diags.report(Severity::Warning, Rie::MissingData, s.place,
                         "deep shadow map \"" + s.name +
                             "\": a picture made of part files has no depths behind the first surfaces",
                         "render the map whole");
        return DepthDriver::open(s, diags);
    }
};

} // namespace

const DriverDescriptor zfileDriver{
    {"zfile", "shadow", "shadowmap", "z"},
    "Depth, camera space, with the matrices of the camera. zfile: the format of this name (32 bits a pixel, in the byte order of "
    "the machine), unless the name ends in .exr; the others, and depth with other channels: floating point OpenEXR whatever the "
    "extension. MakeShadow and shadow() read both, repelling planes of Blobby the first.",
    []() -> std::unique_ptr<Driver> { return std::make_unique<Zfile>(); }};

const DriverDescriptor deepDriver{{"deepshad", "dsm", "deepshadow", "dshadow"},
                                  "Deep shadow map: for each pixel, with all of its samples, how much light of each colour is "
                                  "left behind every depth, so transparent, thin "
                                  "and moving things cast the shadows that they do. Deep OpenEXR (channels Z, RA, GA, BA, A) "
                                  "whatever the extension and the mode; shadow() "
                                  "and MakeShadow read it. Option \"limits\" \"float deepshadowerror\" says how exactly.",
                                  []() -> std::unique_ptr<Driver> { return std::make_unique<DeepShadow>(); }};

} // namespace alpenglow::display
