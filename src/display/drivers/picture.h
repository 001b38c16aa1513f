// The common part of drivers that write a picture file when closed.
#pragma once
#include "display/driver.h"

namespace alpenglow::display {

/// Collects rows into an Image and encodes it at the end.
class PictureDriver : public Driver {
public:
    bool open(const DriverSetup&, Diagnostics&) override;
    bool rows(int y, int count, const float* data) override;
    bool close(Diagnostics&) override;

protected:
    /// Chooses the format; reports if it is not that of the type.
    virtual Format format(const DriverSetup&, Diagnostics&) = 0;
    /// Whether the numbers are data that must stay floats (depth).
    virtual bool data() const { return false; }
    /// Writes the file, when it is complete. Returns false after an error, which is reported.
    virtual bool write(const std::string& name, const Image& image, const WriteOptions& o, Diagnostics& diags) {
        return writeImage(name, image, o, diags);
    }

private:
    WriteOptions chooseSamples(Diagnostics&);
    void quantiseInto(Image&) const;
    DriverSetup setup_;
    Format format_ = Format::Exr;
    Image image_;
};

/// Reads a string parameter; `fallback` when absent; anything outside `allowed` is reported.
std::string stringParam(const DriverSetup&, const std::string& name, const std::vector<std::string>& allowed,
                        const std::string& fallback, Diagnostics&);

// The descriptors, one per file.
extern const DriverDescriptor fileDriver, framebufferDriver, nullDriver, zfileDriver, deepDriver, cryptomatteDriver, otherDriver;
/// The driver of a format: writes it whatever the name.
DriverDescriptor formatDriver(Format);

} // namespace alpenglow::display
