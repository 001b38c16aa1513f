// Display type "cryptomatte": the picture, and behind its channels the ids and coverages of what is in each pixel.
#include "display/drivers/picture.h"
#include <algorithm>

namespace alpenglow::display {
namespace {

class Cryptomatte final : public PictureDriver {
public:
    bool open(const DriverSetup& s, Diagnostics& diags) override {
        DriverSetup mine = s;
        mattes_ = s.mattes;
        own_ = s.channels.size();
        width_ = size_t(std::max(0, s.width));
        if (!mattes_)
            diags.report(Severity::Warning, Rie::MissingData, s.place,
                         "display \"" + s.name + "\": a picture made of part files has no mattes", "render it whole");
        if (std::erase_if(mine.params, [](const scene::Param& p) { return p.name == "exrpixeltype"; }) > 0)
            diags.report(Severity::Info, Rie::Consistency, s.place,
                         "display \"" + s.name + "\": ids need all bits of floats, so its pixels are floats");
        if (mattes_)
            for (const Matte& m : *mattes_) {
                const std::vector<std::string> names = matteChannels(m);
                mine.channels.insert(mine.channels.end(), names.begin(), names.end());
                addMatteMetadata(m, mine.metadata);
            }
        all_ = mine.channels.size();
        return PictureDriver::open(mine, diags);
    }
    bool rows(int y, int count, const float* data) override {
        if (y < 0 || count < 0) return false;
        std::vector<float> wide;
        wide.reserve(size_t(count) * width_ * all_);
        for (size_t i = 0; i < size_t(count) * width_; ++i) {
            wide.insert(wide.end(), data + i * own_, data + (i + 1) * own_);
            if (!mattes_) continue;
            for (const Matte& m : *mattes_) {
                const size_t n = 2 * size_t(m.ranks), at = (size_t(y) * width_ + i) * n;
                if (at + n > m.pairs.size()) return false;
                wide.insert(wide.end(), m.pairs.data() + at, m.pairs.data() + at + n);
            }
        }
        return PictureDriver::rows(y, count, wide.data());
    }

private:
    Format format(const DriverSetup&, Diagnostics&) override { return Format::Exr; }
    bool data() const override { return true; }
    MattesRef mattes_;
    size_t own_ = 0, all_ = 0, width_ = 0;
};

} // namespace

const DriverDescriptor cryptomatteDriver{
    {"cryptomatte"},
    "OpenEXR whatever the extension: the channels of the mode, and ids and coverages of objects or materials by the Cryptomatte "
    "specification 1.2, as floats (docs/mattes.md). \"string layer\" names what tells them apart: \"identifier:name\" (by "
    "default) "
    "or another attribute, or \"material\"; \"int levels\" (6) how many share a pixel.",
    []() -> std::unique_ptr<Driver> { return std::make_unique<Cryptomatte>(); }};

} // namespace alpenglow::display
