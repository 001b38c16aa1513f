// Display drivers: output of the pixels of a Display request. A driver is one file in drivers/, described by one object with its
// names, manual text and factory; drivers() lists them.
#pragma once
#include "display/imageio.h"
#include "display/matte.h"
#include "display/quantize.h"
#include <functional>
#include <memory>

namespace alpenglow::display {

/// Parameters of a driver, set before the first pixel.
struct DriverSetup {
    std::string name;                  ///< of the Display request: a file name, or a window title
    std::string type;                  ///< as the request named it
    int width = 0, height = 0;         ///< of the delivered pixels (the crop window)
    int originX = 0, originY = 0;      ///< of its first pixel in the full picture
    int fullWidth = 0, fullHeight = 0; ///< of the full picture; 0 = the same
    float pixelAspect = 1;             ///< width divided by height of a pixel
    std::vector<std::string> channels; ///< channelNames(parseMode(...))
    scene::ParamList params;           ///< of the Display request
    Quantization rgba, z;              ///< by quantizationOf; z is for the channel "z", rgba for all others
    bool quantizeAsked = false;        ///< false: rgba and z are RI's defaults, which drivers of float formats pass over
    std::map<std::string, std::string> metadata;     ///< texts for the header, by key
    std::optional<Matrix> worldToCamera, worldToNDC; ///< for formats that store cameras; nothing: unknown
    std::shared_ptr<const DeepSamples> deep;         ///< for a deep shadow map (deepDriver); null: there is none, or no map
    MattesRef mattes;                                ///< for a "cryptomatte" (cryptomatteDriver); null: there are none
    OutputPolicy policy;                             ///< where files may be written
    SourcePlace place;                               ///< of the Display request
};

/// Receives one picture. Calls come from one thread, in the order open, rows..., close. The final file appears when close()
/// succeeds, complete; destroying an unclosed driver leaves no file.
class Driver {
public:
    virtual ~Driver() = default;
    /// Returns false, with an error reported, if the driver cannot show this.
    virtual bool open(const DriverSetup&, Diagnostics&) = 0;
    /// `count` rows from row y (0 = top), each width * channels floats, in any order of y. Unquantised, after exposure.
    virtual bool rows(int y, int count, const float* data) = 0;
    /// Publishes the picture. May be called again after further rows() (progressive renders): each call publishes a complete
    /// picture.
    virtual bool close(Diagnostics&) = 0;
};

/// What there is to know about a driver.
struct DriverDescriptor {
    std::vector<std::string> names; ///< display types it answers to, any case
    std::string doc;                ///< for the manual: what it writes, which parameters it reads
    /// Constructs a driver.
    std::function<std::unique_ptr<Driver>()> make;
    bool writes = true;                ///< a file under the display's name
    std::optional<Format> format = {}; ///< that it writes whatever the name; nothing: another file, or by the name
};

/// All drivers, in the order of the manual.
const std::vector<const DriverDescriptor*>& drivers();
/// By display type, ignoring case; null when there is none.
const DriverDescriptor* findDriver(const std::string& type);
/// The driver of a display type. An unknown type gets a picture driver that chooses by the name's extension, and one warning.
std::unique_ptr<Driver> makeDriver(const std::string& type, Diagnostics&, const SourcePlace& = {});
/// open, all rows, close for a finished picture. The image's channels must be setup.channels. Returns false after an error, which
/// is reported.
bool writeDisplay(const DriverSetup&, const Image&, Diagnostics&);

} // namespace alpenglow::display
