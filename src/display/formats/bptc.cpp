// BC6H and BC7. Source: GL_ARB_texture_compression_bptc, whose tables these are.
#include "base/half.h"
#include "display/formats/blocks.h"
#include <array>
#include <cstring>
#include <utility>

namespace alpenglow::display {
namespace {

/// Bit i: the subset of texel i, where there are two.
constexpr uint16_t kHalves[64] = {
    0xcccc, 0x8888, 0xeeee, 0xecc8, 0xc880, 0xfeec, 0xfec8, 0xec80, 0xc800, 0xffec, 0xfe80, 0xe800, 0xffe8,
    0xff00, 0xfff0, 0xf000, 0xf710, 0x008e, 0x7100, 0x08ce, 0x008c, 0x7310, 0x3100, 0x8cce, 0x088c, 0x3110,
    0x6666, 0x366c, 0x17e8, 0x0ff0, 0x718e, 0x399c, 0xaaaa, 0xf0f0, 0x5a5a, 0x33cc, 0x3c3c, 0x55aa, 0x9696,
    0xa55a, 0x73ce, 0x13c8, 0x324c, 0x3bdc, 0x6996, 0xc33c, 0x9966, 0x0660, 0x0272, 0x04e4, 0x4e40, 0x2720,
    0xc936, 0x936c, 0x39c6, 0x639c, 0x9336, 0x9cc6, 0x817e, 0xe718, 0xccf0, 0x0fcc, 0x7744, 0xee22,
};
/// Bits 2i and 2i + 1: the subset of texel i, where there are three.
constexpr uint32_t kThirds[64] = {
    0xaa685050, 0x6a5a5040, 0x5a5a4200, 0x5450a0a8, 0xa5a50000, 0xa0a05050, 0x5555a0a0, 0x5a5a5050, 0xaa550000, 0xaa555500,
    0xaaaa5500, 0x90909090, 0x94949494, 0xa4a4a4a4, 0xa9a59450, 0x2a0a4250, 0xa5945040, 0x0a425054, 0xa5a5a500, 0x55a0a0a0,
    0xa8a85454, 0x6a6a4040, 0xa4a45000, 0x1a1a0500, 0x0050a4a4, 0xaaa59090, 0x14696914, 0x69691400, 0xa08585a0, 0xaa821414,
    0x50a4a450, 0x6a5a0200, 0xa9a58000, 0x5090a0a8, 0xa8a09050, 0x24242424, 0x00aa5500, 0x24924924, 0x24499224, 0x50a50a50,
    0x500aa550, 0xaaaa4444, 0x66660000, 0xa5a0a5a0, 0x50a050a0, 0x69286928, 0x44aaaa44, 0x66666600, 0xaa444444, 0x54a854a8,
    0x95809580, 0x96969600, 0xa85454a8, 0x80959580, 0xaa141414, 0x96960000, 0xaaaa1414, 0xa05050a0, 0xa0a5a5a0, 0x96000000,
    0x40804080, 0xa9a8a9a8, 0xaaaaaa44, 0x2a4a5254,
};
/// The texel with one bit less of its index: of the second subset of two, of the second of three, of the third of three.
constexpr uint8_t kAnchors[3][64] = {
    {15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 2, 8, 2, 2,  8,  8, 15, 2,  8,  2,  2,  8,  8, 2, 2,
     15, 15, 6,  8,  2,  8,  15, 15, 2,  8,  2,  2,  2,  15, 15, 6,  6,  2, 6, 8, 15, 15, 2, 2,  15, 15, 15, 15, 15, 2, 2, 15},
    {3, 3,  15, 15, 8, 3,  15, 15, 8,  8, 6,  6, 6,  5,  3,  3,  3, 3,  8, 15, 3, 3, 6, 10, 5, 8,  8, 6,  8,  5,  15, 15,
     8, 15, 3,  5,  6, 10, 8,  15, 15, 3, 15, 5, 15, 15, 15, 15, 3, 15, 5, 5,  5, 8, 5, 10, 5, 10, 8, 13, 15, 12, 3,  3},
    {15, 8, 8,  3,  15, 15, 3, 8,  15, 15, 15, 15, 15, 15, 15, 8, 15, 8, 15, 3,  15, 8,  15, 8,  3,  15, 6,  10, 15, 15, 10, 8,
     15, 3, 15, 10, 10, 8,  9, 10, 6,  15, 8,  15, 3,  6,  6,  8, 15, 3, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 3,  15, 15, 8}};

constexpr int kWeights2[4] = {0, 21, 43, 64};
constexpr int kWeights3[8] = {0, 9, 18, 27, 37, 46, 55, 64};
constexpr int kWeights4[16] = {0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64};

int weightOf(unsigned index, unsigned bits) {
    return bits == 2 ? kWeights2[index] : bits == 3 ? kWeights3[index] : kWeights4[index];
}

int between(int a, int b, int weight) { return ((64 - weight) * a + weight * b + 32) >> 6; }

/// The bits of a block, from the lowest on; behind the last there are zeros.
struct BlockBits {
    const uint8_t* b;
    unsigned at = 0;
    unsigned take(unsigned n) {
        unsigned v = 0;
        for (unsigned i = 0; i < n; ++i, ++at)
            if (at < 128) v |= unsigned(b[at / 8] >> (at % 8) & 1) << i;
        return v;
    }
};

unsigned subsetOf(unsigned subsets, unsigned partition, unsigned texel) {
    if (subsets == 2) return kHalves[partition] >> texel & 1;
    return subsets == 3 ? kThirds[partition] >> (2 * texel) & 3 : 0;
}

bool isAnchor(unsigned subsets, unsigned partition, unsigned texel) {
    if (texel == 0) return true;
    if (subsets == 2) return texel == kAnchors[0][partition];
    return subsets == 3 && (texel == kAnchors[1][partition] || texel == kAnchors[2][partition]);
}

struct Bc7Mode {
    unsigned subsets, partition, rotation, selection, colour, alpha, endP, sharedP, index, second;
};
constexpr Bc7Mode kModes[8] = {{3, 4, 0, 0, 4, 0, 1, 0, 3, 0}, {2, 6, 0, 0, 6, 0, 0, 1, 3, 0}, {3, 6, 0, 0, 5, 0, 0, 0, 2, 0},
                               {2, 6, 0, 0, 7, 0, 1, 0, 2, 0}, {1, 0, 2, 1, 5, 6, 0, 0, 2, 3}, {1, 0, 2, 0, 7, 8, 0, 0, 2, 2},
                               {1, 0, 0, 0, 7, 7, 1, 0, 4, 0}, {2, 6, 0, 0, 5, 5, 1, 0, 2, 0}};

/// Endpoints of all subsets as codes 0 to 255: two a subset.
void readEnds(BlockBits& bits, const Bc7Mode& m, int ends[6][4]) {
    const unsigned n = 2 * m.subsets;
    for (int c = 0; c < 3; ++c)
        for (unsigned e = 0; e < n; ++e) ends[e][c] = int(bits.take(m.colour));
    for (unsigned e = 0; e < n; ++e) ends[e][3] = m.alpha ? int(bits.take(m.alpha)) : 255;
    unsigned p[6] = {};
    const unsigned extra = m.endP || m.sharedP;
    for (unsigned e = 0; e < n; ++e) p[e] = m.endP ? bits.take(1) : m.sharedP && e % 2 ? p[e - 1] : m.sharedP ? bits.take(1) : 0;
    for (unsigned e = 0; e < n; ++e)
        for (int c = 0; c < (m.alpha ? 4 : 3); ++c) {
            const unsigned width = (c < 3 ? m.colour : m.alpha) + extra;
            const unsigned v = (extra ? unsigned(ends[e][c]) << 1 | p[e] : unsigned(ends[e][c])) << (8 - width);
            ends[e][c] = int(v | v >> width);
        }
}

void readIndices(BlockBits& bits, unsigned width, unsigned subsets, unsigned partition, unsigned indices[16]) {
    for (unsigned i = 0; i < 16; ++i) indices[i] = width ? bits.take(width - isAnchor(subsets, partition, i)) : 0;
}

/// Bit positions of the endpoints of a BC6H mode, in the words of the specification: r0 to b3 are red to blue of the four
/// endpoints; [a:b] are bits b to a, lowest first, or reversed if a < b.
struct Bc6Mode {
    unsigned number;
    bool relative;
    unsigned partition, width, delta[3];
    const char* fields;
};
constexpr Bc6Mode kFloatModes[14] = {
    {0,
     true,
     5,
     10,
     {5, 5, 5},
     "g2[4],b2[4],b3[4],r0[9:0],g0[9:0],b0[9:0],r1[4:0],g3[4],g2[3:0],g1[4:0],b3[0],g3[3:0],b1[4:0],"
     "b3[1],b2[3:0],r2[4:0],b3[2],r3[4:0],b3[3]"},
    {1,
     true,
     5,
     7,
     {6, 6, 6},
     "g2[5],g3[4],g3[5],r0[6:0],b3[0],b3[1],b2[4],g0[6:0],b2[5],b3[2],g2[4],b0[6:0],b3[3],b3[5],b3[4],"
     "r1[5:0],g2[3:0],g1[5:0],g3[3:0],b1[5:0],b2[3:0],r2[5:0],r3[5:0]"},
    {2,
     true,
     5,
     11,
     {5, 4, 4},
     "r0[9:0],g0[9:0],b0[9:0],r1[4:0],r0[10],g2[3:0],g1[3:0],g0[10],b3[0],g3[3:0],b1[3:0],b0[10],"
     "b3[1],b2[3:0],r2[4:0],b3[2],r3[4:0],b3[3]"},
    {6,
     true,
     5,
     11,
     {4, 5, 4},
     "r0[9:0],g0[9:0],b0[9:0],r1[3:0],r0[10],g3[4],g2[3:0],g1[4:0],g0[10],g3[3:0],b1[3:0],b0[10],"
     "b3[1],b2[3:0],r2[3:0],b3[0],b3[2],r3[3:0],g2[4],b3[3]"},
    {10,
     true,
     5,
     11,
     {4, 4, 5},
     "r0[9:0],g0[9:0],b0[9:0],r1[3:0],r0[10],b2[4],g2[3:0],g1[3:0],g0[10],b3[0],g3[3:0],b1[4:0],"
     "b0[10],b2[3:0],r2[3:0],b3[1],b3[2],r3[3:0],b3[4],b3[3]"},
    {14,
     true,
     5,
     9,
     {5, 5, 5},
     "r0[8:0],b2[4],g0[8:0],g2[4],b0[8:0],b3[4],r1[4:0],g3[4],g2[3:0],g1[4:0],b3[0],g3[3:0],b1[4:0],"
     "b3[1],b2[3:0],r2[4:0],b3[2],r3[4:0],b3[3]"},
    {18,
     true,
     5,
     8,
     {6, 5, 5},
     "r0[7:0],g3[4],b2[4],g0[7:0],b3[2],g2[4],b0[7:0],b3[3],b3[4],r1[5:0],g2[3:0],g1[4:0],b3[0],"
     "g3[3:0],b1[4:0],b3[1],b2[3:0],r2[5:0],r3[5:0]"},
    {22,
     true,
     5,
     8,
     {5, 6, 5},
     "r0[7:0],b3[0],b2[4],g0[7:0],g2[5],g2[4],b0[7:0],g3[5],b3[4],r1[4:0],g3[4],g2[3:0],g1[5:0],"
     "g3[3:0],b1[4:0],b3[1],b2[3:0],r2[4:0],b3[2],r3[4:0],b3[3]"},
    {26,
     true,
     5,
     8,
     {5, 5, 6},
     "r0[7:0],b3[1],b2[4],g0[7:0],b2[5],g2[4],b0[7:0],b3[5],b3[4],r1[4:0],g3[4],g2[3:0],g1[4:0],"
     "b3[0],g3[3:0],b1[5:0],b2[3:0],r2[4:0],b3[2],r3[4:0],b3[3]"},
    {30,
     false,
     5,
     6,
     {6, 6, 6},
     "r0[5:0],g3[4],b3[0],b3[1],b2[4],g0[5:0],g2[5],b2[5],b3[2],g2[4],b0[5:0],g3[5],b3[3],b3[5],"
     "b3[4],r1[5:0],g2[3:0],g1[5:0],g3[3:0],b1[5:0],b2[3:0],r2[5:0],r3[5:0]"},
    {3, false, 0, 10, {10, 10, 10}, "r0[9:0],g0[9:0],b0[9:0],r1[9:0],g1[9:0],b1[9:0]"},
    {7, true, 0, 11, {9, 9, 9}, "r0[9:0],g0[9:0],b0[9:0],r1[8:0],r0[10],g1[8:0],g0[10],b1[8:0],b0[10]"},
    {11, true, 0, 12, {8, 8, 8}, "r0[9:0],g0[9:0],b0[9:0],r1[7:0],r0[10:11],g1[7:0],g0[10:11],b1[7:0],b0[10:11]"},
    {15, true, 0, 16, {4, 4, 4}, "r0[9:0],g0[9:0],b0[9:0],r1[3:0],r0[10:15],g1[3:0],g0[10:15],b1[3:0],b0[10:15]"}};

/// Reads the ends by the fields of a mode.
void readFields(BlockBits& bits, const char* p, int ends[4][3]) {
    while (*p) {
        int* v = &ends[p[1] - '0'][p[0] == 'r' ? 0 : p[0] == 'g' ? 1 : 2];
        p += 3;
        const auto number = [&] {
            int n = 0;
            while (*p >= '0' && *p <= '9') n = 10 * n + (*p++ - '0');
            return n;
        };
        const int a = number();
        int b = a;
        if (*p == ':') ++p, b = number();
        p += p[1] == ',' ? 2 : 1;
        for (int i = 0, n = a < b ? b - a : a - b; i <= n; ++i) *v |= int(bits.take(1)) << (a < b ? b - i : b + i);
    }
}

int signExtended(int v, unsigned bits) {
    const int top = 1 << (bits - 1);
    return (v & ((1 << bits) - 1) & ~top) - (v & top);
}

int unquantised(int x, unsigned width, bool isSigned) {
    const int w = int(width);
    if (!isSigned) {
        if (w >= 15) return x;
        return x == 0 ? 0 : x == (1 << w) - 1 ? 0xffff : ((x << 15) + 0x4000) >> (w - 1);
    }
    if (w >= 16) return x;
    const bool negative = x < 0;
    if (negative) x = -x;
    const int u = x == 0 ? 0 : x >= (1 << (w - 1)) - 1 ? 0x7fff : ((x << 15) + 0x4000) >> (w - 1);
    return negative ? -u : u;
}

float floatOf(int v, bool isSigned) {
    if (!isSigned) return ofHalf(uint16_t((v * 31) >> 6));
    const bool negative = v < 0;
    return ofHalf(uint16_t((((negative ? -v : v) * 31) >> 5) | (negative ? 0x8000 : 0)));
}

} // namespace

void decodeBc7(const uint8_t* b, float texels[16][4]) {
    unsigned number = 0;
    while (number < 8 && !(b[0] >> number & 1)) ++number;
    if (number == 8) { // reserved
        for (unsigned i = 0; i < 16; ++i) std::memset(texels[i], 0, sizeof texels[i]);
        return;
    }
    const Bc7Mode& m = kModes[number];
    BlockBits bits{b, number + 1};
    const unsigned partition = bits.take(m.partition), rotation = bits.take(m.rotation), selection = bits.take(m.selection);
    int ends[6][4];
    readEnds(bits, m, ends);
    unsigned first[16], second[16];
    readIndices(bits, m.index, m.subsets, partition, first);
    readIndices(bits, m.second, m.subsets, partition, second);
    for (unsigned i = 0; i < 16; ++i) {
        const int *p = ends[2 * subsetOf(m.subsets, partition, i)], *q = p + 4;
        int colour = weightOf(first[i], m.index), alpha = m.second ? weightOf(second[i], m.second) : colour;
        if (selection) std::swap(colour, alpha);
        float* to = texels[i];
        for (int c = 0; c < 4; ++c) to[c] = float(between(p[c], q[c], c < 3 ? colour : alpha)) / 255;
        if (rotation) std::swap(to[3], to[rotation - 1]);
    }
}

void decodeBc6(const uint8_t* b, bool isSigned, float texels[16][4]) {
    BlockBits bits{b};
    unsigned number = bits.take(2);
    if (number >= 2) number |= bits.take(3) << 2;
    const Bc6Mode* mode = nullptr;
    for (const Bc6Mode& m : kFloatModes)
        if (m.number == number) mode = &m;
    if (!mode) { // reserved
        for (unsigned i = 0; i < 16; ++i) texels[i][0] = texels[i][1] = texels[i][2] = 0;
        return;
    }
    int ends[4][3] = {};
    readFields(bits, mode->fields, ends);
    const unsigned subsets = mode->partition ? 2 : 1, partition = bits.take(mode->partition), width = mode->width;
    for (unsigned e = 0; e < 2 * subsets; ++e)
        for (int c = 0; c < 3; ++c) {
            int& v = ends[e][c];
            if (e == 0) {
                if (isSigned) v = signExtended(v, width);
                continue;
            }
            if (mode->relative) v = (signExtended(v, mode->delta[c]) + ends[0][c]) & ((1 << width) - 1);
            if (isSigned) v = signExtended(v, width);
        }
    for (auto& end : ends)
        for (int& v : end) v = unquantised(v, width, isSigned);
    unsigned indices[16];
    const unsigned indexBits = subsets == 2 ? 3 : 4;
    readIndices(bits, indexBits, subsets, partition, indices);
    for (unsigned i = 0; i < 16; ++i) {
        const int *p = ends[2 * subsetOf(subsets, partition, i)], *q = p + 3;
        for (int c = 0; c < 3; ++c) texels[i][c] = floatOf(between(p[c], q[c], weightOf(indices[i], indexBits)), isSigned);
    }
}

} // namespace alpenglow::display
