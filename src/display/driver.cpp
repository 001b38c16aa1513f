#include "display/driver.h"
#include "display/drivers/picture.h"

namespace alpenglow::display {
namespace {

std::string lower(std::string s) {
    for (char& c : s) c = char(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    return s;
}

} // namespace

const std::vector<const DriverDescriptor*>& drivers() {
    static const std::vector<DriverDescriptor> ofFormats = [] {
        std::vector<DriverDescriptor> all;
        for (Format f : writtenFormats()) all.push_back(formatDriver(f));
        return all;
    }();
    static const std::vector<const DriverDescriptor*> list = [] {
        std::vector<const DriverDescriptor*> all;
        for (const DriverDescriptor& d : ofFormats) all.push_back(&d);
        all.insert(all.end(),
                   {&fileDriver, &framebufferDriver, &nullDriver, &zfileDriver, &deepDriver, &cryptomatteDriver, &otherDriver});
        return all;
    }();
    return list;
}

const DriverDescriptor* findDriver(const std::string& type) {
    std::string t = lower(type);
    for (const DriverDescriptor* d : drivers())
        for (const std::string& n : d->names)
            if (n == t) return d;
    return nullptr;
}

std::unique_ptr<Driver> makeDriver(const std::string& type, Diagnostics& diags, const SourcePlace& place) {
    if (const DriverDescriptor* d = findDriver(type)) return d->make();
    std::vector<std::string> names;
    for (const DriverDescriptor* d : drivers()) names.insert(names.end(), d->names.begin(), d->names.end());
    Diagnostic d;
    d.severity = Severity::Warning;
    d.code = Rie::BadToken;
    d.place = place;
    d.message = "unknown display type \"" + type + "\"; a picture file is written under the given name";
    d.hint = nearestName(lower(type), names);
    if (!d.hint.empty()) d.hint = "did you mean \"" + d.hint + "\"?";
    diags.reportOnce("display-type:" + type, d);
    return otherDriver.make();
}

bool writeDisplay(const DriverSetup& setup, const Image& image, Diagnostics& diags) {
    if (image.channels != setup.channels || image.width != setup.width || image.height != setup.height ||
        image.data.size() != image.sampleCount()) {
        diags.report(Severity::Error, Rie::Bug, setup.place,
                     "display \"" + setup.name + "\": the picture does not match its announced size and channels");
        return false;
    }
    auto driver = makeDriver(setup.type, diags, setup.place);
    if (!driver->open(setup, diags)) return false;
    return driver->rows(0, image.height, image.data.data()) && driver->close(diags);
}

} // namespace alpenglow::display
