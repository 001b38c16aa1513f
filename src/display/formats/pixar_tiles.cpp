#include "display/formats/pixar.h"
#include <algorithm>
#include <array>
#include <cstring>
#include <vector>
#include <zlib.h>

namespace alpenglow::display::pixar {
namespace {

/// Bits, the first the most significant of its byte. Past the end: -1.
class BitsFromTop {
public:
    explicit BitsFromTop(Bytes b) : bytes_(b) {}
    int next() {
        if (at_ >= bytes_.size() * 8) return -1;
        int bit = bytes_[at_ >> 3] >> (7 - (at_ & 7)) & 1;
        ++at_;
        return bit;
    }
    void toByte() { at_ = (at_ + 7) & ~size_t(7); }

private:
    Bytes bytes_;
    size_t at_ = 0;
};

/// A prefix code as a tree. Nodes: children by bit; 0 = none, below 0 the value -1 - child.
class PrefixTree {
public:
    PrefixTree() : nodes_(1) {}
    /// Whether the code of `length` bits could be taken from `bits` and is no part of another, nor another a part of it.
    const char* add(BitsFromTop& bits, int length, int value) {
        size_t at = 0;
        for (int i = 0; i < length; ++i) {
            int bit = bits.next();
            if (bit < 0) return "end too early";
            int& child = nodes_[at][size_t(bit)];
            if (i + 1 == length) {
                if (child != 0) return "contradict each other";
                child = -1 - value;
                return nullptr;
            }
            if (child < 0) return "contradict each other";
            if (child == 0) {
                child = int(nodes_.size());
                at = nodes_.size();
                nodes_.push_back({}); // after the last use of `child`
            } else at = size_t(child);
        }
        return nullptr;
    }
    /// The next value; -1 at the end of the bits, -2 for an invalid code.
    int read(BitsFromTop& bits) const {
        for (size_t at = 0;;) {
            int bit = bits.next();
            if (bit < 0) return -1;
            int child = nodes_[at][size_t(bit)];
            if (child == 0) return -2;
            if (child < 0) return -1 - child;
            at = size_t(child);
        }
    }

private:
    std::vector<std::array<int, 2>> nodes_;
};

} // namespace

const char* runLengths(Bytes from, std::span<uint8_t> tile, size_t sampleBytes) {
    size_t in = 0, out = 0;
    while (out < tile.size()) {
        if (in >= from.size()) return "end too early";
        const size_t n = size_t(from[in] & 0x7f) + 1;
        const bool literal = from[in] >= 0x80;
        ++in;
        if (from.size() - in < (literal ? n : 1) * sampleBytes) return "end too early";
        const size_t samples = std::min(n, (tile.size() - out) / sampleBytes);
        for (size_t i = 0; i < samples; ++i, out += sampleBytes)
            std::memcpy(&tile[out], &from[in + (literal ? i * sampleBytes : 0)], sampleBytes);
        in += (literal ? n : 1) * sampleBytes;
    }
    return nullptr;
}

const char* lzw(Bytes from, std::span<uint8_t> tile) {
    constexpr uint32_t reserved = 256, firstNew = 257;
    // An entry is a run of earlier output: each code except the first makes one, of the previous code and one more byte.
    struct Run {
        uint32_t at, length;
    };
    std::vector<Run> runs;
    runs.reserve(tile.size());
    uint64_t held = 0;
    int bits = 0, width = 9;
    size_t in = 0, out = 0;
    Run before{0, 0};
    while (out < tile.size()) {
        while (bits < width) {
            if (in >= from.size()) return "end too early";
            held |= uint64_t(from[in++]) << bits;
            bits += 8;
        }
        const uint32_t code = uint32_t(held & ((uint64_t(1) << width) - 1));
        held >>= width;
        bits -= width;
        // The new entry ends with the first byte of this code, which is the next byte put out.
        if (before.length > 0) runs.push_back({before.at, before.length + 1});
        const uint32_t next = firstNew + uint32_t(runs.size());
        Run now{uint32_t(out), 1};
        if (code < reserved) {
            tile[out++] = uint8_t(code);
        } else if (code == reserved || code >= next) {
            return "name a code that is not made yet";
        } else {
            const Run& r = runs[code - firstNew];
            now.length = uint32_t(std::min<size_t>(r.length, tile.size() - out));
            for (uint32_t i = 0; i < now.length; ++i) tile[out++] = tile[r.at + i]; // source and destination may overlap
        }
        before = now;
        if (next == uint32_t(1) << width) ++width;
    }
    return nullptr;
}

const char* huffman(Bytes from, std::span<uint8_t> tile) {
    if (from.size() < 32) return "end too early";
    std::vector<int> used;
    for (int v = 0; v < 256; ++v)
        if (from[size_t(v) >> 3] >> (7 - (v & 7)) & 1) used.push_back(v);
    if (used.empty()) return "name no value";
    const size_t lengths = (used.size() + 1) / 2;
    if (from.size() - 32 < lengths) return "end too early";
    BitsFromTop bits(from.subspan(32 + lengths));
    PrefixTree tree;
    for (size_t i = 0; i < used.size(); ++i) {
        const int nibble = from[32 + i / 2] >> (i % 2 ? 0 : 4) & 15;
        if (const char* why = tree.add(bits, nibble + 1, used[i])) return why;
    }
    bits.toByte();
    for (uint8_t& t : tile) {
        const int v = tree.read(bits);
        if (v == -1) return "end too early";
        if (v < 0) return "hold a code that no value has";
        t = uint8_t(v);
    }
    return nullptr;
}

const char* deflated(Bytes from, std::span<uint8_t> tile, size_t sampleBytes, bool bigEndian) {
    uLongf size = uLongf(tile.size());
    const int result = uncompress(tile.data(), &size, from.data(), uLong(from.size()));
    if (result == Z_MEM_ERROR) return "need more memory than is available";
    if (result != Z_OK) return "cannot be inflated";
    if (size != tile.size()) return "end too early";
    if (sampleBytes == 1) {
        for (size_t i = 1; i < tile.size(); ++i) tile[i] = uint8_t(tile[i] + tile[i - 1]);
        return nullptr;
    }
    uint32_t sum = 0;
    for (size_t i = 0; i + 4 <= tile.size(); i += 4)
        for (int pass = 0; pass < 2; ++pass) { // read the difference, write the sum
            uint32_t word = pass ? sum : 0;
            for (size_t k = 0; k < 4; ++k) {
                const size_t shift = 8 * (bigEndian ? 3 - k : k);
                if (pass) tile[i + k] = uint8_t(word >> shift);
                else word |= uint32_t(tile[i + k]) << shift;
            }
            if (!pass) sum += word;
        }
    return nullptr;
}

} // namespace alpenglow::display::pixar
