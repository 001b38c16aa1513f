// Pictures in formats that are not read here: by the module libalpenglow_pictures.so (texture/modules/openimageio.cpp), which
// knows OpenImageIO; and grids of OpenVDB by libalpenglow_grids.so. Both may be missing. They work in a child process: what goes
// wrong in a foreign decoder ends the child and is an error here.
#pragma once
#include "display/formats/codecs.h"
#include <algorithm>
#include <cstdint>
#include <unistd.h>

namespace alpenglow::display {

/// What the two sides pass each other, in this order: this, `channels` names of kForeignName bytes, then width * height *
/// channels floats, of a grid as many for each slice.
inline constexpr int kForeignName = 64;
struct ForeignPicture {
    uint32_t stamp; ///< kForeignStamp
    int32_t width, height, channels;
    int32_t bits, floating;         ///< of a channel in the file
    char colourSpace[kForeignName]; ///< "" where the file says nothing: "sRGB", "linear", or a gamma as text
    uint32_t depth;                 ///< of grids: slices, each `height` rows, one below the other; pictures: 0
};
/// Bytes of memory that a module may take beside the picture.
inline constexpr uint64_t kForeignBytes = uint64_t(1) << 30;
inline constexpr uint32_t kForeignStamp = 0xa1f01;

/// What a module sends, all of it. False: nobody takes it.
inline bool sendForeign(int to, const void* bytes, size_t n) {
    for (size_t done = 0; done < n;) {
        const ssize_t k = ::write(to, static_cast<const char*>(bytes) + done, std::min<size_t>(n - done, size_t(1) << 30));
        if (k <= 0) return false;
        done += size_t(k);
    }
    return true;
}

/// The one function of the module. Reads the file at `path` and writes it to the descriptor `to`; 0 when it is done. Else `why`,
/// of `whySize` bytes, says what went wrong. Sizes beyond the limits are refused before pixels are read.
struct ForeignLimits {
    uint64_t side, channels, bytes, smallBytes, expansion;
};
using ReadForeignPicture = int (*)(const char* path, int to, const ForeignLimits*, char* why, int whySize);
inline constexpr const char* kReadForeignPicture = "alpenglow_read_picture";

struct ForeignModule {
    const char *file, *variable; ///< its name; the environment variable that names another file
    const char* needs;           ///< what has to be installed, for messages
    const char* known;           ///< what is read without it, for messages
};
const ForeignModule& pictureModule();
const ForeignModule& gridModule();

/// Its file (base/installation.h); "" when there is none.
std::string fileOf(const ForeignModule&);
/// What a module makes of a file; slices of grids lie one below the other, "depth" in the metadata says how many. Nothing: an
/// error was reported, which says so when it is the module that is missing.
std::optional<Image> readForeign(const ForeignModule&, const std::string& path, const DecodeContext&);

} // namespace alpenglow::display
