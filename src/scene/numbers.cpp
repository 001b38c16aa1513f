#include "scene/numbers.h"
#include "scene/scene.h"

namespace alpenglow::scene {

MapColours mapColours(const Options& o, bool path, Diagnostics& diags) {
    const auto space = o.values.find("texture:colorspace");
    if (space != o.values.end() && !space->second.strings.empty()) {
        const std::string& word = space->second.strings[0];
        if (word == "srgb" || word == "sRGB") return MapColours::Srgb;
        if (word == "linear") return MapColours::Light;
        if (word != "auto")
            diags.report(Severity::Error, Rie::Range, space->second.place,
                         "Option \"texture\" \"colorspace\" is auto, srgb or linear, not \"" + word + "\"; auto is used",
                         nearestName(word, {"auto", "srgb", "linear"}));
    }
    return path ? MapColours::Srgb : MapColours::AsTheyAre;
}

} // namespace alpenglow::scene
