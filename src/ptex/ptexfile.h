// Ptex files: a picture for each face of a mesh, and adjacency of faces. Source: Ptex File Format Specification, version 1.3r1
// (ptex.us/PtexFile.html), and its pages on adjacency and triangles. u and v run from 0 to 1 over a face, from its first corner
// to the second and to the last.
#pragma once
#include "base/diagnostics.h"
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace alpenglow {
struct OutputPolicy;
}

namespace alpenglow::ptex {

/// What the faces of the mesh are.
enum class Mesh : uint8_t { Triangle = 0, Quad = 1 };
enum class Number : uint8_t { Byte = 0, Word = 1, Half = 2, Float = 3 }; ///< bytes and words represent 0 to 1
enum class Border : uint8_t { Clamp = 0, Black = 1, Periodic = 2 };      ///< where a face has no neighbour

/// A face as the file describes it.
struct Face {
    uint8_t ulog = 0, vlog = 0;                      ///< logarithms of the pixels along u and v; triangles: the same
    bool constant = false, subface = false;          ///< subface: a quarter, or so, of a face that is no quadrilateral
    std::array<int32_t, 4> adjacent{-1, -1, -1, -1}; ///< by edge, from the first corner on; -1: none
    std::array<uint8_t, 4> edge{};                   ///< which of the neighbour's edges it is
};

/// Rows of constant v, from v = 0; channels of a pixel are interleaved. For triangles: pixel (i, j) with i + j < n is the
/// triangle at (i / n, j / n); the others are the inverted triangles, rotated about the centre of the square.
struct Image {
    int u = 1, v = 1;          ///< pixels along u and v
    std::vector<float> values; ///< rows of pixels
};

/// A level of a face that is read piece by piece: equal rectangles, row by row.
struct Tiles : Image {             ///< sides of the level; no values
    int tu = 0, tv = 0;            ///< logarithms of the sides of a piece
    std::vector<uint64_t> at;      ///< file position of each
    std::vector<uint32_t> headers; ///< bytes of its header, by tile
    /// Index of the tile that contains a pixel, and of the pixel in it.
    uint32_t numberOf(int i, int j) const { return uint32_t(j >> tv) * uint32_t(u >> tu) + uint32_t(i >> tu); }
    size_t within(int i, int j) const { return (size_t(j & ((1 << tv) - 1)) << tu) + size_t(i & ((1 << tu) - 1)); }
};

/// An entry of the metadata.
struct Meta {
    std::string key;            ///< as in the file
    uint8_t type = 0;           ///< 0 text, 1 to 3 integers of 1, 2, 4 bytes, 4 float, 5 double
    std::vector<uint8_t> bytes; ///< as in the file, little-endian
};

/// What holds for the whole file.
struct Head {
    Mesh mesh = Mesh::Quad;                                  ///< shape of the faces
    Number number = Number::Byte;                            ///< how the file stores values
    int channels = 3, alpha = -1;                            ///< alpha: its channel, or none
    Border uBorder = Border::Clamp, vBorder = Border::Clamp; ///< at the edges of the mesh
    std::vector<Face> faces;                                 ///< by index
    std::vector<Meta> metas;                                 ///< in their order
};

/// Faces of any number of files, those that were looked at last; bounded. Thread safe.
class Cache;
/// bytes: most memory of all its faces.
std::shared_ptr<Cache> makeCache(size_t bytes);

/// A file that is open. Thread safe.
class Texture {
public:
    virtual ~Texture() = default;
    /// Valid as long as the texture.
    virtual const Head& head() const = 0;
    /// A face with its sides halved this many times, at least one pixel, premultiplied with alpha. The mean of the face if it
    /// cannot be read, which is reported once.
    virtual std::shared_ptr<const Image> image(uint32_t face, int halvings) const = 0;
    /// File positions of the tiles of such a picture, if it is stored in tiles and too large to read completely; else null.
    virtual std::shared_ptr<const Tiles> tiles(uint32_t face, int halvings) const = 0;
    /// One of its pieces, as image() has it there.
    virtual std::shared_ptr<const Image> tile(uint32_t face, int halvings, const Tiles&, uint32_t number) const = 0;
};
/// Null: an error was reported.
std::shared_ptr<const Texture> openTexture(const std::string& path, std::shared_ptr<Cache>, Diagnostics&,
                                           const SourcePlace& = {});

/// Writes a file: faces of `images`, by index, with the sizes in the head; coarser levels are computed. Returns false after an
/// error, which is reported; an existing file is then unchanged.
bool writeTexture(const std::string& name, Head, const std::vector<Image>& images, const OutputPolicy&, Diagnostics&,
                  const SourcePlace& = {});

/// A picture of half the sides, not below one pixel: means.
Image halved(const Image&, int channels, Mesh);
/// The same tile by tile, where pixels are found by `pixel(i, j)`, the first number of one.
Image halved(const Tiles&, int channels, Mesh, const std::function<const float*(int i, int j)>& pixel);

} // namespace alpenglow::ptex
