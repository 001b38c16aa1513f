// The codings of a tile in Pixar's native textures, apart from the file around them.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace alpenglow::display::pixar {

/// The bytes of a coded tile.
using Bytes = std::span<const uint8_t>;

/// Each fills `tile` with samples of `sampleBytes` bytes in the byte order of the file. Returns null on success, else an error as
/// words that follow "its run lengths", "its LZW codes" and so on; the tile is then undefined. They do not read outside of `from`
/// or write outside of `tile`; surplus bytes are not an error (one writer leaves some).

/// n < 128: repeats the next sample n + 1 times; else copies n - 127 samples.
const char* runLengths(Bytes from, std::span<uint8_t> tile, size_t sampleBytes);
/// As in GIF, but without codes for clearing and the end: 257 is the first new code, 256 is not used.
const char* lzw(Bytes from, std::span<uint8_t> tile);
/// The used values as a bitmap, the lengths of their codes, the codes themselves, then the samples; no differences.
const char* huffman(Bytes from, std::span<uint8_t> tile);
/// A zlib stream of differences from sample to sample, modulo 2^8 or 2^32.
const char* deflated(Bytes from, std::span<uint8_t> tile, size_t sampleBytes, bool bigEndian);

} // namespace alpenglow::display::pixar
