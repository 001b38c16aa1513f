// The scenes of bench/scenes: small ones are files there, large ones are made here, always the same to the byte.
#pragma once
#include "base/diagnostics.h"
#include <string>
#include <vector>

namespace alpenglow::bench {

struct BenchScene {
    const char* name; ///< also of its file, NAME.rib
    const char* what; ///< one line for people
    int samples;      ///< a pixel, for some seconds of one core
    bool made;        ///< by this program; else a file of bench/scenes or examples
};
/// In the order of issue "The engine in columns"; `ten_lights` and `one_shader` belong to the scene before them.
const std::vector<BenchScene>& benchScenes();

/// Writes a scene with all its shaders and maps into a folder, so that `alpenglow render FOLDER/NAME.rib` does. A map or mesh
/// that is there already is kept. `size` 0..1: the share of lights, shaders, spheres, and of the sides of meshes and maps (tests
/// take little); files of another size do not belong into the same folder. False: an error was reported, or there is no such
/// scene.
bool writeBenchScene(const std::string& name, const std::string& folder, double size, Diagnostics&);

} // namespace alpenglow::bench
