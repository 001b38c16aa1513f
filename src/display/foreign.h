// Other picture formats, through the module libalpenglow_pictures.so (texture/modules/openimageio.cpp), which uses OpenImageIO;
// and OpenVDB grids by libalpenglow_grids.so. Both are optional. They run in a child process: a crash of a foreign decoder ends
// the child and is reported as an error.
#pragma once
#include "display/formats/codecs.h"
#include <algorithm>
#include <cstdint>
#include <unistd.h>

namespace alpenglow::display {

/// Data between the two sides, in this order: this structure, `channels` names of kForeignName bytes, then width * height *
/// channels floats, for grids as many for each slice.
inline constexpr int kForeignName = 64;
/// The header that the module writes before the numbers; the layout is part of its interface.
struct ForeignPicture {
    uint32_t stamp;                  ///< kForeignStamp
    int32_t width, height, channels; ///< pixels; number of channels
    int32_t bits, floating;          ///< of a channel in the file
    char colourSpace[kForeignName];  ///< "" if the file does not tell: "sRGB", "linear", or a gamma as text
    uint32_t depth;                  ///< of grids: slices, each `height` rows, one below the other; pictures: 0
};
/// Memory in bytes that a module may use in addition to the picture.
inline constexpr uint64_t kForeignBytes = uint64_t(1) << 30;
inline constexpr uint32_t kForeignStamp = 0xa1f01;

/// Writes all data of a module. Returns false if the reader has gone.
inline bool sendForeign(int to, const void* bytes, size_t n) {
    for (size_t done = 0; done < n;) {
        const ssize_t k = ::write(to, static_cast<const char*>(bytes) + done, std::min<size_t>(n - done, size_t(1) << 30));
        if (k <= 0) return false;
        done += size_t(k);
    }
    return true;
}

/// Limits of base/limits.h on what a module reads: pixels of a side, number of channels, decoded bytes, decoded bytes that are
/// always allowed (smallBytes), and above these decoded bytes for each encoded byte (expansion).
struct ForeignLimits {
    uint64_t side, channels, bytes, smallBytes, expansion;
};
/// The function of the module. Reads the file at `path` and writes it to the descriptor `to`; returns 0 on success, else writes
/// an error to `why`, of `whySize` bytes. Rejects sizes beyond the limits before reading pixels.
using ReadForeignPicture = int (*)(const char* path, int to, const ForeignLimits*, char* why, int whySize);
/// The name under which the module exports it.
inline constexpr const char* kReadForeignPicture = "alpenglow_read_picture";

/// One of the two modules.
struct ForeignModule {
    const char *file, *variable; ///< its name; the environment variable that names another file
    const char* needs;           ///< package to install, for messages
    std::string known;           ///< formats that work without it, for messages
};
/// The module of OpenImageIO, and the one of OpenVDB.
const ForeignModule& pictureModule();
const ForeignModule& gridModule();

/// Its file (base/installation.h); "" when there is none.
std::string fileOf(const ForeignModule&);
/// Reads a file through a module; slices of grids are below each other, "depth" in the metadata is their number. Returns nothing
/// after an error, which is reported, also if the module is missing.
std::optional<Image> readForeign(const ForeignModule&, const std::string& path, const DecodeContext&);

} // namespace alpenglow::display
