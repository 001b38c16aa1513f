// BC1 to BC5. Sources: GL_EXT_texture_compression_s3tc, GL_ARB_texture_compression_rgtc.
#include "display/formats/blocks.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::display {
namespace {

unsigned pairOf(const uint8_t* b) { return unsigned(b[0]) | unsigned(b[1]) << 8; }

/// Codes 0 to 255 of a colour of 5, 6 and 5 bits.
void spread565(unsigned c, int rgb[3]) {
    const int r = int(c >> 11 & 31), g = int(c >> 5 & 63), b = int(c & 31);
    rgb[0] = r << 3 | r >> 2;
    rgb[1] = g << 2 | g >> 4;
    rgb[2] = b << 3 | b >> 2;
}

/// Eight bytes: two colours, and two bits a texel between them. `four`: always four colours, else the order of the two decides.
void colours(const uint8_t* b, bool four, bool alpha, float texels[16][4]) {
    const unsigned c0 = pairOf(b), c1 = pairOf(b + 2);
    int palette[4][3];
    spread565(c0, palette[0]);
    spread565(c1, palette[1]);
    const bool thirds = four || c0 > c1;
    for (int k = 0; k < 3; ++k) {
        const int p = palette[0][k], q = palette[1][k];
        palette[2][k] = thirds ? (2 * p + q + 1) / 3 : (p + q + 1) / 2;
        palette[3][k] = thirds ? (p + 2 * q + 1) / 3 : 0;
    }
    const unsigned bits = pairOf(b + 4) | pairOf(b + 6) << 16;
    for (unsigned i = 0; i < 16; ++i) {
        const unsigned at = bits >> (2 * i) & 3;
        for (int k = 0; k < 3; ++k) texels[i][k] = float(palette[at][k]) / 255;
        if (alpha) texels[i][3] = !thirds && at == 3 ? 0.f : 1.f;
    }
}

/// Eight bytes: two numbers, and three bits a texel between them.
void ramp(const uint8_t* b, bool isSigned, float texels[16][4], int channel) {
    const auto number = [&](uint8_t v) { return isSigned ? float(std::max<int>(int8_t(v), -127)) / 127 : float(v) / 255; };
    const bool eight = isSigned ? int8_t(b[0]) > int8_t(b[1]) : b[0] > b[1];
    float palette[8] = {number(b[0]), number(b[1])};
    const int steps = eight ? 7 : 5;
    for (int i = 1; i < steps; ++i) palette[i + 1] = (float(steps - i) * palette[0] + float(i) * palette[1]) / float(steps);
    if (!eight) palette[6] = isSigned ? -1.f : 0.f, palette[7] = 1;
    uint64_t bits = 0;
    for (unsigned i = 0; i < 6; ++i) bits |= uint64_t(b[2 + i]) << (8 * i);
    for (unsigned i = 0; i < 16; ++i) texels[i][channel] = palette[bits >> (3 * i) & 7];
}

} // namespace

size_t bytesOf(Block k) { return k == Block::Bc1 || k == Block::Bc1Alpha || k == Block::Bc4 || k == Block::Bc4Signed ? 8 : 16; }

int channelsOf(Block k) {
    switch (k) {
    case Block::Bc4:
    case Block::Bc4Signed:
        return 1;
    case Block::Bc5:
    case Block::Bc5Signed:
        return 2;
    case Block::Bc1:
    case Block::Bc6:
    case Block::Bc6Signed:
        return 3;
    default:
        return 4;
    }
}

void decodeBlock(Block k, const uint8_t* b, float texels[16][4]) {
    switch (k) {
    case Block::Bc1:
    case Block::Bc1Alpha:
        return colours(b, false, k == Block::Bc1Alpha, texels);
    case Block::Bc2:
        colours(b + 8, true, false, texels);
        for (unsigned i = 0; i < 16; ++i) texels[i][3] = float(b[i / 2] >> (i % 2 * 4) & 15) / 15;
        return;
    case Block::Bc3:
        colours(b + 8, true, false, texels);
        ramp(b, false, texels, 3);
        for (unsigned i = 0; i < 16; ++i) texels[i][3] = float(std::lround(texels[i][3] * 255)) / 255;
        return;
    case Block::Bc4:
    case Block::Bc4Signed:
        return ramp(b, k == Block::Bc4Signed, texels, 0);
    case Block::Bc5:
    case Block::Bc5Signed:
        ramp(b, k == Block::Bc5Signed, texels, 0);
        return ramp(b + 8, k == Block::Bc5Signed, texels, 1);
    case Block::Bc6:
    case Block::Bc6Signed:
        return decodeBc6(b, k == Block::Bc6Signed, texels);
    case Block::Bc7:
        return decodeBc7(b, texels);
    }
}

} // namespace alpenglow::display
