// Reading and writing pictures: OpenEXR, TIFF, PNG, JPEG; reading only: Radiance, Targa, KTX, zfiles, Pixar's
// native textures, and through a module (display/foreign.h) whatever OpenImageIO reads.
#pragma once
#include "base/file.h"
#include "display/image.h"
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace alpenglow::display {

enum class Format { Exr, Tiff, Png, Jpeg };
/// "OpenEXR", "TIFF", "PNG", "JPEG".
const char* toString(Format);
enum class Sample { UInt8, UInt16, Half, Float };

struct ReadOptions {
    bool levels = false; ///< also the reduced levels of a MIP-mapped file
    SourcePlace place;   ///< where the file was named
};

/// Reads a picture, recognised by its first bytes rather than its name. Returns nothing after an error, which is reported.
/// Damaged, truncated and oversized files are errors (limits.h); memory use is limited by file size.
std::optional<Image> readImage(const std::string& path, Diagnostics&, const ReadOptions& = {});
/// The same from memory; `name` is for messages.
std::optional<Image> decodeImage(std::span<const uint8_t> bytes, const std::string& name, Diagnostics&, const ReadOptions& = {});

struct WriteOptions {
    Format format = Format::Exr;
    /// EXR: Half or Float. TIFF: UInt8, UInt16, Float. PNG: UInt8, UInt16. JPEG: UInt8. Other types are converted to the nearest
    /// that the format has; drivers report that before.
    Sample sample = Sample::Float;
    bool quantised = false; ///< integer formats: data are codes (0..255) already; else [0,1] is scaled, rounded and clamped
    std::string compression = "zip"; ///< EXR: none rle zips zip piz; TIFF: none zip lzw packbits
    int tile = 0;                    ///< > 0: tiles of that side (EXR only); image.levels are then written as MIP-map levels
    OutputPolicy policy;
    SourcePlace place;
};

/// Writes a complete picture or nothing (base/file.h). Returns false after an error, which is reported.
bool writeImage(const std::string& path, const Image&, const WriteOptions&, Diagnostics&);

/// The format of a name's extension (kPictureExtensions, any case); nothing for others.
std::optional<Format> formatOfExtension(const std::string& path);
inline constexpr const char* kPictureExtensions = ".exr .png .tif .tiff .jpg .jpeg";

} // namespace alpenglow::display
