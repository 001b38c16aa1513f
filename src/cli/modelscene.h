#pragma once
#include <string>

namespace alpenglow::cli {

/// A scene around a file of polygons (.ply, .obj): the model whole in the picture, seen from a little above and to the side of
/// its front
/// (+z, y up), on a floor under a sky and a sun. Its own colours, on a plastic that takes its maps. The text names the file
/// without its folder. Messages about the file come when the scene is read, not here.
std::string modelScene(const std::string& file);

} // namespace alpenglow::cli
