// Shared by imageio.cpp and the codecs. One codec a file.
#pragma once
#include "display/imageio.h"
#include <algorithm>
#include <initializer_list>

namespace alpenglow::display {

/// The bytes of a file.
using Bytes = std::span<const uint8_t>;

/// Diagnostics context of a decoder.
struct DecodeContext {
    const std::string& name;    ///< of the file, for messages
    Diagnostics& diags;         ///< where errors are reported
    const ReadOptions& options; ///< what the caller asked for
    size_t fileBytes;           ///< size of the encoded file
    bool file = false;          ///< the name is a file name: unknown formats are read through the module (foreign.h)
    /// Reports `cannot read "name": why` and returns nothing.
    std::nullopt_t refuse(const std::string& why, Rie code = Rie::BadFile) const;
    /// Warns about a file that is read all the same.
    void warn(const std::string& why) const;
    /// The limits on sides, channels, bytes and expansion; false after an error. Ask before allocating.
    bool sizeAllowed(uint64_t width, uint64_t height, uint64_t channels) const;
};

/// A picture format: how it is recognised, read and, if it is, written. None of the functions throws.
struct PictureFormat {
    const char* name;         ///< for messages
    bool (*recognise)(Bytes); ///< by the first bytes
    /// Decodes a complete file; nothing after an error, which is reported.
    std::optional<Image> (*decode)(Bytes, const DecodeContext&);
    /// Writes to an open file; returns false after an error, which is in `why` (or in the file). Null: the format is read only.
    bool (*encode)(OutputFile&, const Image&, const WriteOptions&, Diagnostics&, std::string& why) = nullptr;
    const WrittenFormat* written = nullptr; ///< with `encode`
};

/// Whether a file begins with these bytes.
inline bool starts(Bytes b, std::initializer_list<int> magic) {
    return b.size() >= magic.size() &&
           std::equal(magic.begin(), magic.end(), b.begin(), [](int m, uint8_t x) { return uint8_t(m) == x; });
}

/// Indices of the channels that a file of one picture holds: r g b, else the first three or the first one; then a, with `alpha`.
std::vector<int> pictureChannels(const Image&, bool alpha);
/// Warns about channels that are not in `written`; for alpha alone only a note.
void sayLeftOut(const char* format, const Image&, const std::vector<int>& written, const std::string& path, const WriteOptions&,
                Diagnostics&);

/// Converts a sample to an integer code of 8 or 16 bits: unchanged if quantised, else value * maximum; rounded, clamped; NaN is
/// 0.
unsigned toCode(float value, unsigned maximum, bool quantised);

} // namespace alpenglow::display
