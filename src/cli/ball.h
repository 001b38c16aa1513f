// The picture of `alpenglow shade`: a shader on a lit ball.
#pragma once
#include "base/diagnostics.h"
#include "rsl/compiler.h"
#include <string>
#include <vector>

namespace alpenglow::cli {

/// Settings of `alpenglow shade` for the ball.
struct BallSettings {
    std::string shader;                              ///< file or name, as the user gave it
    rsl::ShaderKind kind = rsl::ShaderKind::Surface; ///< surface or volume
    std::vector<rsl::ParameterValue> given;          ///< parameters that the user set
    std::string output;                              ///< picture, or "-"
    int width = 256, height = 256, spp = 0;          ///< 0 = 64
    int lanes = 16;                                  ///< of the kernel; the picture does not depend on it
    float gamma = 0;                                 ///< 0 = as -o has it under path
    std::vector<std::string> searchPaths;            ///< for shaders and maps
    std::string dialect;                             ///< of --dialect; "": found out
    bool allowExec = false;                          ///< shaders may run programs
};

/// Requests of the scene: a ball on a floor, under a lamp and a sky, as in examples/shaders/ball.rib. A surface is on the ball, a
/// displacement pushes it, a volume is the air, a light is the lamp, an imager processes the picture.
std::string ballScene(const BallSettings&);

/// Path traces the ball and writes the picture. Returns the exit status.
int shadeBall(const BallSettings&, Diagnostics&);

} // namespace alpenglow::cli
