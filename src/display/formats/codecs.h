// Shared by imageio.cpp and the codecs. One codec per file; none throws.
#pragma once
#include "display/imageio.h"

namespace alpenglow::display {

using Bytes = std::span<const uint8_t>;

/// Diagnostics context of a decoder.
struct DecodeContext {
    const std::string& name;
    Diagnostics& diags;
    const ReadOptions& options;
    size_t fileBytes;
    bool file = false; ///< the name is a file name: unknown formats are read through the module (foreign.h)
    /// Reports `cannot read "name": why` and returns nothing.
    std::nullopt_t refuse(const std::string& why, Rie code = Rie::BadFile) const;
    void warn(const std::string& why) const;
    /// The limits on sides, channels, bytes and expansion; false after an error. Ask before allocating.
    bool sizeAllowed(uint64_t width, uint64_t height, uint64_t channels) const;
};

std::optional<Image> decodeExr(Bytes, const DecodeContext&);
std::optional<Image> decodeTiff(Bytes, const DecodeContext&);
std::optional<Image> decodePng(Bytes, const DecodeContext&);
std::optional<Image> decodeJpeg(Bytes, const DecodeContext&);
std::optional<Image> decodeZfile(Bytes, const DecodeContext&);
std::optional<Image> decodeRadiance(Bytes, const DecodeContext&);
std::optional<Image> decodePixar(Bytes, const DecodeContext&);
std::optional<Image> decodeTarga(Bytes, const DecodeContext&);
std::optional<Image> decodeKtx(Bytes, const DecodeContext&);
/// Whether a file starts like KTX or KTX2.
bool looksLikeKtx(Bytes);
/// Whether a file may be a Targa picture, by its complete header.
bool looksLikeTarga(Bytes);

/// Encoders write to an open file; they return false after an error, which is in `why` (or in the file).
bool encodeExr(OutputFile&, const Image&, const WriteOptions&, std::string& why);
bool encodeTiff(OutputFile&, const Image&, const WriteOptions&, std::string& why);
bool encodePng(OutputFile&, const Image&, const WriteOptions&, Diagnostics&, std::string& why);
bool encodeJpeg(OutputFile&, const Image&, const WriteOptions&, Diagnostics&, std::string& why);

/// Indices of the channels that a file of one picture holds: r g b, else the first three or the first one; then a, with `alpha`.
std::vector<int> pictureChannels(const Image&, bool alpha);
/// Warns about channels that are not in `written`; for alpha alone only a note.
void sayLeftOut(const char* format, const Image&, const std::vector<int>& written, const std::string& path, const WriteOptions&,
                Diagnostics&);

/// Converts a sample to an integer code of 8 or 16 bits: unchanged if quantised, else value * maximum; rounded, clamped; NaN is
/// 0.
unsigned toCode(float value, unsigned maximum, bool quantised);

} // namespace alpenglow::display
