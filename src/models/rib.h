// A model as a scene in RIB.
#pragma once
#include "models/model.h"
#include <functional>
#include <string_view>

namespace alpenglow::models {

/// What a map of a material is made of.
struct MapWish {
    const Texture* texture; ///< a texture with a picture
    bool colour;            ///< sRGB that becomes light; else numbers
};
/// The map of a wish: its name as the scene shall have it ("": there is none, the factor alone counts) and its channels.
struct MapFile {
    std::string name;
    int channels = 3; ///< of 4 the last is opacity
};
using MapMaker = std::function<MapFile(const MapWish&)>;

/// What the command line sets.
struct RibOptions {
    std::string picture;   ///< name of the display
    int animation = 0;     ///< which one moves the model, where it has any; kNone: none
    double time = 0;       ///< seconds, when the shutter opens
    double shutter = 0;    ///< seconds that it is open; what moves meanwhile is blurred
    int camera = 0;        ///< which of those that are drawn; kNone: one that shows all
    double lightScale = 1; ///< on candela and lux: 1/683 for files of watts (docs/models.md)
    bool addLights = true; ///< a sky and a sun where there is no light
    int height = 480;      ///< of the picture; its width follows the camera
};

/// The text, in pieces. The model was checked. What cannot be said in RIB goes to `note`, once each.
void writeRib(const Model&, const RibOptions&, const MapMaker&, const std::function<void(std::string_view)>& text,
              const std::function<void(std::string)>& note);

/// "Surface ..." and what goes with it, for shaders/standard.sl. Text of lines. material: kNone for glTF's default.
std::string materialText(const Model&, int material, const MapMaker&, const std::function<void(std::string)>& note);
/// The set of texture coordinates that the maps of a material want.
int coordinateSet(const Material&);

/// A RIB string, in quotes.
std::string quoted(const std::string&);

} // namespace alpenglow::models
