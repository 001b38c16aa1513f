// Display type "null": discards the picture.
#include "display/drivers/picture.h"

namespace alpenglow::display {
namespace {

class Null : public Driver {
    bool open(const DriverSetup&, Diagnostics&) override { return true; }
    bool rows(int, int, const float*) override { return true; }
    bool close(Diagnostics&) override { return true; }
};

} // namespace

const DriverDescriptor nullDriver{{"null", "none"},
                                  "Nothing: the picture is rendered and thrown away.",
                                  []() -> std::unique_ptr<Driver> { return std::make_unique<Null>(); },
                                  false};

} // namespace alpenglow::display
