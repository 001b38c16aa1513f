// Names of output files: frame numbers, which displays are maps, and unique files for all outputs.
#pragma once
#include "render/settings.h"
#include "scene/fwd.h"
#include <map>
#include <string>
#include <vector>

namespace alpenglow::render {

/// Whether a name has a place for the frame number: a run of '#', or %d with optional width (%04d, up to 16).
bool hasFrameNumber(const std::string& name);
/// Puts the number into the first such place, padded with zeros to as many digits as there are '#'. Other names are unchanged.
std::string withFrame(const std::string& name, int frame);
/// withFrame() if there is such a place; else name.ext becomes name.<number>.ext, with at least four digits.
std::string numberedName(const std::string& name, int number);
/// Lower case, without the dot; "" if there is none.
std::string extensionOf(const std::string& file);
/// Whether a frame has a number, i.e. is between FrameBegin and FrameEnd.
bool isNumbered(const scene::Options&);

/// Whether a display is a map for later frames rather than a picture: types zfile, shadow, deepshad, depth only, or read by a
/// Make request.
bool isMap(const scene::Display&);
/// Whether all files of a frame are maps. Picture options of the command line do not apply to such a frame.
bool isMapPass(const scene::Options&);
/// The settings without picture options (-o, --hider, --format, --gamma, --spp, --samples, --pixel ...).
RenderSettings settingsOfMaps(const RenderSettings&);
/// The picture options that were given, for messages: "-o, --hider"; "" if none.
std::string pictureOptions(const RenderSettings&);

/// A display of a frame with its final file name.
struct NamedDisplay {
    scene::Display display;
    bool user = false; ///< by --display: may be in any folder
};
/// The displays of the scene and of --display with frame numbers filled in; "ri.pic" if there are none. `pictures` false: only
/// maps, those of --display, and next to the picture of -o those after the first that hold other outputs.
std::vector<NamedDisplay> displaysOf(const scene::Options&, const RenderSettings&, bool pictures = true);

/// The files that a run has written or will write. Not thread safe.
class OutputNames {
public:
    /// Starts a world: files of earlier worlds are not overwritten, except maps by maps.
    void nextWorld() { ++world_; }
    /// The name for an output: its own, or if another output of this run has that file, a variant: with the frame number if an
    /// earlier frame has it, else with .2, .3 ... before the extension. A change is reported unless `diags` is null. kind:
    /// "display", "checkpoint" for the message.
    std::string take(const std::string& kind, const std::string& name, bool map, const scene::Options&, const SourcePlace&,
                     Diagnostics* diags);
    /// A Make request has read this file; the next frame may reuse the name.
    void release(const std::string& name);

private:
    struct Owner {
        int world = 0;
        bool map = false;
        SourcePlace place;
    };
    bool mayTake(const std::string& name, bool map) const;
    std::map<std::string, Owner> owners_; ///< by fileIdentity()
    int world_ = 0;
};

} // namespace alpenglow::render
