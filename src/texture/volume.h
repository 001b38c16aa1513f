// Blocks of voxels: stacks of pictures, what maketx --gradients makes of them, and grids of OpenVDB (through a module).
// texture3d() reads them as it reads point clouds. (0, 0, 0) is the upper left corner of the first slice, (1, 1, 1) the lower
// right one of the last.
#pragma once
#include "base/file.h"
#include "clouds/map.h"
#include "texture/maketexture.h"
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::texture {

struct Volume {
    int width = 0, height = 0, depth = 0;
    std::vector<std::string> names; ///< of channels
    std::vector<float> values;      ///< slice by slice, row by row, interleaved
    int channels() const { return int(names.size()); }
    const float* at(int x, int y, int z) const {
        return &values[((size_t(z) * size_t(height) + size_t(y)) * size_t(width) + size_t(x)) * names.size()];
    }
    float* at(int x, int y, int z) { return const_cast<float*>(std::as_const(*this).at(x, y, z)); }
};

/// "textureformat" of a picture whose slices lie one below the other; its "depth" says how many.
extern const char* const volumeFormat;

/// Whether a name stands for a stack of pictures: a number like "%03d" or "####" (slices from the first that is there, 0 or 1,
/// without gaps), a number behind a star ("a.png*16": a strip of 16 slices, else 16 times the same), or ".vdb".
bool namesVolume(const std::string& name);

struct VolumeFiles {
    std::vector<std::string> searchPath{""};
    ReadPolicy read{};
    SourcePlace place;
};
/// The slices that a name stands for, or a picture of volumeFormat. Nothing: an error was reported.
std::optional<Volume> loadVolume(const std::string& name, const VolumeFiles&, Diagnostics&);
/// Whether the picture at a path is of volumeFormat. Reads no more than its head.
bool holdsVolume(const std::string& path);

/// What a volume is as r, g, b, a: the gradients of its opacity as colours, 0.5 (n + 1), and its opacity. Opacity: "a", else the
/// mean of the colours. n: the central difference over 2 * radius voxels, of length 1, or 0 where it is below 1e-4; and 0 nearer
/// than `radius` to the border. radius: at least 1.
Volume gradientsOf(const Volume&, int radius);
/// The means of the directions in r, g, b over (2 radius + 1)^3 voxels, those that are there; not made of length 1 again.
void smoothGradients(Volume&, int radius);
/// `maketx --gradients`: a picture of volumeFormat. False: an error was reported.
bool makeGradients(const std::string& volume, const std::string& picture, int radius, int smooth, const MakeOptions&,
                   Diagnostics&);

/// For texture3d(): in the unit cube. Channels: "color" (r, g, b, or grey thrice), "alpha" (a, else the mean of the colours),
/// "gradient" (vector: 2 r - 1, 2 g - 1, 2 b - 1), and each channel by its own name. Interpolated between voxels and levels;
/// nothing beside the cube.
std::shared_ptr<const clouds::CloudMap> mapOf(Volume);

} // namespace alpenglow::texture
