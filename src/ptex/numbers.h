// Numbers of Ptex files, little-endian whatever the machine.
#pragma once
#include "ptex/ptexfile.h"
#include <bit>
#include <span>
#include <zlib.h>

namespace alpenglow::ptex {

/// Bytes of a number.
inline size_t sizeOf(Number n) { return n == Number::Byte ? 1 : n == Number::Float ? 4 : 2; }

/// Reads an unsigned integer of sizeof(T) bytes.
template <class T> T take(const uint8_t* from) {
    T v = 0;
    for (size_t i = 0; i < sizeof(T); ++i) v = T(v | T(from[i]) << (8 * i));
    return v;
}
/// Appends an unsigned integer.
template <class T> void put(std::vector<uint8_t>& to, T v) {
    for (size_t i = 0; i < sizeof(T); ++i) to.push_back(uint8_t(v >> (8 * i)));
}

/// A number as a float, bytes and words as 0 to 1.
float toFloat(Number, const uint8_t*);
/// Appends a number; bytes and words are rounded and clamped.
void fromFloat(Number, float, std::vector<uint8_t>& to);

/// Decompresses exactly `size` bytes. Returns false if the stream is damaged, or has another size.
bool inflated(std::span<const uint8_t>, size_t size, std::vector<uint8_t>& to);
/// Compresses by zlib.
std::vector<uint8_t> deflated(std::span<const uint8_t>);
/// Parses the 20 bytes of a face.
Face faceOf(const uint8_t*);

/// Reverses difference encoding for integers of this size in bytes; other sizes are unchanged.
void addUp(size_t size, std::vector<uint8_t>&);
/// Largest decompressed size of a stream with so many bytes.
inline uint64_t mostInflated(uint64_t bytes) { return bytes * 1040 + 1024; }

/// Encodings of data blocks, in bits 30 and 31 of their size.
enum Encoding : uint32_t { kConstant = 0, kZipped = 1, kDifferences = 2, kTiled = 3 };
/// Bytes of a data block, from the size with its encoding.
inline uint32_t blockSize(uint32_t header) { return header & 0x3fffffffu; }
/// The encoding from the same word.
inline Encoding encodingOf(uint32_t header) { return Encoding(header >> 30); }

} // namespace alpenglow::ptex
