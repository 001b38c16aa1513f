#include "scene/numbers.h"
#include "scene/scene.h"
#include <algorithm>

namespace alpenglow::scene {
namespace {
constexpr const char* kLaterFormats[] = {".png", ".jpg", ".jpeg", ".exr"};
}

bool keepsOwnNumbers(const Options& o, bool path) {
    if (path) return false;
    if (o.exposureSet || o.quantizeRgba.set) return true;
    return std::any_of(o.displays.begin(), o.displays.end(), [](const Display& d) {
        std::string name = d.name;
        for (char& c : name) c = char(std::tolower(static_cast<unsigned char>(c)));
        const bool later =
            std::any_of(std::begin(kLaterFormats), std::end(kLaterFormats), [&](const char* e) { return name.ends_with(e); });
        return (d.type == "file" || d.type == "framebuffer") && !later;
    });
}

bool readsMapsAsLight(const Options& o, bool path, Diagnostics& diags) {
    const auto told = o.values.find("texture:colorspace");
    if (told != o.values.end() && !told->second.strings.empty()) {
        const std::string& word = told->second.strings[0];
        if (word == "srgb" || word == "sRGB") return true;
        if (word == "linear") return false;
        if (word != "auto")
            diags.report(Severity::Error, Rie::Range, told->second.place,
                         "Option \"texture\" \"colorspace\" is auto, srgb or linear, not \"" + word + "\"; auto is used",
                         nearestName(word, {"auto", "srgb", "linear"}));
    }
    return !keepsOwnNumbers(o, path);
}

} // namespace alpenglow::scene
