// Reading and writing pictures. Each format has a file in formats/, which describes it; imageio.cpp has the list. A module
// (display/foreign.h) reads what OpenImageIO reads.
#pragma once
#include "base/file.h"
#include "display/image.h"
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace alpenglow::display {

/// The formats that are written, in the order of the list.
enum class Format { Exr, Tiff, Png, Jpeg };

/// A format that is written.
struct WrittenFormat {
    const char* name;                    ///< for messages
    std::vector<std::string> extensions; ///< in small letters, without the dot
    bool floats = true;                  ///< holds floating point
    bool codes = true;                   ///< holds integer codes, by Quantize
    int bits = 16;                       ///< most bits of a code
    std::vector<std::string> displays;   ///< display types that write it always
    std::string doc;                     ///< for the manual of display types
};
/// The description of a format.
const WrittenFormat& written(Format);
/// The name for messages.
inline const char* toString(Format f) { return written(f).name; }
/// All formats that are written.
std::span<const Format> writtenFormats();
/// The names of all formats that are read, in one line.
std::string readFormats();
/// How a file stores a number; integers stand for 0 to 1.
enum class Sample { UInt8, UInt16, Half, Float };

/// What is read of a file besides its pixels.
struct ReadOptions {
    bool levels = false; ///< also the reduced levels of a MIP-mapped file
    SourcePlace place;   ///< where the file was named
};

/// Reads a picture, recognised by its first bytes rather than its name. Returns nothing after an error, which is reported.
/// Damaged, truncated and oversized files are errors (limits.h); memory use is limited by file size.
std::optional<Image> readImage(const std::string& path, Diagnostics&, const ReadOptions& = {});
/// The same from memory; `name` is for messages.
std::optional<Image> decodeImage(std::span<const uint8_t> bytes, const std::string& name, Diagnostics&, const ReadOptions& = {});

/// How a picture is written.
struct WriteOptions {
    Format format = Format::Exr; ///< file format
    /// A type that the format does not have (WrittenFormat) is converted to the nearest; drivers report that before.
    Sample sample = Sample::Float;
    bool quantised = false; ///< integer formats: data are codes (0..255) already; else [0,1] is scaled, rounded and clamped
    std::string compression = "zip"; ///< EXR: none rle zips zip piz; TIFF: none zip lzw packbits
    int tile = 0;                    ///< > 0: tiles of that side (EXR only); image.levels are then written as MIP-map levels
    OutputPolicy policy;             ///< where files may be written
    SourcePlace place;               ///< of the request, for messages
};

/// Writes a complete picture or nothing (base/file.h). Returns false after an error, which is reported.
bool writeImage(const std::string& path, const Image&, const WriteOptions&, Diagnostics&);

/// Writes depths as a zfile, which holds the channel "z" of a whole picture with its matrices: what is not there is at 1e30, as
/// are pixels outside of a crop window. Returns false after an error, which is reported.
bool writeZfile(const std::string& path, const Image&, const OutputPolicy&, Diagnostics&, const SourcePlace& = {});

/// The format of a name's extension, in any case; nothing for others.
std::optional<Format> formatOfExtension(const std::string& path);
/// The extensions of all formats that are written: ".exr .tif ...".
std::string pictureExtensions();

} // namespace alpenglow::display
