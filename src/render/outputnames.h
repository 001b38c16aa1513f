// Names of what a run writes: the numbers of frames in them, which displays are maps, and that no two outputs share a file.
#pragma once
#include "render/settings.h"
#include "scene/fwd.h"
#include <map>
#include <string>
#include <vector>

namespace alpenglow::render {

/// Whether a name says where the number of a frame stands: a run of '#', or %d with or without a width (%04d, up to 16).
bool hasFrameNumber(const std::string& name);
/// The name with the number in the first such place, padded with zeros to as many digits as there are '#'. Others stay as they
/// are.
std::string withFrame(const std::string& name, int frame);
/// withFrame() where there is such a place, else name.ext becomes name.<number>.ext, number with four digits at least.
std::string numberedName(const std::string& name, int number);
/// In lower case and without the dot; "" when there is none.
std::string extensionOf(const std::string& file);
/// Whether a frame has a number: it is between FrameBegin and FrameEnd.
bool isNumbered(const scene::Options&);

/// Whether a display is a map for later frames and no picture to look at: of the types zfile, shadow, deepshad, depth alone, or
/// read by a Make request.
bool isMap(const scene::Display&);
/// Whether all files of a frame are maps. The command line's options about pictures do not concern such a frame.
bool isMapPass(const scene::Options&);
/// The settings without what concerns pictures (-o, --hider, --format, --gamma, --spp, --samples, --pixel ...).
RenderSettings settingsOfMaps(const RenderSettings&);
/// The options about pictures that were given, for messages: "-o, --hider"; "" when none was.
std::string pictureOptions(const RenderSettings&);

/// A display of a frame under the name of its file.
struct NamedDisplay {
    scene::Display display;
    bool user = false; ///< by --display: it may lie anywhere
};
/// The scene's displays and those of --display, numbers of frames put in; "ri.pic" when there are none. `pictures` false: only
/// maps, those of --display and, beside the picture of -o, those behind the first that hold other outputs.
std::vector<NamedDisplay> displaysOf(const scene::Options&, const RenderSettings&, bool pictures = true);

/// The files that a run has written or will write. Not thread safe.
class OutputNames {
public:
    /// A world begins: what earlier ones wrote is not overwritten, but for maps by maps.
    void nextWorld() { ++world_; }
    /// The name under which an output is written: its own, or where another output of this run has that file, one beside it: with
    /// the number of the frame when an earlier frame has it, else with .2, .3 ... before the extension. A change of name is
    /// reported unless `diags` is null. kind: "display", "checkpoint" for the message.
    std::string take(const std::string& kind, const std::string& name, bool map, const scene::Options&, const SourcePlace&,
                     Diagnostics* diags);
    /// A Make request has read this file; the next frame may use the name again.
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
